#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const std::string bash = "source <(insonify completion bash)", zsh = "source <(insonify completion zsh)";

/** Types lines with tabs into an interactive shell; returns the words of each line as the shell receives them on
 *  Enter. */
json typed(const TestFolder& folder, const std::string& shell, const std::string& setup,
           const std::vector<std::string>& lines) {
    const std::string path = std::string("PATH=") + insonify::test::bin_dir + ":" + std::getenv("PATH");
    std::vector<std::string> words{
        "env", path, "/usr/bin/python3", insonify::test::sourceFile("tests/deployer/type_in_shell.py"), shell, setup};
    words.insert(words.end(), lines.begin(), lines.end());
    const Outcome outcome = Process(words, folder.path()).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
}

/** A folder with files to complete. */
TestFolder& fill(TestFolder& folder) {
    for (const char* name : {"mine.yml", "two words.yml", "sonar.yml"}) writeFile(folder / name, "");
    fs::create_directory(folder / "out");
    return folder;
}

}  // namespace

TEST(CompletionCommandTest, TabCompletesCommandsOptionsTypesSonarsAndFilesInBash) {
    TestFolder folder;
    const json words = typed(fill(folder), "bash", bash,
                             {"insonify ru\t", "insonify log inf\t", "insonify run mine.yml --pi\t", "insonify run m\t",
                              "insonify run tw\t", "insonify run two\\ w\t", "insonify run mine.yml --out=o\t",
                              "insonify describe sonar::SonarT\t", "insonify describe son\tSonarT\tconfig",
                              "insonify init dive --sonar gem\t", "insonify log info mine.yml --st\tx"});
    EXPECT_EQ(words, json::parse(R"([["insonify", "run"], ["insonify", "log", "info"],
        ["insonify", "run", "mine.yml", "--pings"], ["insonify", "run", "mine.yml"],
        ["insonify", "run", "two words.yml"], ["insonify", "run", "two words.yml"],
        ["insonify", "run", "mine.yml", "--out=out/"], ["insonify", "describe", "sonar::SonarTask"],
        ["insonify", "describe", "sonar::SonarTask", "config"],
        ["insonify", "init", "dive", "--sonar", "gemini_720is"],
        ["insonify", "log", "info", "mine.yml", "--stx"]])"));
}

TEST(CompletionCommandTest, TabListsAllCandidatesInBash) {
    TestFolder folder;
    const std::string insert_all = "bind '\"\\t\": insert-completions'; ";
    const json words =
        typed(fill(folder), "bash", insert_all + bash,
              {"insonify r\t", "insonify study s\t", "insonify run m\t", "insonify describe sonar::Sonar\t"});
    ASSERT_EQ(words.size(), 4u);
    EXPECT_EQ(words[0], json({"insonify", "replay", "run"}));
    EXPECT_EQ(words[1], json({"insonify", "study", "speckle", "stability"}));
    EXPECT_EQ(words[2], json({"insonify", "run", "mine.yml"}));
    EXPECT_EQ(words[3], json({"insonify", "describe", "sonar::Sonar3dTask", "SonarTask"}))
        << "the part after the colons is inserted, for each candidate";
}

TEST(CompletionCommandTest, TabCompletesTheSameInZsh) {
    TestFolder folder;
    if (Process({"zsh", "--version"}, folder.path()).wait().code != 0) GTEST_SKIP() << "NOT TESTED: there is no zsh";
    const json words =
        typed(fill(folder), "zsh", zsh,
              {"insonify ru\t", "insonify log inf\t", "insonify run mine.yml --pi\t", "insonify run m\t",
               "insonify run tw\t", "insonify describe sonar::SonarT\t", "insonify init dive --sonar gem\t"});
    EXPECT_EQ(words, json::parse(R"([["insonify", "run"], ["insonify", "log", "info"],
        ["insonify", "run", "mine.yml", "--pings"], ["insonify", "run", "mine.yml"],
        ["insonify", "run", "two words.yml"], ["insonify", "describe", "sonar::SonarTask"],
        ["insonify", "init", "dive", "--sonar", "gemini_720is"]])"));
}

TEST(CompletionCommandTest, OtherShellsAreRefused) {
    const TestFolder folder;
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
