#include <gmock/gmock.h>

#include "components/framework/DynamicPorts.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;

/** The data of the tasks below for each port. */
template <class T>
struct Noted {
    std::string source;
    std::vector<std::string> got = {};
};

/** Takes doubles, texts and pictures on ports of any name. */
struct Collector : TaskContext {
    using TaskContext::TaskContext;
    DynamicInputs<std::tuple<double, std::string, types::Image>, Noted> inputs{this};
    InputPortBase* makeInput(const std::string& port, OutputPortBase& source) override {
        return inputs.make(port, source, source.path());
    }
    void updateHook() override {
        inputs.forEach([]<class Input>(Input& input) {
            for (typename Input::Carried sample{}; input.port.readNew(sample);)
                input.kept.got.push_back(framework::typeName<typename Input::Sample>());
        });
    }
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        inputs.forEach([&](const auto& input) { names.push_back(input.kept.source + ">" + input.port.path()); });
        return names;
    }
};

template <class T>
void connect(test::Writer<T>& writer, TaskContext& reader, const std::string& name) {
    InputPortBase* const port = reader.makeInput(name, writer.port);
    ASSERT_NE(port, nullptr);
    ASSERT_TRUE(writer.port.connectTo(*port, ConnPolicy::buffer(4)));
}

TEST(DynamicPortsTest, MakesAnInputWithTaskDataForEachConnectionInOrder) {
    test::Writer<double> depth("depth");
    test::Writer<std::string> text("text");
    test::Writer<std::shared_ptr<const types::Image>> camera("camera");
    Collector task("log");
    connect(text, task, "b");
    connect(camera, task, "c");
    connect(depth, task, "a");
    EXPECT_THAT(task.names(), ElementsAre("text.port>log.b", "camera.port>log.c", "depth.port>log.a"));
    EXPECT_EQ(task.input("c")->typeName(), types::Image::type_name);
    EXPECT_EQ(task.input("c")->doc(), "samples of camera.port");
    EXPECT_EQ(task.input("c")->need(), Need::Optional);
}

TEST(DynamicPortsTest, SamplesOfEachTypeArriveOnTheirOwnPorts) {
    test::Writer<double> depth("depth");
    test::Writer<std::shared_ptr<const types::Image>> camera("camera");
    Collector task("log");
    connect(depth, task, "depth");
    connect(camera, task, "camera");
    ASSERT_TRUE(task.configure() && task.start());
    depth.port.write(1);
    depth.port.write(2);
    camera.port.write(std::make_shared<types::Image>());
    task.update();
    std::vector<size_t> counts;
    task.inputs.forEach([&](const auto& input) { counts.push_back(input.kept.got.size()); });
    EXPECT_THAT(counts, ElementsAre(2, 1));
    task.stop();
}

TEST(DynamicPortsTest, ATypeThatIsNotInTheListGetsNoPort) {
    test::Writer<int32_t> numbers;
    Collector task("log");
    EXPECT_EQ(task.makeInput("a", numbers.port), nullptr);
    EXPECT_TRUE(task.inputs.empty());
    EXPECT_EQ(task.input("a"), nullptr);
}

TEST(DynamicPortsTest, AnOutputHasTheFirstTypeThatFits) {
    test::Writer<double> owner("player");
    DynamicOutputs<types::SampleTypes, Noted> outputs{&owner};
    const auto* made =
        outputs.makeFirst("depth", "a depth", []<class T>(std::type_identity<T>) { return std::is_arithmetic_v<T>; });
    ASSERT_NE(made, nullptr);
    EXPECT_TRUE((std::holds_alternative<DynamicOutput<double, Noted>>(*made)));
    EXPECT_EQ(owner.output("depth")->typeName(), "/double");
    EXPECT_EQ(outputs.makeFirst("none", "", [](auto) { return false; }), nullptr);
    EXPECT_EQ(owner.output("none"), nullptr);
    auto& text = outputs.make<std::string>("text", "a text");
    test::Reader<std::string> reader;
    text.port.connectTo(reader.port, {});
    text.port.write("hello");
    std::string got;
    EXPECT_TRUE(reader.port.readNew(got));
    EXPECT_EQ(got, "hello");
}

/** Copies numbers to its output. */
struct Pipe : TaskContext {
    using TaskContext::TaskContext;
    DynamicInputs<types::SampleTypes> inputs{this};
    double sum = 0;
    void updateHook() override {
        inputs.forEach([this]<class Input>(Input& input) {
            for (typename Input::Carried sample{}; input.port.readNew(sample);)
                if constexpr (std::is_same_v<typename Input::Sample, double>) sum += sample;
        });
    }
};

TEST(DynamicPortsTest, ASteadyStreamAllocatesNothing) {
    test::Writer<double> writer;
    Pipe task("pipe");
    writer.port.connectTo(*task.inputs.make("in", writer.port), ConnPolicy::buffer(2));
    ASSERT_TRUE(task.configure() && task.start());
    const auto cycles = [&] {
        for (int i = 0; i < 100; ++i) writer.port.write(1), task.update();
    };
    cycles();
    EXPECT_THAT(test::allocationsOn(task, cycles), testing::IsEmpty());
    EXPECT_EQ(task.sum, 200);
    task.stop();
}

}  // namespace
}  // namespace insonify::framework
