// Data about the project for other programs: the labels of deploy/Dockerfile, as BlueOS documents them, and
// CITATION.cff.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <regex>
#include <set>

#include "tests/deployer/Command.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const fs::path repository = test::source_dir;

/** Returns the labels as Docker reads them: continued lines are joined, quotes removed, and SOURCE is set by the
 *  builder. */
std::map<std::string, std::string> labels() {
    std::string recipe = std::regex_replace(readFile(repository / "deploy/Dockerfile"), std::regex("\\\\\n"), "");
    static const std::regex label(R"re(\nLABEL (\w+)=('([^'\n]*)'|"((\\"|[^"\n])*)"))re");
    std::map<std::string, std::string> found;
    for (std::sregex_iterator it(recipe.begin(), recipe.end(), label); it != std::sregex_iterator(); ++it) {
        const bool is_raw = (*it)[3].matched;
        std::string text = (*it)[is_raw ? 3 : 4];
        if (!is_raw) {
            text = std::regex_replace(text, std::regex(R"(\\")"), "\"");
            text = std::regex_replace(text, std::regex(R"(\$\{SOURCE\})"), "https://example.org/insonify");
        }
        found[(*it)[1]] = text;
    }
    return found;
}

std::string projectVersion() {
    const std::string text = readFile(repository / "CMakeLists.txt");
    std::smatch found;
    return std::regex_search(text, found, std::regex(R"(project\(Insonify VERSION ([\d.]+))")) ? found[1].str() : "";
}

}  // namespace

TEST(MetadataTest, TheLabelsAreWhatBlueOsReads) {
    auto all = labels();
    for (const char* name : {"version", "permissions", "authors", "company", "readme", "links", "type", "tags"})
        EXPECT_TRUE(all.contains(name)) << name;
    EXPECT_EQ(all["version"], projectVersion());
    EXPECT_EQ(all["readme"], "https://example.org/insonify/README.md");
    const json authors = json::parse(all["authors"]), company = json::parse(all["company"]),
               links = json::parse(all["links"]), tags = json::parse(all["tags"]);
    ASSERT_TRUE(authors.is_array() && !authors.empty());
    for (const char* key : {"name", "email"}) EXPECT_TRUE(authors[0][key].is_string()) << key;
    for (const char* key : {"about", "name", "email"}) EXPECT_TRUE(company[key].is_string()) << key;
    for (const auto& [key, link] : links.items()) EXPECT_THAT(link.get<std::string>(), HasSubstr("https://")) << key;
    ASSERT_TRUE(tags.is_array() && !tags.empty());
    for (const json& tag : tags) EXPECT_TRUE(std::regex_match(tag.get<std::string>(), std::regex("[a-z0-9-]+"))) << tag;
    // One of the types by which BlueOS's store sorts.
    EXPECT_THAT((std::set<std::string>{"device-integration", "example", "theme", "tool", "other"}),
                testing::Contains(all["type"]));
}

TEST(MetadataTest, TheExtensionStartsAValidDeployment) {
    const json permissions = json::parse(labels()["permissions"]);
    EXPECT_EQ(permissions["HostConfig"]["NetworkMode"], "host");
    auto words = permissions["Cmd"].get<std::vector<std::string>>();
    ASSERT_GT(words.size(), 4u);
    EXPECT_EQ(words[0], "run");
    const std::string installed = "/usr/share/insonify/";
    ASSERT_TRUE(words[1].starts_with(installed)) << words[1];
    words[1] = repository / words[1].substr(installed.size());
    const auto out = std::ranges::find(words, "--out");
    ASSERT_LT(out + 1, words.end());
    *(out + 1) = "out";
    // The networks of the testing machine do not matter here.
    for (std::string& word : words) word = std::regex_replace(word, std::regex("0\\.0\\.0\\.0"), "127.0.0.1");
    words.insert(words.end(), {"--set", "ping360.port=0", "--set", "ping1d.port=0", "--duration", "0.2"});
    EXPECT_THAT(callInsonify(TestFolder(), words), succeeds());
}

TEST(MetadataTest, TheCitationHasTheFieldsOfItsFormat) {
    const YAML::Node citation = YAML::LoadFile((repository / "CITATION.cff").string());
    const auto text = [&](const char* key) { return citation[key].as<std::string>(""); };
    EXPECT_EQ(text("cff-version"), "1.2.0");
    EXPECT_EQ(text("version"), projectVersion());
    EXPECT_EQ(text("license"), "Apache-2.0");
    EXPECT_EQ(text("type"), "software");
    EXPECT_EQ(text("title"), "Insonify");
    EXPECT_FALSE(text("message").empty());
    ASSERT_TRUE(citation["authors"].IsSequence() && citation["authors"].size() > 0);
    for (const YAML::Node& author : citation["authors"]) EXPECT_FALSE(author["name"].as<std::string>("").empty());
    static const std::set<std::string> keys = {"cff-version", "message", "type",    "title",   "abstract",
                                               "version",     "license", "authors", "keywords"};
    for (const auto& entry : citation) EXPECT_TRUE(keys.contains(entry.first.as<std::string>())) << entry.first;
}
