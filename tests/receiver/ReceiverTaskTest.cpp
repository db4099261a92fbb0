#include <gmock/gmock.h>

#include "components/receiver/ReceiverTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::receiver {
namespace {

using testing::HasSubstr;

struct ReceiverTaskTest : test::TaskBench<ReceiverTask, types::SonarPtr> {
    ReceiverTaskTest() : TaskBench(&ReceiverTask::intensity, &ReceiverTask::ping) {}
};

TEST_F(ReceiverTaskTest, PassesOnThePingItselfWithoutConfiguration) {
    startWith({});
    const types::SonarPtr ping = test::shared(test::makePing(2, 10));
    EXPECT_EQ(answerTo(ping), ping);
}

TEST_F(ReceiverTaskTest, KeepsTheInputPingUnchangedAndItsTime) {
    ReceiverConfig config;
    config.gain_db = 10;
    startWith(config);
    const types::SonarPtr ping = test::shared(test::makePing(2, 10, 1, 42)), answer = answerTo(ping);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->time.microseconds, 42);
    EXPECT_EQ(answer->bins, std::vector<float>(20, 10));
    EXPECT_EQ(ping->bins, std::vector<float>(20, 1));
}

TEST_F(ReceiverTaskTest, TheGainOfADriverAppliesFromTheNextPing) {
    test::Writer<types::SonarSettings> driver{"driver"};
    driver.port.connectTo(task_.settings, {});
    startWith({});
    const types::SonarPtr ping = test::shared(test::makePing(2, 10));
    types::SonarSettings asked;
    asked.gain_db = 10;
    driver.port.write(asked);
    task_.update();
    const types::SonarPtr louder = answerTo(ping);
    ASSERT_TRUE(louder);
    EXPECT_EQ(louder->bins, std::vector<float>(20, 10));
    driver.port.write({});
    EXPECT_EQ(answerTo(ping)->bins, louder->bins) << "NaN leaves the gain unchanged";
    EXPECT_EQ(task_.config->gain_db, 10);
}

TEST_F(ReceiverTaskTest, RejectsDecibelsWithARemedyAndRecoversWithIntensities) {
    startWith({});
    EXPECT_FALSE(answerTo(test::shared(test::makePing(2, 10, -60))));
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_EQ(task_.lastError(),
              "intensity: bins are below 0, as decibels are: no intensities; connect the noise, or a sonar's ping");
    EXPECT_TRUE(answerTo(test::shared(test::makePing(2, 10))));
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

TEST_F(ReceiverTaskTest, ABrightnessRejectsBeamsOfUnknownWidthAndRecovers) {
    ReceiverConfig config;
    config.brightness.emplace();
    startWith(config);
    types::Sonar ping = test::makePing(2, 10);
    ping.beam_width = {};
    EXPECT_FALSE(answerTo(test::shared(ping)));
    EXPECT_THAT(task_.lastError(), HasSubstr("the width of its beams is unknown, which brightness needs"));
    EXPECT_TRUE(answerTo(test::shared(test::makePing(2, 10))));
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

TEST_F(ReceiverTaskTest, RejectsAPingShorterThanItsCounts) {
    ReceiverConfig config;
    config.gain_db = 10;
    startWith(config);
    types::Sonar ping = test::makePing(2, 10);
    ping.bins.pop_back();
    EXPECT_FALSE(answerTo(test::shared(ping)));
    EXPECT_THAT(task_.lastError(), HasSubstr("more or fewer bins than the counts say"));
}

TEST_F(ReceiverTaskTest, AChangedGainAppliesFromTheNextPing) {
    startWith({});
    task_.operation("setGain_db")->callText({"20"});
    EXPECT_EQ(answerTo(test::shared(test::makePing(1, 3)))->bins, std::vector<float>(3, 100));
}

TEST_F(ReceiverTaskTest, ReportsTheRangeOfTheGainsClamp) {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 20, .db_per_m = 0, .max_db = 20};
    startWith(config);
    answerTo(test::shared(test::makePing(1, 90)));
    EXPECT_THAT(task_.notices(), testing::IsEmpty()) << "the ping ends at 9 m";
    answerTo(test::shared(test::makePing(1, 110)));
    EXPECT_THAT(task_.notices(), testing::ElementsAre("tvg reaches its max_db of 20 dB at 10 m and stays there"));
}

/** A receiver of eight bits whose warnings are kept. */
struct FlawTest : ReceiverTaskTest {
    FlawTest() {
        const auto environment = std::make_shared<framework::Environment>();
        environment->warn = [this](const std::string& text) { reported_.push_back(text); };
        task_.setEnvironment(environment);
        config_.output = Output::Code;
        config_.code = CodeConfig{.bits = 8, .law = CodeLaw::Log, .full_scale_db = -20, .dynamic_range_db = 60};
    }
    /** Sends pings of 200 bins: a number of bins with an intensity, the others with 1e-5, in the middle of the
     *  codes. */
    void receive(int bins, float intensity, int pings = 1) {
        for (int i = 0; i < pings; ++i) {
            types::Sonar ping = test::makePing(2, 100, 1e-5f);
            std::fill_n(ping.bins.begin(), bins, intensity);
            answerTo(test::shared(ping));
        }
    }

    ReceiverConfig config_;
    std::vector<std::string> reported_;
};

TEST_F(FlawTest, WarnsOnceAboutSaturatedCodesAndAgainAfterGoodPings) {
    startWith(config_);
    receive(20, 1);
    EXPECT_TRUE(reported_.empty()) << "a tenth";
    receive(74, 2, 5);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0],
              "task: saturates: 37 % of the codes are 255, and the loudest bin is 23 dB above full_scale_db, -20 dB; "
              "lower gain_db, or raise full_scale_db");
    receive(1, 1, 10);
    receive(74, 2);
    EXPECT_EQ(reported_.size(), 2u);
}

