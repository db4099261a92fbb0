#include <gmock/gmock.h>

#include <cstdlib>
#include <iterator>
#include <map>
#include <regex>
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

TEST(CommandLineTest, AnEmptyValueOfAnyOptionIsRefusedByItsName) {
    const TestFolder folder;
    std::istringstream lines(callInsonify(folder, {"completion", "bash"}).out);
    const std::regex command("^        \" ([a-z ]+)\"\\) words="), option("^  (?:-.,)?(--[a-z-]+) ([A-Z{i][^ ]*)");
    std::set<std::string> refused;
    std::smatch found;
    for (std::string line; std::getline(lines, line);) {
        if (!std::regex_search(line, found, command)) continue;
        std::istringstream named(found[1]);
        const std::vector<std::string> words{std::istream_iterator<std::string>(named), {}};
        std::vector<std::string> help = words;
        help.emplace_back("--help");
        std::istringstream helped(callInsonify(folder, help).out);
        for (std::string text; std::getline(helped, text);) {
            if (!std::regex_search(text, found, option) || found.str(2).ends_with(':')) continue;
            std::vector<std::string> apart = words, joined = words;
            apart.insert(apart.end(), {found[1], ""});
            joined.push_back(found.str(1) + "=");
            for (const std::vector<std::string>& call : {apart, joined})
                EXPECT_THAT(callInsonify(folder, call), isRefused(HasSubstr(found.str(1) + ": is empty; must be ")))
                    << testing::PrintToString(call);
            refused.insert(found.str(1));
        }
    }
    for (const char* name : {"--out", "--real", "--to", "--pings", "--sweep", "--sediment", "--timeout", "--pose"})
        EXPECT_TRUE(refused.contains(name)) << name;
}

TEST(CommandLineTest, NumbersThatAreNotFiniteAreRefused) {
    const WallFolder folder;
    using Words = std::vector<std::string>;
    for (const Words& words : {Words{"water", "--depth"},
                               {"device", "probe", "x", "--timeout"},
                               {"fit", "wall.yml", "--real", "x", "--out", "y.yml", "--range"},
                               {"backscatter", "--frequency-khz"}})
        for (const char* value : {"nan", "-NaN", "inf", "Infinity", "1e999"}) {
            Words call = words;
            call.emplace_back(value);
            EXPECT_THAT(callInsonify(folder, call),
                        isRefused(HasSubstr(words.back() + ": is " + value + "; must be a finite number")));
        }
}

TEST(CommandLineTest, ANameThatIsTooLongIsBadInput) {
    const WallFolder folder;
    const std::string name(300, 'a');
    using Words = std::vector<std::string>;
    for (const Words& words : {Words{"check", name},
                               {"run", "wall.yml", "--out", name},
                               {"scene", name + ".glb"},
                               {"log", "info", name},
                               {"replay", name + ".log", "wall.yml"},
                               {"init", name},
                               {"log", "repair", name + ".0.log", "--to", "x.0.log"},
                               {"fit", "wall.yml", "--real", name, "--out", "y.yml"},
                               {"fit", "wall.yml", "--real", "x", "--out", name},
                               {"dataset", "wall.yml", "--sweep", name, "--out", "set"},
                               {"run", "wall.yml", "--summary", name}}) {
        const Outcome refused = callInsonify(folder, words);
        EXPECT_THAT(refused, isRefused(HasSubstr(name))) << testing::PrintToString(words) << refused.err;
    }
}

TEST(CommandLineTest, FailsWhenResultsCannotBeWritten) {
    const TestFolder folder;
    const std::string command = insonify::test::program("insonify") + " describe > /dev/full";
    EXPECT_EQ(Process({"sh", "-c", command}, folder.path()).wait().code, 1);
}
