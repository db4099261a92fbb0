#include <gtest/gtest.h>

#include "components/output/tasks/PictureTask.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::output {
namespace {

template <class Task>
struct TaskBench : ::testing::Test {
    TaskBench() {
        auto environment = std::make_shared<framework::Environment>(task_.environment());
        environment->output_folder = folder_.path();
        task_.setEnvironment(environment);
        in_.port.connectTo(task_.ping, {});
        config_.width = 320;
    }
    void start() {
        task_.config.set(config_);
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    void give(int64_t time) {
        types::Sonar ping = test::emptyPing(120, 60);
        ping.time = {time};
        in_.port.write(std::make_shared<const types::Sonar>(ping));
        task_.update();
    }
    size_t filesWritten() const {
        size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) ++count;
        return count;
    }

    Folder folder_;
    Task task_{"fan"};
    test::Writer<types::SonarPtr> in_;
    test::Reader<types::ImagePtr> out_;
    PictureConfig config_;
};
using PictureTaskTest = TaskBench<FanImageTask>;
using DiscTaskTest = TaskBench<DiscImageTask>;

TEST_F(PictureTaskTest, APictureHasThePingsTime) {
    task_.image.connectTo(out_.port, {});
    start();
    give(1234567);
    types::ImagePtr picture;
    ASSERT_TRUE(out_.port.readNew(picture));
    EXPECT_EQ(picture->time.microseconds, 1234567);
    EXPECT_EQ(picture->size.width, 320);
    EXPECT_EQ(filesWritten(), 0u);
}

TEST_F(PictureTaskTest, PaintsNothingWithoutAReceiver) {
    start();
    give(1);
    EXPECT_EQ(task_.stages().count("paint"), 0u);
    EXPECT_EQ(task_.image.written(), 0u);
}

TEST_F(PictureTaskTest, WritesAFileForEveryThirdPing) {
    config_.file = "fan_%06d.png";
    config_.every = 3;
    start();
    for (int64_t time = 1; time <= 7; ++time) give(time);
    ASSERT_TRUE(task_.stop());
    EXPECT_EQ(filesWritten(), 3u);
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "fan_000002.png"));
}

TEST_F(DiscTaskTest, WritesAFileAfterEveryThirdPing) {
    config_.file = "disc_%06d.png";
    config_.every = 3;
    start();
    for (int64_t time = 1; time <= 2; ++time) give(time);
    EXPECT_EQ(task_.stages().count("paint"), 0u);
    for (int64_t time = 3; time <= 8; ++time) give(time);
    ASSERT_TRUE(task_.stop());
    EXPECT_EQ(filesWritten(), 2u);
}

TEST_F(DiscTaskTest, ARunThatEndsBeforeATurnShowsItsLastPing) {
    config_.every = 3;
    task_.image.connectTo(out_.port, {});
    start();
    for (const int64_t time : {1, 2}) give(time);
    types::ImagePtr picture;
    EXPECT_FALSE(out_.port.readNew(picture));
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(out_.port.readNew(picture));
    EXPECT_EQ(picture->time.microseconds, 2);
}

TEST_F(PictureTaskTest, AFileThatCannotBeWrittenEndsInException) {
    config_.file = "%d.png";
    std::filesystem::create_directories(folder_.path() / "0.png");
    start();
    give(1);
    EXPECT_FALSE(task_.stop());
    EXPECT_EQ(task_.state(), framework::TaskState::Exception);
    EXPECT_NE(task_.lastError().find("0.png"), std::string::npos) << task_.lastError();
}

TEST_F(PictureTaskTest, ReusesPicturesThatNobodyHolds) {
    task_.image.connectTo(out_.port, {});
    start();
    const types::Image* first = nullptr;
    bool again = false;
    for (int64_t time = 1; time < 8; ++time) {
        give(time);
        types::ImagePtr picture;
        ASSERT_TRUE(out_.port.readNew(picture));
        again = again || picture.get() == first;
        if (!first) first = picture.get();
    }
    EXPECT_TRUE(again);
}

}  // namespace
}  // namespace insonify::output
