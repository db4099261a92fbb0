#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

/** What bash offers after these words, the last of which is begun. */
std::string offered(const TestFolder& folder, const std::string& words, int index) {
    const std::string command = "source <(" + insonify::test::program("insonify") + " completion bash); COMP_WORDS=(" +
                                words + "); COMP_CWORD=" + std::to_string(index) +
                                "; _insonify; printf '%s\\n' \"${COMPREPLY[@]}\"";
    const Outcome outcome = Process({"bash", "-c", command}, folder.path()).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return "\n" + outcome.out;
}

}  // namespace

TEST(CompletionCommandTest, BashCompletesCommandsOptionsTypesSonarsAndFiles) {
    const TestFolder folder;
    writeFile(folder / "mine.yml", "");
    EXPECT_THAT(offered(folder, "insonify r", 1),
                AllOf(HasSubstr("\nrun\n"), HasSubstr("\nreplay\n"), Not(HasSubstr("check"))));
    EXPECT_THAT(offered(folder, "insonify log i", 2), AllOf(HasSubstr("\ninfo\n"), Not(HasSubstr("run"))));
    EXPECT_THAT(offered(folder, "insonify run mine.yml --p", 3), HasSubstr("\n--pings\n"));
    EXPECT_THAT(offered(folder, "insonify run m", 2), HasSubstr("\nmine.yml\n"));
    EXPECT_THAT(offered(folder, "insonify describe sonar", 2), HasSubstr("\nsonar::SonarTask\n"));
    EXPECT_THAT(offered(folder, "insonify init dive --sonar g", 4), HasSubstr("\ngemini_720is\n"));
}

TEST(CompletionCommandTest, ZshUsesTheSameAndOtherShellsAreRefused) {
    const TestFolder folder;
    const std::string bash = callInsonify(folder, {"completion", "bash"}).out;
    EXPECT_THAT(callInsonify(folder, {"completion", "zsh"}).out, AllOf(HasSubstr("bashcompinit"), HasSubstr(bash)));
    EXPECT_EQ(callInsonify(folder, {"completion", "fish"}).code, 2);
}

TEST(CompletionCommandTest, TheManualPageHasEveryCommandAndTheVersion) {
    const TestFolder folder;
    const std::string page = callInsonify(folder, {"man"}).out;
    const std::string version = callInsonify(folder, {"--version"}).out;
    EXPECT_TRUE(page.starts_with(".TH INSONIFY 1"));
    EXPECT_THAT(page, HasSubstr("Insonify " + version.substr(0, version.find('\n'))));
    for (const char* command : {"init", "run", "check", "plan", "scene", "schema", "log info", "log export", "replay",
                                "study error", "completion"})
        EXPECT_THAT(page, HasSubstr(std::string(".SS ") + command + "\n"));
    EXPECT_THAT(page, HasSubstr(".B \\-\\-pings"));
}
