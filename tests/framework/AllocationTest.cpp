#include <gmock/gmock.h>

#include "components/framework/SamplePool.hpp"
#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::framework {
namespace {

using Large = std::shared_ptr<const std::vector<float>>;

/** Copies a large sample to its output, like a component. */
struct Copier : TaskContext {
    using TaskContext::TaskContext;
    InputPort<Large> in{this, "in", "samples"};
    OutputPort<Large> out{this, "out", "their copies"};
    SamplePool<std::vector<float>> pool;
    void updateHook() override {
        Large sample;
        if (!in.readNew(sample)) return;
        const auto copy = pool.take();
        *copy = *sample;
        recordStage("copying of the whole sample", 1e-3);
        out.write(copy);
    }
};

TEST(AllocationTest, CountsAllocationsOnTheTasksThreadOnly) {
    Copier task("copier");
    std::unique_ptr<int> kept;
    auto allocate = [&] { kept = std::make_unique<int>(1); };
    EXPECT_THAT(test::allocationsOn(task, [&] { task.activity().call(allocate); }),
                testing::ElementsAre(testing::HasSubstr("framework_test+0x")));
    EXPECT_THAT(test::allocationsOn(task, allocate), testing::IsEmpty());
}

TEST(AllocationTest, ASteadyStreamAllocatesNothing) {
    for (const ConnPolicy policy : {ConnPolicy::data(), ConnPolicy::buffer(3), ConnPolicy::circularBuffer(2)}) {
        test::Writer<Large> writer;
        test::Reader<Large> reader;
        Copier task("copier");
        writer.port.connectTo(task.in, policy);
        task.out.connectTo(reader.port, policy);
        task.configure();
        task.start();
        const Large sample = std::make_shared<std::vector<float>>(1000);
        Large got;
        const auto ping = [&] {
            writer.port.write(sample);
            task.update();
            return reader.port.readNew(got);
        };
        for (int warm_up = 0; warm_up < 5; ++warm_up) ASSERT_TRUE(ping());
        const auto allocations = test::allocationsOn(task, [&] {
            test::countHere(true);  // the ends of the connections allocate nothing either
            for (int i = 0; i < 100; ++i) ping();
            test::countHere(false);
        });
        EXPECT_THAT(allocations, testing::IsEmpty());
    }
}

}  // namespace
}  // namespace insonify::framework
