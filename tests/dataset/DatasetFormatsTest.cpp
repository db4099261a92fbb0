// insonify dataset: boxes and masks in the formats of other programs, and the log of a sample.
#include <gmock/gmock.h>

#include <map>

#include "tests/dataset/DatasetFolder.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using testing::ElementsAre;
using testing::StartsWith;

namespace {

struct DatasetFormatsTest : insonify::dataset::DatasetFolder {};

}  // namespace

TEST_F(DatasetFormatsTest, PycocotoolsReadsItAndEveryBoxHoldsItsObjectsEnergy) {
    if (!insonify::pythonHas("pycocotools.coco"))
        GTEST_SKIP() << "python has no pycocotools; scripts/setup installs it";
    ASSERT_EQ(make("coco", {"--format", "coco"}).code, 0);
    ASSERT_EQ(make("npz", {"--format", "npz"}).code, 0);
    const std::string said = insonify::pythonSays((root / "tests/dataset/check_coco.py").string() + " " +
                                                      (folder_ / "coco").string() + " " + (folder_ / "npz").string(),
                                                  folder_ / "answer.txt");
    const size_t at = said.find("{\"pictures\"");
    ASSERT_NE(at, std::string::npos) << said;
    const json found = json::parse(said.substr(at));
    EXPECT_EQ(found["pictures"], 8);
    EXPECT_GT(found["boxes"], 40);
    EXPECT_GE(found["worst"], 0.99);
    RecordProperty("worst", found["worst"].dump());
}

TEST_F(DatasetFormatsTest, YoloWithoutASplitValidatesOnTheTrainingPictures) {
    writeFile(folder_ / "sweep.yml", replaced(sweep, "split: {train: 0.5, val: 0.5, test: 0}\n", ""));
    ASSERT_EQ(make("out", {"--format", "yolo"}).code, 0);
    EXPECT_THAT(getFiles(folder_ / "out").at("data.yaml"), StartsWith("train: train.txt\nval: train.txt  # "));
}

TEST_F(DatasetFormatsTest, YoloHasALabelForEachBoxAndListsByPart) {
    ASSERT_EQ(make("out", {"--format", "yolo"}).code, 0);
    const auto files = getFiles(folder_ / "out");
    EXPECT_EQ(files.at("data.yaml"),
              "train: train.txt\nval: val.txt\nnames:\n  0: \"pile\"\n  1: \"wreck\"\n  2: \"rock\"\n  3: "
              "\"pipeline\"\n");
    size_t listed = 0;
    for (const char* list : {"train.txt", "val.txt"}) {
        std::istringstream lines(files.at(list));
        for (std::string line; std::getline(lines, line); ++listed) EXPECT_TRUE(files.contains(line.substr(2))) << line;
    }
    EXPECT_EQ(listed, 8u);
    const json record = makeRecord("out", "000002");
    std::istringstream labels(files.at(std::string(record["files"].items().begin().key()).substr(0, 19) + ".txt"));
    for (const json& each : record["annotations"]) {
        double category = 0, x = 0, y = 0, width = 0, height = 0;
        labels >> category >> x >> y >> width >> height;
        EXPECT_EQ(category + 1, each["category"]);
        EXPECT_NEAR((x - width / 2) * record["picture"]["width"].get<double>(), each["bbox"][0], 1e-2);
        EXPECT_NEAR((y + height / 2) * 200, each["bbox"][1].get<double>() + each["bbox"][3].get<double>(), 1e-2);
    }
    std::string more;
    EXPECT_FALSE(labels >> more);
}

TEST_F(DatasetFormatsTest, MasksShowInstancesAndClassesPixelByPixel) {
    if (python(folder_, "import matplotlib.image").code != 0)
        GTEST_SKIP() << "/usr/bin/python3 has no matplotlib; scripts/setup installs it";
    ASSERT_EQ(make("out", {"--format", "mask", "--shard", "1/8"}).code, 0);
    const json record = makeRecord("out", "000001");
    const Outcome read = python(folder_, R"(
import glob, json
import matplotlib.image as image
import numpy as np
record = json.load(open(glob.glob("out/000001_*[0-9a-f].json")[0]))
levels = lambda end: np.rint(image.imread(glob.glob("out/000001_*" + end)[0]) * 255).astype(int)
instances, classes = levels("_instances.png"), levels("_classes.png")
for number, each in enumerate(record["annotations"], 1):
    assert (instances == number).sum() == each["area"], each
    assert set(classes[instances == number]) == {each["category"]}, each
assert ((classes == 0) == (instances == 0)).all() and instances.max() == len(record["annotations"])
print(instances.shape))");
    ASSERT_EQ(read.code, 0) << read.err;
    EXPECT_GT(record["annotations"].size(), 3u);
}

TEST_F(DatasetFormatsTest, ALogOfASampleHasItsPingTruthAndPose) {
    ASSERT_EQ(make("out", {"--format", "mcap", "--shard", "2/8"}).code, 0);
    const json record = makeRecord("out", "000002");
    const std::string log = "out/" + std::string(record["files"].items().begin().key());
    const json info = json::parse(callInsonify(folder_, {"log", "info", log, "--json"}).out);
    std::map<std::string, int> samples;
    for (const json& stream : info["streams"]) samples[stream["name"]] = stream["count"];
    EXPECT_THAT(samples, ElementsAre(testing::Pair("sonar.ping", 1), testing::Pair("sonar.truth", 1),
                                     testing::Pair("vehicle.pose", 1)));
}
