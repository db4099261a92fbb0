#include <gmock/gmock.h>

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

TEST(CommandLineTest, FailsWhenResultsCannotBeWritten) {
    const TestFolder folder;
    const std::string command = insonify::test::program("insonify") + " describe > /dev/full";
    EXPECT_EQ(Process({"sh", "-c", command}, folder.path()).wait().code, 1);
}
