// Disks that are full, folders that are not there.
#include <gmock/gmock.h>

#include "components/log/pocolog/Reader.hpp"
#include "components/logger/LogThread.hpp"
#include "components/logger/LoggerTask.hpp"
#include "tests/logger/LimitedDisk.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::logger {
namespace {

using framework::ConnPolicy;
using framework::TaskState;

LoggerConfig configFor(const std::string& file) {
    LoggerConfig config;
    config.file = file;
    config.flush_period = 0.001;
    return config;
}

std::string thousandBytes() { return std::string(1000, 'x'); }

TEST(LogFailureTest, AFolderThatCannotBeMadeRefusesConfigure) {
    Folder folder;
    writeBytes(folder / "file", {'x'});
    LoggerTask task("log");
    task.environment().output_folder = folder / "file";
    task.config.set(configFor("x.0.log"));
    EXPECT_FALSE(task.configure());
    ASSERT_NE(task.configError(), nullptr);
    EXPECT_THAT(task.configError()->what(), testing::HasSubstr((folder / "file").string()));
}

TEST(LogFailureTest, AFileThatCannotBeOpenedRefusesConfigure) {
    Folder folder;
    std::filesystem::create_directory(folder / "x.0.log");
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    task.config.set(configFor("x.0.log"));
    EXPECT_FALSE(task.configure());
    ASSERT_NE(task.configError(), nullptr);
    EXPECT_THAT(task.configError()->what(), testing::HasSubstr("cannot be written"));
}

TEST(LogFailureTest, AFullDiskEndsInExceptionWithTheSystemsReason) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    task.config.set(configFor("x.0.log"));
    test::Writer<std::string> source;
    source.port.connectTo(*task.makeInput("in", source.port), ConnPolicy::buffer(10));
    ASSERT_TRUE(task.configure());
    ASSERT_TRUE(task.start());
    logUntilFailure(task, source, thousandBytes);
    EXPECT_EQ(task.state(), TaskState::Exception);
    EXPECT_THAT(task.lastError(), testing::HasSubstr("No space left on device"));
}

TEST(LogFailureTest, TheSamplesThatDidNotReachTheDiskAreCounted) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    const auto log = log::createLog(folder / "x.0.log");
    Rotation rotation(configFor("x.0.log"), *log);
    const double never = 3600;
    LogThread thread(*log, rotation, 10, never);
    const types::AnySample text = std::string("x");
    thread.declare([&](log::Writer& file) { return file.add(text.index(), "texts", {}); });
    for (int i = 0; i < 3; ++i) thread.push(0, {}, text);
    EXPECT_THAT([&] { thread.finish(); },
                testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("3 samples did not reach it")));
}

TEST(LogFailureTest, ADiskThatIsFullOnlyAtTheEndIsToldByStop) {
    Folder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.0.log");
    LoggerTask task("log");
    task.environment().output_folder = folder.path();
    LoggerConfig config = configFor("x.0.log");
    config.flush_period = 1;
    task.config.set(config);
    ASSERT_TRUE(task.configure());
    ASSERT_TRUE(task.start());
    EXPECT_FALSE(task.stop());
    EXPECT_EQ(task.state(), TaskState::Exception);
    EXPECT_THAT(task.lastError(), testing::HasSubstr("No space left on device"));
}

TEST(LogFailureTest, WhatWasFlushedBeforeTheDiskWasFullIsKeptWhole) {
    Folder folder;
    EXPECT_EXIT(fillLimitedDisk(folder / "x.0.log", thousandBytes), testing::ExitedWithCode(0), "");
    log::pocolog::Reader log(folder / "x.0.log");
    EXPECT_TRUE(log.complete()) << log.diagnostic();
    EXPECT_GT(log.samples().size(), 5u);
    log.forEach<std::string>("writer.port",
                             [](const std::string& text, const log::SampleRef&) { EXPECT_EQ(text.size(), 1000u); });
}

}  // namespace
}  // namespace insonify::logger
