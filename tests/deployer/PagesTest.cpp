// The examples of the pages work: commands, deployments, code.
#include <gmock/gmock.h>

#include <map>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Pages.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using insonify::test::allPages;
using insonify::test::CodeBlock;
using insonify::test::findUnprinted;
using insonify::test::getCode;
using insonify::test::Page;
using insonify::test::readPage;
using testing::HasSubstr;

namespace {

const fs::path sources = insonify::test::source_dir;

bool holdsCommands(const CodeBlock& block) { return block.language == "sh"; }

/** Whether a block is what the commands of the block above it print. */
bool showsOutput(const CodeBlock& commands, const CodeBlock& block) {
    return holdsCommands(commands) && block.language == "text" && commands.isFollowedBy(block);
}

/** The pages with commands to run. */
std::vector<std::string> pagesWithCommands() {
    std::vector<std::string> paths;
    for (const Page& page : allPages())
        if (std::ranges::any_of(page.blocks(), holdsCommands)) paths.push_back(page.path());
    return paths;
}

/** A user's folder while reading a page: the project, without the output of any run. */
void makeCheckout(const TestFolder& folder) {
    fs::copy(sources / "deploy", folder / "deploy", fs::copy_options::recursive);
    for (const char* name : {"types", "components", "shaders", "scripts", "tests"})
        fs::create_directory_symlink(sources / name, folder / name);
    fs::create_directories(folder / "build");
    fs::create_directory_symlink(insonify::test::bin_dir, folder / "build/bin");
}

Outcome runInBash(const TestFolder& folder, const std::string& commands) {
    const std::string path = std::string("export PATH=") + insonify::test::bin_dir + ":$PATH\n";
    return Process({"bash", "-euo", "pipefail", "-c", path + commands}, folder.path()).wait();
}

class PagesTest : public testing::TestWithParam<std::string> {};

/** The command's help. */
struct Commands {
    std::map<std::string, std::string> help;  ///< By the words of the command, after "insonify": "", "log", "log cut".

