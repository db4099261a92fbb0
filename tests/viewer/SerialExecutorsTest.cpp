#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "components/viewer/Publisher.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::viewer {
namespace {

bool arrives(const std::future<void>& done) { return done.wait_for(test::patience) == std::future_status::ready; }

TEST(SerialExecutorsTest, ABlockedExecutorBlocksNoOther) {
    std::promise<void> release, begun, other;
    SerialExecutors executors;
    ASSERT_TRUE(executors.run("blocked", [&] {
        begun.set_value();
        release.get_future().wait();
    }));
    ASSERT_TRUE(arrives(begun.get_future()));
    ASSERT_TRUE(executors.run("other", [&] { other.set_value(); }));
    EXPECT_TRUE(arrives(other.get_future()));
    release.set_value();
}

TEST(SerialExecutorsTest, AnExecutorKeepsTheOrder) {
    std::string order;
    std::promise<void> last;
    SerialExecutors executors;
    for (const char c : {'a', 'b', 'c'}) ASSERT_TRUE(executors.run("", [&order, c] { order += c; }));
    ASSERT_TRUE(executors.run("", [&] { last.set_value(); }));
    ASSERT_TRUE(arrives(last.get_future()));
    EXPECT_EQ(order, "abc");
}

TEST(SerialExecutorsTest, RefusesTooMuchWorkOfOneExecutorOnly) {
    std::promise<void> release, begun;
    SerialExecutors executors;
    ASSERT_TRUE(executors.run("full", [&] {
        begun.set_value();
        release.get_future().wait();
    }));
    ASSERT_TRUE(arrives(begun.get_future()));
    for (size_t i = 0; i < SerialExecutors::max_waiting; ++i) EXPECT_TRUE(executors.run("full", [] {}));
    EXPECT_FALSE(executors.run("full", [] {}));
    EXPECT_TRUE(executors.run("empty", [] {}));
    release.set_value();
}

TEST(SerialExecutorsTest, TheEndWaitsForRunningWorkAndStartsNoMore) {
    std::promise<void> release, begun;
    std::atomic<bool> done{false}, more{false};
    SerialExecutors executors;
    executors.run("", [&] {
        begun.set_value();
        release.get_future().wait();
        done = true;
    });
    executors.run("", [&] { more = true; });
    ASSERT_TRUE(arrives(begun.get_future()));
    auto ended = std::async(std::launch::async, [&] { executors.end(); });
    while (executors.run("probe", [] {})) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    release.set_value();
    ASSERT_TRUE(arrives(ended));
    EXPECT_TRUE(done);
    EXPECT_FALSE(more);
}

}  // namespace
}  // namespace insonify::viewer