TEST_F(FlawTest, WarnsAboutCodesOfZeroWithTheDistanceOfTheLoudestBin) {
    config_.gain_db = -50;
    startWith(config_);
    receive(1, 1e-4f, 3);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0],
              "task: gives code 0 in every bin: the loudest is 70 dB below full_scale_db, -20 dB, and codes begin 59.9 "
              "dB below it; raise gain_db, or lower full_scale_db");
}

TEST_F(FlawTest, LinearAndRootCodesBeginAtTheLevelOfTheirLaw) {
    for (const auto& [law, begin] :
         {std::pair{CodeLaw::Linear, "codes begin 27.1 dB"}, {CodeLaw::Sqrt, "codes begin 54.2 dB"}}) {
        config_.code->law = law;
        config_.gain_db = -50;
        Receiver receiver(config_);
        const types::Sonar ping = test::makePing(2, 100, 1e-4f);
        types::Sonar received;
        receiver.receive(ping, received);
        const Receiver::Flaws flaws = receiver.getFlaws(ping, received);
        EXPECT_TRUE(flaws.all_zero);
        EXPECT_THAT(receiver.text(flaws, ping), HasSubstr(begin));
    }
}

TEST_F(FlawTest, AnEmptyPingHasCodesOfZeroAndNoFlaw) {
    startWith(config_);
    answerTo(test::shared(test::makePing(2, 100, 0)));
    EXPECT_TRUE(reported_.empty());
}

TEST_F(FlawTest, WarnsAboutBlankingBeyondTheRangeWithAnyOutput) {
    config_.output = Output::Intensity;
    config_.code.reset();
    config_.blanking = BlankingConfig{12};
    startWith(config_);
    receive(1, 1, 3);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0], "task: silences everything: blanking.range_min is 12 m, the range ends at 10 m");
}

TEST_F(FlawTest, BlankingSilencesARingDown) {
    config_ = {};
    config_.blanking = BlankingConfig{0.5};
    startWith(config_);
    types::Sonar ping = test::makePing(1, 100, 1e-9f);
    for (size_t k = 0; k < 5; ++k) ping.bins[k] = 1;
    const types::SonarPtr echoes = answerTo(test::shared(ping));
    EXPECT_EQ(*std::ranges::max_element(echoes->bins), 1e-9f);
    EXPECT_TRUE(reported_.empty());
}

}  // namespace
}  // namespace insonify::receiver
