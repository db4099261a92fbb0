// insonify dataset: samples, settings, processes, parts and the command line, with a small sonar in the harbour.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "tests/dataset/DatasetFolder.hpp"

using namespace insonify::deployer;
using insonify::dataset::deployment;
using testing::AllOf;
using testing::HasSubstr;

namespace {

const std::string drawn_settings = R"(settings:
  scene.materials.sand.lambert_db: {uniform: [-30, -15]}
  scene.water_surface: {normal: [0, 0.2]}
  noise.speckle: {choice: [{law: rayleigh}, {law: k, shape: 5}]}
)";

struct DatasetCommandTest : insonify::dataset::DatasetFolder {};

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

TEST_F(DatasetCommandTest, PicturesOfCodesAsIntensitiesAreWarnedOf) {
    const std::vector<std::string> codes{"--count", "1",
                                         "--set",   "receiver.output=code",
                                         "--set",   "receiver.code={bits: 8, law: sqrt, full_scale_db: -40}"};
    const Outcome shown = make("codes", codes), plain = make("plain", {"--count", "1"});
    EXPECT_THAT(shown, succeeds());
    EXPECT_THAT(shown.err, HasSubstr("warning: picture: shows the codes of the receiver as intensities; give scale"));
    EXPECT_THAT(plain.err, testing::Not(HasSubstr("codes of the receiver")));
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

TEST_F(DatasetCommandTest, ABudgetInAPropertyFileIsRefused) {
    writeFile(folder_ / "sonar.yml", "--- name:default\nquality:\n  budget_ms: 5\n");
    const std::string open = replaced(deployment, "quality: {rows: 128, columns_per_beam: 1}", "");
    writeFile(folder_ / "d.yml",
              replaced(open, "sonar::SonarTask\n", "sonar::SonarTask\n    property_files: {files: [sonar.yml]}\n"));
    EXPECT_THAT(
        make("out"),
        isRefused(HasSubstr("sonar.yml:3:14: quality.budget_ms: budget_ms lets the speed of the machine decide")));
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

TEST_F(DatasetCommandTest, AShardCountsItsOwnSamplesAndSaysWhetherTheSetIsWhole) {
    const auto print = [&](const char* shard) { return make("out", {"--shard", shard}).out; };
    EXPECT_THAT(print("0/3"), AllOf(HasSubstr("shard 0/3: 3 of 3 samples in out, 3 of them new\n"),
                                    HasSubstr("of the 8 samples of all shards some are missing")));
    EXPECT_THAT(print("0/3"), HasSubstr("shard 0/3: 3 of 3 samples in out, 0 of them new\n"));
    print("1/3");
    for (const char* known : {"2 of 2 samples in out, 2 of them new\n", "2 of 2 samples in out, 0 of them new\n"})
        EXPECT_THAT(print("2/3"), AllOf(HasSubstr(known), HasSubstr("all 8 samples of all shards are there: ")));
}

TEST_F(DatasetCommandTest, WarnsOnceOfOddPosesOfClassesAndOfEmptyParts) {
    writeFile(folder_ / "sweep.yml",
              "poses: {grid: {x: 2, y: -2, z: [-5.5, 3, -60, 500]}}\nclasses: {all: '*', pile: pile_*}\n"
              "split: {train: 0.999, val: 0.001, test: 0}\npicture: {height: 100}\n");
    const Outcome outcome = make("out", {"--set", "scene.water_surface=0"});
    EXPECT_THAT(outcome, succeeds());
    for (const char* text :
         {"warning: 2 of 4 poses: the sonar is above the water surface, at z 0 m (z is up: depths are negative); the "
          "first is "
          "pose 1, at [2.4, -2, 2.8]\n",
          "warning: 1 of 4 poses: the sonar is below the floor or inside of a body",
          "warning: 2 of 4 poses: the sonar is farther from the scene than its range of 30 m",
          "classes.pile: all its names match a class before it, which counts: pile_",
          "warning: split: none of 4 samples is in val (share 0.001); "})
        EXPECT_THAT(outcome.err, HasSubstr(text));
    EXPECT_THAT(make("none").err, testing::Not(HasSubstr("above the water"))) << "there is no water surface";
}

TEST_F(DatasetCommandTest, TheSweepOfTheHarbourIsMadeWithItsDeployment) {
    ASSERT_THAT(callInsonify(folder_, {"dataset", root / "deploy/truth.yml", "--sweep",
                                       root / "deploy/sweeps/harbour.yml", "--out", "out", "--shard", "0/24"}),
                prints(AllOf(HasSubstr("shard 0/24: 1 of 1 samples in "), HasSubstr(", 1 of them new"))));
    EXPECT_GT(makeRecord("out", "000000")["annotations"].size(), 5u);
}
