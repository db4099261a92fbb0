#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <set>

#include "components/command/init/Starter.hpp"
#include "tests/deployer/Command.hpp"

using namespace insonify::command;
using insonify::sonars::SonarFigures;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

/** Arguments of a run without the noise of the sea; a 3-D sonar's range images have no noise anyway. */
std::vector<std::string> quietly(std::vector<std::string> words, const std::string& sonar) {
    if (!starterSonar(sonar).isGrid()) words.insert(words.end(), {"--set", "noise.ambient=null"});
    return words;
}

/** Returns, for one ping of the deployment of `init` for this sonar, the number of bins or beams with an echo, before
 *  noise. */
size_t echoesReceived(const TestFolder& folder, const std::string& sonar) {
    EXPECT_THAT(callInsonify(folder, {"init", sonar, "--sonar", sonar}), succeeds());
    EXPECT_THAT(callInsonify(folder, quietly({"run", sonar, "--pings", "1", "--out", sonar + "/out"}, sonar)),
                succeeds());
    const std::string log = sonar + "/out/" + sonar + ".0.log";
    const bool grid = starterSonar(sonar).isGrid();
    const std::string stream = grid ? "sonar.range_image" : "receiver.ping", array = grid ? "distances" : "bins";
    EXPECT_THAT(callInsonify(folder, {"log", "export", log, "--stream", stream, "--to", sonar + ".npz"}), succeeds());
    const Outcome counted = python(folder, "import numpy; b = numpy.load('" + sonar + ".npz')['" + array +
                                               "']; print((numpy.isfinite(b) & (b > 0)).sum())");
    EXPECT_EQ(counted.code, 0) << counted.err;
    return std::stoul(counted.out);
}

/** Returns the records of a data set's samples. */
std::vector<json> getRecords(const fs::path& set) {
    std::vector<json> records;
    for (const auto& entry : fs::directory_iterator(set))
        if (entry.path().extension() == ".json" && entry.path().filename().string().starts_with("0"))
            records.push_back(json::parse(readFile(entry.path())));
    return records;
}

/** Returns the number of tires that the starter's sweep annotates in `dive`, after its last line is replaced if one is
 *  given. */
size_t annotatedTires(const TestFolder& folder, const std::string& annotations) {
    std::string sweep = readFile(folder / "dive/sweep.yml");
    if (!annotations.empty()) sweep = sweep.substr(0, sweep.find("annotations:")) + annotations;
    writeFile(folder / "dive/other.yml", sweep);
    const std::string out = "set" + std::to_string(annotations.size());
    EXPECT_THAT(callInsonify(folder, {"dataset", "dive", "--sweep", "dive/other.yml", "--out", out, "--format", "mask",
                                      "--set", "sonar.quality.rows=128"}),
                succeeds());
    size_t tires = 0;
    for (const json& record : getRecords(folder / out))
        for (const json& annotation : record["annotations"]) tires += annotation["class"] == "tire";
    return tires;
}

/** Returns the line of a sweep that says how its pictures look. */
std::string pictureOf(const std::string& sweep) {
    const size_t from = sweep.find("picture:");
    return sweep.substr(from, sweep.find('\n', from) + 1 - from);
}

/** Returns the level below white that a code of a device states [dB], by the law of its codes. */
double belowWhite(const YAML::Node& receiver, double code) {
    const YAML::Node law = receiver["code"];
    const double share = code / (std::pow(2.0, law["bits"].as<int>()) - 1);
    if (law["law"].Scalar() == "log") return (share - 1) * law["dynamic_range_db"].as<double>();
    return 20 / law["gamma"].as<double>() * std::log10(share);
}

