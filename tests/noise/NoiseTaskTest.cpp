#include <gtest/gtest.h>

#include "components/noise/NoiseTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::noise {
namespace {

types::SonarPtr makePing(int64_t time) { return test::shared(test::pingOf(2, 100, 1, time)); }

class NoiseTaskTest : public test::TaskBench<NoiseTask, types::SonarPtr> {
protected:
    NoiseTaskTest() : TaskBench(&NoiseTask::clean, &NoiseTask::noisy) {}
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
