#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "components/viewer/SerialExecutors.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::viewer {
namespace {

bool comes(const std::future<void>& done) { return done.wait_for(test::patience) == std::future_status::ready; }

TEST(SerialExecutorsTest, ABlockedExecutorBlocksNoOther) {
    std::promise<void> release, begun, other;
    SerialExecutors lanes;
    ASSERT_TRUE(lanes.run("blocked", [&] {
        begun.set_value();
        release.get_future().wait();
    }));
    ASSERT_TRUE(comes(begun.get_future()));
    ASSERT_TRUE(lanes.run("other", [&] { other.set_value(); }));
    EXPECT_TRUE(comes(other.get_future()));
    release.set_value();
}

TEST(SerialExecutorsTest, AnExecutorKeepsTheOrder) {
    std::string order;
    std::promise<void> last;
    SerialExecutors lanes;
    for (const char c : {'a', 'b', 'c'}) ASSERT_TRUE(lanes.run("", [&order, c] { order += c; }));
    ASSERT_TRUE(lanes.run("", [&] { last.set_value(); }));
    ASSERT_TRUE(comes(last.get_future()));
    EXPECT_EQ(order, "abc");
}

TEST(SerialExecutorsTest, RefusesTooMuchWorkOfOneExecutorOnly) {
    std::promise<void> release, begun;
    SerialExecutors lanes;
    ASSERT_TRUE(lanes.run("full", [&] {
        begun.set_value();
        release.get_future().wait();
    }));
    ASSERT_TRUE(comes(begun.get_future()));
    for (size_t i = 0; i < SerialExecutors::max_waiting; ++i) EXPECT_TRUE(lanes.run("full", [] {}));
    EXPECT_FALSE(lanes.run("full", [] {}));
    EXPECT_TRUE(lanes.run("empty", [] {}));
    release.set_value();
}

TEST(SerialExecutorsTest, TheEndWaitsForRunningWorkAndStartsNoMore) {
    std::promise<void> release, begun;
    std::atomic<bool> done{false}, more{false};
    SerialExecutors lanes;
    lanes.run("", [&] {
        begun.set_value();
        release.get_future().wait();
        done = true;
    });
    lanes.run("", [&] { more = true; });
    ASSERT_TRUE(comes(begun.get_future()));
    auto ended = std::async(std::launch::async, [&] { lanes.end(); });
    while (lanes.run("probe", [] {})) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    release.set_value();
    ASSERT_TRUE(comes(ended));
    EXPECT_TRUE(done);
    EXPECT_FALSE(more);
}

}  // namespace
}  // namespace insonify::viewer
