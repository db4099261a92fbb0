#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

TEST(MultipathCommandTest, WritesTableJsonAndDiagramAndEveryClaimHolds) {
    const WallFolder folder;
    EXPECT_THAT(callInsonify(folder, {"study", "multipath", "--out", "report"}), succeeds());
    const json report = json::parse(readFile(folder / "report/multipath.json"));
    EXPECT_EQ(report["curves"].size(), 6u);
    EXPECT_EQ(report["verdicts"].size(), 8u);
    for (const json& verdict : report["verdicts"]) EXPECT_EQ(verdict["verdict"], "pass") << verdict;
    EXPECT_THAT(readFile(folder / "report/multipath.csv"), HasSubstr("\nsquare trihedral,-20,"));
}

TEST(MultipathCommandTest, ReportsAFolderThatCannotBeWritten) {
    const WallFolder folder;
    writeFile(folder / "taken", "a file");
    const Outcome outcome = callInsonify(folder, {"study", "multipath", "--out", "taken/report"});
    EXPECT_NE(outcome.code, 0);
    EXPECT_FALSE(outcome.err.empty());
}
