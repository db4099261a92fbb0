#include <gmock/gmock.h>

#include "components/framework/Activity.hpp"
#include "components/pocolog/Writer.hpp"
#include "components/replay/ReplayTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "types/Sonar.hpp"

namespace insonify::replay {
namespace {

using framework::ConnPolicy;
using framework::TaskState;
using testing::ElementsAre;
using testing::HasSubstr;

types::Pose poseAt(int64_t time) {
    types::Pose pose;
    pose.time = {time};
    pose.position.x = static_cast<double>(time);
    return pose;
}

types::Sonar pingAt(int64_t time) {
    types::Sonar ping;
    ping.time = {time};
    ping.bins = {static_cast<float>(time)};
    return ping;
}

/** A log of poses at 10, 20 and 30 us and pings of the first two that arrive late, and a task that replays it. */
struct Bench {
    Folder folder;
    ReplayTask task{"replay"};
    types::Time clock;

    explicit Bench(bool lockstep = true, ReplayConfig config = {}) {
        writeLog();
        config.file = "x.0.log";
        task.config.set(config);
        task.environment().input_folder = folder.path();
        task.environment().lockstep = lockstep;
        task.environment().now = [this] { return clock; };
        if (!lockstep) task.environment().now = task.clock(task.environment().now);
    }
    void writeLog() {
        pocolog::Writer log(folder / "x.0.log");
        const size_t pose = log.addStream<types::Pose>("vehicle.pose");
        const size_t ping = log.addStream<types::Sonar>("sonar.ping");
        log.write(pose, {11}, poseAt(10));
        log.write(pose, {21}, poseAt(20));
        log.write(ping, {25}, pingAt(10));
        log.write(pose, {31}, poseAt(30));
        log.write(ping, {35}, pingAt(20));
        log.close();
    }
    template <class T>
    void connect(const std::string& stream, test::Reader<T>& reader) {
        ASSERT_TRUE(task.makeOutput(stream)->connectTo(reader.port, ConnPolicy::buffer(100)));
    }
    void updateAt(int64_t time) {
        clock = {time};
        task.update();
    }
};

template <class T>
std::vector<int64_t> stampsIn(test::Reader<T>& reader) {
    std::vector<int64_t> stamps;
    for (T sample; reader.port.readNew(sample);) stamps.push_back(pocolog::carriedSample(sample).time.microseconds);
    return stamps;
}

TEST(ReplayTaskTest, WhatWasLoggedComesOutInTheOrderOfTheFileWhenItsTimeHasCome) {
    Bench bench;
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.connect("sonar.ping", pings);
    ASSERT_TRUE(bench.task.configure());
    ASSERT_TRUE(bench.task.start());
    EXPECT_EQ(bench.task.nextTime(), types::Time{10});
    bench.updateAt(9);
    EXPECT_THAT(stampsIn(poses), ElementsAre());
    bench.updateAt(10);
    EXPECT_THAT(stampsIn(poses), ElementsAre(10));
    EXPECT_THAT(stampsIn(pings), ElementsAre()) << "in the file it comes after the pose at 20";
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

TEST(ReplayTaskTest, SamplesAreTheRecordedOnes) {
    Bench bench;
    test::Reader<types::SonarPtr> pings;
    bench.connect("sonar.ping", pings);
    bench.task.configure();
    bench.task.start();
    bench.updateAt(30);
    types::SonarPtr first, second;
    ASSERT_TRUE(pings.port.readNew(first));
    ASSERT_TRUE(pings.port.readNew(second));
    EXPECT_EQ(first->bins, std::vector<float>{10});
    EXPECT_EQ(second->bins, std::vector<float>{20});
}

TEST(ReplayTaskTest, StartedAgainItPlaysFromTheStart) {
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

TEST(ReplayTaskTest, PaceScalesTheWallClock) {
    Bench bench(false, {.file = {}, .pace = 2});
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.clock = {1'000'000};
    ASSERT_TRUE(bench.task.configure());
    ASSERT_TRUE(bench.task.start());
    EXPECT_TRUE(bench.task.activity().settings().periodic()) << "nothing else would run it";
    bench.updateAt(1'000'004);
    EXPECT_THAT(stampsIn(poses), ElementsAre(10)) << "8 us of the log have gone by";
    bench.updateAt(1'000'005);
    EXPECT_THAT(stampsIn(poses), ElementsAre(20));
    bench.updateAt(1'000'010);
    EXPECT_THAT(stampsIn(poses), ElementsAre(30));
}

TEST(ReplayTaskTest, WithoutPaceEachCyclePlaysOneInstant) {
    Bench bench(false, {.file = {}, .pace = 0});
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.connect("sonar.ping", pings);
    bench.task.configure();
    bench.task.start();
    bench.task.update();
    EXPECT_THAT(stampsIn(poses), ElementsAre(10));
    bench.task.update();
    EXPECT_THAT(stampsIn(poses), ElementsAre(20));
    EXPECT_THAT(stampsIn(pings), ElementsAre(10));
}

TEST(ReplayTaskTest, InRealtimeAllTasksReadTheLogsTime) {
    Bench bench(false, {.file = {}, .pace = 2});
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.clock = {1'000'000};
    ASSERT_TRUE(bench.task.configure());
    const auto now = [&] { return bench.task.environment().now(); };
    EXPECT_EQ(now(), types::Time{10}) << "before the start it stands at the first sample";
    ASSERT_TRUE(bench.task.start());
    bench.clock = {1'000'004};
    EXPECT_EQ(now(), types::Time{18});
}

TEST(ReplayTaskTest, WithoutPaceTheLogsTimeIsThatOfTheInstantThatIsPlayed) {
    Bench bench(false, {.file = {}, .pace = 0});
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.task.configure();
    bench.task.start();
    for (const int64_t time : {10, 20, 30}) {
        bench.task.update();
        EXPECT_EQ(bench.task.environment().now(), types::Time{time});
    }
}

TEST(ReplayTaskTest, ItStartsWhereItIsToldTo) {
    Bench bench(true, {.file = {}, .from = 10e-6});
    test::Reader<types::Pose> poses;
    test::Reader<types::SonarPtr> pings;
    bench.connect("vehicle.pose", poses);
    bench.connect("sonar.ping", pings);
    bench.task.configure();
    bench.task.start();
    EXPECT_EQ(bench.task.nextTime(), types::Time{20});
    bench.updateAt(100);
    EXPECT_THAT(stampsIn(poses), ElementsAre(20, 30));
    EXPECT_THAT(stampsIn(pings), ElementsAre(10, 20)) << "in the file they come after the pose at 20";
}

TEST(ReplayTaskTest, AStartBeyondTheEndIsSeenBeforeAnythingStarts) {
    Bench bench(true, {.file = {}, .from = 1});
    types::Problems problems;
    bench.task.check(problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].path, "from");
}

TEST(ReplayTaskTest, InALoopStampsGoOnAndTimeNeverGoesBack) {
    Bench bench(true, {.file = {}, .loop = true});
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.task.configure();
    bench.task.start();
    std::vector<int64_t> instants;
    for (int i = 0; i < 7; ++i) {
        instants.push_back(bench.task.nextTime()->microseconds);
        bench.updateAt(instants.back());
    }
    EXPECT_THAT(instants, ElementsAre(10, 20, 30, 40, 50, 60, 70));
    EXPECT_FALSE(bench.task.finished());
    std::vector<double> places;
    std::vector<int64_t> stamps;
    for (types::Pose pose; poses.port.readNew(pose);) {
        places.push_back(pose.position.x);
        stamps.push_back(pose.time.microseconds);
    }
    EXPECT_EQ(stamps, instants);
    EXPECT_THAT(places, ElementsAre(10, 20, 30, 10, 20, 30, 10));
}

TEST(ReplayTaskTest, SeekGoesOnElsewhereInTheLogWhileTimeGoesOn) {
    Bench bench;
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.task.configure();
    bench.task.start();
    bench.updateAt(10);
    bench.updateAt(20);
    bench.task.seek(0);
    EXPECT_EQ(bench.task.nextTime(), types::Time{30});
    bench.updateAt(30);
    bench.task.seek(20e-6);
    bench.updateAt(40);
    std::vector<double> places;
    for (types::Pose pose; poses.port.readNew(pose);) places.push_back(pose.position.x);
    EXPECT_THAT(places, ElementsAre(10, 20, 10, 30));
    EXPECT_TRUE(bench.task.finished());
}

TEST(ReplayTaskTest, ALogThatWasCutOffPlaysUpToItsLastWholeBlockAndSaysSo) {
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

TEST(ReplayTaskTest, AStreamThatIsNotThereIsAnsweredWithThoseThatAre) {
    Bench bench;
    try {
        bench.task.makeOutput("sonar.pong");
        FAIL() << "found what is not there";
    } catch (const types::ConfigError& error) {
        EXPECT_THAT(error.what(), HasSubstr("vehicle.pose, sonar.ping"));
    }
}

TEST(ReplayTaskTest, AFileThatIsNoLogIsSeenBeforeAnythingStarts) {
    Bench bench;
    writeBytes(bench.folder / "x.0.log", std::vector<char>(100, 'g'));
    types::Problems problems;
    bench.task.check(problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].path, "file");
    EXPECT_THAT(problems[0].message, HasSubstr("is not a pocolog file"));
    EXPECT_FALSE(bench.task.configure());
    EXPECT_NE(bench.task.configError(), nullptr);
}

TEST(ReplayTaskTest, ASampleThatCannotBeDecodedEndsInException) {
    Bench bench;
    std::vector<char> bytes = bytesOf(bench.folder / "x.0.log");
    const uint64_t position = pocolog::Reader(bench.folder / "x.0.log").samples().front().position;
    bytes[position + 15] = '\x7f';  // top byte of the length of a name
    writeBytes(bench.folder / "x.0.log", bytes);
    test::Reader<types::Pose> poses;
    bench.connect("vehicle.pose", poses);
    bench.task.configure();
    bench.task.start();
    bench.updateAt(10);
    EXPECT_EQ(bench.task.state(), TaskState::Exception);
    EXPECT_THAT(bench.task.lastError(), HasSubstr("vehicle.pose: the sample at byte"));
}

}  // namespace
}  // namespace insonify::replay
