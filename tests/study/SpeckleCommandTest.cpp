#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"
#include "tests/support/SpeckleRecording.hpp"

using namespace insonify::deployer;
using insonify::test::recordedSpeckle;
using testing::HasSubstr;
using testing::Not;

namespace {

json getVerdict(const json& report, const std::string& claim) {
    for (const json& verdict : report["verdicts"])
        if (verdict["claim"].get<std::string>().find(claim) != std::string::npos) return verdict;
    return {};
}

}  // namespace

TEST(SpeckleCommandTest, WritesTablesJsonDiagramAndVerdictsThatRecordingsCannotFail) {
    const WallFolder folder;
    writeFile(folder / "new.raw", recordedSpeckle());
    writeFile(folder / "frozen.raw", recordedSpeckle(true));
    for (const bool frozen : {false, true}) {
        const Outcome outcome =
            callInsonify(folder, {"study", "speckle", "--real", frozen ? "frozen.raw" : "new.raw", "--out", "report"});
        EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
        const json report = json::parse(readFile(folder / "report/speckle.json"));
        ASSERT_EQ(report["pings"].size(), 4u) << "two recorded, the sonar's, the law's";
        EXPECT_EQ(report["pings"][0]["name"], "recorded_5");
        EXPECT_EQ(report["pings"][0]["slices"].size(), 8u);
        EXPECT_NEAR(report["pings"][0]["slices"][0]["contrast"], 0.52, 0.05);
        const json verdict = getVerdict(report, "recorded_5, where it is loudest: frozen part");
        EXPECT_EQ(verdict["verdict"], frozen ? "pass" : "open");
        EXPECT_NEAR(verdict["measured"], frozen ? 1 : 0, 0.1);
        EXPECT_EQ(getVerdict(report, "law rayleigh: distance")["verdict"], "pass");
        EXPECT_THAT(outcome.out, Not(HasSubstr("FAIL")));
    }
    EXPECT_THAT(readFile(folder / "report/speckle.csv"), HasSubstr("\nlaw_rayleigh,"));
    EXPECT_THAT(readFile(folder / "report/lags.csv"), HasSubstr("\nrecorded_6,8,"));
}

TEST(SpeckleCommandTest, ReportsASceneThatIsTooSmall) {
    const WallFolder folder;
    EXPECT_THAT(callInsonify(folder, {"study", "speckle", "wall.yml", "--out", "report"}),
                prints(HasSubstr("too few bins")));
}
