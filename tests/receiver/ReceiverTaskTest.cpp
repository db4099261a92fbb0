#include <gmock/gmock.h>

#include "components/receiver/ReceiverTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::receiver {
namespace {

using testing::HasSubstr;

class ReceiverTaskTest : public test::TaskBench<ReceiverTask, types::SonarPtr> {
protected:
    ReceiverTaskTest() : TaskBench(&ReceiverTask::intensity, &ReceiverTask::ping) {}
};

TEST_F(ReceiverTaskTest, WithNothingToDoThePingItselfIsPassedOn) {
    startWith({});
    const types::SonarPtr ping = test::shared(test::pingOf(2, 10));
    EXPECT_EQ(answerTo(ping), ping);
}

TEST_F(ReceiverTaskTest, ThePingThatCameInIsNotChangedAndItsTimeIsKept) {
    ReceiverConfig config;
    config.gain_db = 10;
    startWith(config);
    const types::SonarPtr ping = test::shared(test::pingOf(2, 10, 1, 42)), answer = answerTo(ping);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->time.microseconds, 42);
    EXPECT_EQ(answer->bins, std::vector<float>(20, 10));
    EXPECT_EQ(ping->bins, std::vector<float>(20, 1));
}

TEST_F(ReceiverTaskTest, DecibelsAreRefusedWithWhatToConnectAndTheNextIntensitiesAreTaken) {
    startWith({});
    EXPECT_FALSE(answerTo(test::shared(test::pingOf(2, 10, -60))));
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_EQ(task_.lastError(),
              "intensity: bins are below 0, as decibels are: no intensities; connect the noise, or a sonar's ping");
    EXPECT_TRUE(answerTo(test::shared(test::pingOf(2, 10))));
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

TEST_F(ReceiverTaskTest, APingThatIsShorterThanItSaysIsRefused) {
    ReceiverConfig config;
    config.gain_db = 10;
    startWith(config);
    types::Sonar ping = test::pingOf(2, 10);
    ping.bins.pop_back();
    EXPECT_FALSE(answerTo(test::shared(ping)));
    EXPECT_THAT(task_.lastError(), HasSubstr("more or fewer bins than the counts say"));
}

TEST_F(ReceiverTaskTest, AGainThatIsSetWhileItRunsHoldsFromTheNextPingOn) {
    startWith({});
    task_.operation("setGain_db")->callText({"20"});
    EXPECT_EQ(answerTo(test::shared(test::pingOf(1, 3)))->bins, std::vector<float>(3, 100));
}

TEST_F(ReceiverTaskTest, WhereTheGainIsClampedWithinThePingIsTold) {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 20, .db_per_m = 0, .max_db = 20};
    startWith(config);
    answerTo(test::shared(test::pingOf(1, 90)));
    EXPECT_THAT(task_.notices(), testing::IsEmpty()) << "the ping ends at 9 m";
    answerTo(test::shared(test::pingOf(1, 110)));
    EXPECT_THAT(task_.notices(), testing::ElementsAre("tvg reaches its max_db of 20 dB at 10 m and stays there"));
}

}  // namespace
}  // namespace insonify::receiver
