// `insonify gazebo` in a world that is paused, stepped, slowed, sped up and reset, with a ball on a turning link.
#include <gmock/gmock.h>
#include <signal.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "components/gazebo/Subscriptions.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/gazebo/Partition.hpp"
#include "tests/gazebo/SteppedWorld.hpp"

using namespace insonify;
using namespace insonify::deployer;

namespace {

struct GazeboStepTest : gazebo::OwnPartition {
    /** A ping as its LaserScan reports it. */
    struct Echo {
        int64_t time;  ///< Of the simulation [us].
        double range;  ///< Of the first return of all beams [m]; infinite: none.
    };
    static constexpr int64_t period = 100'000;  ///< Of the sonar [us].

    /** Starts the sonar, and steps the world until its first ping. */
    void start() {
        writeFile(folder / "w.world",
                  gazebo::SteppedWorld::makeSdf(
                      "<sensor name='fls' type='custom' gz:type='insonify'><update_rate>10</update_rate>"
                      "<topic>/fls</topic><gz:insonify><range>20</range><bin_count>400</bin_count><beam_count>64"
                      "</beam_count><field_of_view_deg>120</field_of_view_deg></gz:insonify></sensor>"));
        sonar = std::make_unique<Process>(insonifyWords({"gazebo", "w.world", "--out", "out", "--timeout", "60"}),
                                          folder.path());
        ASSERT_TRUE(gazebo::becomesTrue([&] {
            step(100);
            pause(0.1);
            return !pings().empty();
        })) << readFile(folder / "stderr.txt");
        pause(0.3);
        const std::lock_guard lock(mutex);
        echoes.clear();
    }
    void stop() {
        sonar->signal(SIGINT);
        EXPECT_THAT(sonar->wait(), succeeds());
    }
    static void pause(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
    void step(int milliseconds) {
        world.step(milliseconds);
        time += milliseconds * 1000;
    }
    std::vector<Echo> pings() const {
        const std::lock_guard lock(mutex);
        return echoes;
    }
    void take(std::string_view bytes) {
        gazebo::wire::LaserScan scan;
        ASSERT_TRUE(scan.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
        const gazebo::wire::Time& stamp = scan.header().stamp();
        const std::lock_guard lock(mutex);
        echoes.push_back({stamp.sec() * 1'000'000 + stamp.nsec() / 1000,
                          *std::min_element(scan.ranges().begin(), scan.ranges().end())});
    }
    /** Waits for a ping of the world's time, the only one since `before` pings. */
    void expectPing(size_t before, const std::string& when) {
        ASSERT_TRUE(gazebo::becomesTrue([&] { return pings().size() > before; })) << when;
        pause(0.05);
        const std::vector<Echo> all = pings();
        ASSERT_EQ(all.size(), before + 1) << when;
        EXPECT_EQ(all.back().time, time) << when;
        EXPECT_NEAR(all.back().range, gazebo::SteppedWorld::computeRange(static_cast<double>(time) * 1e-6), 0.1)
            << when << ": the ball has turned with its link";
    }

    TestFolder folder;
    gazebo::SteppedWorld world;
    int64_t time = 0;  ///< Of the stepped world [us].
    mutable std::mutex mutex;
    std::vector<Echo> echoes;
    gazebo::Subscriber scans{gazebo::TransportOptions::fromEnvironment(""),
                             {{"/fls/scan", [this](const std::string&, std::string_view bytes) { take(bytes); }}}};
    std::unique_ptr<Process> sonar;
};

}  // namespace

TEST_F(GazeboStepTest, EachStepThatReachesItsTimeIsOnePingAndAPauseIsNone) {
    ASSERT_NO_FATAL_FAILURE(start());
    size_t count = 0;
    for (int i = 0; i < 16; ++i) {
        step(50);
        if (time % period == 0)
            ASSERT_NO_FATAL_FAILURE(expectPing(count++, "step of 50 ms"));
        else
            pause(0.06);
        EXPECT_EQ(pings().size(), count) << "step of 50 ms, to " << time;
    }
    for (int i = 0; i < 99; ++i) step(1), pause(i % 20 == 0 ? 0.03 : 0);
    pause(0.1);
    EXPECT_EQ(pings().size(), count) << "99 steps of 1 ms";
    step(1);
    ASSERT_NO_FATAL_FAILURE(expectPing(count++, "the 100th step of 1 ms"));
    step(1000);
    ASSERT_NO_FATAL_FAILURE(expectPing(count++, "1000 steps at once"));
    pause(1.5);  // longer than pose_timeout
    EXPECT_EQ(pings().size(), count) << "paused";
    step(100);
    ASSERT_NO_FATAL_FAILURE(expectPing(count++, "after a pause of 1.5 s"));
    EXPECT_GT(time, 1'000'000);
    for (const int after : {500, 300}) {  // the second reset is of a world younger than a second
        world.reset();
        time = 0;
        ASSERT_NO_FATAL_FAILURE(expectPing(count++, "reset"));
        while (time < after * 1000) {
            step(100);
            ASSERT_NO_FATAL_FAILURE(expectPing(count++, "after the reset"));
        }
    }
    stop();
}

TEST_F(GazeboStepTest, PingsKeepToSimulatedTimeAtAnyRealTimeFactor) {
    ASSERT_NO_FATAL_FAILURE(start());
    world.reset();
    EXPECT_TRUE(gazebo::becomesTrue([&] { return !pings().empty(); }));
    for (const double factor : {0.3, 3.0, 1.0}) {
        const size_t before = pings().size();
        world.setFactor(factor);
        EXPECT_TRUE(gazebo::becomesTrue([&] { return pings().size() >= before + 12; })) << factor;
        world.setFactor(0);
        pause(0.3);
    }
    stop();
    const std::set<int64_t> sent = world.sent();
    ASSERT_GE(echoes.size(), 37u);
    EXPECT_EQ(echoes.front().time, 0);
    for (size_t i = 1; i < echoes.size(); ++i) {
        const auto& [time, range] = echoes[i];
        EXPECT_TRUE(sent.contains(time)) << time << " us is the time of no pose";
        const auto grid = time / period * period;
        const auto first = sent.lower_bound(grid);
        EXPECT_GT(time, echoes[i - 1].time);
        EXPECT_EQ(time, *first) << "the first pose from " << grid << " us on";
        EXPECT_NEAR(range, gazebo::SteppedWorld::computeRange(static_cast<double>(time) * 1e-6), 0.1) << time;
    }
}
