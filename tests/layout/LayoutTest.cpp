#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/layout/Sources.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::layout;

namespace {

std::string fileText(const std::string& path) {
    std::string text;
    for (const std::string& line : readSource(std::filesystem::path(insonify::test::source_dir) / path).lines)
        text += line + "\n";
    return text;
}

/** The headers in back quotes that a section of the page for developers lists, by their path in the folder. */
std::set<std::string> headersListed(const std::string& page, const std::string& folder) {
    static const std::regex row(R"(\| `([\w/]+\.hpp)` \| [^|]+)");
    const size_t begin = std::min(page.find("\n## " + folder + "\n"), page.size() - 1);
    const std::string section = page.substr(begin, page.find("\n## ", begin + 1) - begin);
    std::set<std::string> names;
    for (std::sregex_iterator it(section.begin(), section.end(), row); it != std::sregex_iterator(); ++it)
        names.insert((*it)[1].str());
    return names;
}

}  // namespace

TEST(LayoutTest, TheTopLevelHoldsOnlyWhatTheDesignNames) {
    const std::set<std::string> expected = {"CMakeLists.txt",
                                            "CMakePresets.json",
                                            "README.md",
                                            "LICENSE",
                                            "CHANGELOG.md",
                                            "types",
                                            "components",
                                            "shaders",
                                            "deploy",
                                            "tests",
                                            "scripts",
                                            "ros2",
                                            ".ci",
                                            ".git",
                                            ".clang-format",
                                            ".clang-tidy",
                                            ".gitignore",
                                            "out",
                                            "pyproject.toml",
                                            "CITATION.cff",
                                            "CONTRIBUTING.md"};
    for (const auto& entry : std::filesystem::directory_iterator(insonify::test::source_dir)) {
        const std::string name = entry.path().filename();
        EXPECT_TRUE(expected.contains(name) || name.starts_with("build")) << name;
    }
}

TEST(LayoutTest, AComponentsFolderIsItsNamespace) {
    for (const Source& source : sourcesIn("components", {".hpp", ".cpp"})) {
        if (source.stem() == "main" || source.stem() == "Library") continue;
        std::string space = source.folder();
        if (space == "log" && source.path.find("/pocolog/") != std::string::npos) space += "::pocolog";
        if (space == "log" && source.path.find("/mcap/") != std::string::npos) space += "::mcap";
        const auto opensIt = [&](const std::string& line) {
            return line.find("namespace insonify::" + space) != std::string::npos;
        };
        EXPECT_TRUE(std::ranges::any_of(source.lines, opensIt)) << source.path;
    }
}

