#include <gmock/gmock.h>

#include "components/framework/Operation.hpp"
#include "components/log/Copy.hpp"
#include "components/log/TypeNames.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Waiting.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::logger {
namespace {

using framework::ConnPolicy;
using framework::TaskState;

/** A source and its connection to a logger's port. */
template <class T>
struct Source {
    test::Writer<T> writer;
    Source(LoggerTask& logger, const std::string& name) : writer(name) {
        writer.port.connectTo(*logger.makeInput(name, writer.port), ConnPolicy::buffer(2000));
    }
    void write(const T& sample) { writer.port.write(sample); }
};

/** A logger that writes to x.0.log in its folder, at 5 s. */
struct Bench {
    Folder folder;
    LoggerTask task{"log"};
    explicit Bench(LoggerConfig config = {}) {
        config.file = "x.0.log";
        task.config.set(config);
        task.environment().output_folder = folder.path();
        task.environment().now = [] { return types::Time{5'000'000}; };
    }
    std::filesystem::path path() const { return folder / "x.0.log"; }
    void finish() {
        ASSERT_TRUE(task.stop());
        ASSERT_TRUE(task.cleanup());
    }
};

types::SonarPtr ping(int64_t time) {
    auto sample = std::make_shared<types::Sonar>();
    sample->time = {time};
    sample->bins = {1, 2, 3};
    return sample;
}

TEST(LoggerTaskTest, ReportsWhatItHasWrittenAndTheSpaceLeft) {
    LoggerConfig config;
    config.max_file_size = 1e6;
    Bench bench(config);
    Source<std::string> source(bench.task, "text");
    EXPECT_FALSE(bench.task.recording());
    ASSERT_TRUE(bench.task.configure() && bench.task.start()) << bench.task.lastError();
    for (int i = 0; i < 25; ++i) {
        source.write(std::string(100'000, ' '));
        bench.task.update();
    }
    ASSERT_TRUE(test::becomesTrue([&] {
        bench.task.update();
        return bench.task.recording()->bytes > 2'500'000;
    }));
    const types::Recording seen = *bench.task.recording();
    EXPECT_EQ(std::filesystem::path(seen.file).filename(), "x.2.log");
    EXPECT_GT(seen.free_bytes, 0u);
    bench.finish();
    uint64_t on_disk = 0;
    for (const char* const name : {"x.0.log", "x.1.log", "x.2.log"})
        on_disk += std::filesystem::file_size(bench.folder / name);
    EXPECT_LE(seen.bytes, on_disk);
    EXPECT_GE(seen.bytes + 1'000, on_disk) << "apart from what ends the files";
}

TEST(LoggerTaskTest, OnlyRecordCanBeSetWhileItRuns) {
    Bench bench;
    EXPECT_TRUE(bench.task.adjusts("record"));
    for (const char* const fixed : {"file", "queue", "flush_period", "mcap"}) EXPECT_FALSE(bench.task.adjusts(fixed));
}

TEST(LoggerTaskTest, StreamsStateTheWidthOfBinsThatAreNotWholeMicroseconds) {
    for (const double width : {0.005, 0.0495}) {
        Bench bench;
        Source<types::SonarPtr> sonar(bench.task, "sonar");
        EXPECT_TRUE(bench.task.configure() && bench.task.start());
        auto sample = std::make_shared<types::Sonar>();
        sample->setBins(width, 1500);
        sample->resize(1000, 1);
        sonar.write(sample);
        bench.task.update();
        bench.finish();
        log::pocolog::Reader log(bench.path());
        const bool is_whole = width == 0.0495;  // 33 us
        EXPECT_EQ(log.streams()[0].metadatum("insonify_bin_width"), is_whole ? "" : "0.005");
        EXPECT_EQ(log.streams()[0].metadatum("insonify_speed_of_sound"), is_whole ? "" : "1500");
        log.forEach<types::Sonar>("sonar.port", [&](const types::Sonar& ping, const log::SampleRef&) {
            EXPECT_DOUBLE_EQ(ping.binWidth(), width);
            EXPECT_EQ(ping.speed_of_sound, 1500);
        });
    }
}

TEST(LoggerTaskTest, EverySampleIsLoggedUnderItsSourcesNameWithBothTimes) {
    Bench bench;
    Source<types::SonarPtr> sonar(bench.task, "sonar");
    Source<types::Pose> vehicle(bench.task, "vehicle");
    ASSERT_TRUE(bench.task.configure() && bench.task.start()) << bench.task.lastError();
    sonar.write(ping(3'000'000));
    vehicle.write({});
    bench.task.update();
    sonar.write(ping(4'000'000));
    bench.task.update();
    bench.finish();

    log::pocolog::Reader log(bench.path());
    EXPECT_TRUE(log.complete());
    EXPECT_EQ(log.find("sonar.port")->type, "/base/samples/Sonar");
    EXPECT_EQ(log.find("vehicle.port")->type, "/base/samples/RigidBodyState_m");
    ASSERT_EQ(log.samples().size(), 3u);
    EXPECT_EQ(log.samples()[0].time.microseconds, 3'000'000);
    EXPECT_EQ(log.samples()[0].received.microseconds, 5'000'000);
    EXPECT_EQ(log.samples()[1].time.microseconds, 5'000'000) << "a pose without a stamp";
    EXPECT_EQ(log.samples()[2].time.microseconds, 4'000'000);
    EXPECT_TRUE(std::filesystem::exists(bench.folder / "x.0.idx"));
}

TEST(LoggerTaskTest, EveryTypeOfTheListCanBeLogged) {
    Bench bench;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        test::Writer<types::Carried<T>> writer("source");
        EXPECT_NE(bench.task.makeInput("in", writer.port), nullptr) << log::typelibName<T>();
    });
}

TEST(LoggerTaskTest, RefusesATypeThatALogCannotStore) {
    Bench bench;
    test::Writer<types::SnapshotPtr> scene("scene");
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { bench.task.makeInput("snapshot", scene.port); }),
                testing::StartsWith("scene.port is /insonify/Snapshot, which a log cannot hold; it holds "));
    EXPECT_TRUE(bench.task.inputs().empty());
}

