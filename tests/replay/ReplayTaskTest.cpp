#include <gmock/gmock.h>

#include "components/log/pocolog/Reader.hpp"
#include "tests/replay/Bench.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::replay {
namespace {

using framework::TaskState;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ReplayTaskTest, PublishesSamplesInFileOrderWhenDue) {
    Bench bench;
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.start("sonar.ping", pings);
    EXPECT_EQ(bench.task.nextTime(), types::Time{10});
    bench.updateAt(9);
    EXPECT_THAT(stampsIn(poses), ElementsAre());
    bench.updateAt(10);
    EXPECT_THAT(stampsIn(poses), ElementsAre(10));
    EXPECT_THAT(stampsIn(pings), ElementsAre()) << "in the file it is after the pose at 20";
    EXPECT_EQ(bench.task.nextTime(), types::Time{20});
    bench.updateAt(20);
    EXPECT_THAT(stampsIn(poses), ElementsAre(20));
    EXPECT_THAT(stampsIn(pings), ElementsAre(10));
    EXPECT_FALSE(bench.task.finished());
    bench.updateAt(30);
    EXPECT_THAT(stampsIn(poses), ElementsAre(30));
    EXPECT_THAT(stampsIn(pings), ElementsAre(20));
    EXPECT_TRUE(bench.task.finished());
    EXPECT_EQ(bench.task.nextTime(), std::nullopt);
}

TEST(ReplayTaskTest, ReplaysTheRecordedSamples) {
    Bench bench;
    test::Reader<types::SonarPtr> pings;
    bench.start("sonar.ping", pings);
    bench.updateAt(30);
    types::SonarPtr first, second;
    ASSERT_TRUE(pings.port.readNew(first));
    ASSERT_TRUE(pings.port.readNew(second));
    EXPECT_EQ(first->bins, std::vector<float>{10});
    EXPECT_EQ(second->bins, std::vector<float>{20});
}

TEST(ReplayTaskTest, ReportsItsPositionInTheLog) {
    Bench bench;
    EXPECT_FALSE(bench.task.playback()) << "no log is open";
    test::Reader<types::Pose> poses;
    bench.start("vehicle.pose", poses);
    const auto at = [&] { return std::lround(bench.task.playback()->at_s * 1e6); };
    EXPECT_NEAR(bench.task.playback()->length_s, 20e-6, 1e-12);
    EXPECT_EQ(at(), 0);
    bench.updateAt(20);
    EXPECT_EQ(at(), 10);
    bench.task.seek(0);
    EXPECT_EQ(at(), 0) << "it continues from there";
    bench.updateAt(1000);
    EXPECT_EQ(at(), 20) << "in the log, whose stamps were shifted by the jump";
}

TEST(ReplayTaskTest, ARestartPlaysFromTheStart) {
    Bench bench;
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.task.configure();
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(bench.task.start());
        bench.updateAt(100);
        EXPECT_THAT(stampsIn(poses), ElementsAre(10, 20, 30));
        ASSERT_TRUE(bench.task.stop());
    }
}

TEST(ReplayTaskTest, ATruncatedLogPlaysUpToItsLastCompleteBlockWithANotice) {
    Bench bench;
    std::filesystem::resize_file(bench.folder / "x.0.log", std::filesystem::file_size(bench.folder / "x.0.log") - 1);
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.connect("sonar.ping", pings);
    ASSERT_TRUE(bench.task.configure());
    EXPECT_THAT(bench.task.notices(), ElementsAre(HasSubstr("ends within a block")));
    bench.task.start();
    bench.updateAt(100);
    EXPECT_THAT(stampsIn(poses), ElementsAre(10, 20, 30));
    EXPECT_THAT(stampsIn(pings), ElementsAre(10));
    EXPECT_TRUE(bench.task.finished());
}

TEST(ReplayTaskTest, StreamsThatAreNotReplayedAreListed) {
    Bench bench;
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    ASSERT_TRUE(bench.task.configure());
    EXPECT_THAT(bench.task.notices(), ElementsAre("stream sonar.ping (/base/samples/Sonar) is not replayed"));
}

TEST(ReplayTaskTest, AMissingStreamIsReportedWithTheExistingStreams) {
    Bench bench;
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { bench.task.makeOutput("sonar.pong"); }),
                HasSubstr("vehicle.pose, sonar.ping"));
}

TEST(ReplayTaskTest, ReportsAFileThatIsNotALogBeforeAnythingStarts) {
    Bench bench;
    writeBytes(bench.folder / "x.0.log", std::vector<char>(100, 'g'));
    EXPECT_THAT(test::countRefusals(bench.task),
                ElementsAre(testing::AllOf(testing::StartsWith("file: "), HasSubstr("is not a pocolog file"))));
    EXPECT_FALSE(bench.task.configure());
    EXPECT_NE(bench.task.configError(), nullptr);
}

TEST(ReplayTaskTest, ASampleThatCannotBeDecodedEndsInException) {
    Bench bench;
    std::vector<char> bytes = toBytes(bench.folder / "x.0.log");
    const uint64_t position = log::pocolog::Reader(bench.folder / "x.0.log").samples().front().position;
    bytes[position + 15] = '\x7f';  // top byte of the length of a name
    writeBytes(bench.folder / "x.0.log", bytes);
    test::Reader<types::Pose> poses;
    bench.start("vehicle.pose", poses);
    bench.updateAt(10);
    EXPECT_EQ(bench.task.state(), TaskState::Exception);
    EXPECT_THAT(bench.task.lastError(), HasSubstr("vehicle.pose: the sample at byte"));
}

/** A log of poses each 0.1 s whose logger's clock is set back by ten minutes after the tenth. */
void logOfAClockThatWasSetBack(const std::filesystem::path& file) {
    log::pocolog::Writer log(file);
    const size_t pose = log.addStream<types::Pose>("vehicle.pose");
    for (int64_t i = 0; i < 20; ++i) {
        const int64_t time = 1'000'000'000 + 100'000 * i - (i < 10 ? 0 : 600'000'000);
        log.write(pose, {time + 1}, poseAt(time));
    }
    log.close();
}

TEST(ReplayTaskTest, TimeContinuesWhereTheLoggersClockWasSetBack) {
    for (const bool lockstep : {true, false}) {
        Bench bench(lockstep);
        logOfAClockThatWasSetBack(bench.folder / "x.0.log");
        test::Reader<types::Pose> poses;
        bench.clock = {1'000'000};
        bench.start("vehicle.pose", poses);
        std::vector<int64_t> expected;
        for (int64_t i = 0; i < 20; ++i) {
            expected.push_back(1'000'000'000 + 100'000 * i);
            EXPECT_TRUE(!lockstep || bench.task.nextTime() == types::Time{expected.back()}) << i;
            lockstep ? bench.updateAt(expected.back()) : bench.updateAt(1'000'000 + 100'000 * i);
            const auto played = stampsIn(poses);
            EXPECT_THAT(played, ElementsAre(expected.back())) << i;
        }
        EXPECT_TRUE(bench.task.finished());
    }
}

}  // namespace
}  // namespace insonify::replay
