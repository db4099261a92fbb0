// The project speaks the field's words: identifiers, comments and pages do without those of its former dialect.
#include <gmock/gmock.h>

#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "tests/layout/Sources.hpp"
#include "tests/support/Pages.hpp"

namespace insonify::layout {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Texts = std::vector<std::string>;

/** Words of no identifier, comment or page. */
const std::set<std::string, std::less<>> unwanted{
    "tell",    "tells",    "told",   "telling",   "hear",       "hears",  "heard", "hearing", "unheard", "beside",
    "aim",     "aims",     "aimed",  "slab",      "slabs",      "lane",   "judge", "judges",  "judged",  "regard",
    "regards", "regarded", "caster", "complaint", "complaints", "stands", "goes",  "comes",   "lies",    "ones"};
/** In addition of no variable or function: bounds are "max" and "min". */
const std::set<std::string, std::less<>> unwanted_in_names{"most", "least", "largest", "smallest", "lanes"};
/** Two words of no comment or page. */
constexpr std::array<std::array<std::string_view, 2>, 6> unwanted_pairs{
    {{"so", "many"}, {"so", "much"}, {"as", "many"}, {"as", "much"}, {"left", "out"}, {"leaves", "out"}}};

/** Splits text into words of lower case, at every character that is not a letter, and in names before capitals. */
Texts wordsOf(std::string_view text) {
    Texts words;
    bool in_word = false, after_small = false;
    for (const char c : text) {
        const bool is_letter = std::isalpha(static_cast<unsigned char>(c));
        const bool is_capital = std::isupper(static_cast<unsigned char>(c));
        if (is_letter && (!in_word || (is_capital && after_small))) words.emplace_back();
        if (is_letter) words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        in_word = is_letter, after_small = is_letter && !is_capital;
    }
    return words;
}

/** Returns the unwanted words of a comment or page. */
Texts unwantedIn(std::string_view prose) {
    Texts found;
    const Texts words = wordsOf(prose);
    for (size_t i = 0; i < words.size(); ++i) {
        if (unwanted.contains(words[i])) found.push_back(words[i]);
        for (const auto& [first, second] : unwanted_pairs)
            if (i > 0 && words[i - 1] == first && words[i] == second) found.push_back(words[i - 1] + " " + words[i]);
    }
    return found;
}

/** Returns the first word of a comment that begins with "Of": a detached genitive. */
Texts detachedIn(std::string_view comment) {
    const size_t begin = comment.find_first_not_of("/*<# ");
    return begin != std::string_view::npos && comment.substr(begin).starts_with("Of ") ? Texts{"Of"} : Texts{};
}

/** Returns the name if it has an unwanted word, but for names of other libraries and of `types::Plan`, which logs
 * contain. */
Texts unwantedInName(std::string_view name) {
    static const std::set<std::string, std::less<>> others{"ones", "ones_like", "slabs"};
    Texts found;
    if (others.contains(name)) return found;
    const bool is_type = std::isupper(static_cast<unsigned char>(name[0])) && name.find('_') == std::string_view::npos;
    const Texts words = wordsOf(name);
    for (size_t i = 0; i < words.size(); ++i) {
        const bool is_bound = (words[i] == "most" || words[i] == "least") && i > 0 && words[i - 1] == "at";
        if (unwanted.contains(words[i]) || (unwanted_in_names.contains(words[i]) && !is_bound && !is_type))
            found.push_back(std::string(name));
    }
    return found;
}

/** Divides code into comments and names; strings are neither. */
class Divider {
public:
    Divider(std::string_view code, bool is_python) : code_(code), is_python_(is_python) {}