/** Returns the median code in bins about a third of the range, of the deployment `.` in empty water. */
double medianCodeOfNoise(const TestFolder& folder, const SonarFigures& figures) {
    EXPECT_THAT(
        callInsonify(folder, {"run", ".", "--pings", figures.isFan() ? "1" : "40", "--out", "empty", "--set",
                              "vehicle.file=null", "--set", "vehicle.waypoints=[{time: 0, position: [-5000, 0, -6]}]"}),
        succeeds());
    EXPECT_THAT(callInsonify(folder, {"log", "export", "empty/" + figures.name + ".0.log", "--stream", "receiver.ping",
                                      "--to", "empty.npz"}),
                succeeds());
    const Outcome read = python(folder,
                                "import numpy; b = numpy.load('empty.npz')['bins']; n = b.shape[-1]; "
                                "print(numpy.median(b[..., n // 3 - n // 50:n // 3 + n // 50]))");
    EXPECT_EQ(read.code, 0) << read.err;
    return std::stod(read.out);
}

/** Settings that hide almost everything in a ping: only its last hundredth, or only returns above the source's
 *  level. */
std::string almostNothing(const SonarFigures& figures) {
    if (figures.isGrid()) return "sonar.detection.threshold_db=0";
    return "sonar.range_min=" + std::to_string(0.99 * starterRange(figures));
}

/** Returns the pixels of echoes in the first picture of a run with a property set. */
int brightPixels(const TestFolder& folder, const std::string& sonar, const std::string& assignment) {
    const std::string out = "out_" + assignment;
    std::vector<std::string> words{"run", ".", "--pings", "1", "--out", out, "--set", assignment};
    if (starterSonar(sonar).isGrid()) words.insert(words.end(), {"--set", "view.every=1"});
    EXPECT_THAT(callInsonify(folder, quietly(words, sonar)), succeeds());
    for (const char* name : {"fan_000000.png", "disc_000000.png", "range_000000.png"}) {
        const cv::Mat picture = cv::imread((folder / out / name).string(), cv::IMREAD_GRAYSCALE);
        if (!picture.empty())
            return static_cast<int>(std::count_if(picture.begin<uint8_t>(), picture.end<uint8_t>(),
                                                  [](uint8_t grey) { return grey > 70; }));
    }
    ADD_FAILURE() << "there is no picture";
    return 0;
}

/** Counts pixels of objects in data sets of masks: all, those that are white, and those of at least a third of white.
 */
struct Shares {
    int pixels = 0, white = 0, bright = 0;

    void add(const fs::path& set) {
        for (const auto& entry : fs::directory_iterator(set)) {
            const std::string name = entry.path().string(), ending = "_instances.png";
            if (!name.ends_with(ending)) continue;
            const cv::Mat mask = cv::imread(name, cv::IMREAD_GRAYSCALE);
            const cv::Mat levels =
                cv::imread(name.substr(0, name.size() - ending.size()) + ".png", cv::IMREAD_GRAYSCALE);
            pixels += cv::countNonZero(mask);
            white += cv::countNonZero(mask & (levels >= 250));
            bright += cv::countNonZero(mask & (levels >= 85));
        }
    }
};

/** Returns the name of a file with the poses of the deployment's vehicle: its own, or one made from its waypoints. */
std::string writePass(const TestFolder& folder, const std::string& sonar) {
    const YAML::Node vehicle = YAML::LoadFile(folder / (sonar + ".yml"))["tasks"]["vehicle"]["properties"];
    if (vehicle["file"]) return vehicle["file"].Scalar();
    std::string csv = "time,x,y,z,qw,qx,qy,qz\n";
    for (const YAML::Node& waypoint : vehicle["waypoints"]) {
        const auto place = waypoint["position"].as<std::vector<double>>();
        const double half_yaw = waypoint["yaw_deg"].as<double>() * std::numbers::pi / 360;
        csv += fmt::format("{},{},{},0,0,{}\n", waypoint["time"].Scalar(), fmt::join(place, ","), std::cos(half_yaw),
                           std::sin(half_yaw));
    }
    writeFile(folder / "waypoints.csv", csv);
    return "waypoints.csv";
}

