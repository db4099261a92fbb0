#include <gmock/gmock.h>

#include "components/framework/execution/StreamAligner.hpp"
#include "tests/support/Ports.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::framework {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/** Reads poses and pings in the order of their time, and records "pose 10" and "ping 10". */
struct AligningTask : TaskContext {
    explicit AligningTask(double timeout) : TaskContext("aligning") { aligner.clear(timeout); }
    InputPort<types::Pose> pose{this, "pose", "any"};
    InputPort<types::SonarPtr> ping{this, "ping", "any"};
    StreamAligner aligner;
    AlignedPort<types::Pose> poses{aligner, pose, [this](const types::Pose& sample) { note("pose", sample.time); }, 4};
    AlignedPort<types::SonarPtr> pings{aligner, ping,
                                       [this](const types::SonarPtr& sample) { note("ping", sample->time); }, 4};
    std::vector<std::string> notes;

    void note(const std::string& what, types::Time time) {
        notes.push_back(what + " " + std::to_string(time.microseconds));
    }
};

/** Times are in microseconds; the timeout is 100 us. */
struct StreamAlignerTest : testing::Test {
    StreamAlignerTest() {
        poses_.port.connectTo(task_.pose, ConnPolicy::buffer(100));
        pings_.port.connectTo(task_.ping, ConnPolicy::buffer(100));
    }
    void writePoses(std::initializer_list<int64_t> times) {
        for (const int64_t time : times) {
            types::Pose pose;
            pose.time = {time};
            poses_.port.write(pose);
        }
    }
    void writePings(std::initializer_list<int64_t> times) {
        for (const int64_t time : times) {
            types::Sonar ping;
            ping.time = {time};
            pings_.port.write(std::make_shared<const types::Sonar>(ping));
        }
    }
    /** Returns what is handed over now. */
    std::vector<std::string> update() {
        task_.aligner.update();
        return std::exchange(task_.notes, {});
    }

    AligningTask task_{100e-6};
    test::Writer<types::Pose> poses_;
    test::Writer<types::SonarPtr> pings_;
};

TEST_F(StreamAlignerTest, OrdersSamplesByTimeForAnyOrderOfArrival) {
    writePings({15, 25});
    writePoses({10, 20, 30});
    EXPECT_THAT(update(), ElementsAre("pose 10", "ping 15", "pose 20", "ping 25"));
    writePings({30});
    EXPECT_THAT(update(), ElementsAre("pose 30", "ping 30"));
}

TEST_F(StreamAlignerTest, ASampleWaitsForAPortThatMayHaveEarlierSamples) {
    writePings({15});
    EXPECT_THAT(update(), IsEmpty()) << "no pose has arrived";
    writePoses({10});
    EXPECT_THAT(update(), ElementsAre("pose 10")) << "there may be another before 15";
    writePoses({16});
    EXPECT_THAT(update(), ElementsAre("ping 15"));
    EXPECT_THAT(task_.aligner.notices(), IsEmpty());
}

TEST_F(StreamAlignerTest, AtEqualTimesThePortDeclaredFirstIsFirst) {
    writePings({10});
    writePoses({10});
    EXPECT_THAT(update(), ElementsAre("pose 10", "ping 10"));
}

TEST_F(StreamAlignerTest, ThePortsNextSampleIsVisibleDuringTheHandOverOfItsPredecessor) {
    writePoses({10, 20});
    writePings({15});
    EXPECT_THAT(update(), ElementsAre("pose 10", "ping 15"));
    ASSERT_NE(task_.poses.next(), nullptr);
    EXPECT_EQ(task_.poses.next()->time, types::Time{20});
    EXPECT_EQ(task_.pings.next(), nullptr);
}

TEST_F(StreamAlignerTest, ASilentPortDelaysTheOthersByTheTimeoutOnly) {
    writePoses({10});
    writePings({20, 119});
    EXPECT_THAT(update(), ElementsAre("pose 10"));
    writePings({120});
    EXPECT_THAT(update(), ElementsAre("ping 20"));
    EXPECT_EQ(task_.poses.counts().awaited, 1u);
    EXPECT_THAT(task_.aligner.notices(), ElementsAre("pose: samples of other ports handed over without it: 1"));
}

TEST_F(StreamAlignerTest, AfterAGapThePortIsWaitedForAgain) {
    writePings({20, 120});
    EXPECT_THAT(update(), ElementsAre("ping 20"));
    writePoses({115, 121});
    EXPECT_THAT(update(), ElementsAre("pose 115", "ping 120"));
    writePings({122});
    EXPECT_THAT(update(), ElementsAre("pose 121"));
    EXPECT_EQ(task_.poses.counts().awaited, 1u);
}

TEST_F(StreamAlignerTest, LateSamplesAreDroppedAndCounted) {
    writePings({20, 120});
    update();
    writePoses({19, 20, 130, 125});
    EXPECT_THAT(update(), ElementsAre("pose 20", "ping 120"))
        << "19 is before the last sample handed over, 125 before 130";
    EXPECT_EQ(task_.poses.counts().received, 4u);
    EXPECT_EQ(task_.poses.counts().late, 2u);
    EXPECT_THAT(task_.aligner.notices(),
                ElementsAre("pose: 2 of 4 samples came too late and were dropped; samples of other ports handed over "
                            "without it: 1"));
}

