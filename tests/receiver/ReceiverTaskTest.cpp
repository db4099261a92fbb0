#include <gmock/gmock.h>

#include "components/receiver/ReceiverTask.hpp"
#include "tests/receiver/Pings.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::receiver {
namespace {

using testing::HasSubstr;

class ReceiverTaskTest : public ::testing::Test {
protected:
    ReceiverTaskTest() {
        in_.port.connectTo(task_.intensity, {});
        task_.ping.connectTo(out_.port, {});
    }
    void startWith(const ReceiverConfig& config) {
        task_.config.set(config);
        ASSERT_TRUE(task_.configure());
        ASSERT_TRUE(task_.start());
    }
    /** Null when the task refuses it. */
    types::SonarPtr answerTo(const types::SonarPtr& ping) {
        in_.port.write(ping);
        task_.update();
        types::SonarPtr answer;
        out_.port.readNew(answer);
        return answer;
    }

    ReceiverTask task_{"receiver"};
    test::Writer<types::SonarPtr> in_;
    test::Reader<types::SonarPtr> out_;
};

TEST_F(ReceiverTaskTest, WithNothingToDoThePingItselfIsPassedOn) {
    startWith({});
    const types::SonarPtr ping = shared(pingOf(2, 10));
    EXPECT_EQ(answerTo(ping), ping);
}

TEST_F(ReceiverTaskTest, ThePingThatCameInIsNotChangedAndItsTimeIsKept) {
    ReceiverConfig config;
    config.gain_db = 10;
    startWith(config);
    const types::SonarPtr ping = shared(pingOf(2, 10, 1, 42)), answer = answerTo(ping);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->time.microseconds, 42);
    EXPECT_EQ(answer->bins, std::vector<float>(20, 10));
    EXPECT_EQ(ping->bins, std::vector<float>(20, 1));
}

TEST_F(ReceiverTaskTest, DecibelsAreRefusedWithWhatToConnectAndTheNextIntensitiesAreTaken) {
    startWith({});
    EXPECT_FALSE(answerTo(shared(pingOf(2, 10, -60))));
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
    EXPECT_EQ(task_.lastError(),
              "intensity: bins are below 0, as decibels are: no intensities; connect the noise, or a sonar's ping");
    EXPECT_TRUE(answerTo(shared(pingOf(2, 10))));
    EXPECT_EQ(task_.state(), framework::TaskState::Running);
}

TEST_F(ReceiverTaskTest, APingThatIsShorterThanItSaysIsRefused) {
    ReceiverConfig config;
    config.gain_db = 10;
    startWith(config);
    types::Sonar ping = pingOf(2, 10);
    ping.bins.pop_back();
    EXPECT_FALSE(answerTo(shared(ping)));
    EXPECT_THAT(task_.lastError(), HasSubstr("more or fewer bins than the counts say"));
}

TEST_F(ReceiverTaskTest, AGainThatIsSetWhileItRunsHoldsFromTheNextPingOn) {
    startWith({});
    task_.operation("setGain_db")->callText({"20"});
    EXPECT_EQ(answerTo(shared(pingOf(1, 3)))->bins, std::vector<float>(3, 100));
}

TEST_F(ReceiverTaskTest, WhereTheGainIsClampedWithinThePingIsTold) {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 20, .db_per_m = 0, .max_db = 20};
    startWith(config);
    answerTo(shared(pingOf(1, 90)));
    EXPECT_THAT(task_.notices(), testing::IsEmpty()) << "the ping ends at 9 m";
    answerTo(shared(pingOf(1, 110)));
    EXPECT_THAT(task_.notices(), testing::ElementsAre("tvg reaches its max_db of 20 dB at 10 m and stays there"));
}

}  // namespace
}  // namespace insonify::receiver
