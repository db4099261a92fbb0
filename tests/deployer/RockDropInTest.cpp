// deploy/rock_dropin.yml: the published simulator's ports, properties and property files, by their published names.
#include <gmock/gmock.h>

#include "components/log/Writer.hpp"
#include "tests/deployer/SceneRun.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Pings.hpp"
#include "types/geometry/Angle.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::HasSubstr;

namespace {

const std::string multibeam_file = "deploy/rock/imaging_sonar_simulation::MultibeamSonarTask.yml";

/** A copy of deploy/, with a few beams so that a run is short. */
struct RockDropInTest : testing::Test {
    RockDropInTest() {
        fs::copy(fs::path(test::source_dir) / "deploy", folder_ / "deploy", fs::copy_options::recursive);
    }
    Outcome run(std::vector<std::string> more) const {
        std::vector<std::string> words = {"run",   "deploy/rock_dropin.yml", "--out", "out",
                                          "--set", "multibeam.beam_count=16"};
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(folder_, words);
    }
    /** Returns the only ping of a run. */
    types::Sonar ping(std::vector<std::string> more, const std::string& stream = "multibeam.sonar_samples") const {
        more.insert(more.end(), {"--pings", "1"});
        const Outcome outcome = run(more);
        if (outcome.code != 0) throw std::runtime_error(outcome.err);
        return exportedPings(folder_, "out/rock.0.log", stream).at(0);
    }
    void edit(const std::string& file, const std::string& what, const std::string& with) const {
        writeFile(folder_ / file, replaced(readFile(folder_ / file), what, with));
    }
    TestFolder folder_;
};

double spanDeg(const types::Sonar& ping) { return ping.bearings.back().deg() - ping.bearings.front().deg(); }

}  // namespace

TEST_F(RockDropInTest, ThePublishedPropertiesAndSectionsGiveTheSonarTheyDescribe) {
    const types::Sonar ping = this->ping({});
    EXPECT_EQ(ping.beam_count, 16u);
    EXPECT_EQ(ping.bin_count, 500u);                      // of section harbour
    EXPECT_NEAR(ping.binStart(ping.bin_count), 36, 0.1);  // of section harbour
    EXPECT_NEAR(spanDeg(ping), 120 - 120.0 / 16, 1e-6);   // of section default: the whole fan
    EXPECT_TRUE(fs::exists(folder_ / "out/multibeam_000000.png"));
    EXPECT_TRUE(fs::exists(folder_ / "out/scanning_000000.png"));
}

TEST_F(RockDropInTest, AScanningSonarStartsAtItsLeftLimitAndTurnsByItsMotorStep) {
    ASSERT_EQ(run({"--pings", "3"}).code, 0);
    const auto pings = exportedPings(folder_, "out/rock.0.log", "scanning.sonar_samples");
    ASSERT_EQ(pings.size(), 3u);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(pings[i].bearings.at(0).deg(), 140 - 1.8 * static_cast<double>(i), 1e-6);
}

TEST_F(RockDropInTest, BeamWidthIsTheFansOrByConventionOneBeams) {
    const std::string width = "multibeam.beam_width={rad: 5.deg}";
    EXPECT_NEAR(spanDeg(ping({"--set", width})), 5 * 15.0 / 16, 1e-6);
    EXPECT_NEAR(spanDeg(ping({"--set", width, "--set", "multibeam.beam_width_convention=per_beam"})), 75, 1e-6);
}

TEST_F(RockDropInTest, EchoesGrowWithTheGainAndAreNearOneAtOneHalf) {
    for (const std::string model : {"physical", "cerqueira2017"}) {
        const std::vector<std::string> plain = {"--set", "multibeam.model=" + model,
                                                "--set", "multibeam.enable_speckle_noise=false",
                                                "--set", "multibeam.enable_attenuation=false"};
        const auto gained = [&](const char* gain) {
            std::vector<std::string> words = plain;
            words.insert(words.end(), {"--set", std::string("multibeam.gain=") + gain});
            return ping(words);
        };
        const types::Sonar half = gained("0.5"), tenth = gained("0.1"), none = gained("0");
        const float strongest = *std::max_element(half.bins.begin(), half.bins.end());
        EXPECT_GT(strongest, 0.5f) << model;
        EXPECT_LE(strongest, 1.0f) << model;
        EXPECT_GT(std::ranges::count_if(half.bins, [](float bin) { return bin > 0.05f; }), 100) << model;
        EXPECT_GT(test::computeSum(half), 1.5 * test::computeSum(tenth)) << model;
        EXPECT_EQ(test::computeSum(none), 0) << model;
    }
}