    Commands() {
        add("");
        for (const char* parent : {"log", "study", "device", "scene", "dataset"}) add(parent);
    }
    /** Returns the longest command at the beginning of a call. */
    std::string getName(const std::vector<std::string>& words) const {
        std::string name;
        for (size_t i = 1; i < words.size(); ++i) {
            const std::string longer = name.empty() ? words[i] : name + " " + words[i];
            if (!help.contains(longer)) return name;
            name = longer;
        }
        return name;
    }
    bool asksForOneMore(const std::string& name) const {
        const std::string& text = help.at(name);
        return text.find("Subcommands:") != std::string::npos && text.find("[SUBCOMMAND]") == std::string::npos;
    }
    bool knows(const std::string& name, const std::string& option) const {
        return std::regex_search(help.at(name), std::regex(option + "[^-\\w]"));
    }

private:
    static std::string getHelp(const std::string& name) {
        const TestFolder folder;
        return runInBash(folder, "insonify " + name + " --help").out;
    }
    /** Returns the commands in a list of "Subcommands:". */
    void add(const std::string& parent) {
        const std::string text = help[parent] = getHelp(parent);
        std::istringstream lines(text.substr(text.find("Subcommands:")));
        for (std::string line; std::getline(lines, line);) {
            const std::string word = line.substr(0, line.find(' ', 2));
            if (!line.starts_with("  ") || word.size() < 3) continue;
            const std::string name = (parent.empty() ? "" : parent + " ") + word.substr(2);
            help[name] = getHelp(name);
        }
    }
};

std::vector<std::string> splitWords(const std::string& line) {
    std::istringstream stream(line.substr(0, line.find(" #")));
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

/** Returns all inputs on the page that begin with the name of the command. */
std::vector<std::string> shownCalls(const Page& page) {
    std::vector<std::string> calls = page.inlineCode();
    for (const CodeBlock& block : page.blocks())
        if (block.language == "sh" || block.language == "console") {
            std::istringstream lines(block.text);
            for (std::string line; std::getline(lines, line);) calls.push_back(line);
        }
    std::erase_if(calls, [](const std::string& call) { return !call.starts_with("insonify "); });
    return calls;
}

/** Returns the command or the options of a call that do not exist. */
std::vector<std::string> unknownIn(const std::string& call, const Commands& commands) {
    const std::vector<std::string> words = splitWords(call);
    const std::string name = commands.getName(words);
    const size_t next = name.empty() ? 1 : 2 + static_cast<size_t>(std::ranges::count(name, ' '));
    std::vector<std::string> unknown;
    if (commands.asksForOneMore(name) && next < words.size() && !words[next].starts_with("-")) return {words[next]};
    for (const std::string& word : words)
        if (word.starts_with("--") && !commands.knows(name, word)) unknown.push_back(word);
    return unknown;
}

}  // namespace

TEST_P(PagesTest, ItsCommandsWorkOneAfterTheOther) {
    const TestFolder folder;
    makeCheckout(folder);
    const Page page = readPage(GetParam());
    size_t run = 0;
    Outcome outcome;
    for (size_t i = 0; i < page.blocks().size(); ++i) {
        const CodeBlock& block = page.blocks()[i];
        if (i > 0 && showsOutput(page.blocks()[i - 1], block)) {
            EXPECT_EQ(findUnprinted(block.text, outcome.out), "") << page.path() << ":" << block.line << "\n"
                                                                  << outcome.out;
        }
        if (!holdsCommands(block)) continue;
        outcome = runInBash(folder, "exec 2>&1\n" + block.text);
        ASSERT_THAT(outcome, succeeds()) << page.path() << ":" << block.line << "\n" << block.text;
        ++run;
    }
    const auto fences = std::ranges::count_if(
        page.lines(), [](const std::string& line) { return line.find("```sh") != std::string::npos; });
    EXPECT_EQ(run, fences) << page.path();
}

INSTANTIATE_TEST_SUITE_P(All, PagesTest, testing::ValuesIn(pagesWithCommands()), [](const auto& tested) {
    std::string name = tested.param;
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
});

TEST(PagesTest, TheFirstCommandsShowWhatTheyPrint) {
    for (const char* path : {"README.md", "components/dataset/README.md", "components/dds/README.md",
                             "components/device/README.md", "deploy/TUTORIAL.md"}) {
        const std::vector<CodeBlock> blocks = readPage(path).blocks();
        const auto first = std::ranges::adjacent_find(blocks, showsOutput);
        EXPECT_NE(first, blocks.end()) << path;
    }
}

TEST(PagesTest, ShownLinesAreLinesOfTheOutputWithDotsForWhatVaries) {
    const std::string output = "a\n3 pings in 1.5 s: 2 per second\nb\nc\n";
    for (const char* shown : {"", "a\n", "b\nc\n", "a\n3 pings in ...\nb\n", "a\n...\nc\n",
                              "3 ... in ... s: ... per second\n", "  ...\nb\n", "...\n"})
        EXPECT_EQ(findUnprinted(shown, output), "") << shown;
    EXPECT_EQ(findUnprinted("a\nb\n", output), "a\nb\n");
    EXPECT_EQ(findUnprinted("c\n...\nb\n", output), "b\n");
    EXPECT_EQ(findUnprinted("a\n4 pings ...\n", output), "a\n4 pings ...\n");
    EXPECT_EQ(findUnprinted("3 pings in ... per minute\n", output), "3 pings in ... per minute\n");
    EXPECT_EQ(findUnprinted("pings in ...\n", output), "pings in ...\n");
    EXPECT_EQ(findUnprinted("3 pings in 1.5 s...: 2 per secondsecond\n", output),
              "3 pings in 1.5 s...: 2 per secondsecond\n");
    EXPECT_EQ(findUnprinted("\n", output), "\n");
    EXPECT_TRUE(showsOutput({"sh", 3, "a\nb\n"}, {"text", 8, ""}));
    EXPECT_FALSE(showsOutput({"sh", 3, "a\nb\n"}, {"text", 9, ""}));
    EXPECT_FALSE(showsOutput({"console", 3, "a\nb\n"}, {"text", 7, ""}));
}

TEST(PagesTest, EveryCommandAndOptionOnAPageExists) {
    const Commands commands;
    size_t calls = 0;
    for (const Page& page : allPages())
        for (const std::string& call : shownCalls(page)) {
            EXPECT_THAT(unknownIn(call, commands), testing::IsEmpty()) << page.path() << ": " << call;
            ++calls;
        }
    EXPECT_GT(calls, 50u);
    EXPECT_THAT(unknownIn("insonify log mend x.log", commands), testing::ElementsAre("mend"));
    EXPECT_THAT(unknownIn("insonify lgo info x.log", commands), testing::ElementsAre("lgo"));
    EXPECT_THAT(unknownIn("insonify run x.yml --ping 3 --worst 3 --out y  # --no", commands),
                testing::ElementsAre("--ping", "--worst"));
}

TEST(PagesTest, EveryTaskOnAPageIsInTheSchema) {
    const TestFolder folder;
    if (python(folder, "import jsonschema, yaml").code != 0) GTEST_SKIP() << "there is no python3-jsonschema";
    writeFile(folder / "schema.json", callInsonify(folder, {"schema"}).out);
    for (const Page& page : allPages())
        for (const CodeBlock& block : page.blocks())
            if (block.language == "yaml")
                writeFile(folder / (std::to_string(block.line) + "_" +
                                    fs::path(page.path()).parent_path().stem().string() + ".yml"),
                          block.text);
    const Outcome outcome = python(folder, R"(
import glob, json, re, textwrap, yaml, jsonschema
schema, seen = json.load(open("schema.json")), 0
def tasks(node):
    if isinstance(node, dict) and "::" in str(node.get("type", "")):
        yield node
    elif isinstance(node, (dict, list)):
        for child in node.values() if isinstance(node, dict) else node:
            yield from tasks(child)
for name in sorted(glob.glob("*.yml")):
    for part in re.split(r"^\.\.\.$", open(name).read(), flags=re.MULTILINE):
        for task in tasks(yaml.safe_load(textwrap.dedent(part))):
            if task["type"] not in schema["$defs"] and task["type"].startswith(("dds::", "gazebo::", "viewer::")):
                continue  # a build may be without them
            try:
                jsonschema.validate({"schedule": "realtime", "tasks": {"task": task}}, schema)
            except jsonschema.ValidationError as error:
                raise SystemExit(f"{name}: {task}: {error.message}")
            seen += 1
print(seen))");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(std::stoi(outcome.out), 15);
}

TEST(PagesTest, TheComponentBuildsAndRunsInADeployment) {
    std::string deployment =
        replaced(wall_deployment, "tasks:\n",
                 "libraries: [mean_echo.so]\ntasks:\n  mean: {type: example::MeanEchoTask, properties: {beyond: 2}}\n");
    deployment +=
        "  - {from: sonar.ping, to: mean.ping}\n  - {from: mean.mean, to: log.mean, policy: {type: buffer, size: "
        "64}}\n";
    const WallFolder folder(deployment);
    writeFile(folder / "mean_echo.cpp", getCode(readPage("components/framework/README.md"), "cpp"));
    ASSERT_THAT(
        Process({"g++", "-std=c++20", "-shared", "-fPIC", "-I" + sources.string(),
                 "-I" + std::string(insonify::test::build_dir) + "/include", "mean_echo.cpp", "-o", "mean_echo.so"},
                folder.path())
            .wait(),
        succeeds());

    const auto described =
        prints(testing::AllOf(testing::HasSubstr("example::MeanEchoTask: "), testing::HasSubstr("  beyond: ")));
    EXPECT_THAT(callInsonify(folder, {"describe", "example::MeanEchoTask", "--library", "mean_echo.so"}), described);
    EXPECT_THAT(callInsonify(folder, {"describe", "example::MeanEchoTask", "--deployment", "wall.yml"}), described);
    EXPECT_THAT(callInsonify(folder, {"describe", "--json", "--library", "mean_echo.so"}).out,
                testing::HasSubstr("example::MeanEchoTask"));
    EXPECT_THAT(callInsonify(folder, {"describe", "example::MeanEchoTask"}),
                isRefused(testing::HasSubstr("is read with --library FILE or --deployment FILE")));
    EXPECT_THAT(callInsonify(folder, {"describe", "a::B", "--library", "none.so"}),
                isRefused(testing::HasSubstr("none.so")));
    EXPECT_THAT(callInsonify(folder, {"describe", "a::B", "--deployment", "none.yml"}),
                isRefused(testing::HasSubstr("none.yml")));

    ASSERT_THAT(folder.run({"--pings", "2"}), succeeds());
    ASSERT_EQ(
        callInsonify(folder, {"log", "export", "out/wall.0.log", "--stream", "mean.mean", "--to", "mean.csv"}).code, 0);
    EXPECT_TRUE(readFile(folder / "mean.csv").starts_with("time,value\n"));
    EXPECT_THAT(callInsonify(folder, {"run", "wall.yml", "--set", "mean.beyond=-1"}).err,
                HasSubstr("tasks.mean.properties.beyond"));
}

TEST(PagesTest, TheFirstDeploymentIsTheMinimalOne) {
    for (const char* path : {"README.md", "components/framework/README.md"})
        EXPECT_THAT(readFile(sources / "deploy/minimal.yml"), HasSubstr(getCode(readPage(path), "yaml"))) << path;
}
