// insonify dataset: data sets of a small sonar in the harbour.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "components/pose/SeaMotion.hpp"
#include "tests/dataset/HarbourDeployment.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using insonify::dataset::deployment;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

namespace {

const fs::path root = insonify::test::source_dir;

const std::string sweep = R"(seed: 3
poses:
  random: {count: 4, x: {uniform: [0, 20]}, y: {uniform: [-8, 0]}, z: -5.5, yaw_deg: {uniform: [-60, 30]}}
settings:
  sonar.range: [20, 30]
objects:
  - {names: [rock_00*], count: [2, 8], x: [4, 20], y: [-8, 4], frame: vehicle, ground: sea_floor, avoid: [quay_wall, hull, pile_*]}
classes: {pile: pile_*, wreck: hull, rock: rock_*, pipeline: [pipeline, saddle_*]}
split: {train: 0.5, val: 0.5, test: 0}
picture: {height: 200}
annotations: {min_pixels: 30}
)";

const std::string drawn_settings = R"(settings:
  scene.materials.sand.lambert_db: {uniform: [-30, -15]}
  scene.water_surface: {normal: [0, 0.2]}
  noise.speckle: {choice: [{law: rayleigh}, {law: k, shape: 5}]}
)";

/** Bytes of all files of a folder, by name. */
std::map<std::string, std::string> getFiles(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) files[entry.path().filename()] = readFile(entry.path());
    return files;
}

std::vector<std::string> getNames(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : getFiles(folder)) names.push_back(name);
    return names;
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
    return text.replace(text.find(old), old.size(), by);
}

struct DatasetCommandTest : testing::Test {
    DatasetCommandTest() {
        writeFile(folder_ / "d.yml", deployment);
        writeFile(folder_ / "sweep.yml", sweep);
    }
    std::vector<std::string> words(const std::string& out, std::vector<std::string> more = {}) const {
        std::vector<std::string> all = {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", out};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome make(const std::string& out, std::vector<std::string> more = {}) const {
        return callInsonify(folder_, words(out, std::move(more)));
    }
    json makeRecord(const std::string& out, const std::string& index) const {
        for (const auto& [name, bytes] : getFiles(folder_ / out))
            if (name.starts_with(index) && name.ends_with(".json")) return json::parse(bytes);
        return {};
    }

    const TestFolder folder_;
};

}  // namespace

TEST_F(DatasetCommandTest, EachSampleHasItsFilesAndTheManifestNamesAll) {
    ASSERT_THAT(make("out"), prints(AllOf(HasSubstr("8 of 8 samples in "), HasSubstr(", 8 of them new"))));
    const auto files = getFiles(folder_ / "out");
    const json manifest = json::parse(files.at("manifest.json"));
    EXPECT_EQ(manifest["samples"], 8);
    EXPECT_EQ(manifest["classes"], json::array({"pile", "wreck", "rock", "pipeline"}));
    EXPECT_EQ(manifest["files"].size() + 1, files.size());
    for (const auto& [name, sum] : manifest["files"].items()) EXPECT_TRUE(files.contains(name)) << name;
    const json near = makeRecord("out", "000001"), far = makeRecord("out", "000005");
    EXPECT_EQ(near["settings"]["sonar.range"], 20);
    EXPECT_EQ(far["settings"]["sonar.range"], 30);
    EXPECT_EQ(near["pose"], far["pose"]);
    EXPECT_EQ(near["objects"], far["objects"]);
    EXPECT_NEAR(far["ping"]["range_m"], 30, 0.3);
    EXPECT_EQ(far["picture"]["height"], 200);
}

TEST_F(DatasetCommandTest, TheBytesDoNotDependOnTheProcess) {
    const std::string few = replaced(sweep, "count: 4", "count: 2");
    const std::string tilted = replaced(few, "ground: sea_floor,", "ground: sea_floor, roll_deg: [0, 90],");
    writeFile(folder_ / "sweep.yml", replaced(tilted, "settings:\n", drawn_settings));
    for (const char* format : {"coco", "mcap", "npz"}) {
        const std::string one = std::string("one_") + format, three = std::string("three_") + format;
        ASSERT_EQ(make(one, {"--format", format}).code, 0);
        for (const char* shard : {"2/3", "0/3", "1/3"}) {
            EXPECT_FALSE(fs::exists(folder_ / three / "manifest.json"));
            ASSERT_EQ(make(three, {"--format", format, "--shard", shard}).code, 0);
        }
        EXPECT_EQ(getNames(folder_ / one), getNames(folder_ / three)) << format;
        EXPECT_EQ(getFiles(folder_ / one), getFiles(folder_ / three)) << format;
    }
}

