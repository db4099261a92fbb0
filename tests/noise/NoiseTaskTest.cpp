#include <gtest/gtest.h>

#include "components/noise/NoiseTask.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::noise {
namespace {

class NoiseTaskTest : public ::testing::Test {
protected:
    NoiseTaskTest() {
        in_.port.connectTo(task_.clean, {});
        task_.noisy.connectTo(out_.port, {});
    }
    void startWith(const NoiseConfig& config) {
        task_.config.set(config);
        ASSERT_TRUE(task_.configure());
        ASSERT_TRUE(task_.start());
    }
    types::SonarPtr answerTo(const types::SonarPtr& ping) {
        in_.port.write(ping);
        task_.update();
        types::SonarPtr answer;
        EXPECT_TRUE(out_.port.readNew(answer));
        return answer;
    }
    static types::SonarPtr makePing(int64_t time) {
        types::Sonar ping;
        ping.time = {time};
        ping.beam_count = 2;
        ping.bin_count = 100;
        ping.bearings.resize(2);
        ping.bins.assign(200, 1);
        return std::make_shared<const types::Sonar>(ping);
    }

    NoiseTask task_{"noise"};
    test::Writer<types::SonarPtr> in_;
    test::Reader<types::SonarPtr> out_;
};

TEST_F(NoiseTaskTest, WithoutNoiseThePingItselfIsPassedOn) {
    startWith({});
    const types::SonarPtr ping = makePing(1);
    EXPECT_EQ(answerTo(ping), ping);
}

TEST_F(NoiseTaskTest, ThePingThatCameInIsNotChangedAndItsTimeIsKept) {
    startWith({.seed = 1, .speckle = SpeckleConfig{}, .ambient = {}, .additive = AdditiveConfig{-20}});
    const types::SonarPtr ping = makePing(42);
    const types::SonarPtr noisy = answerTo(ping);
    EXPECT_EQ(noisy->time.microseconds, 42);
    EXPECT_NE(noisy->bins, ping->bins);
    EXPECT_EQ(ping->bins, std::vector<float>(200, 1));
}

TEST_F(NoiseTaskTest, APingReplayedGetsTheSameNoiseWhateverCameBefore) {
    startWith({.seed = 5, .speckle = SpeckleConfig{}, .ambient = {}, .additive = {}});
    const std::vector<float> first = answerTo(makePing(7))->bins;
    EXPECT_NE(answerTo(makePing(8))->bins, first);
    EXPECT_EQ(answerTo(makePing(7))->bins, first);
}

TEST_F(NoiseTaskTest, ClampedFactorsAreCountedFromStart) {
    NoiseConfig config;
    config.speckle = SpeckleConfig{.law = SpeckleLaw::Gaussian, .mean = 0, .deviation = 1};
    startWith(config);
    answerTo(makePing(1));
    EXPECT_GT(task_.clamped(), 50u);
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.start());
    EXPECT_EQ(task_.clamped(), 0u);
}

TEST_F(NoiseTaskTest, ASampleThatNobodyHoldsAnyMoreIsUsedAgain) {
    startWith({.seed = 1, .speckle = SpeckleConfig{}, .ambient = {}, .additive = {}});
    const types::Sonar* held = nullptr;
    bool again = false;
    for (int64_t time = 1; time < 8; ++time) {
        const types::SonarPtr noisy = answerTo(makePing(time));
        again = again || noisy.get() == held;
        if (!held) held = noisy.get();
    }
    EXPECT_TRUE(again);
}

TEST_F(NoiseTaskTest, DecibelsAreRefusedWithWhatToConnectAndTheNextIntensitiesAreTaken) {
    NoiseConfig speckle;
    speckle.speckle.emplace();
    for (const NoiseConfig& config : {NoiseConfig{}, speckle}) {
        startWith(config);
        types::Sonar levels = *makePing(1);
        levels.bins[150] = -42;
        in_.port.write(std::make_shared<const types::Sonar>(levels));
        task_.update();
        types::SonarPtr answer;
        EXPECT_FALSE(out_.port.readNew(answer));
        EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
        EXPECT_EQ(task_.lastError(),
                  "clean: bins are below 0, as decibels are: no intensities; connect a sonar's ping here, and a "
                  "receiver after the noise");
        EXPECT_TRUE(answerTo(makePing(2)));
        EXPECT_EQ(task_.state(), framework::TaskState::Running);
        ASSERT_TRUE(task_.stop());
        ASSERT_TRUE(task_.cleanup());
    }
}

TEST_F(NoiseTaskTest, ALawThatIsSetWhileItRunsHoldsFromTheNextPingOn) {
    startWith({});
    task_.operation("setSpeckle")->callText({"{law: gamma, looks: 4}"});
    EXPECT_NE(answerTo(makePing(1))->bins, makePing(1)->bins);
}

}  // namespace
}  // namespace insonify::noise