TEST_F(RockDropInTest, ThePublishedModelMultipliesTheMeanByTwiceTheGainUpToOne) {
    const auto with = [&](const char* gain) {
        return ping({"--set", "multibeam.model=cerqueira2017", "--set", "multibeam.enable_speckle_noise=false", "--set",
                     std::string("multibeam.gain=") + gain});
    };
    const types::Sonar plain = with("0.5"), bright = with("1"), dim = with("0.05");
    for (size_t i = 0; i < plain.bins.size(); ++i) {
        EXPECT_FLOAT_EQ(bright.bins[i], std::min(2 * plain.bins[i], 1.0f));
        EXPECT_FLOAT_EQ(dim.bins[i], 0.1f * plain.bins[i]);
    }
}

TEST_F(RockDropInTest, SwitchesInsertAndRemoveEffects) {
    std::string model;
    const auto with = [&](const char* attenuation, const char* speckle) {
        std::vector<std::string> words = {"--set", "multibeam.model=" + model};
        for (const auto& [name, on] : {std::pair("attenuation", attenuation), std::pair("speckle_noise", speckle)})
            words.insert(words.end(), {"--set", std::string("multibeam.enable_") + name + "=" + on});
        return ping(words);
    };
    for (const char* name : {"cerqueira2017", "physical"}) {
        model = name;
        const types::Sonar plain = with("false", "false");
        EXPECT_EQ(plain.bins, with("false", "false").bins) << name;
        EXPECT_NE(plain.bins, with("false", "true").bins) << name;
        EXPECT_GT(test::computeSum(plain), 1.2 * test::computeSum(with("true", "false"))) << name;
    }
}

TEST_F(RockDropInTest, ScansOfAnOlderLogBecomePictures) {
    {
        const auto log = insonify::log::createLog(folder_ / "old.0.log");
        types::SonarScan scan;
        scan.time = {1'000'000};
        scan.number_of_beams = 8;
        scan.number_of_bins = 20;
        scan.data.assign(160, 200);
        scan.start_bearing = {0.5};
        scan.angular_resolution = {0.125};
        scan.sampling_interval = 1e-3;
        scan.speed_of_sound = 1500;
        log->write(log->addStream<types::SonarScan>("multibeam.sonar_samples"), {1'000'000}, scan);
        log->close();
    }
    writeFile(folder_ / "old.yml",
              "tasks:\n  replay: {type: replay::ReplayTask, properties: {file: old.0.log}}\n"
              "  fan: {type: output::FanImageTask, properties: {file: fan_%06d.png}}\n"
              "connections:\n  - {from: replay.multibeam.sonar_samples, to: fan.ping}\n");
    EXPECT_THAT(callInsonify(folder_, {"run", "old.yml", "--out", "drawn"}), succeeds());
    EXPECT_TRUE(fs::exists(folder_ / "drawn/fan_000000.png"));
}

/** A property file of the published tasks, with every key of their files. */
std::string published(const std::string& of_one) {
    return "--- name:default\n"
           "attenuation_properties:\n  water_temperature:\n    kelvin: 293.15\n  sonar_frequency: 700.0\n" +
           of_one +
           "gain: 0.5\nheight: 600\nignored_models: []\nmodel_paths: []\nrange: 50.0\nwidth: 800\n"
           "world_file_path: ''\nwrite_shader_image: false\n";
}

