#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "components/output/PictureFiles.hpp"
#include "components/output/PictureWriter.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "tests/output/Pixels.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::output {
namespace {

types::Image fanPicture(double time = 1) {
    DisplayConfig config;
    config.width = 320;
    FanImage fan(config);
    types::Sonar ping = test::withEcho(test::emptyPing(120, 60), 30, 50);
    ping.time = types::Time::fromSeconds(time);
    types::Image picture;
    fan.paint(ping, picture);
    return picture;
}

RecordingConfig recording(std::optional<std::string> file, std::optional<std::string> video = {}) {
    return {.file = file, .video = video, .video_rate = {}};
}

TEST(PictureFilesTest, PngFilesHaveThePicturesPixels) {
    const Folder folder;
    PictureFiles files(recording("deep/er/fan_%03d.png"), folder.path());
    files.write(fanPicture());
    files.write(fanPicture());
    for (const char* name : {"deep/er/fan_000.png", "deep/er/fan_001.png"}) {
        const cv::Mat read = cv::imread((folder.path() / name).string());
        ASSERT_FALSE(read.empty()) << name;
        EXPECT_EQ(cv::norm(read, test::toPixels(fanPicture()), cv::NORM_INF), 0);
    }
}

TEST(PictureFilesTest, AVideoHasEveryPictureAndTheRateOfThePings) {
    const Folder folder;
    for (const char* name : {"fan.avi", "fan.mp4"}) {
        PictureFiles files(recording({}, name), folder.path());
        for (int i = 0; i < 12; ++i) files.write(fanPicture(1 + 0.125 * i));
        files.close();
        cv::VideoCapture video((folder.path() / name).string());
        ASSERT_TRUE(video.isOpened()) << name;
        EXPECT_NEAR(video.get(cv::CAP_PROP_FPS), 8, 0.01);
        cv::Mat frame, last;
        int count = 0;
        for (; video.read(frame); ++count) last = frame.clone();
        EXPECT_EQ(count, 12) << name;
        EXPECT_LT(cv::norm(last, test::toPixels(fanPicture(1 + 0.125 * 11)), cv::NORM_L1) /
                      static_cast<double>(3 * last.total()),
                  12)
            << name;
    }
}

TEST(PictureFilesTest, WritesAVideoOfOnePicture) {
    const Folder folder;
    PictureFiles files(recording({}, "fan.avi"), folder.path());
    files.write(fanPicture());
    files.close();
    cv::Mat frame;
    EXPECT_TRUE(cv::VideoCapture((folder.path() / "fan.avi").string()).read(frame));
}

TEST(PictureFilesTest, NamesAFileThatCannotBeWritten) {
    EXPECT_THAT(test::computeError<std::runtime_error>([] { writePng("/dev/full", fanPicture()); }),
                testing::HasSubstr("/dev/full"));
    EXPECT_THROW(writePng("no/such/folder.png", fanPicture()), std::runtime_error);
}

TEST(PictureWriterTest, WritesEveryPictureBeforeTheEnd) {
    const Folder folder;
    const auto picture = std::make_shared<const types::Image>(fanPicture());
    for (const size_t queue : {size_t{1}, size_t{4}}) {
        PictureWriter writer(PictureFiles(recording("%d.png"), folder.path()), AtPictureFailure::Throw, queue);
        for (int i = 0; i < 20; ++i) {
            writer.write(picture);
            EXPECT_LE(picture.use_count(), static_cast<long>(queue) + 2) << "those that wait, the one that is written";
        }
        writer.close();
        EXPECT_TRUE(std::filesystem::remove(folder.path() / "19.png"));
        EXPECT_EQ(picture.use_count(), 1);
    }
}

TEST(PictureWriterTest, AnErrorReachesTheCaller) {
    const Folder folder;
    std::filesystem::create_directories(folder.path() / "0.png");  // blocks the first file
    const auto picture = std::make_shared<const types::Image>(fanPicture());
    PictureWriter writer(PictureFiles(recording("%d.png"), folder.path()));
    EXPECT_THROW(
        {
            writer.write(picture);
            writer.close();
        },
        std::runtime_error);
}

}  // namespace
}  // namespace insonify::output
