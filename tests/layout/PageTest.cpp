// The project's pages are consistent: links and anchors, names of files, tests and messages, the way in and back.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "tests/layout/Sources.hpp"
#include "tests/support/Pages.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::layout;
using insonify::test::allPages;
using insonify::test::CodeBlock;
using insonify::test::Page;
using insonify::test::readPage;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

namespace {

using Texts = std::vector<std::string>;

const fs::path root = insonify::test::source_dir;

bool isOnTheWeb(const std::string& link) { return link.find(':') != std::string::npos; }

/** The file that a link of the page refers to, from the root; "" for a place on the page itself. */
std::string getTarget(const Page& page, const std::string& link) {
    const std::string file = link.substr(0, link.find('#'));
    return file.empty() ? "" : (fs::path(page.path()).parent_path() / file).lexically_normal().generic_string();
}

bool leadsSomewhere(const Page& page, const std::string& link) {
    const std::string target = getTarget(page, link);
    if (!target.empty() && !fs::exists(root / target)) return false;
    const size_t hash = link.find('#');
    if (hash == std::string::npos) return true;
    return (target.empty() ? page : readPage(target)).anchors().contains(link.substr(hash + 1));
}

Texts brokenLinks(const Page& page) {
    Texts broken = page.links();
    std::erase_if(broken, [&](const std::string& link) { return isOnTheWeb(link) || leadsSomewhere(page, link); });
    return broken;
}

/** Addresses that no browser could open. */
Texts brokenAddresses(const Page& page) {
    static const std::regex form(R"(https://[\w-]+(\.[\w-]+)+(/[\w./~%#?=&+:-]*)?)");
    Texts broken = page.addresses();
    std::erase_if(broken, [&](const std::string& address) { return std::regex_match(address, form); });
    return broken;
}

/** Cells of a row of a table; 0 for any other line. */
size_t countCells(const std::string& line) {
    if (!line.starts_with("|")) return 0;
    size_t bars = 0;
    for (size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    return bars - 1;
}

/** Rows of tables with more or fewer cells than the row above. */
Texts unevenRows(const Page& page) {
    Texts uneven;
    size_t above = 0;
    for (const std::string& line : page.lines()) {
        const size_t cells = countCells(line);
        if (cells > 0 && above > 0 && cells != above) uneven.push_back(line);
        above = cells;
    }
    return uneven;
}

/** Files and folders of the project in a page's back quotes that do not exist. */
Texts deadLinks(const Page& page) {
    static const std::regex path("(types|components|shaders|deploy|tests|scripts)/[\\w./-]+");
    Texts missing;
    for (const std::string& code : page.inlineCode()) {
        const std::string word = code.substr(0, code.find(' '));
        if (std::regex_match(word, path) && !fs::exists(root / word)) missing.push_back(word);
    }
    return missing;
}

/** "Suite.Name" of every TEST in the project. */
std::set<std::string> allTests() {
    static const std::regex test(R"(TEST(?:_F|_P)?\((\w+),\s*(\w+)\))");
    std::set<std::string> tests;
    for (const Source& source : sourcesIn("tests", {".cpp"})) {
        std::string code;
        for (const std::string& line : source.lines) code += line + "\n";
        for (std::sregex_iterator it(code.begin(), code.end(), test); it != std::sregex_iterator(); ++it)
            tests.insert((*it)[1].str() + "." + (*it)[2].str());
    }
    return tests;
}

Texts missingTests(const Page& page, const std::set<std::string>& tests) {
    static const std::regex test(R"(\w+Test\.\w+)");
    Texts missing;
    for (const std::string& code : page.inlineCode())
        if (std::regex_match(code, test) && !tests.contains(code)) missing.push_back(code);
    return missing;
}

/** All code that prints, adjacent literals joined. */
std::string printingCode() {
    std::string code;
    std::vector<Source> sources{readSource(root / "CMakeLists.txt")};
    for (const char* folder : {"components", "types", "scripts"})
        for (const Source& source : sourcesIn(folder, {".cpp", ".hpp", ".js", ".cmake", ".in", ""}))
            sources.push_back(source);
    for (const Source& source : sources)
        for (const std::string& line : source.lines) code += line + "\n";
    static const std::regex between(R"("\s*\n\s*")");
    return std::regex_replace(code, between, "");
}

/** Parts of a quoted message, between the dots that represent variable text, that the code does not print. */
Texts unprintedParts(const std::string& message, const std::string& code) {
    Texts unprinted;
    const bool has_kind = message.starts_with("warning: ") || message.starts_with("notice: ");
    for (size_t at = has_kind ? message.find(' ') : 0; at < message.size();) {
        const size_t end = std::min(message.find("...", at), message.size());
        std::string part = message.substr(at, end - at);
        part.erase(0, part.find_first_not_of(" :;,.("));
        part.erase(part.find_last_not_of(" :;,.(") + 1);
        if (part.size() > 2 && code.find(part) == std::string::npos) unprinted.push_back(part);
        at = end + 3;
    }
    return unprinted;
}

/** A row of the index of messages: a part of the message, what is printed before it, anchors of sections. */
struct IndexRow {
    std::string text, beginning;
    Texts sections;
};

std::vector<IndexRow> readIndex(const Page& page) {
    static const std::regex row(R"(\| `([^|]+)` \| ([^|]+) \| (.+) \|)"), anchor(R"(\(#([\w-]+)\))");
    std::vector<IndexRow> rows;
    for (const std::string& line : page.lines()) {
        std::smatch cells;
        if (!std::regex_match(line, cells, row)) continue;
        const std::string links = cells[3];
        rows.push_back({cells[1], cells[2], {}});
        for (std::sregex_iterator it(links.begin(), links.end(), anchor); it != std::sregex_iterator(); ++it)
            rows.back().sections.push_back((*it)[1]);
    }
    std::erase_if(rows, [](const IndexRow& each) { return each.sections.empty(); });
    return rows;
}

/** The messages that a page quotes, by the anchor of their section. */
std::map<std::string, Texts> quotedMessages(const Page& page) {
    std::map<std::string, Texts> messages;
    std::string section;
    for (size_t i = 0, block = 0; i < page.lines().size(); ++i) {
        if (page.lines()[i].starts_with("## ")) section = *Page("", page.lines()[i]).anchors().begin();
        if (block == page.blocks().size() || page.blocks()[block].line != i + 1) continue;
        std::istringstream lines(page.blocks()[block].language == "text" ? page.blocks()[block].text : "");
        for (std::string line; std::getline(lines, line);) messages[section].push_back(line);
        ++block;
    }
    return messages;
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/** Whether a message begins as its row says: with the word of its kind, or with its place or its own text. */
bool beginsAs(const std::string& message, const std::string& beginning) {
    for (const char* kind : {"warning:", "notice:", "insonify:", "scripts/setup:", "scripts/build:"})
        if (message.starts_with(kind)) return beginning.starts_with(std::string("`") + kind);
    return !beginning.starts_with("`warning:") && !beginning.starts_with("`notice:");
}

/** What is wrong in an index: its order, rows whose section does not quote the message, messages that it lacks. */
Texts wrongRows(const std::vector<IndexRow>& rows, const Page& page) {
    Texts wrong;
    std::map<std::string, Texts> messages = quotedMessages(page);
    std::map<std::string, size_t> count;
    for (const auto& [section, lines] : messages)
        for (const std::string& line : lines) count[line];
    for (size_t i = 0; i < rows.size(); ++i) {
        const IndexRow& row = rows[i];
        if (i > 0 && lowered(row.text) < lowered(rows[i - 1].text))
            wrong.push_back(row.text + ": after " + rows[i - 1].text);
        for (const std::string& section : row.sections) {
            Texts found = messages[section];
            std::erase_if(found, [&](const std::string& line) { return line.find(row.text) == std::string::npos; });
            if (found.empty()) wrong.push_back(row.text + ": not under " + section);
            for (const std::string& line : found) ++count[line];
            if (!std::ranges::all_of(found, [&](const std::string& line) { return beginsAs(line, row.beginning); }))
                wrong.push_back(row.text + ": begins otherwise under " + section);
        }
    }
    for (const auto& [line, times] : count)
        if (times != 1) wrong.push_back(line + ": in " + std::to_string(times) + " rows");
    return wrong;
}

/** A figure that a page quotes: a row of the table of components/SPEED.md. */
struct Quote {
    std::string page, text, words,
        source;  ///< Pages from the root; the words of the source, with dots for what is left out.
};

std::vector<Quote> readQuotes(const Page& page) {
    static const std::regex row(R"(\| \[[^\]]+\]\((\S+)\) \| `([^`]+)` \| `([^`]+)` \| \[[^\]]+\]\((\S+)\) \|)");
    std::vector<Quote> quotes;
    for (const std::string& line : page.lines()) {
        std::smatch cells;
        if (!std::regex_match(line, cells, row)) continue;
        const std::string link = cells[4], file = getTarget(page, link);
        quotes.push_back({getTarget(page, cells[1]), cells[2], cells[3],
                          (file.empty() ? page.path() : file) + link.substr(link.find('#'))});
    }
    return quotes;
}

std::string joinLines(const Page& page) {
    std::string text;
    for (const std::string& line : page.lines()) text += line + " ";
    return text;
}

/** The lines below a heading up to the next one, joined by spaces. */
std::string getSection(const Page& page, const std::string& anchor) {
    std::string text;
    bool inside = false;
    for (const std::string& line : page.lines()) {
        if (line.starts_with("#")) inside = Page("", line).anchors().contains(anchor);
        if (inside) text += line + " ";
    }
    return text;
}

/** Whether a text has the words in their order, with anything in place of their dots. */
bool hasWords(const std::string& text, const std::string& words) {
    size_t from = 0;
    for (size_t at = 0, dots = 0; dots != std::string::npos; at = dots + 4) {
        dots = words.find(" ...", at);
        const std::string part = words.substr(at, dots == std::string::npos ? dots : dots - at);
        from = text.find(part, from);
        if (from == std::string::npos) return false;
        from += part.size();
    }
    return true;
}

std::vector<double> numbersIn(const std::string& text) {
    static const std::regex number(R"(\d[\d,]*(\.\d+)?)");
    std::vector<double> numbers;
    for (std::sregex_iterator it(text.begin(), text.end(), number); it != std::sregex_iterator(); ++it) {
        std::string digits = it->str();
        std::erase(digits, ',');
        numbers.push_back(std::stod(digits));
    }
    return numbers;
}

/** The first number of a quote that no number of its source gives, exactly, rounded or cut off; none: NaN. */
double unknownNumber(const Quote& quote) {
    const std::vector<double> known = numbersIn(quote.words);
    for (const double number : numbersIn(quote.text))
        if (!std::ranges::any_of(known, [&](double each) {
                return each == number || std::floor(each) == number || std::round(each) == number;
            }))
            return number;
    return std::nan("");
}

/** Times, rates and memory of runs on a page that no quote from it contains. */
Texts unquotedFigures(const Page& page, const std::vector<Quote>& quotes) {
    static const std::regex figure(R"(\d[\d.]*\)? (ms|MB|times as fast))");
    std::string text = joinLines(page);
    for (const Quote& quote : quotes)
        if (const size_t at = text.find(quote.text); quote.page == page.path() && at != std::string::npos)
            text.erase(at, quote.text.size());
    Texts figures;
    for (std::sregex_iterator it(text.begin(), text.end(), figure); it != std::sregex_iterator(); ++it)
        figures.push_back(it->str());
    return figures;
}

}  // namespace

TEST(PageTest, LinksOfEveryPageLeadSomewhere) {
    for (const Page& page : allPages()) {
        EXPECT_THAT(brokenLinks(page), IsEmpty()) << page.path();
        EXPECT_THAT(brokenAddresses(page), IsEmpty()) << page.path();
    }
}

TEST(PageTest, EveryPageIsReachedFromTheReadme) {
    std::set<std::string> reached;
    for (Texts next = {"README.md"}; !next.empty();) {
        const std::string path = next.back();
        next.pop_back();
        if (!path.ends_with(".md") || !reached.insert(path).second) continue;
        const Page page = readPage(path);
        for (const std::string& link : page.links())
            if (!isOnTheWeb(link)) next.push_back(getTarget(page, link));
    }
    for (const Page& page : allPages()) EXPECT_TRUE(reached.contains(page.path())) << page.path();
}

TEST(PageTest, EveryPageNextToCodeLinksBackToTheReadme) {
    for (const Page& page : allPages()) {
        if (page.path() == "README.md" || page.path() == "CHANGELOG.md" || fs::path(page.path()).stem() == "ACOUSTICS")
            continue;
        Texts targets;
        for (const std::string& link : page.links()) targets.push_back(getTarget(page, link));
        EXPECT_THAT(targets, Contains("README.md")) << page.path();
    }
}

TEST(PageTest, TheBeginningOfEveryPageSaysForWhomItIs) {
    static const std::regex reader(
        "(This page|It) is for |This page helps |\\b[Ff]or (those|users|everybody|authors) ");
    for (const Page& page : allPages()) {
        std::string begin;
        for (size_t i = 0; i < std::min<size_t>(page.lines().size(), 14); ++i) begin += page.lines()[i] + "\n";
        EXPECT_TRUE(std::regex_search(begin, reader)) << page.path() << ": " << begin;
    }
}

TEST(PageTest, EveryComponentHasAPage) {
    for (const auto& entry : fs::directory_iterator(root / "components"))
        EXPECT_TRUE(!entry.is_directory() || fs::exists(entry.path() / "README.md")) << entry.path();
}

TEST(PageTest, TheReadmeIsALandingPageWithATableOfItsContents) {
    const Page readme = readPage("README.md");
    EXPECT_LE(readme.lines().size(), 200u);
    const Texts links = readme.links();
    for (const std::string& heading : readme.headings(2))
        EXPECT_THAT(links, Contains("#" + *Page("", "## " + heading).anchors().begin())) << heading;
}

TEST(PageTest, EveryBlockOfCodeSaysWhatItIs) {
    // Commands: tests/deployer/PagesTest.cpp runs `sh`; `console` cannot be tested, because it installs, waits for
    // others, uses the wall clock or takes minutes.
    static const std::set<std::string> known = {"sh",   "console", "yaml",   "json", "cpp",
                                                "glsl", "cmake",   "python", "text", "xml"};
    for (const Page& page : allPages())
        for (const CodeBlock& block : page.blocks())
            EXPECT_TRUE(known.contains(block.language)) << page.path() << ":" << block.line << ": " << block.language;
}

TEST(PageTest, TheRowsOfATableHaveTheSameNumberOfCells) {
    for (const Page& page : allPages()) EXPECT_THAT(unevenRows(page), IsEmpty()) << page.path();
}

TEST(PageTest, EveryFileAndTestThatAPageNamesIsThere) {
    const std::set<std::string> tests = allTests();
    for (const Page& page : allPages()) {
        EXPECT_THAT(deadLinks(page), IsEmpty()) << page.path();
        EXPECT_THAT(missingTests(page, tests), IsEmpty()) << page.path();
    }
}

TEST(PageTest, EveryMessageOfTheTroubleshootingPageIsOneThatTheCodePrints) {
    const std::string code = printingCode();
    const Page page = readPage("components/TROUBLESHOOTING.md");
    size_t messages = 0;
    for (const CodeBlock& block : page.blocks()) {
        if (block.language != "text") continue;
        std::istringstream lines(block.text);
        for (std::string message; std::getline(lines, message); ++messages)
            EXPECT_THAT(unprintedParts(message, code), IsEmpty()) << message;
    }
    EXPECT_GT(messages, 30u);
}

TEST(PageTest, TheIndexOfMessagesHasEachOnceByTheAlphabet) {
    const Page page = readPage("components/TROUBLESHOOTING.md");
    const std::vector<IndexRow> rows = readIndex(page);
    EXPECT_THAT(wrongRows(rows, page), IsEmpty());
    EXPECT_GT(rows.size(), 70u);
    const std::string section = "## B c\n```text\nwarning: ...: the x is low\nnotice: no y\n```\n";
    const auto wrong = [&](const std::string& table) {
        const Page made("", "| text | begins with | read |\n| --- | --- | --- |\n" + table + section);
        return wrongRows(readIndex(made), made);
    };
    const std::string no_y = "| `no y` | `notice:` | [b](#b-c) |\n",
                      low = "| `the x is` | `warning: TASK:` | [b](#b-c) |\n";
    EXPECT_THAT(wrong(no_y + low), IsEmpty());
    EXPECT_THAT(wrong(low + no_y), ElementsAre("no y: after the x is"));
    EXPECT_THAT(wrong(no_y), ElementsAre("warning: ...: the x is low: in 0 rows"));
    EXPECT_THAT(wrong(no_y + low + "| `x is low` | `warning: TASK:` | [b](#b-c) |\n"),
                ElementsAre("warning: ...: the x is low: in 2 rows"));
    EXPECT_THAT(wrong(no_y + "| `the x is` | `notice: TASK:` | [b](#b-c) |\n"),
                ElementsAre("the x is: begins otherwise under b-c"));
    EXPECT_THAT(wrong(no_y + low + "| `z` | `warning: TASK:` | [b](#b) |\n"), ElementsAre("z: not under b"));
}

TEST(PageTest, FiguresOfOtherPagesAreQuotes) {
    const std::vector<Quote> quotes = readQuotes(readPage("components/SPEED.md"));
    EXPECT_GT(quotes.size(), 10u);
    for (const Quote& quote : quotes) {
        const size_t hash = quote.source.find('#');
        const std::string section = getSection(readPage(quote.source.substr(0, hash)), quote.source.substr(hash + 1));
        EXPECT_NE(joinLines(readPage(quote.page)).find(quote.text), std::string::npos)
            << quote.page << ": " << quote.text;
        EXPECT_TRUE(hasWords(section, quote.words)) << quote.source << ": " << quote.words;
        EXPECT_TRUE(std::isnan(unknownNumber(quote))) << quote.text << ": " << unknownNumber(quote);
    }
    for (const char* path : {"README.md", "components/COMPARISON.md"})
        EXPECT_THAT(unquotedFigures(readPage(path), quotes), IsEmpty()) << path;
}

TEST(PageTest, OtherFiguresAreFound) {
    const Page source(
        "components/SPEED.md",
        "# S\n| [P](../README.md) | `takes 12 ms` | `x ... 11.9 ms` | [b](#b) |\n## B\nx | 11.9 ms\ny\n## C\nz\n");
    ASSERT_EQ(readQuotes(source).size(), 1u);
    const Quote quote = readQuotes(source)[0];
    EXPECT_THAT((Texts{quote.page, quote.text, quote.words, quote.source}),
                ElementsAre("README.md", "takes 12 ms", "x ... 11.9 ms", "components/SPEED.md#b"));
    EXPECT_EQ(getSection(source, "b"), "## B x | 11.9 ms y ");
    EXPECT_TRUE(hasWords(getSection(source, "b"), quote.words));
    EXPECT_FALSE(hasWords(getSection(source, "c"), quote.words));
    EXPECT_FALSE(hasWords("11.9 ms x", quote.words));
    EXPECT_TRUE(std::isnan(unknownNumber(quote)));
    EXPECT_EQ(unknownNumber({"", "takes 13 ms", "x ... 11.9 ms", ""}), 13);
    EXPECT_EQ(unknownNumber({"", "1,500 of 7", "1500 of 8", ""}), 7);
    EXPECT_THAT(
        unquotedFigures(Page("README.md", "It takes 12 ms, or 3 ms (5) and (6) ms,\n23 times as fast.\n"), {quote}),
        ElementsAre("3 ms", "6) ms", "23 times as fast"));
}

TEST(PageTest, EveryEnvironmentVariableIsOnThePageOfTheCommand) {
    static const std::regex name(R"re("(INSONIFY_[A-Z_]+)")re");
    const std::string code = printingCode();
    std::set<std::string> variables;
    for (std::sregex_iterator it(code.begin(), code.end(), name); it != std::sregex_iterator(); ++it)
        variables.insert((*it)[1].str());
    const Texts shown = readPage("components/command/README.md").inlineCode();
    for (const std::string& variable : variables) EXPECT_THAT(shown, Contains(variable));
    EXPECT_GT(variables.size(), 5u);
}

TEST(PageTest, TheRulesRefuseWhatTheyShould) {
    const Page page(
        "components/README.md",
        "# A page\n## A page\n[a](#a-page-1) [b](#nowhere) [c](log/README.md#damage) [d](log/README.md#no)\n"
        "[e](nowhere.png) ![f](../deploy/pictures/harbour_fls.png) `[g](no.png)` [h](https://a.org/b_(c))\n"
        "https://example.org/a, http:/broken and https://nowhere\n```sh\n[i](no.png)\n```\n"
        "`tests/layout/PageTest.cpp`, `scripts/nowhere --all`, `PageTest.Nothing`\n");
    EXPECT_THAT(brokenLinks(page), ElementsAre("#nowhere", "log/README.md#no", "nowhere.png"));
    EXPECT_THAT(brokenAddresses(page), ElementsAre("https://a.org/b_(c", "http:/broken", "https://nowhere"));
    EXPECT_THAT(deadLinks(page), ElementsAre("scripts/nowhere"));
    EXPECT_THAT(missingTests(page, allTests()), ElementsAre("PageTest.Nothing"));
    EXPECT_THAT(unprintedParts("...: is 3 m; may be ... or so", "\"{} is 3 m; may be {}\""), ElementsAre("or so"));
    EXPECT_THAT(unevenRows(Page("", "| a | b |\n| - | - |\n| a\\|b | c |\n\n| d |\n| e | f |\n")),
                ElementsAre("| e | f |"));
    ASSERT_EQ(page.blocks().size(), 1u);
    EXPECT_EQ(page.blocks()[0].language, "sh");
    EXPECT_EQ(page.blocks()[0].line, 6u);
    EXPECT_EQ(getCode(page, "sh"), "[i](no.png)\n");
}
