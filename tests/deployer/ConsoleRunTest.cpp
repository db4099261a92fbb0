// Consoles that are full, closed or stopped, and runs that share a folder.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <thread>

#include "tests/deployer/Growing.hpp"
#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** The wall in realtime, with a warning at the start of each run: there is no such processor. */
std::string warningWall() {
    return replaced(realtimeWall(), "activity: {trigger: [snapshot]}", "activity: {trigger: [snapshot], cpus: [1000]}");
}

Outcome inBash(const TestFolder& folder, const std::string& line) {
    return Process({"bash", "-c", line}, folder.path()).wait();
}

std::string program() { return insonify::test::program("insonify"); }

std::vector<std::string> getLines(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool isError(const std::string& line) { return !line.starts_with("notice: ") && !line.starts_with("warning: "); }

/** Whether a log is complete and has samples. */
bool isWhole(const fs::path& log) {
    return insonify::log::pocolog::Reader(log).complete() && flushedSamples(log, "sonar.ping") > 0;
}

}  // namespace

TEST(ConsoleRunTest, NoConsoleEndsARun) {
    const std::string run = program() + " run wall.yml --out out --duration 0.6 --summary summary.json";
    const std::vector<std::string> consoles = {
        run + " 2>/dev/full",
        run + " 2>&-",
        "trap '' PIPE; " + run + " 2> >(head -1 >first.txt)",
        run + " 2> >(true)",
        run + " --quiet >&- 2>&-",
    };
    for (const std::string& console : consoles) {
        const WallFolder folder(warningWall());
        EXPECT_EQ(inBash(folder, console).code, 0) << console;
        EXPECT_TRUE(isWhole(folder / "out/wall.0.log")) << console;
        EXPECT_GT(json::parse(readFile(folder / "summary.json"))["pings"], 2) << console;
    }
}

TEST(ConsoleRunTest, AWarningOnTheFullDiskOfTheLogEndsNoTask) {
    const WallFolder folder(warningWall());
    writeFile(folder / "console.txt", std::string(100 << 10, 'x'));
    const Outcome outcome =
        inBash(folder, "ulimit -f 100; " + program() +
                           " run wall.yml --out out --duration 2.5 --summary summary.json --set sonar.bin_count=500"
                           " 2>>console.txt");
    EXPECT_EQ(outcome.code, 1) << "samples are lost at the end";
    const json summary = json::parse(readFile(folder / "summary.json"));
    EXPECT_GE(summary["pings"], 20);
    EXPECT_THAT(summary["warnings"].dump(), HasSubstr("log: RunTimeError: "));
    EXPECT_THAT(outcome.out, HasSubstr(" lines of notices and warnings could not be printed"));
}

