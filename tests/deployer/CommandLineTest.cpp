#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(CommandLineTest, WrongUsageIsExitCode2WithAMessage) {
    const WallFolder folder;
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{},
                                               {"fly"},
                                               {"study"},
                                               {"run"},
                                               {"run", "wall.yml", "--fast"},
                                               {"run", "wall.yml", "--pings", "0"},
                                               {"run", "wall.yml", "--pings", "-3"},
                                               {"run", "wall.yml", "--pings", "1.5"},
                                               {"run", "wall.yml", "--pings", "many"},
                                               {"run", "wall.yml", "--duration", "0"},
                                               {"run", "wall.yml", "--duration", "nan"},
                                               {"run", "wall.yml", "--duration", "inf"},
                                               {"run", "wall.yml", "--pings", "2", "--duration", "2"},
                                               {"run", "wall.yml", "--seed", "-1"},
                                               {"run", "wall.yml", "--set", "sonar.range"},
                                               {"run", "wall.yml", "--set", "sonor.range=3"},
                                               {"run", "wall.yml", "--set", "sonar.range=-3"},
                                               {"check"},
                                               {"plan"},
                                               {"log"},
                                               {"log", "info"},
                                               {"log", "info", "nowhere.0.log"},
                                               {"log", "export", "wall.0.log", "--to", "x.npz"},
                                               {"replay", "wall.0.log"},
                                               {"replay", "nowhere.0.log", "wall.yml"},
                                               {"describe", "noise::NoisyTask"}}) {
        const Outcome outcome = callInsonify(folder, words);
        EXPECT_EQ(outcome.code, 2) << testing::PrintToString(words);
        EXPECT_NE(outcome.err, "") << testing::PrintToString(words);
        EXPECT_EQ(outcome.out, "") << testing::PrintToString(words);
        EXPECT_FALSE(fs::exists(folder / "out")) << testing::PrintToString(words);
    }
}

TEST(CommandLineTest, HelpNamesEveryCommand) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"--help"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* command : {"run", "check", "plan", "describe", "log", "replay"})
        EXPECT_THAT(outcome.out, HasSubstr(std::string("\n  ") + command + " "));
}

TEST(CommandLineTest, TheVersionHasTheCommitAndTheParts) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"--version"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    std::string version, line;
    std::getline(lines, version);
    EXPECT_THAT(version, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
    std::map<std::string, std::set<std::string>> words;
    while (std::getline(lines, line)) {
        std::istringstream each(line);
        std::string head, word;
        for (each >> head; each >> word;) words[head].insert(word);
    }
    if (fs::exists(insonify::test::sourceFile(".git")) && std::system("git --version > /dev/null 2>&1") == 0) {
        EXPECT_THAT(outcome.out, testing::ContainsRegex("\ncommit [0-9a-f]{10} of [0-9]{4}-[0-9]{2}-[0-9]{2}"));
    }
    const json libraries = json::parse(callInsonify(folder, {"libraries", "--json"}).out);
    std::set<std::string> present;
    for (const json& each : libraries)
        if (each["state"] == "here") present.insert(each["name"]);
    EXPECT_EQ(words["parts:"], present);
    for (const std::string& absent : words["absent:"]) EXPECT_FALSE(present.contains(absent)) << absent;
}

TEST(CommandLineTest, FailsWhenResultsCannotBeWritten) {
    const TestFolder folder;
    const std::string command = insonify::test::program("insonify") + " describe > /dev/full";
    EXPECT_EQ(Process({"sh", "-c", command}, folder.path()).wait().code, 1);
}