/** Returns the level that a share of pixels is below; 0 without pixels. */
uint8_t quantile(std::vector<uint8_t> levels, double share) {
    if (levels.empty()) return 0;
    const auto at = levels.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(levels.size() - 1));
    std::nth_element(levels.begin(), at, levels.end());
    return *at;
}

/** Returns whether an object of a mask stands out: the brightest tenth of its pixels is 20 levels above that of what
 *  surrounds it, whose speckle is bright in places, too. */
bool standsOut(const cv::Mat& levels, const cv::Mat& mask, int object) {
    constexpr int margin = 8, contrast = 20;
    const cv::Mat own = mask == object;
    const cv::Rect box = cv::boundingRect(own);
    const cv::Rect about =
        (box + cv::Size(2 * margin, 2 * margin) - cv::Point(margin, margin)) & cv::Rect(0, 0, mask.cols, mask.rows);
    std::vector<uint8_t> inside, outside;
    for (int y = about.y; y < about.y + about.height; ++y)
        for (int x = about.x; x < about.x + about.width; ++x)
            if (own.at<uint8_t>(y, x) > 0)
                inside.push_back(levels.at<uint8_t>(y, x));
            else if (mask.at<uint8_t>(y, x) == 0)
                outside.push_back(levels.at<uint8_t>(y, x));
    return quantile(inside, 0.9) >= quantile(outside, 0.9) + contrast;
}

/** Returns the share of the pictures of a data set of masks in which an object stands out. */
double getShareWithObjects(const fs::path& set) {
    int pictures = 0, shown = 0;
    for (const auto& entry : fs::directory_iterator(set)) {
        const std::string name = entry.path().string(), ending = "_instances.png";
        if (!name.ends_with(ending)) continue;
        const cv::Mat mask = cv::imread(name, cv::IMREAD_GRAYSCALE);
        const cv::Mat levels = cv::imread(name.substr(0, name.size() - ending.size()) + ".png", cv::IMREAD_GRAYSCALE);
        double objects = 0;
        cv::minMaxLoc(mask, nullptr, &objects);
        bool is_shown = false;
        for (int object = 1; object <= objects && !is_shown; ++object) is_shown = standsOut(levels, mask, object);
        ++pictures, shown += is_shown;
    }
    return pictures > 0 ? static_cast<double>(shown) / pictures : 0;
}

class InitPresetTest : public testing::TestWithParam<std::string> {};

std::vector<std::string> presetNames() {
    std::vector<std::string> names;
    for (const SonarFigures* figures : starterSonars()) names.push_back(figures->name);
    return names;
}

}  // namespace

TEST_P(InitPresetTest, IsValidRunsAtOnceAndReceivesEchoes) {
    const TestFolder folder;
    EXPECT_GT(echoesReceived(folder, GetParam()), 100u);
    EXPECT_THAT(callInsonify(folder, {"check", GetParam()}), prints(testing::Not(HasSubstr("warning"))));
}

TEST_P(InitPresetTest, PrintsNoWarningBeforeAnybodyHasChangedIt) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    for (const char* command : {"run", "check", "plan"}) {
        std::vector<std::string> words{command, "."};
        if (words[0] == "run") words.insert(words.end(), {"--pings", "1", "--out", "out"});
        const Outcome outcome = callInsonify(folder, words);
        EXPECT_EQ(outcome.code, 0);
        EXPECT_THAT(outcome.err + outcome.out, testing::Not(HasSubstr("arning"))) << command;
        if (words[0] != "plan") continue;
        EXPECT_THAT(outcome.out, HasSubstr("omitted: measured levels of seabeds: no law was measured at"));
        EXPECT_THAT(outcome.out, HasSubstr("levels of the floor are then a guess"));
    }
}

