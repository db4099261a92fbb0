// insonify dataset: samples of a 3-D sonar, whose range images are labelled cell by cell.
#include <gmock/gmock.h>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

struct RangeImageTest : testing::Test {
    RangeImageTest() { writeFile(folder_ / "sweep.yml", sweep("range")); }
    static std::string sweep(const std::string& shape) {
        return "poses: {grid: {x: [31, 32], y: -6, z: -5.5, yaw_deg: -50}}\n"
               "settings: {sonar.horizontal: [{beam_count: 90, field_of_view_deg: 90}],\n"
               "  sonar.vertical: [{beam_count: 40, field_of_view_deg: 40}], sonar.beam_height_deg: [1]}\n"
               "classes: {wreck: hull, rock: rock_*, floor: sea_floor}\npicture: {shape: " +
               shape + "}\n";
    }
    Outcome make(const std::string& out, const std::string& format) const {
        return callInsonify(folder_, {"dataset", insonify::test::sourceFile("deploy/harbour_sonar3d.yml"), "--sweep",
                                      "sweep.yml", "--out", out, "--format", format});
    }

    const TestFolder folder_;
};

}  // namespace

TEST_F(RangeImageTest, EveryPixelIsABeamAndEveryMaskTheTruthOfItsReturns) {
    ASSERT_EQ(make("coco", "coco").code, 0);
    ASSERT_EQ(make("npz", "npz").code, 0);
    const Outcome read = python(folder_, R"(
import glob, json
import numpy as np
for record in sorted(glob.glob("coco/0*.json")):
    told = json.load(open(record))
    x = np.load(glob.glob("npz/" + record[5:11] + "*.npz")[0])
    assert told["picture"]["shape"] == "range" and (told["picture"]["width"], told["picture"]["height"]) == (90, 40)
    assert x["distances"].shape == x["range_object"].shape == (40, 90)
    assert (np.isfinite(x["distances"]) == (x["range_object"] >= 0)).all()
    seen = set()
    for each in told["annotations"]:
        runs, value, flat = each["segmentation"]["counts"], False, []
        for run in runs:
            flat += [value] * run
            value = not value
        mask = np.array(flat).reshape(90, 40).T
        expected = (x["range_object"] == each["object"]) & (x["range_share"] >= 0.5)
        assert (mask == expected).all(), each["name"]
        rows, columns = np.nonzero(mask)
        assert each["bbox"] == [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1]
        assert each["area"] == mask.sum() == each["bins"]
        assert np.allclose(each["range_m"], [x["distances"][mask].min(), x["distances"][mask].max()])
        assert np.isclose(each["bearing_rad"][1], x["horizontal_interval"][columns.min()])
        assert np.isclose(each["energy"], (x["remissions"] * x["range_share"])[mask].sum(), rtol=1e-4)
        seen.add(each["class"])
    print(sorted(seen), x["object"].shape, x["range_elevation"].shape)
)");
    ASSERT_THAT(read, prints(AllOf(HasSubstr("'wreck'"), HasSubstr("'floor'"), HasSubstr("(90, 500) (40, 90)"))));
}

TEST_F(RangeImageTest, NearIsBrightAndNothingIsBlack) {
    if (python(folder_, "import matplotlib.image").code != 0)
        GTEST_SKIP() << "/usr/bin/python3 has no matplotlib; scripts/setup installs it";
    ASSERT_EQ(make("coco", "coco").code, 0);
    ASSERT_EQ(make("npz", "npz").code, 0);
    const Outcome read = python(folder_, R"(
import glob
import matplotlib.image as image
import numpy as np
x = np.load(sorted(glob.glob("npz/*.npz"))[0])
levels = np.rint(image.imread(sorted(glob.glob("coco/*.png"))[0]) * 255).astype(int)
expected = np.where(np.isfinite(x["distances"]), np.rint(255 - 254 * np.minimum(x["distances"] / 15, 1)), 0)
print(abs(levels - expected).max(), (levels == 0).sum() > 0, levels.max() > 128)
)");
    ASSERT_THAT(read, prints(HasSubstr("0.0 True True")));
}

/** The ping of a 3-D sonar is a fan like any other, with its truth. */
TEST_F(RangeImageTest, ItsPingIsAPictureAsWell) {
    writeFile(folder_ / "sweep.yml", sweep("fan"));
    ASSERT_THAT(make("fans", "yolo"), succeeds());
    const Outcome read = python(folder_, R"(
import glob, json
told = json.load(open(sorted(glob.glob("fans/0*.json"))[0]))
print(told["picture"]["shape"], sorted({each["class"] for each in told["annotations"]}))
)");
    ASSERT_THAT(read, prints(HasSubstr("fan ['floor', 'rock', 'wreck']")));
}

TEST_F(RangeImageTest, ALogHasTheImageAndItsTruth) {
    ASSERT_EQ(make("logs", "mcap").code, 0);
    for (const auto& entry : fs::directory_iterator(folder_ / "logs")) {
        if (entry.path().extension() != ".mcap") continue;
        const Outcome info = callInsonify(folder_, {"log", "info", entry.path()});
        EXPECT_THAT(info.out, testing::AllOf(HasSubstr("sonar.range_image"), HasSubstr("sonar.range_truth")));
    }
}