TEST_F(RockDropInTest, ThePublishedFilesLoadUnchangedAndOmittedKeysAreNamed) {
    writeFile(folder_ / multibeam_file,
              published("beam_count: 256\nbeam_height:\n  rad: 20.deg\nbeam_width:\n  rad: 120.deg\nbin_count: 500\n"));
    writeFile(folder_ / "deploy/rock/imaging_sonar_simulation::ScanningSonarTask.yml",
              published("beam_height:\n  rad: 35.deg\nbeam_width:\n  rad: 3.deg\nbin_count: 400\ncontinuous: true\n"
                        "left_limit:\n  rad: -180.deg\nright_limit:\n  rad: 179.9.deg\nmotor_step:\n  rad: 1.8.deg\n"));
    for (const std::string name : {"harbour", "port_sector"})
        edit("deploy/rock_dropin.yml", name == "harbour" ? "[default, harbour]" : "[port_sector]", "[default]");
    const Outcome outcome = run({"--pings", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const types::Sonar ping = exportedPings(folder_, "out/rock.0.log", "multibeam.sonar_samples").at(0);
    EXPECT_EQ(ping.bin_count, 500u);
    EXPECT_NEAR(ping.binStart(ping.bin_count), 50.25, 1e-3);  // 67 us a bin
    EXPECT_EQ(exportedPings(folder_, "out/rock.0.log", "scanning.sonar_samples").at(0).bin_count, 400u);
    EXPECT_THAT(outcome.err, HasSubstr("multibeam: omitted by ignored_properties: height, ignored_models, model_paths, "
                                       "width, world_file_path, write_shader_image"));
}

TEST_F(RockDropInTest, TheLogHasRocksNamesOfPortsPropertiesAndTasks) {
    ASSERT_EQ(run({"--pings", "1"}).code, 0);
    const auto metadata = [&](const std::string& log) {
        return json::parse(callInsonify(folder_, {"log", "info", log, "--metadata", "--json"}).out)["metadata"];
    };
    const json log = metadata("out/rock.0.log"), properties = metadata("out/properties.0.log");
    int deployments = 0;
    for (const json& all : {log, properties})
        for (const auto& [name, stream] : all.items())
            deployments += stream["metadata"].contains("insonify_deployment");
    EXPECT_EQ(deployments, 2) << "once in each file";
    const auto expectEntry = [](const json& stream, const char* object, const char* kind, const char* type) {
        EXPECT_EQ(stream["metadata"]["rock_task_name"], "multibeam");
        EXPECT_EQ(stream["metadata"]["rock_task_object_name"], object);
        EXPECT_EQ(stream["metadata"]["rock_task_model"], "imaging_sonar_simulation::MultibeamSonarTask");
        EXPECT_EQ(stream["metadata"]["rock_stream_type"], kind);
        EXPECT_EQ(stream["metadata"]["rock_cxx_type_name"], type);
    };
    expectEntry(log.at("multibeam.sonar_samples"), "sonar_samples", "port", "/base/samples/Sonar");
    expectEntry(log.at("multibeam.shader_image"), "shader_image", "port", "/base/samples/frame/Frame");
    expectEntry(log.at("multibeam.state"), "state", "port", "/int32_t");
    expectEntry(properties.at("multibeam.range"), "range", "property", "/double");
    expectEntry(properties.at("multibeam.gain"), "gain", "property", "/double");
    expectEntry(properties.at("multibeam.beam_width"), "beam_width", "property", "/base/Angle");
    expectEntry(properties.at("multibeam.enable_attenuation"), "enable_attenuation", "property", "/bool");
    ASSERT_THAT(callInsonify(folder_, {"log", "export", "out/properties.0.log", "--stream", "multibeam.beam_width",
                                       "--to", "w.csv"}),
                succeeds());
    EXPECT_THAT(readFile(folder_ / "w.csv"), HasSubstr(",2.094395"));  // 120 deg, in rad
}

TEST_F(RockDropInTest, ALogReplaysByItsAliasesAndScoresPerfectly) {
    ASSERT_EQ(run({"--pings", "2"}).code, 0);
    ASSERT_THAT(callInsonify(folder_, {"replay", "out/rock.0.log", "deploy/rock_dropin.yml", "--out", "again", "--set",
                                       "multibeam.beam_count=16"}),
                succeeds());
    const auto first = exportedPings(folder_, "out/rock.0.log", "multibeam.sonar_samples"),
               again = exportedPings(folder_, "again/rock.0.log", "multibeam.sonar_samples");
    ASSERT_EQ(first.size(), again.size());
    for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].bins, again[i].bins);
}

TEST_F(RockDropInTest, ReportsAllDiagnosticsOfPropertyFilesWithTheirPlaces) {
    edit(multibeam_file, "enable_reverberation: false", "enable_reverberation: maybe");
    edit(multibeam_file, "rad: 120.deg", "rad: 120.m");
    edit(multibeam_file, "bin_count: 500", "bin_cuont: 500");
    const Outcome outcome = run({});
    EXPECT_THAT(outcome, isRefused(HasSubstr("gain, ")));  // an alias is known as well
    for (const char* diagnostic :
         {":10:5: beam_width: is {rad: 120.m}; must be in deg", ":15:23: enable_reverberation: is maybe",
          ":25:1: bin_cuont: is not a key here; did you mean bin_count?"})
        EXPECT_THAT(outcome.err, HasSubstr(multibeam_file + diagnostic));
}
