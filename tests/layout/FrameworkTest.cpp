// components/framework is about tasks, ports and time, but nothing about sonars.
#include <gmock/gmock.h>

#include <regex>

#include "tests/layout/Sources.hpp"

using namespace insonify::layout;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

namespace {

/** Lines, code and comments alike, that contain a word of the field, by itself or in a name. */
std::vector<std::string> linesOfTheField(const Source& source) {
    static const std::regex word(R"(\b(ping|sonar|replay|bin|beam)s?(\b|_))", std::regex::icase);
    static const std::regex in_name(R"((Ping|Sonar|Replay|Beam)(s?[A-Z_]|s?\b))");
    std::vector<std::string> found;
    for (const std::string& line : source.lines)
        if (std::regex_search(line, word) || std::regex_search(line, in_name)) found.push_back(line);
    return found;
}

std::vector<std::string> friends(const Source& source) {
    std::vector<std::string> found;
    for (const std::string& line : source.lines)
        if (line.find("friend class") != std::string::npos) found.push_back(line);
    return found;
}

std::vector<Source> framework() { return sourcesIn("components/framework", {".hpp", ".cpp", ".txt"}); }

}  // namespace

TEST(FrameworkTest, ItSaysNoWordOfPingsSonarsOrReplay) {
    const std::vector<Source> sources = framework();
    EXPECT_GT(sources.size(), 40u);
    for (const Source& source : sources) EXPECT_THAT(linesOfTheField(source), IsEmpty()) << source.path;
}

TEST(FrameworkTest, NoClassReachesThroughToAnother) {
    for (const Source& source : framework()) EXPECT_THAT(friends(source), IsEmpty()) << source.path;
}

TEST(FrameworkTest, TheRulesRefuseWhatTheyShould) {
    const Source bad{"a.hpp",
                     {"// a ping", "uint64_t pings() const;", "types::SonarPtr last_;", "\"/base/samples/Sonar\"",
                      "// of a Beam", "int bin_count;", "class ReplayTask;"}};
    EXPECT_EQ(linesOfTheField(bad), bad.lines);
    const Source good{"b.hpp", {"// keeping, combined, replayed, beaming, a binary", "mapping.cabin();"}};
    EXPECT_THAT(linesOfTheField(good), IsEmpty());
    EXPECT_THAT(friends({"c.hpp", {"    friend class Wiring;", "    friend bool operator==(A, A);"}}),
                ElementsAre("    friend class Wiring;"));
}
