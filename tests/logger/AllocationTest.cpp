#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "components/framework/Activity.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"

namespace {

std::atomic<uint64_t> allocations{0};
std::atomic<std::thread::id> watched;  // only this thread's allocations count

}  // namespace

// Not inlined: g++ would take the pairs apart and warn that they do not match.
[[gnu::noinline]] void* operator new(size_t size) {
    if (watched.load() == std::this_thread::get_id()) ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace insonify::logger {
namespace {

TEST(AllocationTest, TheTasksThreadAllocatesNothingOnceItRuns) {
    Folder folder;
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    LoggerConfig config;
    config.file = "x.0.log";
    task.config.set(config);
    test::Writer<types::SonarPtr> sonar("sonar");
    test::Writer<types::Pose> vehicle("vehicle");
    sonar.port.connectTo(*task.makeInput("ping", sonar.port), framework::ConnPolicy::buffer(8));
    vehicle.port.connectTo(*task.makeInput("pose", vehicle.port), framework::ConnPolicy::buffer(8));
    ASSERT_TRUE(task.configure());
    ASSERT_TRUE(task.start());
    const auto ping = std::make_shared<const types::Sonar>();
    types::Pose pose;
    pose.source_frame = "body";
    const auto cycle = [&] {
        sonar.port.write(ping);
        vehicle.port.write(pose);
        task.update();
    };
    cycle();
    task.activity().call([] { watched = std::this_thread::get_id(); });
    for (int i = 0; i < 200; ++i) cycle();
    watched = std::thread::id();
    EXPECT_EQ(allocations, 0u);
    task.activity().call([] {
        watched = std::this_thread::get_id();
        operator delete(operator new(1));
    });
    EXPECT_GE(allocations, 1u) << "counting counts";
    watched = std::thread::id();
}

}  // namespace
}  // namespace insonify::logger
