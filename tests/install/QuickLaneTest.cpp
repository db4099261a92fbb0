// The tests that `scripts/test --quick` runs: those with the label `quick` (tests/CMakeLists.txt).
#include <fnmatch.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/install/Outside.hpp"

using namespace insonify::deployer;
using nlohmann::json;

namespace {

/** The names of the quick and of the slow tests of each program, and the programs that are not built. */
struct Lane {
    std::map<std::string, std::set<std::string>> quick, slow;
    std::set<std::string> absent;
};

/** Asks ctest for the tests of the build folder. Programs that are not built, and Mesa's zink, are not in the result.
 */
Lane readLane() {
    const TestFolder folder;
    const Outcome shown =
        call(folder, {INSONIFY_CTEST, "--test-dir", insonify::test::build_dir, "--show-only=json-v1"});
    EXPECT_THAT(shown, succeeds());
    Lane lane;
    const json answer = json::parse(shown.out.substr(shown.out.find('{')));
    for (const json& test : answer.at("tests")) {
        const std::string name = test.at("name");
        const std::string not_built = "_NOT_BUILT";
        if (name.ends_with(not_built)) lane.absent.insert(name.substr(0, name.size() - not_built.size()));
        if (!test.contains("command") || name.starts_with("zink.")) continue;
        bool quick = false;
        for (const json& property : test.at("properties"))
            quick |= property.at("name") == "LABELS" && property.at("value") == json{"quick"};
        const std::string program = fs::path(std::string(test.at("command").at(0))).filename();
        (quick ? lane.quick : lane.slow)[program].insert(name);
    }
    return lane;
}

/** The texts that the expression's first group matches. */
std::vector<std::string> matches(const std::string& text, const std::regex& expression) {
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it)
        found.push_back((*it)[1].str());
    return found;
}

/** The tests that a source defines, as Suite.Name. */
std::set<std::string> testsIn(const std::string& source) {
    const std::regex test(R"(TEST(?:_F|_P)?\((\w+),\s*(\w+))");
    std::set<std::string> found;
    for (std::sregex_iterator it(source.begin(), source.end(), test), end; it != end; ++it)
        found.insert((*it)[1].str() + "." + (*it)[2].str());
    return found;
}

bool matchesAny(const std::string& pattern, const std::set<std::string>& names) {
    for (const std::string& name : names)
        if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) return true;
    return false;
}

}  // namespace

TEST(QuickLaneTest, EveryProgramOfTestsHasQuickOnes) {
    const Lane lane = readLane();
    ASSERT_TRUE(lane.quick.contains("configure_test")) << "this test is not quick";
    for (const auto& [program, names] : lane.slow)
        EXPECT_TRUE(lane.quick.contains(program)) << program << " has only slow tests, such as " << *names.begin();
}

TEST(QuickLaneTest, EveryFilterOfSlowTestsSelectsSome) {
    const Lane lane = readLane();
    std::set<std::string> slow;
    for (const auto& [program, names] : lane.slow) slow.insert(names.begin(), names.end());
    int tried = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(insonify::test::source_dir) / "tests")) {
        if (entry.path().filename() != "CMakeLists.txt") continue;
        const std::string text = readFile(entry.path());
        bool built = true;
        for (const std::string& name : matches(text, std::regex(R"(insonify_test\((\w+))")))
            built &= !lane.absent.contains(name + "_test");
        if (!built) continue;
        // Tests of packages that this machine lacks are in the sources alone.
        std::set<std::string> names = slow;
        for (const auto& source : fs::directory_iterator(entry.path().parent_path()))
            if (source.path().extension() == ".cpp") names.merge(testsIn(readFile(source.path())));
        for (const std::string& list : matches(text, std::regex(R"(\n  SLOW((?:\s+"[^"]*")+))")))
            for (const std::string& pattern : matches(list, std::regex(R"rx("([^"]*)")rx"))) {
                EXPECT_TRUE(matchesAny(pattern, names))
                    << entry.path() << ": SLOW \"" << pattern << "\" selects no test";
                ++tried;
            }
    }
    if (tried == 0) GTEST_SKIP() << "no program with slow tests is built";
}
