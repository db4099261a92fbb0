#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"

using namespace insonify::deployer;
using testing::AnyOf;
using testing::HasSubstr;

// StabilityTest checks that no case fails.
TEST(StabilityCommandTest, EvaluatesEverySelectedCaseOnBothSheets) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"study", "stability", "--only", "beam", "--out", "new/sheets"});
    EXPECT_THAT(outcome, prints(HasSubstr(" 0 fail, "))) << outcome.out << outcome.err;
    const json rows = json::parse(readFile(folder / "new/sheets/stability.json"));
    const std::string sheet = readFile(folder / "new/sheets/stability.md");
    EXPECT_EQ(rows.size(), 3u);
    for (const json& row : rows) {
        EXPECT_THAT(row.at("case"), HasSubstr("beam"));
        EXPECT_THAT(row.at("verdict"), AnyOf("pass", "not run")) << row;
        EXPECT_TRUE(row.at("conditions").is_object() && row.at("deviation").is_number()) << row;
        EXPECT_FALSE(row.at("expected").get<std::string>().empty() || row.at("got").get<std::string>().empty()) << row;
        EXPECT_THAT(sheet, HasSubstr("| " + row.at("case").get<std::string>() + " |"));
    }
}

TEST(StabilityCommandTest, AMissingOrImpossibleFolderIsWrongUsage) {
    const TestFolder folder;
    EXPECT_EQ(callInsonify(folder, {"study", "stability"}).code, 2);
    writeFile(folder / "file", "");
    EXPECT_THAT(callInsonify(folder, {"study", "stability", "--out", "file/sheets"}),
                isRefused(HasSubstr("cannot be made")));
}

TEST(StabilityCommandTest, ATextThatIsInNoNameIsWrongUsage) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"study", "stability", "--only", "kraken", "--out", "sheets"}),
                isRefused(HasSubstr("--only: no case has \"kraken\" in its name")));
    EXPECT_FALSE(std::filesystem::exists(folder / "sheets"));
}