TEST(InitCommandTest, AFrequencyThatNoImagingSonarHasIsAWarning) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "."}).code, 0);
    for (const char* khz : {"5", "75000"})  // 75000: in Hz by mistake
        EXPECT_THAT(callInsonify(folder, {"run", ".", "--pings", "1", "--out", "out", "--set", "sonar.pulse=null",
                                          "--set", std::string("sonar.frequency_khz=") + khz})
                        .err,
                    HasSubstr("warning: sonar: backscatter of seabeds is extrapolated outside its law's validity"))
            << khz;
}

TEST_P(InitPresetTest, MakesAPictureOfTheScene) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    const SonarFigures& figures = starterSonar(GetParam());
    const int empty = brightPixels(folder, GetParam(), almostNothing(figures)),
              rasterised =
                  brightPixels(folder, GetParam(), "sonar.range_min=" + std::to_string(figures.modes[0].range_min));
    EXPECT_GT(rasterised, empty + (figures.isFan() || figures.isGrid() ? 5000 : 50));
}

TEST_P(InitPresetTest, HasTheBeamWidthOfItsDataSheetAndAPulse) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    const SonarFigures& figures = starterSonar(GetParam());
    const Outcome beam = callInsonify(folder, {"beam", ".", "--json"});
    ASSERT_EQ(beam.code, 0) << beam.err;
    const json cuts = json::parse(beam.out);
    EXPECT_NEAR(cuts["azimuth"]["width_3db_deg"], figures.modes[0].beam_width_deg,
                0.01 * figures.modes[0].beam_width_deg);
    EXPECT_NEAR(cuts["elevation"]["width_3db_deg"], figures.modes[0].beam_height_deg,
                0.01 * figures.modes[0].beam_height_deg);
    EXPECT_THAT(readFile(folder / (GetParam() + ".yml")), HasSubstr("pulse: {"));
}