TEST_F(DatasetCommandTest, ACountDrawsSamplesOfTheSweepWhateverTheNumberOfWorkers) {
    ASSERT_EQ(make("whole").code, 0);
    ASSERT_THAT(make("five", {"--count", "5"}), prints(HasSubstr("5 of 5 samples in ")));
    for (const char* shard : {"1/2", "0/2"}) ASSERT_EQ(make("shards", {"--count", "5", "--shard", shard}).code, 0);
    EXPECT_EQ(getFiles(folder_ / "five"), getFiles(folder_ / "shards"));
    ASSERT_EQ(make("three", {"--count", "3"}).code, 0);
    ASSERT_EQ(make("other", {"--count", "3", "--seed", "4"}).code, 0);
    const auto drawn = [&](const char* out) {
        std::set<std::string> all;
        for (const auto& [name, bytes] : getFiles(folder_ / out))
            if (name.starts_with("00") && name.ends_with(".png")) all.insert(name.substr(0, 6) + bytes);
        return all;
    };
    EXPECT_EQ(drawn("five").size(), 5u);
    EXPECT_EQ(drawn("three").size(), 3u);
    EXPECT_THAT(drawn("whole"), testing::IsSupersetOf(drawn("five")));
    EXPECT_THAT(drawn("five"), testing::IsSupersetOf(drawn("three")));
    EXPECT_NE(drawn("other"), drawn("three"));
    EXPECT_THAT(make("five", {"--count", "3"}), isRefused(HasSubstr("a sample of another sweep")));
    EXPECT_THAT(make("out", {"--count", "9"}),
                isRefused(HasSubstr("--count: is 9; may be 1 to 8, the number of samples of the sweep")));
    EXPECT_THAT(make("out", {"--count", "0"}), isRefused(HasSubstr("--count: is 0; may be 1 to 8")));
    EXPECT_EQ(make("out", {"--count", "2.5"}).code, 2);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(DatasetCommandTest, PartsAreJoinedToTheBytesOfTheWholeSetAndSeedsToOneSet) {
    ASSERT_EQ(make("whole").code, 0);
    for (const char* shard : {"0/3", "1/3", "2/3"})
        ASSERT_EQ(make(std::string("part") + shard[0], {"--shard", shard}).code, 0);
    const auto join = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"dataset", "join"});
        return callInsonify(folder_, words);
    };
    ASSERT_THAT(join({"part2", "part0", "part1", "--out", "joined"}),
                prints(HasSubstr("8 samples of 3 parts in joined: manifest.json, statistics.html")));
    EXPECT_EQ(getFiles(folder_ / "joined"), getFiles(folder_ / "whole"));
    ASSERT_EQ(make("nine", {"--seed", "9", "--count", "2"}).code, 0);
    ASSERT_THAT(join({"whole", "nine", "--out", "both"}), prints(HasSubstr("10 samples of 2 parts")));
    std::multiset<int> images, annotations;
    for (const char* part : {"train", "val"}) {
        const json coco = json::parse(readFile(folder_ / fmt::format("both/instances_{}.json", part)));
        for (const json& image : coco["images"]) images.insert(image["id"].get<int>());
        for (const json& each : coco["annotations"]) annotations.insert(each["id"].get<int>());
    }
    EXPECT_EQ(images.size(), 10u);
    EXPECT_EQ(std::set<int>(images.begin(), images.end()).size(), 10u);
    EXPECT_GT(annotations.size(), 10u);
    EXPECT_EQ(std::set<int>(annotations.begin(), annotations.end()).size(), annotations.size());
}

