// Every stiff and extreme case of the stability study: none may fail.
#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <string>

#include "components/study/stability/StabilityStudy.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::study {

void PrintTo(const StabilityCase& c, std::ostream* out) { *out << c.name; }

namespace {

using ::testing::HasSubstr;

/** Returns the cases that subsection `heading` of the reference lists. */
std::set<int> listedIn(const std::string& heading) {
    std::set<int> listed;
    std::ifstream page(test::sourceFile("components/sonar/ACOUSTICS.md"));
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("##")) inside = line.starts_with("### " + heading + " ");
        if (inside && line.size() > 2 && line.starts_with("| ") && std::isdigit(static_cast<unsigned char>(line[2])))
            listed.insert(std::stoi(line.substr(2)));
    }
    return listed;
}

/** Converts "33 TVG gain of 1e20" to the name of a test. */
std::string testName(const testing::TestParamInfo<StabilityCase>& info) {
    std::string name = "Case" + std::to_string(info.param.number) + "_";
    bool begins = true;
    for (const char c : info.param.name) {
        const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (letter) name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = !letter;
    }
    return name;
}

class StabilityTest : public testing::TestWithParam<StabilityCase> {};

TEST_P(StabilityTest, DoesAsExpected) {
    const StabilityRow row = runCase(GetParam());
    if (row.outcome.verdict == Verdict::NotRun) GTEST_SKIP() << row.outcome.got;
    EXPECT_NE(row.outcome.verdict, Verdict::Fail)
        << row.number << ". " << row.name << "\n  expected: " << row.expected << "\n  got: " << row.outcome.got
        << "\n  deviation: " << row.outcome.deviation;
    EXPECT_FALSE(row.outcome.got.empty());
}

INSTANTIATE_TEST_SUITE_P(Cases, StabilityTest, testing::ValuesIn(stabilityCases()), testName);

TEST(StabilityStudyTest, TheReferenceListsTheExistingCases) {
    EXPECT_EQ(stabilityCases().size(), 69u) << "as README.md and components/study/README.md say";
    std::set<int> numbers;
    for (const StabilityCase& c : stabilityCases()) numbers.insert(c.number);
    EXPECT_EQ(listedIn("11.1"), numbers);
}

TEST(StabilityStudyTest, NoneOfThe60CasesIsMissing) {
    std::set<int> listed = listedIn("11.1");
    listed.merge(listedIn("11.2"));
    for (int number = 1; number <= 60; ++number) EXPECT_TRUE(listed.contains(number)) << number;
}

TEST(StabilityStudyTest, ACaseThatThrowsFailsAndTheSheetsReportIt) {
    const std::vector<StabilityCase> cases = {
        {7, "a \"quoted\" | case", "calm",
         [] {
             return Outcome{{{"kappa", 2.5}}, "calm", 1e-3, Verdict::Pass};
         }},
        {3, "storm", "calm", []() -> Outcome { throw std::runtime_error("mast lost"); }},
        {8, "ice", "sight", [] {
             return Outcome{{}, "not run: no ice", 0, Verdict::NotRun};
         }}};
    Folder folder;
    const std::vector<StabilityRow> rows = studyStability(cases, [](const StabilityRow&) {});
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].number, 3) << "in order";
    EXPECT_EQ(rows[0].outcome.verdict, Verdict::Fail);
    writeStability(rows, folder.path());
    const auto text = [&](const char* name) {
        const std::vector<char> bytes = toBytes(folder / name);
        return std::string(bytes.begin(), bytes.end());
    };
    EXPECT_EQ(text("stability.json"), R"([
 {"case": "3. storm", "conditions": {}, "expected": "calm", "got": "threw: mast lost", "deviation": null, "verdict": "fail"},
 {"case": "7. a \"quoted\" | case", "conditions": {"kappa": 2.5}, "expected": "calm", "got": "calm", "deviation": 0.001, "verdict": "pass"},
 {"case": "8. ice", "conditions": {}, "expected": "sight", "got": "not run: no ice", "deviation": 0, "verdict": "not run"}
]
)");
    EXPECT_THAT(text("stability.md"), HasSubstr("1 pass, 1 fail, 1 not run"));
    EXPECT_THAT(text("stability.md"), HasSubstr("| 8. ice |  | sight | not run: no ice |  | not run |"));
    EXPECT_THAT(text("stability.md"),
                HasSubstr("| 7. a \"quoted\" \\| case | kappa 2.5 | calm | calm | 0.001 | pass |"));
}

TEST(StabilityStudyTest, ASheetThatCannotBeWrittenIsAnError) {
    EXPECT_THROW(writeStability({}, "/proc/nowhere"), std::runtime_error);
}

}  // namespace
}  // namespace insonify::study