TEST(LoggerTaskTest, TheLogHasTheDeploymentItsSeedAndTheUsersMetadata) {
    LoggerConfig config;
    config.metadata = {{"vessel", "Kai"}};
    Bench bench(config);
    bench.task.environment().deployment_text = "tasks:\n  a: {type: \"b\"}\n";
    bench.task.environment().seed = 7;
    Source<double> source(bench.task, "depth");
    ASSERT_TRUE(bench.task.configure() && bench.task.start());
    ASSERT_TRUE(bench.task.stop() && bench.task.cleanup());
    const log::pocolog::Reader log(bench.path());
    const log::Metadata& metadata = log.streams().at(0).metadata;
    EXPECT_EQ(metadata.at("insonify_deployment"), "tasks:\n  a: {type: \"b\"}\n");
    EXPECT_EQ(metadata.at("insonify_seed"), "7");
    EXPECT_EQ(metadata.at("vessel"), "Kai");
}

TEST(LoggerTaskTest, TheDeploymentIsOnceInALogAndInCutsOfIt) {
    Bench bench;
    bench.task.environment().deployment_text = "tasks: {}";
    Source<double> depth(bench.task, "depth");
    Source<int32_t> counter(bench.task, "counter");
    ASSERT_TRUE(bench.task.configure() && bench.task.start()) << bench.task.lastError();
    counter.write(1);
    depth.write(2.5);
    bench.task.update();
    bench.finish();
    const log::pocolog::Reader log(bench.path());
    ASSERT_EQ(log.streams().size(), 2u);
    EXPECT_EQ(log.streams()[0].metadatum("insonify_deployment"), "tasks: {}");
    EXPECT_EQ(log.streams()[1].metadata.count("insonify_deployment"), 0u);
    log::copyLog({bench.path()}, bench.folder / "cut.0.log", {.selection = {.streams = {log.streams()[1].name}}});
    EXPECT_EQ(log::openLog(bench.folder / "cut.0.log")->metadatum("insonify_deployment"), "tasks: {}");
}

TEST(LoggerTaskTest, AFileSlowerThanTheSamplesLosesNone) {
    LoggerConfig config;
    config.queue = 1;
    Bench bench(config);
    Source<int32_t> source(bench.task, "counter");
    ASSERT_TRUE(bench.task.configure() && bench.task.start()) << bench.task.lastError();
    for (int32_t i = 0; i < 2000; ++i) source.write(i);
    bench.task.update();
    bench.finish();
    int32_t expected = 0;
    log::pocolog::Reader log(bench.path());
    log.forEach<int32_t>("counter.port", [&](int32_t value, const log::SampleRef&) { EXPECT_EQ(value, expected++); });
    EXPECT_EQ(expected, 2000);
}