TEST_F(DatasetCommandTest, PartsThatDoNotFitAreRefusedBeforeAnythingIsWritten) {
    const auto join = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"dataset", "join"});
        return callInsonify(folder_, words);
    };
    ASSERT_EQ(make("a", {"--shard", "0/2"}).code, 0);
    ASSERT_EQ(make("b", {"--shard", "1/2", "--set", "sonar.bin_count=100"}).code, 0);
    EXPECT_THAT(join({"a", "b", "--out", "out"}),
                isRefused(HasSubstr("b/dataset.json: origin: another deployment (d.yml), sweep (sweep.yml), scene or "
                                    "--set than a")));
    EXPECT_THAT(join({"a", "--out", "out"}),
                isRefused(HasSubstr("4 of 8 samples of seed 3 are in none of the parts, the first is 1")));
    EXPECT_THAT(join({"a", "a", "--out", "out"}), isRefused(HasSubstr("sample 0 of seed 3 is in a as well")));
    EXPECT_THAT(join({"a", "nowhere", "--out", "out"}), isRefused(HasSubstr("nowhere: has no dataset.json")));
    EXPECT_THAT(join({"a"}).err, HasSubstr("--out is required"));
    EXPECT_THAT(join({"--out", "out"}).err, HasSubstr("PART is required"));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    ASSERT_EQ(make("c", {"--shard", "1/2"}).code, 0);
    const auto before = getFiles(folder_ / "a");
    EXPECT_THAT(join({"a", "c", "--out", "a"}), isRefused(HasSubstr("--out: is a, one of the parts")));
    fs::create_directory(folder_ / "own");
    writeFile(folder_ / "own/manifest.json", "mine");
    EXPECT_THAT(join({"a", "c", "--out", "own"}), isRefused(HasSubstr("holds manifest.json, which a data set would")));
    EXPECT_EQ(getFiles(folder_ / "a"), before);
}

TEST_F(DatasetCommandTest, DrawnSettingsAreInTheRecordAndChangeThePicture) {
    writeFile(folder_ / "sweep.yml", "poses: {random: {count: 3, x: 5, y: -4, z: -5.5}}\n" +
                                         replaced(drawn_settings, ", {law: k, shape: 5}]", "]"));
    ASSERT_THAT(make("out"), succeeds());
    std::set<double> strengths;
    for (const char* index : {"000000", "000001", "000002"}) {
        const json settings = makeRecord("out", index)["settings"];
        strengths.insert(settings["scene.materials.sand.lambert_db"].get<double>());
        EXPECT_TRUE(settings["scene.water_surface"].is_number());
        EXPECT_EQ(settings["noise.speckle"]["law"], "rayleigh");
    }
    EXPECT_EQ(strengths.size(), 3u);
    EXPECT_TRUE(*strengths.begin() >= -30 && *strengths.rbegin() <= -15);
}

TEST_F(DatasetCommandTest, SettingsOfTheSweepAndTheSeedOfTheCommandTakePrecedence) {
    writeFile(folder_ / "sweep.yml",
              "poses: {random: {count: 1, x: {uniform: [0, 20]}, y: -4, z: -5.5}}\nsettings: {sonar.range: [20]}\n");
    const std::vector<std::string> set = {"--set", "sonar.range=30", "--set", "sonar.bin_count=100"};
    ASSERT_EQ(make("plain").code, 0);
    ASSERT_EQ(make("set", set).code, 0);
    ASSERT_EQ(make("seed", {"--seed", "9"}).code, 0);
    const json plain = makeRecord("plain", "000000"), changed = makeRecord("set", "000000");
    EXPECT_EQ(plain["ping"]["bins"], 200);
    EXPECT_EQ(changed["ping"]["bins"], 100);
    EXPECT_NEAR(changed["ping"]["range_m"], 20, 0.3);
    EXPECT_EQ(changed["pose"], plain["pose"]);
    EXPECT_NE(makeRecord("seed", "000000")["pose"], plain["pose"]);
    EXPECT_THAT(make("plain", set).err, HasSubstr("a sample of another sweep"));
    EXPECT_THAT(make("plain", {"--seed", "9"}).err, HasSubstr("a sample of another sweep"));
}

/** Paths of the values of a record. Lists of numbers, settings and files are not expanded. */
void addKeys(const json& value, const std::string& path, std::set<std::string>& keys) {
    if (value.is_array() && !value.empty() && value[0].is_object()) {
        for (const json& each : value) addKeys(each, path + "[]", keys);
    } else if (value.is_object() && path != "settings" && path != "files") {
        for (const auto& [key, inner] : value.items()) addKeys(inner, path.empty() ? key : path + "." + key, keys);
    } else {
        keys.insert(path);
    }
}

