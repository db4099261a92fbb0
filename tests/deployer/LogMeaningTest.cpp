// The meaning of the numbers in a log and in its exports.
#include <gmock/gmock.h>

#include "tests/deployer/Wall.hpp"

using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

/** A log of the wall in out/wall.0.log: noiseless pings, pings with speckle, pings of a receiver with a TVG. */
struct LogMeaningTest : testing::Test {
    LogMeaningTest()
        : folder_(replaced(replaced(replaced(wall_deployment, "  log:\n",
                                             "  receiver: {type: receiver::ReceiverTask, properties: {tvg: "
                                             "{log_coefficient: 40}, output: level_db}}\n  log:\n"),
                                    "  - {from: noise.noisy,",
                                    "  - {from: noise.noisy, to: receiver.intensity}\n  - {from: receiver.ping, to: "
                                    "log.amplified, policy: {type: buffer, size: 64}}\n  - {from: noise.noisy,"),
                           "properties: {file: wall.gltf}", "properties: {file: wall.gltf, mount: {pitch_deg: 3}}")) {
        EXPECT_THAT(folder_.run({"--pings", "2", "--seed", "5"}), succeeds());
    }
    /** Returns the output of a python program on x.npz, exported from this stream. */
    std::string exported(const std::string& stream, const std::string& program) {
        EXPECT_THAT(callInsonify(folder_, {"log", "export", "out/wall.0.log", "--stream", stream, "--to", "x.npz"}),
                    succeeds());
        const Outcome said = python(
            folder_, "import json, numpy\nd = numpy.load('x.npz')\nmeta = json.loads(str(d['meta']))\n" + program);
        EXPECT_EQ(said.code, 0) << said.err;
        return said.out;
    }

    WallFolder folder_;
};

}  // namespace

TEST_F(LogMeaningTest, ArraysHaveTheRangeOfEachBin) {
    EXPECT_EQ(exported("sonar.ping", R"(
width = d['bin_duration'] * d['speed_of_sound']
ranges = (numpy.arange(50) + 0.5) * width[:, None]
print(d['range_m'].shape, numpy.allclose(d['range_m'], ranges, rtol=1e-6)))"),
              "(2, 50) True\n");
}

TEST_F(LogMeaningTest, ArraysHaveTheMeaningOfTheirNumbers) {
    EXPECT_EQ(exported("receiver.ping",
                       "print(meta['output'], meta['tvg']['log_coefficient'], meta['model'], "
                       "meta['mount']['pitch_deg'], meta['seed'])"),
              "level_db 40 physical 3 5\n");
    EXPECT_EQ(exported("receiver.ping", "print(meta['noise']['speckle']['law'], meta['quaternion_order'])"),
              "rayleigh w, x, y, z\n");
    EXPECT_THAT(exported("receiver.ping", "print(meta['bins'])"), HasSubstr("10 log10 of: received intensity"));
    EXPECT_THAT(exported("receiver.ping", "print(meta['bin_duration'])"), HasSubstr("one-way"));
    EXPECT_THAT(exported("receiver.ping", "print(meta['frame'])"), HasSubstr("positive to port"));
    EXPECT_EQ(exported("sonar.ping", "print(meta['output'], meta['tvg'], meta['noise'])"), "intensity None None\n");
    EXPECT_EQ(exported("vehicle.pose", "print(meta['quaternion_order'])"), "w, x, y, z\n");
}

TEST_F(LogMeaningTest, SettingsFromOutsideAreKnownFromThePropertyLog) {
    ASSERT_EQ(
        folder_.run({"--pings", "2", "--set", "receiver.tvg.log_coefficient=30", "--set", "receiver.gain_db=7"}).code,
        0);
    EXPECT_EQ(exported("receiver.ping", "print(meta['tvg']['log_coefficient'], meta['gain_db'])"), "30 7\n");
    writeFile(folder_ / "out/properties.0.log", "damaged");
    EXPECT_THAT(callInsonify(folder_, {"log", "info", "out/wall.0.log", "--metadata"}).err,
                HasSubstr("what was set from outside is unknown"));
    EXPECT_EQ(exported("receiver.ping", "print(meta['tvg'], meta['gain_db'])"), "{'log_coefficient': 40} None\n");
    fs::remove(folder_ / "out/properties.0.log");
    EXPECT_EQ(exported("receiver.ping", "print(meta['tvg'], meta['gain_db'])"), "{'log_coefficient': 40} None\n");
}