TEST_P(InitPresetTest, BinsOfWholeMicrosecondsReachTheConfiguredRange) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    const Outcome ran = callInsonify(folder, {"run", ".", "--pings", "1", "--out", "out"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_THAT(ran.err, testing::Not(HasSubstr("range reached"))) << ran.err;
    const SonarFigures& figures = starterSonar(GetParam());
    EXPECT_LE(starterRange(figures), figures.modes[0].range_max);
    EXPECT_THAT(readFile(folder / (GetParam() + ".yml")), HasSubstr(figures.starter->note));
}

TEST_P(InitPresetTest, MostPicturesOfAFanShowAnObjectOnTheFloor) {
    if (!starterSonar(GetParam()).isFan()) GTEST_SKIP() << "data sets have whole pictures of fans only";
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    writeFile(folder / "pass.yml", "poses: {trajectory: {file: " + writePass(folder, GetParam()) +
                                       ", period: 1}}\n"
                                       "classes: {object: [tire_*, stone_*, container, pile_*, pipeline]}\n" +
                                       pictureOf(readFile(folder / "sweep.yml")) +
                                       "annotations: {min_level: 40, min_pixels: 100}\n");
    ASSERT_THAT(callInsonify(folder, {"dataset", ".", "--sweep", "pass.yml", "--out", "pass", "--format", "mask",
                                      "--set", "sonar.quality.rows=128"}),
                succeeds());
    EXPECT_GE(getRecords(folder / "pass").size(), 12u);
    EXPECT_GE(getShareWithObjects(folder / "pass"), 0.9) << "of the pass";
    Shares shares;
    shares.add(folder / "pass");
    EXPECT_LE(shares.white, 0.01 * shares.pixels) << "an object is not white over large parts";
    EXPECT_GT(shares.bright, 0.05 * shares.pixels);
    ASSERT_THAT(callInsonify(folder, {"dataset", ".", "--sweep", "sweep.yml", "--out", "sweep", "--format", "mask",
                                      "--count", "12", "--set", "sonar.quality.rows=128"}),
                succeeds());
    EXPECT_GE(getShareWithObjects(folder / "sweep"), 0.6) << "of the sweep";
}

/** A head hears one direction at a time: a picture is made of a whole turn. */
TEST_P(InitPresetTest, TheFirstPictureOfAHeadShowsEveryDirection) {
    const SonarFigures& figures = starterSonar(GetParam());
    if (figures.isFan() || figures.isGrid()) GTEST_SKIP() << "it has no head";
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    const auto firstPicture = [&](std::vector<std::string> words, const std::string& out) {
        words.insert(words.begin(), {"run", ".", "--out", out});
        EXPECT_THAT(callInsonify(folder, words), succeeds());
        return cv::imread((folder / out / "disc_000000.png").string(), cv::IMREAD_GRAYSCALE);
    };
    const cv::Mat turn = firstPicture({}, "turn"), ping = firstPicture({"--pings", "1"}, "ping");
    ASSERT_FALSE(turn.empty() || ping.empty()) << "a shorter run has a picture, too";
    ASSERT_EQ(turn.size(), ping.size());
    cv::Mat changed;
    cv::absdiff(turn, ping, changed);
    cv::Point2d middle;
    std::vector<cv::Point2d> pixels;
    for (int y = 0; y < changed.rows; ++y)
        for (int x = 0; x < changed.cols; ++x)
            if (changed.at<uint8_t>(y, x) > 20) pixels.emplace_back(x, y), middle += pixels.back();
    ASSERT_GT(pixels.size(), 100'000u);
    middle *= 1.0 / static_cast<double>(pixels.size());
    std::map<int, size_t> sectors;
    for (const cv::Point2d& pixel : pixels)
        ++sectors[static_cast<int>(
            std::floor(18 / std::numbers::pi * std::atan2(pixel.y - middle.y, pixel.x - middle.x)))];
    EXPECT_GE(sectors.size(), 36u);
    for (const auto& [sector, count] : sectors) EXPECT_GT(count, pixels.size() / 100) << 10 * sector << " deg";
    EXPECT_FALSE(fs::exists(folder / "ping/disc_000001.png"));
}

/** Where nothing is: in real recordings noise has a code, too. */
TEST_P(InitPresetTest, NoiseHasTheCodeOfItsDeviceAtAThirdOfTheRange) {
    const SonarFigures& figures = starterSonar(GetParam());
    if (figures.device->code_bits == 0) GTEST_SKIP() << "its samples are no codes";
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    const YAML::Node receiver = YAML::LoadFile(folder / (GetParam() + ".yml"))["tasks"]["receiver"]["properties"];
    EXPECT_NEAR(belowWhite(receiver, medianCodeOfNoise(folder, figures)), figures.device->noise_db, 1);
}

TEST_P(InitPresetTest, TheSweepOfAFanDrawsWhatAnOperatorSets) {
    if (!starterSonar(GetParam()).isFan()) GTEST_SKIP() << "only fans have a sweep";
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", ".", "--sonar", GetParam()}).code, 0);
    ASSERT_THAT(callInsonify(folder, {"dataset", ".", "--sweep", "sweep.yml", "--out", "set", "--format", "mask",
                                      "--count", "4", "--set", "sonar.quality.rows=64"}),
                succeeds());
    const YAML::Node tasks = YAML::LoadFile(folder / (GetParam() + ".yml"))["tasks"];
    const YAML::Node noise = tasks["noise"]["properties"], receiver = tasks["receiver"]["properties"];
    std::map<std::string, std::set<double>> drawn;
    for (const json& record : getRecords(folder / "set"))
        for (const auto& [property, value] : record["settings"].items()) drawn[property].insert(value.get<double>());
    const auto expectAbout = [&](const char* property, double value, double below, double above) {
        ASSERT_EQ(drawn[property].size(), 4u) << property << " is the same in two samples";
        EXPECT_GE(*drawn[property].begin(), value - below) << property;
        EXPECT_LE(*drawn[property].rbegin(), value + above) << property;
    };
    expectAbout("receiver.gain_db", 0, 9, 9);
    expectAbout("receiver.tvg.log_coefficient", receiver["tvg"]["log_coefficient"].as<double>(), 5, 5);
    expectAbout("noise.ambient.source_level_db", noise["ambient"]["source_level_db"].as<double>(), 8, 8);
    if (const YAML::Node code = receiver["code"]; code && code["gamma"]) {
        expectAbout("receiver.code.gamma", code["gamma"].as<double>(), 0.1, 0.1);
    }
}

/** Bodies of metal that hang in front of the sonar as the deployment is, without what the sweep draws. */
TEST(InitCommandTest, BodiesInMidWaterAreNotWhite) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "device"}).code, 0);
    ASSERT_THAT(Process({"/usr/bin/python3", insonify::test::sourceFile("scripts/scenes/make_hanging_objects.py"),
                         "hang", "--seed", "7", "--scenes", "2", "--objects", "2", "--samples", "5", "--device",
                         "device/oculus_m750d.yml"},
                        folder.path())
                    .wait(),
                succeeds());
    Shares shares;
    for (const std::string name : {"near_0", "far_0", "near_1", "far_1"}) {
        writeFile(folder / ("hang/" + name + ".yml"),
                  std::regex_replace(readFile(folder / ("hang/" + name + ".yml")),
                                     std::regex("\n  (receiver|noise)\\.[^\n]*"), ""));
        ASSERT_THAT(callInsonify(folder, {"dataset", "device", "--sweep", "hang/" + name + ".yml", "--out", name,
                                          "--format", "mask", "--set", "sonar.quality.rows=256"}),
                    succeeds());
        shares.add(folder / name);
    }
    EXPECT_GT(shares.pixels, 5000);
    EXPECT_LE(shares.white, 0.01 * shares.pixels);
    EXPECT_GT(shares.bright, 0.05 * shares.pixels) << "they are not dark either";
}