TEST_F(DatasetCommandTest, ARecordHasTheKeysOfThePage) {
    ASSERT_EQ(make("out", {"--shard", "1/8"}).code, 0);
    std::set<std::string> written, documented;
    addKeys(makeRecord("out", "000001"), "", written);
    const std::string page = readFile(root / "components/dataset/README.md");
    const size_t begin = page.find("\n## The record\n");
    ASSERT_NE(begin, std::string::npos);
    std::istringstream lines(page.substr(begin + 1, page.find("\n## ", begin + 1) - begin));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("| `")) {
            std::istringstream cell(line.substr(1, line.find('|', 1) - 1));
            for (std::string part; std::getline(cell, part, '`') && std::getline(cell, part, '`');)
                documented.insert(part);
        }
    EXPECT_EQ(documented, written);
}

TEST_F(DatasetCommandTest, KeepsSamplesAndRemakesMissingOrDamagedSamples) {
    ASSERT_EQ(make("out").code, 0);
    const auto whole = getFiles(folder_ / "out");
    const std::vector<std::string> names = getNames(folder_ / "out");
    const auto kept = fs::last_write_time(folder_ / "out" / names[6]);
    fs::remove(folder_ / "out" / names[0]);
    fs::resize_file(folder_ / "out" / names[3], 100);
    fs::remove(folder_ / "out/manifest.json");
    const Outcome again = make("out");
    EXPECT_THAT(again.out, AllOf(HasSubstr("8 of 8 samples in "), HasSubstr(", 2 of them new")));
    EXPECT_EQ(getFiles(folder_ / "out"), whole);
    EXPECT_EQ(fs::last_write_time(folder_ / "out" / names[6]), kept);
    EXPECT_THAT(make("out").out, AllOf(HasSubstr("8 of 8 samples in "), HasSubstr(", 0 of them new")));
}

TEST_F(DatasetCommandTest, AKilledRunIsContinued) {
    ASSERT_EQ(make("whole").code, 0);
    const TestFolder elsewhere;  // for the output of the killed run
    for (const char* name : {"d.yml", "sweep.yml"}) fs::copy(folder_ / name, elsewhere / name);
    const Process killed(insonifyWords(words((folder_ / "out").string())), elsewhere.path());
    const auto aFewAreThere = [&] { return fs::exists(folder_ / "out") && getNames(folder_ / "out").size() > 4; };
    EXPECT_TRUE(insonify::test::becomesTrue(aFewAreThere));
    killed.signal(SIGKILL);
    killed.wait();
    writeFile(folder_ / "out/.part_00_1_left.png", "of a writer that is no more");
    ASSERT_EQ(make("out").code, 0);
    EXPECT_EQ(getFiles(folder_ / "out"), getFiles(folder_ / "whole"));
}

TEST_F(DatasetCommandTest, TwoProcessesInOneFolderDoNotHarmEachOther) {
    ASSERT_EQ(make("whole").code, 0);
    const TestFolder elsewhere;
    for (const char* name : {"d.yml", "sweep.yml"}) fs::copy(folder_ / name, elsewhere / name);
    const Process other(insonifyWords(words((folder_ / "out").string())), elsewhere.path());
    const Outcome own = make("out");
    const Outcome others = other.wait();
    EXPECT_EQ(own.code, 0) << own.err;
    EXPECT_EQ(others.code, 0) << others.err;
    EXPECT_EQ(getFiles(folder_ / "out"), getFiles(folder_ / "whole"));
}

TEST_F(DatasetCommandTest, AnotherSweepNeedsAnotherFolder) {
    ASSERT_EQ(make("out", {"--shard", "0/8"}).code, 0);
    writeFile(folder_ / "sweep.yml", sweep + "# changed\n");
    EXPECT_THAT(make("out"), isRefused(HasSubstr("a sample of another sweep, deployment, scene, format or version")));
    fs::create_directory(folder_ / "own");
    writeFile(folder_ / "own/manifest.json", "mine");
    EXPECT_THAT(make("own"), isRefused(HasSubstr("--out: holds manifest.json, which a data set would replace")));
    EXPECT_EQ(readFile(folder_ / "own/manifest.json"), "mine");
}

