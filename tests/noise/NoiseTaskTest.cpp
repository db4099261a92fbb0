#include <gmock/gmock.h>

#include "components/noise/NoiseTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::noise {
namespace {

types::SonarPtr shortPing(int64_t time) { return test::shared(test::makePing(2, 100, 1, time)); }

struct NoiseTaskTest : test::TaskBench<NoiseTask, types::SonarPtr> {
    NoiseTaskTest() : TaskBench(&NoiseTask::clean, &NoiseTask::noisy) {}
};

TEST_F(NoiseTaskTest, PassesOnThePingItselfWithoutNoise) {
    startWith({});
    const types::SonarPtr ping = shortPing(1);
    EXPECT_EQ(answerTo(ping), ping);
}

TEST_F(NoiseTaskTest, KeepsTheInputPingUnchangedAndItsTime) {
    startWith({.seed = 1, .speckle = SpeckleConfig{}, .ambient = {}, .additive = AdditiveConfig{-20}});
    const types::SonarPtr ping = shortPing(42);
    const types::SonarPtr noisy = answerTo(ping);
    EXPECT_EQ(noisy->time.microseconds, 42);
    EXPECT_NE(noisy->bins, ping->bins);
    EXPECT_EQ(ping->bins, std::vector<float>(200, 1));
}

TEST_F(NoiseTaskTest, AReplayedPingGetsTheSameNoiseIndependentOfEarlierPings) {
    startWith({.seed = 5, .speckle = SpeckleConfig{}, .ambient = {}, .additive = {}});
    const std::vector<float> first = answerTo(shortPing(7))->bins;
    EXPECT_NE(answerTo(shortPing(8))->bins, first);
    EXPECT_EQ(answerTo(shortPing(7))->bins, first);
}

TEST_F(NoiseTaskTest, ClampedFactorsAreCountedFromStart) {
    NoiseConfig config;
    config.speckle = SpeckleConfig{.law = SpeckleLaw::Gaussian, .mean = 0, .deviation = 1};
    startWith(config);
    answerTo(shortPing(1));
    EXPECT_GT(task_.clamped(), 50u);
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.start());
    EXPECT_EQ(task_.clamped(), 0u);
}

TEST_F(NoiseTaskTest, ReusesAReleasedSample) {
    startWith({.seed = 1, .speckle = SpeckleConfig{}, .ambient = {}, .additive = {}});
    const types::Sonar* held = nullptr;
    bool again = false;
    for (int64_t time = 1; time < 8; ++time) {
        const types::SonarPtr noisy = answerTo(shortPing(time));
        again = again || noisy.get() == held;
        if (!held) held = noisy.get();
    }
    EXPECT_TRUE(again);
}

TEST_F(NoiseTaskTest, RejectsDecibelsWithARemedyAndRecoversWithIntensities) {
    NoiseConfig speckle;
    speckle.speckle.emplace();
    for (const NoiseConfig& config : {NoiseConfig{}, speckle}) {
        startWith(config);
        types::Sonar levels = *shortPing(1);
        levels.bins[150] = -42;
        in_.port.write(std::make_shared<const types::Sonar>(levels));
        task_.update();
        types::SonarPtr answer;
        EXPECT_FALSE(out_.port.readNew(answer));
        EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
        EXPECT_EQ(task_.lastError(),
                  "clean: bins are below 0, as decibels are: no intensities; connect a sonar's ping here, and a "
                  "receiver after the noise");
        EXPECT_TRUE(answerTo(shortPing(2)));
        EXPECT_EQ(task_.state(), framework::TaskState::Running);
        ASSERT_TRUE(task_.stop());
        ASSERT_TRUE(task_.cleanup());
    }
}

TEST_F(NoiseTaskTest, AChangedLawAppliesFromTheNextPing) {
    startWith({});
    task_.operation("setSpeckle")->callText({"{law: gamma, looks: 4}"});
    EXPECT_NE(answerTo(shortPing(1))->bins, shortPing(1)->bins);
}

AmbientConfig makeAmbient(double level_db) {
    AmbientConfig ambient;
    ambient.level_db = level_db;
    return ambient;
}

TEST_F(NoiseTaskTest, WarnsOnceAboutEchoesBelowTheNoiseAndAgainAfterLouderEchoes) {
    std::vector<std::string> reported;
    const auto environment = std::make_shared<framework::Environment>();
    environment->warn = [&](const std::string& text) { reported.push_back(text); };
    task_.setEnvironment(environment);
    startWith({.seed = 1, .speckle = {}, .ambient = makeAmbient(-40), .additive = {}});
    int64_t time = 0;
    const auto receive = [&](float loudest, int pings) {
        for (int i = 0; i < pings; ++i) {
            types::Sonar ping = test::makePing(2, 100, 1e-9f, ++time);
            ping.bins[100 + 25] = loudest;
            answerTo(test::shared(ping));
        }
    };
    receive(1e-3f, 3);
    EXPECT_TRUE(reported.empty()) << "30 dB above";
    receive(1e-6f, 5);
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_EQ(reported[0],
              "task: the echoes are below the noise: the loudest, -60 dB at 2.55 m in beam 1, is 20 dB below the mean "
              "of the noise, -40 dB; raise the source level, or lower the noise");
    receive(1e-3f, 9);
    receive(1e-6f, 1);
    EXPECT_EQ(reported.size(), 1u) << "not right for long enough";
    receive(1e-3f, 10);
    receive(1e-6f, 2);
    EXPECT_EQ(reported.size(), 2u);
}

TEST_F(NoiseTaskTest, DoesNotWarnAboutAnEmptyPingOrWithoutBackground) {
    std::vector<std::string> reported;
    const auto environment = std::make_shared<framework::Environment>();
    environment->warn = [&](const std::string& text) { reported.push_back(text); };
    task_.setEnvironment(environment);
    startWith({.seed = 1, .speckle = {}, .ambient = makeAmbient(-40), .additive = {}});
    answerTo(test::shared(test::makePing(2, 100, 0)));
    ASSERT_TRUE(task_.stop() && task_.cleanup());
    startWith({.seed = 1, .speckle = SpeckleConfig{}, .ambient = {}, .additive = {}});
    answerTo(test::shared(test::makePing(2, 100, 1e-30f)));
    EXPECT_TRUE(reported.empty());
}

}  // namespace
}  // namespace insonify::noise