TEST(InitCommandTest, AFanRunsInShards) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "dive"}).code, 0);
    for (const char* shard : {"0/2", "1/2"}) {
        EXPECT_THAT(callInsonify(folder, {"run", "dive", "--pings", "4", "--out", "out", "--shard", shard}),
                    succeeds());
    }
}

INSTANTIATE_TEST_SUITE_P(Every, InitPresetTest, testing::ValuesIn(presetNames()),
                         [](const auto& preset) { return preset.param; });

TEST(InitCommandTest, NothingIsOverwritten) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "dive"}).code, 0);
    const std::string before = readFile(folder / "dive/oculus_m750d.yml");
    writeFile(folder / "dive/pass.csv", "mine");
    for (const char* sonar : {"oculus_m750d", "micron"}) {
        EXPECT_THAT(callInsonify(folder, {"init", "dive", "--sonar", sonar}),
                    isRefused(HasSubstr("dive/pass.csv: exists already")));
    }
    EXPECT_EQ(readFile(folder / "dive/pass.csv"), "mine");
    EXPECT_EQ(readFile(folder / "dive/oculus_m750d.yml"), before);
    EXPECT_FALSE(fs::exists(folder / "dive/micron.yml"));
}

TEST(InitCommandTest, AFileThatCannotBeWrittenLeavesNoneOfThem) {
    const TestFolder folder;
    const std::string init = insonify::test::program("insonify") + " init dive";
    EXPECT_THAT(Process({"bash", "-c", "trap '' XFSZ; ulimit -f 100; exec " + init}, folder.path()).wait(),
                isRefused(HasSubstr("scene.glb: cannot be written: File too large")));
    EXPECT_TRUE(fs::is_empty(folder / "dive"));
    EXPECT_EQ(callInsonify(folder, {"init", "dive"}).code, 0);
}

