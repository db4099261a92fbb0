#include <gmock/gmock.h>

#include "components/output/PictureFiles.hpp"
#include "components/output/tasks/PictureConfig.hpp"
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

TEST(FileFormatTest, EachEndingIsFoundInAnyCaseOfLettersWithItsContentOnly) {
    constexpr FileContent contents[] = {FileContent::Picture, FileContent::Video, FileContent::SideScan};
    for (const FileContent content : contents) {
        std::string endings = fileEndings(content);  // ".avi or .mp4"
        ASSERT_FALSE(endings.empty());
        for (size_t at = endings.find('.'); at != endings.npos; at = endings.find('.', at + 1)) {
            const std::string ending = endings.substr(at, endings.find_first_of(", ", at) - at);
            std::string mixed = ending;
            mixed[1] = static_cast<char>(std::toupper(mixed[1]));
            for (const std::string& name : {"a" + ending, "b/c.d" + mixed})
                for (const FileContent asked : contents)
                    EXPECT_EQ(findFileFormat(name, asked) != nullptr, asked == content) << name;
            EXPECT_EQ(findFileFormat("a" + ending, content)->write != nullptr, content == FileContent::Picture);
            EXPECT_EQ(findFileFormat("a" + ending, content)->codec.size(), content == FileContent::Video ? 4u : 0u);
            EXPECT_EQ(FilePattern::parse("fan_%d" + mixed).has_value(), content == FileContent::Picture) << mixed;
        }
    }
    EXPECT_EQ(findFileFormat("png", FileContent::Picture), nullptr);
    EXPECT_EQ(findFileFormat("", FileContent::Picture), nullptr);
}

TEST(RecordingConfigTest, ReportsNamesThatCannotBeWritten) {
    using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;
    EXPECT_THAT(test::countRefusals(RecordingConfig{}), IsEmpty());
    EXPECT_THAT(test::countRefusals(RecordingConfig{.file = "a%d.png", .video = "b.mp4", .video_rate = {}}), IsEmpty());
    EXPECT_THAT(test::countRefusals(RecordingConfig{.file = "%s%n", .video = "b.mkv", .video_rate = {}}),
                ElementsAre(HasSubstr("must have one number and end in " + fileEndings(FileContent::Picture)),
                            HasSubstr("video: is 'b.mkv'; it must end in .avi or .mp4")));
    EXPECT_THAT(test::countRefusals(RecordingConfig{.file = "b.mp4", .video = {}, .video_rate = {}}),
                ElementsAre(HasSubstr("`video` takes this one")));
}

}  // namespace
}  // namespace insonify::output
