// Values that are made ahead, where a process forks or ends meanwhile.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "components/sonar/base/MadeAhead.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Hills.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/ThreadLimit.hpp"

namespace insonify::sonar {
namespace {

using std::chrono::milliseconds;

/** Returns whether all values are made within 10 s. */
bool isMade(const MadeAhead& ahead) {
    for (int i = 0; i < 10'000 && !ahead.isDone(); ++i) std::this_thread::sleep_for(milliseconds(1));
    return ahead.isDone();
}

MadeAhead::Items oneNumber(int64_t key) {
    return {{{key}, [](const std::atomic<bool>&) { return std::make_shared<const int>(3); }}};
}

TEST(MadeAheadTest, AForkedChildEndsItWithoutWaitingForAThread) {
    auto ahead = std::make_unique<MadeAhead>("numbers");
    ahead->take(oneNumber(1));
    ASSERT_TRUE(isMade(*ahead));
    const pid_t child = fork();
    if (child == 0) {
        alarm(10);
        ahead->take(oneNumber(2));
        ahead.reset();
        _exit(7);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7) << status;
    ahead->take(oneNumber(3));
    EXPECT_TRUE(isMade(*ahead)) << "the parent goes on";
}

TEST(MadeAheadTest, ItWaitsForAPermittedThread) {
    MadeAhead ahead("numbers");
    {
        const test::ThreadLimit limit(0);
        ahead.take(oneNumber(1));
        EXPECT_TRUE(ahead.isDone()) << "there is nothing to wait for";
    }
    std::atomic<bool> is_made{false};
    ahead.take({{{2}, [&](const std::atomic<bool>&) {
                     is_made = true;
                     return std::make_shared<const int>(3);
                 }}});
    EXPECT_TRUE(isMade(ahead));
    EXPECT_TRUE(is_made);
}

/** Returns the bins of the pings of a sonar that crosses borders of cells, over a scene that gets another object. */
std::vector<std::vector<float>> pingsOnTheWay() {
    SonarConfig config = test::getSonar(
        {.beams = 16, .width_deg = 90, .height_deg = 40, .bins = 100, .bin = 0.5, .rows = 32, .columns = 2});
    config.visibility = Visibility::Cpu;
    const types::Mesh floor = test::hills(40), ball = test::sphere(1, 12);
    types::GeometryPtr scene = test::makeScene({floor, ball}, 0, {{}, {270, 12, -5}});
    SonarRenderer renderer(config, scene, {.threads = 1});
    std::vector<std::vector<float>> pings;
    for (int i = 0; i < 60; ++i) {
        if (i == 30) scene = test::makeScene({floor, ball, ball}, 0, {{}, {270, 12, -5}, {262, 8, -6}});
        if (i == 30) renderer.setGeometry(scene);
        types::Sonar ping;
        renderer.render(test::makeSnapshot(scene, {240 + 0.5 * i, 250 + 0.2 * i, -5}, 0, 0.4), ping);
        pings.push_back(ping.bins);
    }
    return pings;
}

TEST(MadeAheadTest, WhereNoThreadIsPermittedPingsAreTheSame) {
    const auto expected = pingsOnTheWay();
    const test::ThreadLimit limit(0);
    EXPECT_EQ(pingsOnTheWay(), expected);
    const auto echoes = [](const auto& bins) { return *std::ranges::max_element(bins) > 0; };
    EXPECT_EQ(std::ranges::count_if(expected, echoes), 60);
    EXPECT_NE(expected[29], expected[30]);
}

TEST(MadeAheadDeathTest, AProcessThatEndsGivesUpAValueThatIsBeingMade) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            auto* const ahead = new MadeAhead("numbers");
            std::atomic<bool> began{false};
            ahead->take({{{1}, [&](const std::atomic<bool>& quits) -> std::shared_ptr<const void> {
                              began = true;
                              while (!quits) std::this_thread::sleep_for(milliseconds(1));
                              std::fputs("given up\n", stderr);
                              return nullptr;
                          }}});
            while (!began) std::this_thread::sleep_for(milliseconds(1));
            std::exit(0);
        },
        testing::ExitedWithCode(0), "given up");
}

}  // namespace
}  // namespace insonify::sonar
