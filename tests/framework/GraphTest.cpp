#include <gmock/gmock.h>

#include "components/framework/Graph.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/** A counted sample. */
struct Shot {
    static constexpr const char* type_name = "/test/Shot";
    static constexpr bool counted = true;
};

struct Gun : TaskContext {
    using TaskContext::TaskContext;
    OutputPort<std::shared_ptr<const Shot>> shot{this, "shot", "counted"};
};

/** Copies counted samples to its output. */
struct Echo : TaskContext {
    using TaskContext::TaskContext;
    InputPort<std::shared_ptr<const Shot>> in{this, "in", "counted"};
    OutputPort<std::shared_ptr<const Shot>> out{this, "out", "counted"};
};

struct Adder : TaskContext {
    using TaskContext::TaskContext;
    InputPort<double> in{this, "in", "a number"};
    OutputPort<double> out{this, "out", "another"};
};

template <class Task>
Task& add(Graph& graph, const std::string& name) {
    return dynamic_cast<Task&>(graph.add(std::make_unique<Task>(name)));
}

std::vector<std::string> namesInOrder(Graph& graph) {
    graph.arrange();
    std::vector<std::string> names;
    for (const TaskContext* task : graph.order()) names.push_back(task->name());
    return names;
}

TEST(GraphTest, OrdersWritersBeforeReadersElseAsAdded) {
    Graph graph;
    auto& last = add<Adder>(graph, "last");
    add<Adder>(graph, "alone");
    auto& first = add<Adder>(graph, "first");
    EXPECT_TRUE(graph.connect(first.out, last.in, {}));
    EXPECT_THAT(namesInOrder(graph), ElementsAre("alone", "first", "last"));
    EXPECT_EQ(graph.task("first"), &first);
    EXPECT_EQ(graph.task("second"), nullptr);
    EXPECT_EQ(graph.connections().front().text(), "first.out>last.in");
}

TEST(GraphTest, PortsOfDifferentTypesAreNotConnected) {
    Graph graph;
    EXPECT_FALSE(graph.connect(add<Gun>(graph, "gun").shot, add<Adder>(graph, "adder").in, {}));
    EXPECT_THAT(graph.connections(), IsEmpty());
}

TEST(GraphTest, InALoopTheBufferLeadsBackwardsAndUnbufferedLoopsAreReported) {
    Graph graph;
    auto &a = add<Adder>(graph, "a"), &b = add<Adder>(graph, "b");
    graph.connect(a.out, b.in, ConnPolicy::buffer(2));
    graph.connect(b.out, a.in, {});
    EXPECT_THAT(namesInOrder(graph), ElementsAre("b", "a"));
    EXPECT_THAT(graph.unbufferedLoops(), IsEmpty());
    graph.connect(a.out, b.in, {});
    EXPECT_EQ(graph.unbufferedLoops().size(), 2u) << "one for each task on it";
}

TEST(GraphTest, CountsTheSamplesThatEverySourceHasWritten) {
    Graph graph;
    auto &near = add<Gun>(graph, "near"), &far = add<Gun>(graph, "far");
    auto& echo = add<Echo>(graph, "echo");
    graph.connect(near.shot, echo.in, {});
    graph.arrange();
    EXPECT_EQ(graph.countedSamples(), 0u);
    for (int i = 0; i < 3; ++i) near.shot.write(nullptr);
    far.shot.write(nullptr);
    far.shot.write(nullptr);
    EXPECT_EQ(graph.countedSamples(), 2u) << "echo reads what it writes, and is no source";
    EXPECT_EQ(Graph().countedSamples(), 0u);
}

/** Causes an error or throws in its cycle. */
struct Misfire : Gun {
    using Gun::Gun;
    bool throws = false;
    void updateHook() override {
        if (throws) throw std::runtime_error("burst");
        error("wet powder");
    }
};

TEST(GraphTest, ReportsErrorsOfSourcesAndFailures) {
    Graph graph;
    auto& gun = add<Misfire>(graph, "gun");
    graph.arrange();
    ASSERT_TRUE(gun.configure() && gun.start()) << gun.lastError();
    EXPECT_FALSE(graph.hasSourceInError());
    gun.update();
    EXPECT_TRUE(graph.hasSourceInError());
    EXPECT_FALSE(graph.hasFailed());
    gun.recover();
    gun.throws = true;
    gun.update();
    EXPECT_TRUE(graph.hasFailed());
}

}  // namespace
}  // namespace insonify::framework