TEST_F(StreamAlignerTest, AFullPortDoesNotWaitAndLosesNothing) {
    writePings({1, 2, 3, 4, 5, 6});
    EXPECT_THAT(update(), ElementsAre("ping 1", "ping 2", "ping 3"));
    EXPECT_EQ(task_.poses.counts().awaited, 3u);
    EXPECT_EQ(task_.pings.counts().late, 0u);
}

TEST_F(StreamAlignerTest, AnOutpacedPortIsReadAlongWithTheOthers) {
    writePings({1, 3, 5, 7, 9, 11, 13, 15});
    writePoses({2, 4, 6, 8, 10, 12, 14, 16});
    EXPECT_EQ(update().size(), 15u);
    EXPECT_EQ(task_.poses.counts().awaited, 0u);
}

TEST_F(StreamAlignerTest, AcceptsNegativeTimes) {
    writePings({-15, -5});
    writePoses({-20, -10, 0});
    EXPECT_THAT(update(), ElementsAre("pose -20", "ping -15", "pose -10", "ping -5"));
    EXPECT_THAT(task_.aligner.notices(), IsEmpty());
}

TEST_F(StreamAlignerTest, AcceptsTheMaxDistanceOfTimes) {
    writePings({-9'000'000'000'000'000'000, 9'000'000'000'000'000'000});
    EXPECT_THAT(update(), ElementsAre("ping -9000000000000000000")) << "the timeout is long over";
}

TEST_F(StreamAlignerTest, FlushHandsOverAllWaitingSamples) {
    writePings({15, 16});
    writePoses({10});
    task_.aligner.flush();
    EXPECT_THAT(task_.notes, ElementsAre("pose 10", "ping 15", "ping 16"));
}

TEST_F(StreamAlignerTest, ClearResets) {
    writePings({100});
    update();
    task_.aligner.clear(1);
    writePoses({10});
    writePings({9});
    EXPECT_THAT(update(), ElementsAre("ping 9")) << "neither 100 nor the last sample handed over is kept";
}

TEST(StreamAlignerPortTest, DoesNotWaitForAnUnconnectedPort) {
    AligningTask task(1);
    test::Writer<types::Pose> poses;
    poses.port.connectTo(task.pose, ConnPolicy::data());
    poses.port.write(types::Pose{});
    task.aligner.update();
    EXPECT_THAT(task.notes, ElementsAre("pose 0"));
}

TEST_F(StreamAlignerTest, StampsThatGoBackBeginAnew) {
    writePoses({1'000'000, 2'000'000, 500'000, 600'000});
    writePings({1'000'001, 2'000'001, 500'001, 600'001});
    EXPECT_THAT(update(), ElementsAre("pose 1000000", "ping 1000001", "pose 2000000", "ping 2000001", "pose 500000",
                                      "ping 500001", "pose 600000"));
    EXPECT_EQ(task_.poses.counts().late + task_.pings.counts().late, 0u);
    EXPECT_THAT(types::lines(task_.aligner.notices()),
                ElementsAre(testing::StartsWith("stamps went back by more than 1 s 1 times")));
}

TEST_F(StreamAlignerTest, ARecordingThatRepeatsIsNeverLate) {
    std::vector<std::string> all;
    for (int round = 0; round < 20; ++round)
        for (int64_t i = 0; i < 15; ++i) {
            writePoses({100'000 * i});
            writePings({100'000 * i + 50});
            for (std::string& note : update()) all.push_back(std::move(note));
        }
    EXPECT_EQ(task_.poses.counts().late + task_.pings.counts().late, 0u);
    EXPECT_EQ(all.size(), 20u * 30 - 1);
}

TEST_F(StreamAlignerTest, AClockThatIsSetBackDropsNoMoreThanWhatIsUnderWay) {
    task_.aligner.clear(1.0);
    size_t handed_over = 0;
    for (int64_t i = 0; i < 200; ++i) {
        const auto clock = [](int64_t step) {
            return 1'000'000'000 + 100'000 * step - (step >= 100 ? 600'000'000 : 0);
        };
        writePoses({clock(i)});
        if (i >= 3) writePings({clock(i - 3)});  // pings are three steps later
        handed_over += update().size();
    }
    EXPECT_GE(handed_over, 385u);
    EXPECT_EQ(task_.poses.counts().late + task_.pings.counts().late, 0u);
}

TEST_F(StreamAlignerTest, APortWhoseStampsDoNotGoBackWithTheOthersTakesPartAgainAfterTheTimeout) {
    task_.aligner.clear(1.0);
    size_t pings = 0;
    for (int64_t i = 0; i < 300; ++i) {
        writePoses({1'000'000'000 + 100'000 * i - (i >= 100 ? 600'000'000 : 0)});
        writePings({1'000'000'000 + 100'000 * i});
        for (const std::string& note : update()) pings += note.starts_with("ping") ? 1 : 0;
    }
    EXPECT_GE(pings, 270u);
}

}  // namespace
}  // namespace insonify::framework
