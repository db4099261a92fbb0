#include <gtest/gtest.h>

#include <cstdlib>

#include "components/framework/SamplePool.hpp"
#include "tests/support/Ports.hpp"

namespace {

std::atomic<uint64_t> allocations{0};  // of all threads

}  // namespace

// Not inlined: g++ would take the pairs apart and warn that they do not match.
[[gnu::noinline]] void* operator new(size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace insonify::framework {
namespace {

using Large = std::shared_ptr<const std::vector<float>>;

/** Passes a large sample on, as a component does. */
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

TEST(AllocationTest, CountingCounts) {
    const uint64_t before = allocations;
    const auto something = std::make_unique<int>(1);
    EXPECT_EQ(allocations - before, 1u);
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
        const uint64_t before = allocations;
        for (int i = 0; i < 100; ++i) ping();
        EXPECT_EQ(allocations - before, 0u);
    }
}

}  // namespace
}  // namespace insonify::framework
