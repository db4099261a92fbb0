// Citations in the project refer to existing files, sections of components/sonar/ACOUSTICS.md, and tests.
#include <gmock/gmock.h>

#include <map>
#include <regex>
#include <set>

#include "tests/layout/Sources.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::layout;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

namespace {

using Names = std::vector<std::string>;

const std::string reference = "components/sonar/ACOUSTICS.md";

/** The files of the project, including the root folder, with one of the extensions. */
std::vector<Source> projectFiles(const std::vector<std::string>& extensions) {
    std::vector<Source> all;
    for (const char* folder : {"types", "components", "shaders", "deploy", "tests", "scripts", "ros2"})
        for (Source& source : sourcesIn(folder, extensions)) all.push_back(std::move(source));
    for (const auto& entry : fs::directory_iterator(insonify::test::source_dir))
        if (std::ranges::count(extensions, entry.path().extension().string())) all.push_back(readSource(entry.path()));
    return all;
}

std::vector<Source> markdownFiles() { return projectFiles({".md"}); }

/** The files that can cite a file in a comment. */
std::vector<Source> citingFiles() {
    return projectFiles(
        {".hpp", ".cpp", ".glsl", ".js", ".html", ".css", ".py", ".cmake", ".yml", ".txt", ".rs", ".service", ".md"});
}

/** The first group of every match. */
Names matches(const std::string& text, const std::regex& pattern) {
    Names found;
    for (std::sregex_iterator it(text.begin(), text.end(), pattern); it != std::sregex_iterator(); ++it)
        found.push_back((*it)[1].str());
    return found;
}

std::string getName(const std::string& path) { return fs::path(path).filename(); }

/** Existing Markdown files, and those that the programs of the project write. */
std::set<std::string> knownMarkdown() {
    static const std::regex written(R"re("([\w./-]*\w\.md)")re");
    std::set<std::string> known;
    for (const Source& source : markdownFiles()) known.insert(getName(source.path));
    for (const char* folder : {"components", "scripts"})
        for (const Source& source : sourcesIn(folder, {".cpp", ".py"}))
            for (const std::string& line : source.lines)
                for (const std::string& path : matches(line, written)) known.insert(getName(path));
    return known;
}

/** Cited Markdown files that do not exist. */
Names missingFiles(const Source& source, const std::set<std::string>& known) {
    static const std::regex cited(R"(([\w./-]*\w\.md)\b)");
    Names missing;
    for (const std::string& line : source.lines)
        for (const std::string& path : matches(line, cited))
            if (!known.contains(getName(path))) missing.push_back(path);
    return missing;
}

/** The numbers of a reference's headings: "4.1". */
std::set<std::string> getSections(const Source& page) {
    static const std::regex heading(R"(^##+ (\d+(\.\d+)*) .*)");
    std::set<std::string> sections;
    for (const std::string& line : page.lines)
        for (const std::string& number : matches(line, heading)) sections.insert(number);
    return sections;
}

/** Cited sections that do not exist; "" if the reference is named without a section, and not as a path. */
Names missingSections(const Source& source, const std::set<std::string>& sections) {
    static const std::regex cited(R"((?:^|[^/])ACOUSTICS\.md((( |, | and | to )\d+(\.\d+)*)*))");
    static const std::regex number(R"((\d+(\.\d+)*))");
    Names missing;
    for (const std::string& line : source.lines)
        for (const std::string& list : matches(line, cited)) {
            const Names numbers = matches(list, number);
            if (numbers.empty()) missing.push_back("");
            for (const std::string& section : numbers)
                if (!sections.contains(section)) missing.push_back(section);
        }
    return missing;
}

std::string toText(const Source& source) {
    std::string text;
    for (const std::string& line : source.lines) text += line + "\n";
    return text;
}

/** A test by its GoogleTest name, and the file that is named before it. */
struct NamedTest {
    std::string file, suite, name;
    bool exists() const {
        const std::string code = toText(readSource(fs::path(insonify::test::source_dir) / file));
        return std::regex_search(code, std::regex("TEST(_F|_P)?\\(" + suite + ",\\s*" + name + "\\)"));
    }
};

std::vector<NamedTest> testsIn(const std::string& text) {
    static const std::regex quoted("`([^`\n]+)`"), test(R"((\w+Test)\.(\w+))");
    std::vector<NamedTest> tests;
    std::string file;
    for (const std::string& token : matches(text, quoted)) {
        std::smatch parts;
        if (token.starts_with("tests/"))
            file = token;
        else if (std::regex_match(token, parts, test))
            tests.push_back({file, parts[1], parts[2]});
    }
    return tests;
}

/** The text of each section and subsection, up to the next heading. */
std::map<std::string, std::string> getTexts(const Source& page) {
    std::map<std::string, std::string> texts;
    std::string section;
    for (const std::string& line : page.lines) {
        const std::set<std::string> numbers = getSections({page.path, {line}});
        if (!numbers.empty()) section = *numbers.begin();
        if (!section.empty()) texts[section] += line + "\n";
    }
    return texts;
}

/** Paths in back quotes that do not exist. */
Names missingPaths(const std::string& text) {
    static const std::regex path("`((types|components|shaders|deploy|tests|scripts)/[\\w./-]+)`");
    Names missing = matches(text, path);
    std::erase_if(missing, [](const std::string& p) { return fs::exists(fs::path(insonify::test::source_dir) / p); });
    return missing;
}

Source referencePage() { return readSource(fs::path(insonify::test::source_dir) / reference); }

}  // namespace