TEST(LoggerTaskTest, LoggedSamplesAreInTheFileWithinTheFlushPeriod) {
    LoggerConfig config;
    config.flush_period = 0.05;
    Bench bench(config);
    Source<double> source(bench.task, "depth");
    ASSERT_TRUE(bench.task.configure() && bench.task.start()) << bench.task.lastError();
    source.write(1.5);
    bench.task.update();
    const auto logged = [&] {
        const bool has_prologue = std::filesystem::file_size(bench.path()) >= 16;
        return has_prologue && log::pocolog::Reader(bench.path()).samples().size() == 1;
    };
    EXPECT_TRUE(test::becomesTrue(logged)) << "while the task is still running";
    bench.finish();
}

TEST(LoggerTaskTest, TheSameSamplesGiveTheSameLogBitForBit) {
    const auto run = [] {
        Bench bench;
        Source<types::SonarPtr> sonar(bench.task, "sonar");
        Source<double> depth(bench.task, "depth");
        bench.task.configure();
        bench.task.start();
        for (int64_t i = 1; i <= 100; ++i) {
            sonar.write(ping(i));
            depth.write(static_cast<double>(i));
            bench.task.update();
        }
        bench.task.stop();
        bench.task.cleanup();
        return toBytes(bench.path());
    };
    EXPECT_EQ(run(), run());
}

TEST(LoggerTaskTest, ARestartContinuesTheSameFile) {
    Bench bench;
    Source<double> source(bench.task, "depth");
    ASSERT_TRUE(bench.task.configure());
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(bench.task.start());
        source.write(i);
        bench.task.update();
        ASSERT_TRUE(bench.task.stop());
    }
    ASSERT_TRUE(bench.task.cleanup());
    EXPECT_EQ(log::pocolog::Reader(bench.path()).samples().size(), 2u);
}

TEST(LoggerTaskTest, RefusesAStreamTwiceAndTwoStreamsOnOnePort) {
    Bench twice;
    test::Writer<double> source("depth");
    source.port.connectTo(*twice.task.makeInput("a", source.port), {});
    source.port.connectTo(*twice.task.makeInput("b", source.port), {});
    EXPECT_FALSE(twice.task.configure());
    ASSERT_NE(twice.task.configError(), nullptr);
    EXPECT_THAT(twice.task.configError()->what(), testing::HasSubstr("a second time"));

    Bench shared;
    Source<double> first(shared.task, "first");
    test::Writer<double> second("second");
    second.port.connectTo(*shared.task.input("first"), {});
    EXPECT_FALSE(shared.task.configure());
    ASSERT_NE(shared.task.configError(), nullptr);
    EXPECT_THAT(shared.task.configError()->what(), testing::HasSubstr("several connections"));
}

TEST(LoggerTaskTest, ALoggerWithoutConnectionsGivesANotice) {
    EXPECT_THAT(Bench().task.notices(), testing::ElementsAre(testing::HasSubstr("nothing is connected")));
}

TEST(LoggerTaskTest, RecordingStopsAndResumesDuringTheRunWithoutOtherChanges) {
    Bench bench;
    Source<types::SonarPtr> sonar(bench.task, "sonar");
    ASSERT_TRUE(bench.task.configure() && bench.task.start()) << bench.task.lastError();
    const auto set = [&](const char* setter, const char* value) { bench.task.operation(setter)->callText({value}); };
    for (const char* record : {"true", "false", "true"}) {
        set("setRecord", record);
        sonar.write(ping(record == std::string("true") ? 1'000'000 : 2'000'000));
        bench.task.update();
    }
    EXPECT_THROW(set("setQueue", "5"), std::runtime_error);
    EXPECT_EQ(bench.task.config->queue, 64);
    bench.finish();

    log::pocolog::Reader log(bench.path());
    ASSERT_EQ(log.samples().size(), 2u);
    for (const log::SampleRef& at : log.samples()) EXPECT_EQ(at.time.microseconds, 1'000'000);
}

}  // namespace
}  // namespace insonify::logger
