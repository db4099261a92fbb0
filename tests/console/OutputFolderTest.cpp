#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

#include "components/console/OutputFolder.hpp"
#include "tests/support/Folder.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::console {
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

TEST(OutputFolderTest, KeepsTheFilesOfAnotherRunInTheFolderThatItHasMade) {
    const Folder folder;
    const std::filesystem::path shared = folder / "dive7";
    auto first = std::make_unique<OutputFolder>(shared, "auv1.yml");
    {
        OutputFolder second(shared, "auv2.yml");
        second.keep();
        writeBytes(shared / "auv2.0.log", {'a'});
    }
    first.reset();  // its start has failed
    EXPECT_EQ(toBytes(shared / "auv2.0.log"), std::vector<char>{'a'});
}

TEST(OutputFolderTest, KeepsAnEmptyFolderThatAnotherRunIsStartingIn) {
    const Folder folder;
    const std::filesystem::path shared = folder / "dive7";
    auto first = std::make_unique<OutputFolder>(shared, "auv1.yml");
    const OutputFolder second(shared, "auv2.yml");
    first.reset();
    EXPECT_TRUE(std::filesystem::is_directory(shared));
}

TEST(OutputFolderTest, RemovesEmptyFoldersThatTasksHaveMadeInIt) {
    const Folder folder;
    {
        const OutputFolder made(folder / "gone/", "x.yml");
        std::filesystem::create_directories(folder / "gone/pictures/fan");
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "gone"));
    {
        const OutputFolder made(folder / "kept", "x.yml");
        std::filesystem::create_directories(folder / "kept/pictures");
        writeBytes(folder / "kept/pictures/fan.png", {});
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "kept/pictures/fan.png"));
}

TEST(OutputFolderTest, RunsThatStartInOneSecondGetFoldersOfTheirOwn) {
    const Folder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    std::vector<std::unique_ptr<OutputFolder>> runs;
    std::set<std::filesystem::path> names;
    for (int i = 0; i < 20; ++i) names.insert(runs.emplace_back(std::make_unique<OutputFolder>("", "x.yml"))->path());
    EXPECT_EQ(names.size(), runs.size());
    runs.clear();
    EXPECT_TRUE(std::filesystem::is_empty("out"));
    std::filesystem::current_path(before);
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
}  // namespace insonify::console
