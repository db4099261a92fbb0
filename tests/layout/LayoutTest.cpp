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

/** The page of a source's component, or of types. */
std::string pageOf(const Source& source) {
    return (source.path.starts_with("types/") ? "" : "components/") + source.folder() + "/README.md";
}

/** The text between "## Files" and the next heading of that level; "" if there is none. */
std::string filesSectionOf(const std::string& page) {
    const size_t begin = page.find("\n## Files\n");
    return begin == std::string::npos ? "" : page.substr(begin, page.find("\n## ", begin + 1) - begin);
}

/** Headers and code files in back quotes, without those that have a folder before them. */
std::set<std::string> filesNamedIn(const std::string& text) {
    static const std::regex name(R"(`(\w+\.[hc]pp)`)");
    std::set<std::string> names;
    for (std::sregex_iterator it(text.begin(), text.end(), name); it != std::sregex_iterator(); ++it)
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

TEST(LayoutTest, EveryHeaderIsOnThePageOfItsFolder) {
    std::map<std::string, std::set<std::string>> files;  // By page.
    for (const char* folder : {"types", "components"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp"}))
            files[pageOf(source)].insert(std::filesystem::path(source.path).filename());
    for (const auto& [page, names] : files) {
        const std::string text = fileText(page);
        for (const std::string& name : names)
            EXPECT_TRUE(!name.ends_with(".hpp") || text.find("`" + name + "`") != std::string::npos)
                << page << ": " << name;
        for (const std::string& name : filesNamedIn(filesSectionOf(text)))
            EXPECT_TRUE(names.contains(name)) << page << ": " << name;
    }
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
