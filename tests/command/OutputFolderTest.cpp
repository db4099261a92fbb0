#include <gtest/gtest.h>

#include "components/command/OutputFolder.hpp"
#include "tests/support/Folder.hpp"
#include "types/ConfigError.hpp"

namespace insonify::command {
namespace {

TEST(OutputFolderTest, RemovesAFolderMadeForARunUnlessKept) {
    const Folder folder;
    { const OutputFolder made(folder / "gone", "x.yml"); }
    EXPECT_FALSE(std::filesystem::exists(folder / "gone"));
    {
        OutputFolder made(folder / "kept", "x.yml");
        made.keep();
    }
    EXPECT_TRUE(std::filesystem::is_directory(folder / "kept"));
    { const OutputFolder found(folder / "kept", "x.yml"); }
    EXPECT_TRUE(std::filesystem::is_directory(folder / "kept")) << "it was there before";
}

TEST(OutputFolderTest, ReportsFilesOfAnEarlierRun) {
    const Folder folder;
    EXPECT_FALSE(OutputFolder(folder / "new", "x.yml").hadFiles());
    std::filesystem::create_directory(folder / "empty");
    EXPECT_FALSE(OutputFolder(folder / "empty", "x.yml").hadFiles());
    writeBytes(folder / "empty/fan.png", {});
    EXPECT_TRUE(OutputFolder(folder / "empty", "x.yml").hadFiles());
}

TEST(OutputFolderTest, RefusesAPathThatIsNotAFolder) {
    const Folder folder;
    writeBytes(folder / "file", {});
    EXPECT_THROW(OutputFolder(folder / "file", "x.yml"), types::ConfigError);
}

}  // namespace
}  // namespace insonify::command