TEST_F(LogMeaningTest, InfoShowsDeploymentSeedPlanAndUnits) {
    const std::string plain = callInsonify(folder_, {"log", "info", "out/wall.0.log"}).out;
    EXPECT_THAT(plain, Not(HasSubstr("schedule: lockstep")));
    const std::string words = callInsonify(folder_, {"log", "info", "out/wall.0.log", "--metadata"}).out;
    EXPECT_THAT(words, AllOf(HasSubstr("schedule: lockstep"), HasSubstr("insonify_seed: 5"), HasSubstr("insonify_plan"),
                             HasSubstr("columns_per_beam"), HasSubstr("[rad]")));
    EXPECT_EQ(words.find("schedule: lockstep"), words.rfind("schedule: lockstep"));
    const json info = json::parse(callInsonify(folder_, {"log", "info", "out/wall.0.log", "--metadata", "--json"}).out);
    EXPECT_EQ(info["metadata"]["receiver.ping"]["meaning"]["output"], "level_db");
    EXPECT_EQ(info["metadata"]["receiver.ping"]["metadata"]["insonify_seed"], "5");
}

TEST_F(LogMeaningTest, TextOfManyBinsIsAnnouncedWithItsSize) {
    const std::vector<std::string> words = {"log",        "export", "out/wall.0.log", "--stream",
                                            "sonar.ping", "--to",   "x.csv"};
    EXPECT_EQ(callInsonify(folder_, words).err, "");
    ASSERT_EQ(folder_.run({"--pings", "60", "--set", "sonar.bin_count=3000"}).code, 0);
    const Outcome large = callInsonify(folder_, words);
    EXPECT_EQ(large.code, 0);
    EXPECT_THAT(large.err, HasSubstr("notice: x.csv gets a line for each bin, some 3 million, 0.1 GB"));
}

TEST(LogRoundingTest, LoggedBinsThatAreNotWholeMicrosecondsHaveExactRanges) {
    const WallFolder logged;
    const Outcome outcome = logged.run({"--pings", "2", "--set", "sonar.range_rounding=exact", "--set",
                                        "sonar.range=20", "--set", "sonar.bin_count=4000"});
    EXPECT_THAT(outcome, succeeds());
    EXPECT_THAT(outcome.err, Not(HasSubstr("bin_duration")));
    const auto info = json::parse(callInsonify(logged, {"log", "info", "out/wall.0.log", "--metadata", "--json"}).out);
    EXPECT_EQ(info["metadata"]["sonar.ping"]["metadata"]["insonify_bin_width"], "0.005");
    ASSERT_THAT(callInsonify(logged, {"log", "export", "out/wall.0.log", "--stream", "sonar.ping", "--to", "x.npz"}),
                succeeds());
    const Outcome ranges = python(logged, R"(import numpy
d = numpy.load('x.npz')
first = [numpy.flatnonzero(beam)[0] for beam in d['bins'][0]]
print(all(abs(d['range_m'][0][first] * numpy.cos(d['bearings'][0]) - 10) < 0.35))
print(abs(d['range_m'][0][first].min() - 10) <= 0.0025 + 0.04, abs(d['range_m'][0][-1] - 19.9975) < 1e-5)
print(abs(d['bin_duration'][0] * d['speed_of_sound'][0] - 0.005) < 1e-12))");
    EXPECT_EQ(ranges.out, "True\nTrue True\nTrue\n") << ranges.err;
}
