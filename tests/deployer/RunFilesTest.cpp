// What a run prints at its end.
#include <gmock/gmock.h>
#include <unistd.h>

#include "components/deployer/RunFiles.hpp"
#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

namespace {

/** The wall with a picture of every ping. */
std::string pictured() {
    const std::string text =
        replaced(wall_deployment, "  log:\n",
                 "  fan: {type: output::FanImageTask, properties: {file: pictures/fan_%06d.png}}\n  log:\n");
    return text + "  - {from: noise.noisy, to: fan.ping, policy: {type: buffer, size: 64}}\n";
}

std::vector<std::string> getLines(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

}  // namespace

TEST(RunFilesTest, TheEndOfARunIsShortAndNamesThePictureToOpenFirst) {
    const WallFolder folder(pictured());
    const Outcome outcome = folder.run({"--pings", "3"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::vector<std::string> lines = getLines(outcome.out);
    ASSERT_EQ(lines.size(), 7u) << outcome.out;
    EXPECT_THAT(lines[0], testing::MatchesRegex("3 pings in .* s: .* per second"));
    EXPECT_THAT(lines[1], testing::MatchesRegex("sonar: .* ms per ping, the median; .* ms at most"));
    EXPECT_EQ(lines[2], "files in out");
    EXPECT_EQ(lines[3], "  pictures/fan_000000.png to pictures/fan_000002.png, 3 files");
    EXPECT_EQ(lines[4], "  properties.0.log");
    EXPECT_EQ(lines[5], "  wall.0.log");
    EXPECT_EQ(lines[6], "open first: out/pictures/fan_000002.png");
    EXPECT_TRUE(fs::exists(folder / "out/pictures/fan_000002.png"));
}

TEST(RunFilesTest, StagesQualityAndOmissionsAreVerbose) {
    const WallFolder folder(pictured());
    const Outcome brief = folder.run({"--pings", "2"}), verbose = folder.run({"--pings", "2", "--verbose"});
    for (const char* detail :
         {"median ms", "deposit", "cull", "sonar: quality: 32 rows", "not configured: ", "omitted"}) {
        EXPECT_THAT(brief.out, Not(HasSubstr(detail)));
        EXPECT_THAT(verbose.out, HasSubstr(detail));
    }
    EXPECT_THAT(verbose.out, EndsWith("open first: out/pictures/fan_000001.png\n"));
    EXPECT_THAT(folder.run({"--quiet", "--verbose"}), isRefused(HasSubstr("--verbose")));
}

TEST(RunFilesTest, FilesOfAnEarlierRunAreNotThoseOfThisOne) {
    const WallFolder folder(pictured());
    ASSERT_EQ(folder.run({"--pings", "4"}).code, 0);
    fs::last_write_time(folder / "out/pictures/fan_000003.png",
                        fs::file_time_type::clock::now() - std::chrono::seconds(5));
    writeFile(folder / "out/notes.txt", "mine");
    fs::last_write_time(folder / "out/notes.txt", fs::file_time_type::clock::now() - std::chrono::seconds(5));
    EXPECT_THAT(folder.run({"--pings", "2"}).out,
                AllOf(HasSubstr("fan_000000.png to pictures/fan_000001.png, 2 files"), Not(HasSubstr("notes.txt")),
                      EndsWith("open first: out/pictures/fan_000001.png\n")));
}

TEST(RunFilesTest, FilesAreTheRunsIfTheyHaveChangedWhateverTheClockSays) {
    const insonify::Folder folder;
    const auto hours = [](int count) { return fs::file_time_type::clock::now() + std::chrono::hours(count); };
    const auto stamp = [&](const char* name, int h) { fs::last_write_time(folder / name, hours(h)); };
    EXPECT_TRUE(listFolder(folder / "missing").empty());
    for (const char* name : {"future", "past", "grown", "rewritten", "set_back", "index.idx"})
        writeFile(folder / name, "earlier");
    fs::create_directory(folder / "below");
    writeFile(folder / "below/kept", "earlier");
    stamp("future", 10);
    stamp("past", -10);
    stamp("rewritten", -1);
    const FolderListing before = listFolder(folder.path());
    EXPECT_EQ(before.size(), 7u);
    const auto kept = fs::last_write_time(folder / "grown");
    writeFile(folder / "grown", "earlier and more");
    fs::last_write_time(folder / "grown", kept);  // in one step of the system's clock
    fs::last_write_time(folder / "rewritten", before.at("rewritten").written + std::chrono::nanoseconds(4));
    writeFile(folder / "set_back", "another");
    stamp("set_back", -5);
    writeFile(folder / "index.idx", "other");
    for (const char* name : {"new", "below/new_in_the_past"}) writeFile(folder / name, "of the run");
    stamp("below/new_in_the_past", -100);
    EXPECT_THAT(writtenSince(before, folder.path()),
                testing::ElementsAre("below/new_in_the_past", "grown", "new", "rewritten", "set_back"));
}

TEST(RunFilesTest, AFolderThatMayNotBeReadHidesNoOtherFile) {
    const TestFolder folder;
    for (const char* name : {"a/secret/file", "b/file", "file"}) {
        fs::create_directories((folder / name).parent_path());
        writeFile(folder / name, "");
    }
    fs::permissions(folder.path(), fs::perms::all);
    fs::permissions(folder / "a/secret", fs::perms::none);
    const uid_t user = geteuid();
    if (user == 0) {  // root may read everything
        ASSERT_EQ(seteuid(65534), 0);
    }
    const FolderListing listing = listFolder(folder.path());
    if (user == 0) {
        ASSERT_EQ(seteuid(0), 0);
    }
    fs::permissions(folder / "a/secret", fs::perms::all);
    EXPECT_EQ(listing.size(), 2u);
    EXPECT_TRUE(listing.contains("b/file") && listing.contains("file"));
    EXPECT_TRUE(listFolder(folder / "missing").empty());
}

TEST(RunFilesTest, AFileFromTheFutureIsNotOfThisRun) {
    const WallFolder folder(pictured());
    ASSERT_EQ(folder.run({"--pings", "1"}).code, 0);
    writeFile(folder / "out/fan_000007.png", "of a run before the clock was set back");
    fs::last_write_time(folder / "out/fan_000007.png", fs::file_time_type::clock::now() + std::chrono::minutes(10));
    EXPECT_THAT(folder.run({"--pings", "2"}).out,
                AllOf(HasSubstr("pictures/fan_000001.png, 2 files"), Not(HasSubstr("fan_000007")),
                      EndsWith("open first: out/pictures/fan_000001.png\n")));
}

TEST(RunFilesTest, WithoutAPictureTheLastLineIsACommandThatDrawsTheLog) {
    const WallFolder folder;
    const std::string out = folder.run({"--pings", "2"}).out, begin = "no pictures; this draws the pings: insonify ";
    const size_t at = out.find(begin);
    ASSERT_NE(at, out.npos) << out;
    const Outcome drawn =
        Process({"bash", "-c", insonify::test::program("insonify") + " " + out.substr(at + begin.size())},
                folder.path())
            .wait();
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_THAT(drawn.out, HasSubstr(".png"));
}