TEST(InitCommandTest, TheScriptMakesTheSceneAndTrajectoriesOfItsFolder) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "dive"}).code, 0);
    std::vector<std::string> before;
    for (const char* name : {"scene.glb", "pass.csv", "hover.csv"}) {
        before.push_back(readFile(folder / "dive" / name));
        fs::remove(folder / "dive" / name);
    }
    ASSERT_THAT(Process({"/usr/bin/python3", "-I", "-S", "dive/make_scene.py"}, folder.path()).wait(), succeeds());
    EXPECT_TRUE(readFile(folder / "dive/scene.glb") == before[0]);
    EXPECT_EQ(readFile(folder / "dive/pass.csv"), before[1]);
    EXPECT_EQ(readFile(folder / "dive/hover.csv"), before[2]);
}

TEST(InitCommandTest, TheSweepMakesADataSetWhoseObjectsFindTheirPlaces) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "dive"}).code, 0);
    for (const char* seed : {"7", "8", "9"}) {
        const std::string out = std::string("set_") + seed;
        ASSERT_THAT(callInsonify(folder, {"dataset", "dive", "--sweep", "dive/sweep.yml", "--out", out, "--seed", seed,
                                          "--set", "sonar.quality.rows=64"}),
                    succeeds());
        std::map<std::string, size_t> found;
        for (const char* part : {"train", "val", "test"}) {
            const json set = json::parse(readFile(folder / out / ("instances_" + std::string(part) + ".json")));
            for (const json& annotation : set["annotations"])
                for (const json& category : set["categories"])
                    if (category["id"] == annotation["category_id"]) ++found[category["name"].get<std::string>()];
        }
        for (const char* name : {"pile", "container", "tire", "stone", "pipeline"}) EXPECT_GT(found[name], 0u) << name;
    }
    ASSERT_EQ(callInsonify(folder, {"init", "head", "--sonar", "micron"}).code, 0);
    EXPECT_FALSE(fs::exists(folder / "head/sweep.yml")) << "its picture is a beam";
}

TEST(InitCommandTest, TheSweepAnnotatesTheTiresInView) {
    const TestFolder folder;
    ASSERT_EQ(callInsonify(folder, {"init", "dive"}).code, 0);
    const size_t in_view = annotatedTires(folder, "annotations: {min_level: 1, min_pixels: 3}\n");
    EXPECT_GT(in_view, 20u);
    EXPECT_GE(annotatedTires(folder, ""), in_view * 9 / 10);
}

TEST(InitCommandTest, AnUnknownSonarIsReportedWithTheNearestName) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"init", "dive", "--sonar", "oculus_m750"}),
                isRefused(HasSubstr("did you mean oculus_m750d?")));
    EXPECT_FALSE(fs::exists(folder / "dive"));
}

TEST(InitCommandTest, TheNextCommandsCanBePasted) {
    const TestFolder folder;
    const Outcome outcome = callInsonify(folder, {"init", "mein tauchgang"});
    EXPECT_THAT(outcome.out, HasSubstr("next: insonify run 'mein tauchgang'\n"));
    EXPECT_THAT(outcome.out, HasSubstr("insonify dataset 'mein tauchgang' --sweep 'mein tauchgang/sweep.yml' "));
}

TEST(InitCommandTest, AFolderSelectsItsOnlyDeployment) {
    const TestFolder folder;
    EXPECT_THAT(callInsonify(folder, {"run", "."}), isRefused(HasSubstr("insonify init")));
    ASSERT_EQ(callInsonify(folder, {"init", "."}).code, 0);
    EXPECT_EQ(callInsonify(folder, {"check", "."}).code, 0);
    fs::copy(folder / "oculus_m750d.yml", folder / "mine.yml");
    EXPECT_THAT(callInsonify(folder, {"run", "."}), isRefused(HasSubstr("name one of ./mine.yml, ./oculus_m750d.yml")));
}
