#include <gmock/gmock.h>

#include "components/output/PictureConfig.hpp"
#include "components/output/PictureFiles.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::output {
namespace {

TEST(FilePatternTest, WritesNumbersAsPrintf) {
    EXPECT_EQ(FilePattern::parse("fan_%06d.png")->name(42), "fan_000042.png");
    EXPECT_EQ(FilePattern::parse("fan_%d.png")->name(42), "fan_42.png");
    EXPECT_EQ(FilePattern::parse("a/%4d.png")->name(7), "a/   7.png");
    EXPECT_EQ(FilePattern::parse("%02d.png")->name(1234567), "1234567.png");
}

TEST(FilePatternTest, RefusesAnythingElse) {
    for (const char* pattern :
         {"", "fan.png", "fan_%s.png", "fan_%d_%d.png", "fan_%n.png", "%", "fan_%", "fan_%06.png", "%%d.png",
          "fan_%-6d.png", "fan_%9999999999d.png", "fan_%0100d.png", "fan_%ld.png", "fan_%06d.bmp", "fan_%06d"})
        EXPECT_FALSE(FilePattern::parse(pattern)) << pattern;
}

TEST(RecordingConfigTest, ReportsNamesThatCannotBeWritten) {
    using testing::ElementsAre, testing::IsEmpty, testing::StartsWith;
    EXPECT_THAT(test::refusalsOf(RecordingConfig{}), IsEmpty());
    EXPECT_THAT(test::refusalsOf(RecordingConfig{.file = "a%d.png", .video = "b.mp4", .video_rate = {}}), IsEmpty());
    EXPECT_THAT(test::refusalsOf(RecordingConfig{.file = "%s%n", .video = "b.mkv", .video_rate = {}}),
                ElementsAre(StartsWith("file: "), StartsWith("video: ")));
}

}  // namespace
}  // namespace insonify::output
