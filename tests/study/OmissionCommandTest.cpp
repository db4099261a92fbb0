#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

json getRow(const json& rows, const std::string& name) {
    for (const json& row : rows)
        if (row["name"] == name) return row;
    return {};
}

}  // namespace

TEST(OmissionCommandTest, OmissionsChangeNoBinByMoreThanTheirBound) {
    const WallFolder folder;
    const Outcome outcome = callInsonify(folder, {"study", "omission", "wall.yml", "--pings", "3", "--out", "report"});
    ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
    const json rows = json::parse(readFile(folder / "report/omission.json"));
    for (const char* neutral :
         {"absorption", "normal maps", "range point-spread", "transmit ring-down", "point targets", "multipath"}) {
        const json row = getRow(rows, neutral);
        ASSERT_EQ(row["verdict"], "pass") << neutral;
        EXPECT_LE(row["change"], row["bound"]) << neutral;
        EXPECT_GT(row["without_ms"], 0) << neutral;
        EXPECT_GT(row["with_ms"], 0) << neutral;
    }
    EXPECT_EQ(getRow(rows, "seabeds by TR 9407")["verdict"], "not measured");
    EXPECT_GT(getRow(rows, "twice the rows and columns")["change"], 0);
    EXPECT_EQ(readFile(folder / "report/omission.md"), outcome.out);
    EXPECT_THAT(outcome.out, HasSubstr("| normal maps | no material has one |"));
}

TEST(OmissionCommandTest, ShowsConfiguredEffectsWithTheirCost) {
    const WallFolder folder;
    writeFile(folder / "loud.yml",
              replaced(wall_deployment, "      range: 20\n", "      range: 20\n      absorption: {db_per_m: 0.2}\n"));
    ASSERT_THAT(callInsonify(folder, {"study", "omission", "loud.yml", "--pings", "3", "--out", "report"}), succeeds());
    const json rows = json::parse(readFile(folder / "report/omission.json"));
    EXPECT_EQ(getRow(rows, "absorption")["verdict"], "kept");
    std::map<std::string, int> count;
    for (const json& row : rows) EXPECT_EQ(++count[row["name"]], 1) << row["name"];
    EXPECT_GT(getRow(rows, "absorption")["change"], 0.01);
    const json inside = getRow(rows, "absorption inside a bin");
    EXPECT_EQ(inside["verdict"], "pass");
    EXPECT_GT(inside["change"], 0);
    EXPECT_LE(inside["rel_l2_tvg"], inside["bound"]);
}

TEST(OmissionCommandTest, ShowsPointTargetsAndARingDownWithTheirCost) {
    const WallFolder folder;
    const std::string ringing =
        replaced(wall_deployment, "      range: 20\n",
                 "      range: 20\n      pulse: {bandwidth_khz: 2, ring_down: {level_db: -20, decay_db_per_m: 30}}\n");
    writeFile(folder / "loud.yml",
              replaced(ringing, "{file: wall.gltf}",
                       "{file: wall.gltf, targets: [{name: buoy, position: [5, 0, 0], strength_db: 0}, "
                       "{name: hidden, position: [12, 0, 0], strength_db: 0}]}"));
    ASSERT_THAT(callInsonify(folder, {"study", "omission", "loud.yml", "--pings", "3", "--out", "report"}), succeeds());
    const json rows = json::parse(readFile(folder / "report/omission.json"));
    for (const char* kept : {"transmit ring-down", "point targets"}) {
        EXPECT_EQ(getRow(rows, kept)["verdict"], "kept") << kept;
        EXPECT_GT(getRow(rows, kept)["change"], 1e-4) << kept;
    }
    EXPECT_EQ(getRow(rows, "1 of 2 point targets")["verdict"], "not measured");
}

TEST(OmissionCommandTest, RefusesUnsuitableDeployments) {
    const WallFolder folder;
    EXPECT_EQ(callInsonify(folder, {"study", "omission"}).code, 2);
    EXPECT_THAT(callInsonify(folder, {"study", "omission", "none.yml", "--out", "report"}),
                isRefused(HasSubstr("none.yml")));
    EXPECT_FALSE(fs::exists(folder / "report"));
}

TEST(OmissionCommandTest, NoOmissionOfADeviceFails) {
    for (const std::string device : {"ping360", "micron", "sonar_3d_15"}) {
        SCOPED_TRACE(device);
        const TestFolder folder;
        ASSERT_THAT(callInsonify(folder, {"init", "dive", "--sonar", device}), succeeds());
        ASSERT_THAT(callInsonify(folder, {"study", "omission", "dive", "--pings", "1", "--out", "report"}), succeeds());
        const json rows = json::parse(readFile(folder / "report/omission.json"));
        for (const json& row : rows) EXPECT_NE(row["verdict"], "FAIL") << row;
        EXPECT_EQ(getRow(rows, "absorption inside a bin")["verdict"], "pass");
    }
}