TEST_F(DatasetCommandTest, PycocotoolsReadsItAndEveryBoxHoldsItsObjectsEnergy) {
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

TEST_F(DatasetCommandTest, YoloWithoutASplitValidatesOnTheTrainingPictures) {
    writeFile(folder_ / "sweep.yml", replaced(sweep, "split: {train: 0.5, val: 0.5, test: 0}\n", ""));
    ASSERT_EQ(make("out", {"--format", "yolo"}).code, 0);
    EXPECT_THAT(getFiles(folder_ / "out").at("data.yaml"), StartsWith("train: train.txt\nval: train.txt  # "));
}

TEST_F(DatasetCommandTest, YoloHasALabelForEachBoxAndListsByPart) {
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

TEST_F(DatasetCommandTest, MasksShowInstancesAndClassesPixelByPixel) {
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

TEST_F(DatasetCommandTest, PosesOfATrajectoryGiveTracks) {
    writeFile(folder_ / "sweep.yml",
              "poses:\n  trajectory: {file: " + (root / "deploy/scenes/harbour_pass.csv").string() +
                  ", count: 4, to: 6}\nclasses: {pile: pile_*}\npicture: {shape: polar}\n");
    ASSERT_EQ(make("out").code, 0);
    std::istringstream lines(readFile(folder_ / "out/tracks_000_000.txt"));
    std::map<std::string, std::set<std::string>> frames;  // by object
    std::string frame, object, rest;
    while (std::getline(lines, frame, ',') && std::getline(lines, object, ',') && std::getline(lines, rest)) {
        frames[object].insert(frame);
        EXPECT_THAT(rest, testing::MatchesRegex("[0-9]+,[0-9]+,[0-9]+,[0-9]+,1,1,1"));
    }
    EXPECT_GT(frames.size(), 1u);
    EXPECT_TRUE(std::ranges::any_of(frames, [](const auto& of) { return of.second.size() > 1; }));
    EXPECT_EQ(makeRecord("out", "000003")["time_s"], 6);
    EXPECT_EQ(makeRecord("out", "000003")["picture"]["width"], 128);
}

TEST_F(DatasetCommandTest, PosesOfATrajectoryMoveOnWavesAsTheTaskMovesThem) {
    writeFile(folder_ / "path.csv", "time,x,y,z,qw,qx,qy,qz\n0,4,-4,-5.5,1,0,0,0\n4,8,-4,-5.5,1,0,0,0\n");
    writeFile(folder_ / "sweep.yml",
              "poses:\n  trajectory: {file: path.csv, count: 3, motion: {heave_m: 0.3, roll_deg: 5, seed: 3}}\n");
    ASSERT_EQ(make("out").code, 0);
    const insonify::pose::SeaMotion motion({.heave_m = 0.3, .roll_deg = 5, .seed = 3});
    for (int i = 0; i < 3; ++i) {
        insonify::types::Pose pose;
        pose.position = {4 + 2 * i, -4, -5.5};
        motion.move(2 * i, pose);
        const json position = makeRecord("out", "00000" + std::to_string(i))["pose"]["position"];
        EXPECT_NEAR(position[2].get<double>(), pose.position.z, 1e-6) << i;
    }
    writeFile(folder_ / "sweep.yml", "poses:\n  trajectory: {file: path.csv, count: 3, motion: {seed: 3}}\n");
    EXPECT_THAT(make("out"), isRefused(HasSubstr("moves nothing; give heave_m, roll_deg or pitch_deg")));
}

TEST_F(DatasetCommandTest, PosesOfATrajectoryAreFromItsFirstStampToItsLast) {
    writeFile(folder_ / "path.csv", "time,x,y,z,qw,qx,qy,qz\n100,4,-4,-5.5,1,0,0,0\n102,8,-4,-5.5,1,0,0,0\n");
    const auto make = [&](const std::string& times) {
        writeFile(folder_ / "sweep.yml", "poses:\n  trajectory: {file: path.csv, count: 3" + times + "}\n");
        return DatasetCommandTest::make("out");
    };
    const std::string place = "sweep.yml:2:15: poses.trajectory.";
    EXPECT_THAT(make(", from: 2"), isRefused(HasSubstr(place + "from: is 2 s; the trajectory is from 100 to 102 s")));
    EXPECT_THAT(make(", to: 103"), isRefused(HasSubstr(place + "to: is 103 s; the trajectory is from 100 to 102 s")));
    ASSERT_EQ(make("").code, 0);
    for (int i = 0; i < 3; ++i) {
        const json record = makeRecord("out", "00000" + std::to_string(i));
        EXPECT_EQ(record["time_s"], 100 + i);
        EXPECT_EQ(record["pose"]["position"][0], 4 + 2 * i);
    }
}

TEST_F(DatasetCommandTest, AnotherFileThatTheSweepNamesIsAnotherDataSet) {
    for (const char* place : {"settings: {scene.materials: [{sand: {table: sand.csv}}]}\n",
                              "scenes: [{set: {scene.materials.sand.table: sand.csv}}]\n"}) {
        writeFile(folder_ / "sand.csv", "grazing_deg,strength_db\n10,-30\n80,-20\n");
        writeFile(folder_ / "sweep.yml", place + std::string("poses: {grid: {x: 5, y: -4, z: -5.5}}\n"));
        const std::string out = place[1] == 'e' ? "settings" : "scenes";
        ASSERT_THAT(make(out), succeeds());
        writeFile(folder_ / "sand.csv", "grazing_deg,strength_db\n10,-30\n80,-21\n");
        EXPECT_THAT(make(out), isRefused(HasSubstr("a sample of another sweep, deployment, scene, format or version")))
            << place;
    }
}

TEST_F(DatasetCommandTest, TheFloorOfASurveyIsAScene) {
    const std::string file = (root / "deploy/scenes/harbour.glb").string(),
                      survey = (root / "deploy/scenes/bay.flt").string();
    writeFile(folder_ / "d.yml", replaced(deployment, "file: " + file, "bathymetry: {file: " + survey + "}"));
    writeFile(folder_ / "sweep.yml", "poses: {grid: {z: [-11, -10]}}\n");
    ASSERT_THAT(make("out"), succeeds());
    for (const char* index : {"000000", "000001"}) {
        const json record = makeRecord("out", index);
        EXPECT_EQ(record["scene"], "bathymetry");
        EXPECT_THAT(record["annotations"], IsEmpty());
    }
    EXPECT_THAT(json::parse(readFile(folder_ / "out/manifest.json"))["classes"], IsEmpty());
    writeFile(folder_ / "sweep.yml", "poses: {grid: {z: -11}}\nclasses: {rock: rock_*}\n");
    EXPECT_THAT(make("none").err,
                HasSubstr("sweep.yml:2:11: classes.rock[0]: is rock_*, which is no name in the scene"));
}

TEST_F(DatasetCommandTest, ABudgetInAPropertyFileIsRefused) {
    writeFile(folder_ / "sonar.yml", "--- name:default\nquality:\n  budget_ms: 5\n");
    const std::string open = replaced(deployment, "quality: {rows: 128, columns_per_beam: 1}", "");
    writeFile(folder_ / "d.yml",
              replaced(open, "sonar::SonarTask\n", "sonar::SonarTask\n    property_files: {files: [sonar.yml]}\n"));
    EXPECT_THAT(
        make("out"),
        isRefused(HasSubstr("sonar.yml:3:14: quality.budget_ms: budget_ms lets the speed of the machine decide")));
}

TEST_F(DatasetCommandTest, ObjectsEchoFromTheirPlaces) {
    writeFile(folder_ / "sweep.yml", R"(poses: {grid: {x: 5, y: -30, z: -5.5, yaw_deg: [0, 90]}}
objects: [{names: [rock_000], x: [12, 12.001], y: [2, 2.001], frame: vehicle, ground: sea_floor}]
classes: {rock: rock_000}
)");
    ASSERT_EQ(make("out").code, 0);
    for (const char* index : {"000000", "000001"}) {
        const json record = makeRecord("out", index);
        ASSERT_EQ(record["annotations"].size(), 1u) << index;
        const json& found = record["annotations"][0];
        EXPECT_EQ(found["name"], "rock_000");
        const double bearing = std::atan2(2, 12 - 0.4);
        EXPECT_LT(found["bearing_rad"][0], bearing);
        EXPECT_GT(found["bearing_rad"][1], bearing);
        EXPECT_LT(found["range_m"][0], std::hypot(11.6, 2, 3.5));
        EXPECT_GT(found["range_m"][1], std::hypot(11.6, 2, 3.5) - 1);
    }
}

TEST_F(DatasetCommandTest, RangesInARecordAreThoseOfTheSonarAtAnyRounding) {
    writeFile(folder_ / "sweep.yml", R"(poses: {grid: {x: 5, y: -30, z: -5.5}}
settings:
  sonar.range: [6.3]
  sonar.range_rounding: [sample, exact]
  sonar.range_min: [0, 2]
  sonar.bin_count: [100, 375, 1000]
objects: [{names: [rock_000], x: [5, 5.001], y: [0, 0.001], z: [-6.5, -6.499], frame: vehicle}]
classes: {rock: rock_000}
)");
    ASSERT_EQ(make("out").code, 0);
    double nearest = 0;
    for (int i = 0; i < 12; ++i) {
        const json record = makeRecord("out", fmt::format("{:06}", i));
        const double c = record["ping"]["speed_of_sound_m_s"], bins = record["ping"]["bins"];
        const bool exact = record["settings"]["sonar.range_rounding"] == "exact";
        const double range = exact ? 6.3 : bins * std::ceil(6.3 / bins / c * 1e6) * 1e-6 * c;
        EXPECT_NEAR(record["ping"]["range_m"], range, 1e-9) << i;
        ASSERT_EQ(record["annotations"].size(), 1u) << i;
        const double near = record["annotations"][0]["range_m"][0], cell = range / 100;
        if (i == 2) nearest = near;  // the finest of bins of whole microseconds
        if (i > 2) {
            EXPECT_NEAR(near, nearest, 2 * cell) << i;
        }
    }
    EXPECT_NEAR(nearest, std::hypot(4.6, 0.8), 1);
}

TEST_F(DatasetCommandTest, TheHeightOfAnObjectSetsTheLengthOfItsShadow) {
    writeFile(folder_ / "sweep.yml", R"(poses: {grid: {x: 5, y: -30, z: -5.5, yaw_deg: [0, 90]}}
objects: [{names: [rock_000], x: [10, 10.001], y: [1, 1.001], frame: vehicle, ground: sea_floor}]
classes: {rock: rock_000}
annotations: {shadows: true}
)");
    ASSERT_EQ(make("out").code, 0);
    EXPECT_EQ(json::parse(readFile(folder_ / "out/manifest.json"))["classes"], json::array({"rock", "rock_shadow"}));
    for (const char* index : {"000000", "000001"}) {
        const json record = makeRecord("out", index);
        ASSERT_EQ(record["annotations"].size(), 2u) << index;
        const json &rock = record["annotations"][0], &shadow = record["annotations"][1];
        EXPECT_EQ(rock["shadow"], false);
        EXPECT_EQ(shadow["shadow"], true);
        EXPECT_EQ(shadow["name"], "rock_000");
        EXPECT_EQ(shadow["class"], "rock_shadow");
        EXPECT_GE(shadow["range_m"][0], rock["range_m"][0]);
        EXPECT_GT(shadow["range_m"][1], rock["range_m"][1]);
        EXPECT_GE(shadow["bearing_rad"][0].get<double>(), rock["bearing_rad"][0].get<double>() - 0.02);
        EXPECT_LE(shadow["bearing_rad"][1].get<double>(), rock["bearing_rad"][1].get<double>() + 0.02);
    }
}

TEST_F(DatasetCommandTest, ScenesHaveFilesAndPropertiesOfTheirOwn) {
    writeFile(folder_ / "sweep.yml", "scenes: [" + (root / "deploy/scenes/tank.glb").string() +
                                         ", {set: {sonar.bin_count: 100}}]\nposes: {grid: {z: -3}}\n");
    ASSERT_EQ(make("out").code, 0);
    const json first = makeRecord("out", "000000"), second = makeRecord("out", "000001");
    EXPECT_EQ(first["scene"], "tank.glb");
    EXPECT_EQ(first["ping"]["bins"], 200);
    EXPECT_EQ(second["scene"], "harbour.glb");
    EXPECT_EQ(second["ping"]["bins"], 100);
    const json classes = json::parse(readFile(folder_ / "out/manifest.json"))["classes"];
    EXPECT_THAT(classes, testing::IsSupersetOf({json("pillar"), json("pile"), json("sea_floor")}));
}

TEST_F(DatasetCommandTest, APatternOfObjectsMayMatchInOneOfTheScenesAlone) {
    const std::string scenes = "scenes: [" + (root / "deploy/scenes/harbour.glb").string() + ", " +
                               (root / "deploy/scenes/tank.glb").string() + "]\nposes: {grid: {x: 5, z: -3}}\n";
    writeFile(folder_ / "sweep.yml", scenes +
                                         "objects: [{names: [rock_000, pillar*], x: [6, 20], y: [-8, 8], avoid: "
                                         "[quay_wall]}]\n");
    ASSERT_THAT(make("out"), succeeds());
    const json harbour = makeRecord("out", "000000")["objects"], tank = makeRecord("out", "000001")["objects"];
    ASSERT_EQ(harbour.size(), 1u);
    EXPECT_EQ(harbour[0]["name"], "rock_000");
    for (const json& each : tank) EXPECT_THAT(each["name"].get<std::string>(), testing::StartsWith("pillar"));
    EXPECT_FALSE(tank.empty());
    writeFile(folder_ / "sweep.yml", scenes + "objects: [{names: [rock_000, pilar*], x: [6, 20], y: [-8, 8]}]\n");
    EXPECT_THAT(
        make("none"),
        isRefused(HasSubstr("sweep.yml:3:11: objects[0].names[1]: is pilar*, which is no name in any of the scenes")));
}

TEST_F(DatasetCommandTest, ALogOfASampleHasItsPingTruthAndPose) {
    ASSERT_EQ(make("out", {"--format", "mcap", "--shard", "2/8"}).code, 0);
    const json record = makeRecord("out", "000002");
    const std::string log = "out/" + std::string(record["files"].items().begin().key());
    const json info = json::parse(callInsonify(folder_, {"log", "info", log, "--json"}).out);
    std::map<std::string, int> samples;
    for (const json& stream : info["streams"]) samples[stream["name"]] = stream["count"];
    EXPECT_THAT(samples, ElementsAre(testing::Pair("sonar.ping", 1), testing::Pair("sonar.truth", 1),
                                     testing::Pair("vehicle.pose", 1)));
}

TEST_F(DatasetCommandTest, ChecksOptionsOfTheCommandLine) {
    EXPECT_THAT(make("out", {"--shard", "3/3"}).err, HasSubstr("of 3 shards i may be from 0 to 2"));
    EXPECT_EQ(make("out", {"--format", "voc"}).code, 2);
    EXPECT_THAT(make("out", {"--seed", "-1"}).err, HasSubstr("-1 is no whole number from 0 to 2^64 - 1"));
    const Outcome set = make("out", {"--set", "sonr.range=5"});
    EXPECT_THAT(set, isRefused(HasSubstr("--set: sonr.range=5: there is no task sonr; did you mean sonar?")));
    EXPECT_THAT(make("out", {"--set", "sonar.quality.rows=null", "--set", "sonar.quality.columns_per_beam=null",
                             "--set", "sonar.quality.budget_ms=5"})
                    .err,
                HasSubstr("budget_ms lets the speed"));
    EXPECT_THAT(callInsonify(folder_, {"dataset", "d.yml", "--sweep", "no.yml", "--out", "out"}).err,
                HasSubstr("no.yml"));
    writeFile(folder_ / "d.yml", deployment.substr(0, deployment.find("quality")) + "quality: {budget_ms: 5}\n" +
                                     deployment.substr(deployment.find("  noise:")));
    EXPECT_THAT(make("out").err,
                HasSubstr("d.yml:20:28: tasks.sonar.properties.quality.budget_ms: budget_ms lets the speed"));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(DatasetCommandTest, TheSweepOfTheHarbourIsMadeWithItsDeployment) {
    ASSERT_THAT(callInsonify(folder_, {"dataset", root / "deploy/truth.yml", "--sweep",
                                       root / "deploy/sweeps/harbour.yml", "--out", "out", "--shard", "0/24"}),
                prints(AllOf(HasSubstr("1 of 24 samples in "), HasSubstr(", 1 of them new"))));
    EXPECT_GT(makeRecord("out", "000000")["annotations"].size(), 5u);
}