    void divide(const auto& comment, const auto& name) {
        while (at_ < code_.size()) {
            if (startsComment())
                comment(upTo("\n"));
            else if (starts("/*"))
                comment(upTo("*/"));
            else if (starts("\"\"\""))
                comment(quoted("\"\"\""));
            else if (starts("R\""))
                raw();
            else if (starts("\""))
                quoted("\"");
            else if (starts("'"))
                quoted("'");
            else if (std::isdigit(static_cast<unsigned char>(code_[at_])))
                run("'.");
            else if (std::isalpha(static_cast<unsigned char>(code_[at_])) || code_[at_] == '_')
                name(run(""));
            else
                ++at_;
        }
    }

private:
    bool starts(std::string_view with) const { return code_.substr(at_).starts_with(with); }
    bool startsComment() const { return is_python_ ? starts("#") : starts("//"); }
    std::string_view upTo(std::string_view end) {
        const size_t begin = std::exchange(at_, std::min(code_.find(end, at_), code_.size()));
        return code_.substr(begin, at_ - begin);
    }
    std::string_view quoted(std::string_view quote) {
        const size_t begin = at_;
        for (at_ += quote.size(); at_ < code_.size() && !starts(quote); ++at_) {
            if (code_[at_] == '\\')
                ++at_;
            else if (code_[at_] == '\n' && quote.size() == 1)
                break;
        }
        at_ += quote.size();
        return code_.substr(begin, std::min(at_, code_.size()) - begin);
    }
    void raw() {
        const size_t open = code_.find('(', at_);
        upTo(")" + std::string(code_.substr(at_ + 2, open - at_ - 2)) + "\"");
    }
    /** A name, or with `more` characters a number: 20'000. */
    std::string_view run(std::string_view more) {
        const size_t begin = at_;
        const auto belongs = [&](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || more.find(c) != std::string_view::npos;
        };
        while (at_ < code_.size() && belongs(code_[at_])) ++at_;
        return code_.substr(begin, at_ - begin);
    }

    std::string_view code_;
    bool is_python_;
    size_t at_ = 0;
};

Texts unwantedInCode(std::string_view code, bool is_python) {
    Texts found;
    const auto add = [&](const Texts& more) { found.insert(found.end(), more.begin(), more.end()); };
    Divider(code, is_python)
        .divide([&](std::string_view comment) { add(unwantedIn(comment)), add(detachedIn(comment)); },
                [&](std::string_view name) { add(unwantedInName(name)); });
    return found;
}

std::string textOf(const Source& source) {
    std::string text;
    for (const std::string& line : source.lines) text += line + "\n";
    return text;
}

bool isPython(const Source& source) {
    return source.path.ends_with(".py") ||
           (!source.lines.empty() && source.lines[0].find("python") != std::string::npos);
}

}  // namespace

TEST(WordsTest, NamesAndCommentsUseTheWordsOfTheField) {
    for (const char* folder : {"components", "types", "shaders", "scripts", "tests", "ros2"})
        for (const Source& source : sourcesIn(folder, {".hpp", ".cpp", ".glsl", ".py", ""}))
            if (source.path != "tests/layout/WordsTest.cpp" && source.path.find("/corpus/") == std::string::npos) {
                EXPECT_THAT(unwantedInCode(textOf(source), isPython(source)), IsEmpty()) << source.path;
            }
}

TEST(WordsTest, PagesUseTheWordsOfTheField) {
    for (const test::Page& page : test::allPages()) EXPECT_THAT(unwantedIn(page.prose()), IsEmpty()) << page.path();
}

TEST(WordsTest, TheRuleRefusesWhatItShould) {
    EXPECT_THAT(
        unwantedInCode("// It tells\nint heardPast = 0;  /* as many */ auto s = \"heard\"; f(max_most);", false),
        ElementsAre("tells", "heardPast", "as many", "max_most"));
    EXPECT_THAT(unwantedInCode("int gamma;  ///< Of the codes\n/** Of all. */ /** One of all. */", false),
                ElementsAre("Of", "Of"));
    EXPECT_THAT(unwantedInCode("# left\n\"\"\"Beside\"\"\"\ntold = 'told'\n", true), ElementsAre("beside", "told"));
    EXPECT_THAT(unwantedInCode("static_cast<int>(at_most + 20'000 + at_least); R\"x(told)x\"; // at most", false),
                IsEmpty());
}

}  // namespace insonify::layout