TEST(CitationTest, NoFileCitesAnotherThatIsNotInTheProject) {
    const std::set<std::string> known = knownMarkdown();
    for (const Source& source : citingFiles()) EXPECT_THAT(missingFiles(source, known), IsEmpty()) << source.path;
}

TEST(CitationTest, EverySectionOfTheReferenceThatIsCitedIsThere) {
    const std::set<std::string> sections = getSections(referencePage());
    for (const Source& source : citingFiles()) {
        if (source.path.ends_with(".md")) continue;
        EXPECT_THAT(missingSections(source, sections), IsEmpty()) << source.path;
    }
}

TEST(CitationTest, EveryTestAndFileThatTheReferenceNamesIsThere) {
    const std::string text = toText(referencePage());
    EXPECT_THAT(missingPaths(text), IsEmpty());
    EXPECT_FALSE(testsIn(text).empty());
    for (const NamedTest& test : testsIn(text))
        EXPECT_TRUE(test.exists()) << test.file << ": " << test.suite << "." << test.name;
}

TEST(CitationTest, EverySectionOfTheReferenceNamesATestButItsSources) {
    const auto texts = getTexts(referencePage());
    for (const auto& [section, text] : texts) {
        if (section == "13" || texts.contains(section + ".1")) continue;
        EXPECT_FALSE(testsIn(text).empty()) << section;
    }
}

TEST(CitationTest, TheRulesRefuseWhatTheyShould) {
    const std::string md = ".md", page = "ACOUSTICS" + md;  // so that these citations are not the project's own
    const Source code{"a.cpp", {"// notes/nowhere" + md + " 3", "// " + page + " 1.1, 7 and 99.1: none", "// " + page}};
    EXPECT_THAT(missingFiles(code, {page}), ElementsAre("notes/nowhere" + md));
    EXPECT_THAT(missingSections(code, getSections({"", {"## 1 Sound", "### 1.1 Speed", "Text 99.1", "## 7 Noise"}})),
                ElementsAre("99.1", ""));
    const auto tests = testsIn(
        "`tests/layout/CitationTest.cpp`: `CitationTest.TheRulesRefuseWhatTheyShould`, "
        "`CitationTest.Nothing`, not CitationTest.Quoted");
    ASSERT_EQ(tests.size(), 2u);
    EXPECT_TRUE(tests[0].exists());
    EXPECT_FALSE(tests[1].exists());
    EXPECT_THAT(missingPaths("`tests/layout/CitationTest.cpp`, `tests/nowhere.cpp`"), ElementsAre("tests/nowhere.cpp"));
}