TEST(LayoutTest, LimitsAreMaxAndMin) {
    const std::regex other("\\b(most|least|maximum|minimum)_[a-z]\\w*");
    for (const char* folder : {"types", "components", "shaders"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp", ".glsl"}))
            for (const std::string& line : source.lines) {
                std::smatch found;
                EXPECT_FALSE(std::regex_search(line, found, other)) << source.path << ": " << found[0];
            }
}

TEST(LayoutTest, NoSourceReadsNumbersByTheLocaleOfTheHost) {
    const std::regex by_locale(R"(\b(strto(d|f|ld)|v?f?s?scanf|atof|sto(d|f|ld))\()");
    for (const char* folder : {"types", "components"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp"}))
            for (const std::string& line : source.lines)
                EXPECT_FALSE(std::regex_search(line, by_locale))
                    << source.path << ": std::from_chars instead: " << line;
}

/** A refused thread is an error that names it, and a fork is noticed where processes are told apart by their number. */
TEST(LayoutTest, ThreadsAreStartedAndForksNoticedInOnePlace) {
    const std::regex own_way(R"(\bstd::thread\([^)]|\bstd::jthread\b|\bgetpid\(\)\s*[!=]=|[!=]=\s*getpid\(\))");
    for (const char* folder : {"types", "components"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp"}))
            for (const std::string& line : source.lines)
                EXPECT_TRUE(source.path == "types/Thread.hpp" || !std::regex_search(line, own_way))
                    << source.path << ": types::startThread() and types::OwnProcess instead: " << line;
}

std::string trimmed(const std::string& line) { return line.substr(std::min(line.size(), line.find_first_not_of(' '))); }

/** Returns the functions of several lines in a source, each as its text without indents. */
std::vector<std::string> functionsIn(const Source& source) {
    static const std::regex begin(R"(^(?!return|namespace|struct|class)[\w:<>&*, ]+ [&*]?\w+\(.*\{$)");
    constexpr size_t several = 5;
    std::vector<std::string> functions;
    for (size_t i = 0; i < source.lines.size(); ++i) {
        if (!std::regex_search(source.lines[i], begin)) continue;
        const auto end = std::find(source.lines.begin() + static_cast<std::ptrdiff_t>(i), source.lines.end(), "}");
        const auto size = static_cast<size_t>(end - source.lines.begin()) - i;
        std::string text;
        for (size_t k = i; k < i + size; ++k) text += trimmed(source.lines[k]) + '\n';
        if (size >= several) functions.push_back(text);
    }
    return functions;
}

TEST(LayoutTest, NoFunctionOfSeveralLinesIsWrittenTwice) {
    std::map<std::string, std::string> found;  // path by text
    for (const char* folder : {"types", "components"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp"}))
            for (const std::string& function : functionsIn(source)) {
                const auto [other, is_new] = found.emplace(function, source.path);
                EXPECT_TRUE(is_new || other->second == source.path)
                    << other->second << " and " << source.path << ": " << function.substr(0, function.find('\n'));
            }
    EXPECT_GT(found.size(), 1000u);
}

/** An exception that leaves a function of C ends the process of Python. */
TEST(LayoutTest, EveryFunctionForPythonIsGuarded) {
    const std::regex begin(R"(^[\w:*&<> ]* \*?(insonify_\w+)\()");
    const std::set<std::string> throw_nothing = {"insonify_error", "insonify_free"};
    const std::filesystem::path root = insonify::test::source_dir;
    const Source source = readSource(root / "components/python/Interface.cpp");
    size_t functions = 0;
    for (size_t i = 0; i < source.lines.size(); ++i) {
        std::smatch found;
        if (!std::regex_search(source.lines[i], found, begin) || throw_nothing.contains(found[1])) continue;
        ++functions;
        bool is_guarded = false;
        for (size_t k = i; k < source.lines.size() && source.lines[k] != "}"; ++k)
            is_guarded = is_guarded || source.lines[k].find("return guarded(") != std::string::npos;
        EXPECT_TRUE(is_guarded) << found[1];
    }
    EXPECT_GE(functions, 10u);
}

TEST(LayoutTest, EveryHeaderIsOnThePageForDevelopersAndNoOther) {
    const std::string page = fileText("components/DEVELOP.md");
    std::map<std::string, std::set<std::string>> headers;  // By folder.
    for (const char* top : {"types", "components"})
        for (const Source& source : sourcesIn(top, {".hpp"})) {
            const std::string at = (source.path.starts_with("types/") ? "" : "components/") + source.folder() + "/";
            headers[source.folder()].insert(source.path.substr(at.size()));
        }
    EXPECT_GT(headers.size(), 30u);
    for (const auto& [folder, names] : headers)
        EXPECT_EQ(headersListed(page, folder), names) << folder << ": scripts/make_headers brings the page up to date";
    EXPECT_EQ(headersListed("# A\n## b\n| `c/D.hpp` | e |\n## f\n| `G.hpp` | h |\n", "b"),
              std::set<std::string>{"c/D.hpp"});
}

TEST(LayoutTest, EveryTestFileIsNamedAfterWhatItTests) {
    for (const Source& source : sourcesIn("tests", {".cpp"})) {
        if (source.path.starts_with("tests/support/") || source.path.starts_with("tests/bench/")) continue;
        EXPECT_TRUE(source.stem().ends_with("Test")) << source.path;
    }
}

TEST(LayoutTest, TheReadmeNamesEveryCommand) {
    const std::string readme = fileText("README.md");
    for (const char* command : {"scripts/run", "scripts/test", "insonify run", "insonify check", "insonify plan",
                                "insonify describe", "insonify log info", "insonify log export", "insonify replay"})
        EXPECT_NE(readme.find(command), std::string::npos) << command;
}