TEST(ConsoleRunTest, AFullPipeOfWhichNobodyReadsStopsNoPing) {
    const WallFolder folder(warningWall());
    ASSERT_EQ(mkfifo((folder / "console").c_str(), 0600), 0);
    const int pipe = open((folder / "console").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    const std::string block(4096, 'x');
    size_t stuffed = 0;
    for (ssize_t written; (written = write(pipe, block.data(), block.size())) > 0;)
        stuffed += static_cast<size_t>(written);
    const Process run(
        {"bash", "-c", "exec " + program() + " run wall.yml --out out --duration 0.6 --summary summary.json 2>console"},
        folder.path());
    EXPECT_TRUE(insonify::test::becomesTrue([&] { return fs::exists(folder / "summary.json"); }));
    EXPECT_TRUE(isWhole(folder / "out/wall.0.log")) << "while the console still waits";
    std::string text(stuffed + (16 << 10), ' ');
    size_t got = 0;
    insonify::test::becomesTrue([&] {
        const ssize_t count = read(pipe, text.data() + got, text.size() - got);
        got += count > 0 ? static_cast<size_t>(count) : 0;
        return got > stuffed && text[got - 1] == '\n';
    });
    const Outcome outcome = run.wait();
    close(pipe);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_GT(json::parse(readFile(folder / "summary.json"))["pings"], 2);
    EXPECT_THAT(text.substr(stuffed, got - stuffed), HasSubstr("warning: sonar: cannot run on only the CPUs 1000"));
}

TEST(ConsoleRunTest, AResultThatCannotBeWrittenIsOneErrorWithExitCode1) {
    const WallFolder folder;
    ASSERT_EQ(folder.run().code, 0);
    for (const std::string command : {"run wall.yml --out out --pings 1",
                                      "check wall.yml",
                                      "check wall.yml --json",
                                      "plan wall.yml",
                                      "describe",
                                      "describe materials",
                                      "describe sonar::SonarTask",
                                      "schema",
                                      "scene wall.gltf",
                                      "beam wall.yml",
                                      "water",
                                      "backscatter --frequency-khz 50 --sediment sandy_gravel",
                                      "libraries",
                                      "examples",
                                      "init dive",
                                      "log info out/wall.0.log",
                                      "log check out/wall.0.log",
                                      "completion bash",
                                      "man",
                                      "--help",
                                      "--version",
                                      "run --help",

                                      "replay out/wall.0.log wall.yml --out again"})
        for (const std::string console : {">/dev/full", ">&-", "> >(true)"}) {
            fs::remove_all(folder / "dive");
            const bool is_pipe = console == "> >(true)";
            const std::string wait = is_pipe ? "sleep 0.1; " : "";  // until the reader is gone
            const Outcome outcome = inBash(folder, "{ " + wait + program() + " " + command + "; } " + console);
            EXPECT_EQ(outcome.code, 1) << command << " " << console << ": " << outcome;
            EXPECT_THAT(outcome.err, HasSubstr("insonify: the standard output cannot be written: ")) << command;
            const std::vector<std::string> lines = getLines(outcome.err);
            EXPECT_EQ(std::ranges::count_if(lines, isError), 1) << command << ": " << outcome.err;
        }
}

TEST(ConsoleRunTest, ADiagnosticThatCannotBeWrittenKeepsTheExitCode) {
    const WallFolder folder;
    for (const std::string command : {"check none.yml", "run none.yml", "rnu", "run", "water --depth x", "log info x"})
        for (const std::string console : {"2>/dev/full", "2>&-", "2> >(true)"})
            EXPECT_EQ(inBash(folder, program() + " " + command + " " + console).code, 2) << command << " " << console;
}

namespace {

/** A deployment whose start fails after others have used its folder: its first logger waits for the reader of a pipe,
 * and its last one wants the log of the one before. */
struct SlowStart {
    explicit SlowStart(const WallFolder& folder) : pipe(folder / "pipe.log") {
        if (mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
        const auto logger = [](const std::string& name, const std::string& file) {
            return "  " + name + ": {type: logger::LoggerTask, activity: {period: 1}, properties: {file: " + file +
                   ", property_file: ''}}\n";
        };
        const std::string loggers = logger("waits", pipe) + logger("one", "slow.0.log") + logger("two", "slow.0.log");
        writeFile(folder / "slow.yml",
                  replaced(replaced(wall_deployment, "file: wall.0.log", "file: first.0.log, property_file: ''"),
                           "connections:\n", loggers + "connections:\n"));
    }
    void fail() const { close(open(pipe.c_str(), O_RDONLY | O_CLOEXEC)); }
    fs::path pipe;
};

}  // namespace

TEST(ConsoleRunTest, AStartThatFailsKeepsTheFilesOfAnotherRunInItsFolder) {
    const WallFolder folder;
    const SlowStart slow(folder);
    const Process first(insonifyWords({"run", "slow.yml", "--out", "dive"}), folder.path());
    ASSERT_TRUE(insonify::test::becomesTrue([&] { return fs::exists(folder / "dive"); }));
    const Outcome second = inBash(folder, program() + " run wall.yml --out dive --pings 3 >second.txt 2>&1");
    EXPECT_EQ(second.code, 0) << readFile(folder / "second.txt");
    slow.fail();
    EXPECT_EQ(first.wait().code, 2);
    EXPECT_TRUE(isWhole(folder / "dive/wall.0.log"));
    EXPECT_FALSE(fs::exists(folder / "dive/slow.0.log")) << "the failed run leaves nothing";
}

TEST(ConsoleRunTest, AStartThatFailsKeepsItsFolderForARunThatIsStartingInIt) {
    const WallFolder folder(replaced(wall_deployment,
                                     "  log:\n    type: logger::LoggerTask\n    properties: {file: "
                                     "wall.0.log}\n",
                                     "  log: {type: output::FanImageTask, properties: {file: fan_%06d.png}}\n"));
    const std::string text = readFile(folder / "wall.yml");
    writeFile(folder / "wall.yml", replaced(text.substr(0, text.find("  - {from: sonar.ping, to: log.clean")) +
                                                "  - {from: noise.noisy, to: log.ping}\n",
                                            "schedule: lockstep", "schedule: realtime"));
    const SlowStart slow(folder);
    const Process first(insonifyWords({"run", "slow.yml", "--out", "dive"}), folder.path());
    ASSERT_TRUE(insonify::test::becomesTrue([&] { return fs::exists(folder / "dive"); }));
    fs::create_directory(folder / "b");
    const Process second({"bash", "-c", "cd ..; exec " + program() + " run wall.yml --out dive --duration 1.5"},
                         folder / "b");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    slow.fail();
    EXPECT_EQ(first.wait().code, 2);
    EXPECT_EQ(second.wait().code, 0);
    EXPECT_TRUE(fs::exists(folder / "dive/fan_000000.png"));
}

TEST(ConsoleRunTest, AStartThatFailsChangesNoFileOfAnEarlierRun) {
    std::string text = replaced(wall_deployment, "{file: wall.0.log}", "{file: wall.0.log, max_file_size: 1000000}");
    text = replaced(replaced(text, "beam_count: 16", "beam_count: 128"), "bin_count: 50", "bin_count: 1000");
    const WallFolder folder(text);
    ASSERT_EQ(folder.run({"--pings", "6"}).code, 0);
    std::map<std::string, std::string> before;
    for (const auto& entry : fs::directory_iterator(folder / "out")) before[entry.path()] = readFile(entry.path());
    ASSERT_GT(before.size(), 4u) << "a log in several files, its indices, and its properties";
    const std::string twin =
        "  twin: {type: logger::LoggerTask, activity: {period: 1}, properties: {file: wall.0.log}}\n";
    writeFile(folder / "bad.yml", replaced(readFile(folder / "wall.yml"), "connections:\n", twin + "connections:\n"));
    const Outcome outcome = callInsonify(folder, {"run", "bad.yml", "--out", "out"});
    EXPECT_THAT(outcome, isRefused(HasSubstr("another logger writes it")));
    for (const auto& [file, bytes] : before) EXPECT_TRUE(readFile(file) == bytes) << file;
    EXPECT_EQ(static_cast<size_t>(std::distance(fs::directory_iterator(folder / "out"), {})), before.size());
}
