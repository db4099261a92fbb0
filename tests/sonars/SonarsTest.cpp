// The figures of sonars: all have sources, and `init`, the emulators and the deployments of deploy agree with them.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <numbers>

#include "components/command/init/Starter.hpp"
#include "components/device/oculus/OculusEmulator.hpp"
#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/sonar3d/Sonar3dEmulator.hpp"
#include "components/sonars/Sonars.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::sonars {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not, testing::SizeIs;

/** Returns the deployment that `init` writes for a sonar. */
YAML::Node starter(const SonarFigures& sonar) { return YAML::Load(command::starterDeployment(sonar)); }

/** Returns the properties of the first task of a type in a deployment of deploy. */
YAML::Node deployed(const std::string& file, const std::string& type) {
    const YAML::Node tasks = YAML::LoadFile(test::sourceFile("deploy/" + file))["tasks"];
    for (const auto& task : tasks)
        if (task.second["type"].Scalar() == type) return task.second["properties"];
    ADD_FAILURE() << file << " has no " << type;
    return {};
}

TEST(SonarsTest, AllAreReadAndHaveADocumentOfEachFigure) {
    EXPECT_THAT(sonars(), SizeIs(testing::Ge(9u)));
    for (const SonarFigures& figures : sonars()) {
        EXPECT_FALSE(figures.title.empty()) << figures.name;
        EXPECT_FALSE(figures.sources.empty()) << figures.name;
        EXPECT_EQ(&sonar(figures.name), &figures) << "names are unique";
        types::Diagnostics diagnostics;
        figures.check(diagnostics);
        EXPECT_THAT(diagnostics, SizeIs(0)) << figures.name;
    }
    EXPECT_THROW(sonar("oculus"), std::out_of_range);
}

TEST(SonarsTest, WrongEntriesAreReportedTogetherWithTheirPlaces) {
    const auto refusal = [](const std::string& yaml) {
        return test::computeError<types::ConfigError>([&] { readSonars(yaml, "x.yml"); });
    };
    const std::string mode = "{frequency_khz: 700, range_min: 1, range_max: 9}";
    const std::string source = "{document: a sheet, read: 2026-01-02, gives: [frequency_khz, range_min, range_max]}";
    const auto entry = [](const std::string& modes, const std::string& sources) {
        return "a:\n  title: A\n  modes: [" + modes + "]\n  sources: [" + sources + "]\n";
    };
    EXPECT_EQ(refusal(entry(mode, source)), "");
    EXPECT_THAT(refusal(entry("{frequency: 700}", source)),
                AllOf(HasSubstr("x.yml:3:"), HasSubstr("a.modes[0]"), HasSubstr("frequency_khz")));
    EXPECT_THAT(refusal(entry("{frequency_khz: 0.5, range_max: 9}", source)), HasSubstr("frequency_khz"));
    EXPECT_THAT(refusal(entry("{frequency_khz: 700, range_min: 9, range_max: 9}", source)),
                HasSubstr("range_min below range_max"));
    EXPECT_THAT(refusal(entry("{frequency_khz: 700, range_min: 1, range_max: 9, step_deg: 1}", source)),
                HasSubstr("give no source of step_deg"));
    EXPECT_THAT(refusal(entry(mode, source + ", " + source)), HasSubstr("names frequency_khz again"));
    EXPECT_THAT(refusal(entry(mode, "{document: a sheet, read: today, gives: [frequency_khz, range_min, part]}")),
                AllOf(HasSubstr("is 'today'; must be a day"), HasSubstr("names part, which is not given"),
                      HasSubstr("give no source of range_max")));
    EXPECT_THAT(refusal(entry("", "")), HasSubstr("is empty; a sonar has at least one"));
    EXPECT_THAT(refusal(entry(mode, source) + "a: {}\n"), Not(testing::IsEmpty())) << "twice the same name";
    EXPECT_THAT(refusal("a: ["), HasSubstr("x.yml"));
}

TEST(SonarsTest, TheDeploymentsOfInitHaveTheFigures) {
    for (const SonarFigures* figures : command::starterSonars()) {
        const SonarMode& mode = figures->modes.front();
        const YAML::Node sonar = starter(*figures)["tasks"]["sonar"]["properties"];
        EXPECT_EQ(sonar["frequency_khz"].as<double>(), mode.frequency_khz) << figures->name;
        EXPECT_EQ(sonar["range_min"].as<double>(), mode.range_min);
        EXPECT_LE(sonar["range"].as<double>(), mode.range_max);
        EXPECT_EQ(sonar["bin_count"].as<int>(), figures->starter->bin_count);
        if (figures->isGrid()) {
            EXPECT_EQ(sonar["horizontal"]["beam_count"].as<int>(), mode.beam_count);
            EXPECT_EQ(sonar["vertical"]["beam_count"].as<int>(), mode.row_count);
            EXPECT_EQ(sonar["horizontal"]["field_of_view_deg"].as<double>(), mode.field_of_view_deg);
        } else {
            EXPECT_EQ(sonar["beam_width_deg"].as<double>(), mode.beam_width_deg);
            EXPECT_EQ(sonar["beam_height_deg"].as<double>(), mode.beam_height_deg);
        }
        if (figures->isFan()) {
            EXPECT_EQ(sonar["beam_count"].as<int>(), mode.beam_count);
            EXPECT_EQ(sonar["field_of_view_deg"].as<double>(), mode.field_of_view_deg);
        }
        if (mode.step_deg > 0) {
            EXPECT_EQ(sonar["head"]["step_deg"].as<double>(), mode.step_deg);
        }
    }
}

TEST(SonarsTest, ADeviceHasTheErrorsOfItsKindAndASourceOfEachFigure) {
    const auto refusal = [](const std::string& device, const std::string& gives) {
        const std::string yaml =
            "a:\n  title: A\n  modes: [{frequency_khz: 700, range_min: 1, range_max: 9}]\n"
            "  sources: [{document: a sheet, read: 2026-01-02, gives: [frequency_khz, range_min, range_max" +
            gives + "]}]\n  device: {" + device + "}\n";
        return test::computeError<types::ConfigError>([&] { readSonars(yaml, "x.yml"); });
    };
    EXPECT_EQ(refusal("kind: lens, code_bits: 8, gamma: 0.5", ", kind, code_bits, gamma"), "");
    EXPECT_THAT(refusal("kind: lens", ""), HasSubstr("give no source of kind"));
    EXPECT_THAT(refusal("kind: mirror", ", kind"), HasSubstr("is 'mirror'; must be lens, array or head"));
    EXPECT_THAT(refusal("kind: lens, phase_error_deg: 3", ", kind, phase_error_deg"),
                HasSubstr("which only an array has"));
    EXPECT_THAT(refusal("kind: array, step_error_deg: 3", ", kind, step_error_deg"),
                HasSubstr("only a head has steps"));
    EXPECT_THAT(refusal("kind: lens, code_bits: 8", ", kind, code_bits"),
                HasSubstr("needs one of gamma and dynamic_range_db"));
}

/** A lens has no errors of elements and no cross-talk, an array errors of its elements, a head errors of its steps; all
 *  but those whose samples are no codes output them. */
TEST(SonarsTest, TheDeploymentsOfInitAreTheDevices) {
    for (const SonarFigures* figures : command::starterSonars()) {
        SCOPED_TRACE(figures->name);
        const SonarDevice& device = *figures->device;
        const YAML::Node tasks = starter(*figures)["tasks"], sonar = tasks["sonar"]["properties"];
        const YAML::Node errors = sonar["imperfections"];
        if (device.kind == "lens") {
            EXPECT_FALSE(errors["gain_error_db"] || errors["phase_error_deg"] || errors["crosstalk_db"]);
            EXPECT_TRUE(errors["beam_gain_error_db"]);
        } else if (device.kind == "array") {
            EXPECT_EQ(errors["gain_error_db"].as<double>(), device.gain_error_db);
            EXPECT_EQ(errors["phase_error_deg"].as<double>(), device.phase_error_deg);
        } else {
            EXPECT_EQ(sonar["head"]["error_deg"].as<double>(), device.step_error_deg);
            EXPECT_FALSE(errors);
        }
        if (figures->isGrid()) continue;
        EXPECT_EQ(sonar["beam_pattern"]["receive"]["azimuth"]["sidelobe_db"].as<double>(), device.sidelobe_db);
        const YAML::Node receiver = tasks["receiver"]["properties"], noise = tasks["noise"]["properties"];
        EXPECT_NE(bool(sonar["speckle"]), bool(noise["speckle"])) << "fields have their own speckle";
        EXPECT_EQ(receiver["tvg"]["log_coefficient"].as<double>(), device.tvg);
        EXPECT_EQ(bool(receiver["code"]), device.code_bits > 0);
        if (receiver["code"]) {
            EXPECT_EQ(receiver["code"]["bits"].as<int>(), device.code_bits);
        }
        if (device.correlation_beams > 0) {
            EXPECT_EQ(noise["filter"]["correlation_beams"].as<double>(), device.correlation_beams);
        }
    }
}

/** The rule of components/sonars/README.md, by the numbers of the deployment: a white body at a third of the range is
 *  white in one of a hundred bins of its speckle. */
TEST(SonarsTest, WhiteIsThatOfAWhiteBody) {
    for (const SonarFigures* figures : command::starterSonars()) {
        SCOPED_TRACE(figures->name);
        const YAML::Node tasks = starter(*figures)["tasks"], sonar = tasks["sonar"]["properties"];
        if (figures->isGrid()) continue;
        const double longest = sonar["range"].as<double>(), range = longest / 3;
        const YAML::Node pulse = sonar["pulse"]["duration_us"];
        const double depth =
            std::max(longest / sonar["bin_count"].as<double>(), pulse ? pulse.as<double>() * 1497e-6 / 2 : 0);
        const double square_metres = range * sonar["beam_width_deg"].as<double>() * std::numbers::pi / 180 * depth;
        const YAML::Node receiver = tasks["receiver"]["properties"];
        const double gain = receiver["tvg"]["log_coefficient"].as<double>() * std::log10(range);
        const double body = 10 * std::log10(square_metres / std::numbers::pi) - 40 * std::log10(range) + gain;
        const YAML::Node white =
            receiver["code"] ? receiver["code"]["full_scale_db"] : tasks["fan"]["properties"]["reference_db"];
        EXPECT_NEAR(white.as<double>(), body + 10 * std::log10(std::log(100)) + figures->device->headroom_db, 0.51);
    }
    EXPECT_EQ(starter(sonar("oculus_m750d"))["tasks"]["receiver"]["properties"]["code"]["full_scale_db"].as<double>(),
              -40)
        << "10.1 m, 1 degree and 40 mm are 71 cm^2: -26.5 dB, less 20.1 dB with 20 log r, and 6.6 dB of speckle";
}

TEST(SonarsTest, TheEmulatorsAndTheirDeploymentsHaveTheFigures) {
    const SonarMode& oculus = device::figures(device::OculusModel::M750d).modes.front();
    const YAML::Node fan = deployed("hil_oculus.yml", "sonar::SonarTask");
    EXPECT_EQ(&device::figures(device::OculusModel::M750d), &sonar("oculus_m750d"));
    EXPECT_EQ(fan["frequency_khz"].as<double>(), oculus.frequency_khz);
    EXPECT_EQ(fan["field_of_view_deg"].as<double>(), oculus.field_of_view_deg);
    EXPECT_EQ(fan["beam_height_deg"].as<double>(), oculus.beam_height_deg);

    const YAML::Node grid = deployed("hil_3d15.yml", "sonar::Sonar3dTask");
    const SonarMode& low = sonar("sonar_3d_15").modes[0];
    EXPECT_EQ(device::Sonar3dDevice{}.longest_range, low.range_max);
    EXPECT_EQ(device::Sonar3dDevice{}.high_frequency_khz, sonar("sonar_3d_15").modes[1].frequency_khz);
    EXPECT_EQ(grid["frequency_khz"].as<double>(), low.frequency_khz);
    EXPECT_EQ(grid["horizontal"]["beam_count"].as<int>(), low.beam_count);
    EXPECT_EQ(grid["vertical"]["beam_count"].as<int>(), low.row_count);
    EXPECT_NEAR(grid["horizontal"]["field_of_view_deg"].as<double>() * (low.beam_count - 1) / low.beam_count,
                low.field_of_view_deg, 1e-5);
    EXPECT_NEAR(grid["vertical"]["field_of_view_deg"].as<double>() * (low.row_count - 1) / low.row_count,
                low.rows_field_of_view_deg, 1e-5);

    const YAML::Node head = deployed("hil_micron.yml", "sonar::ScanningSonarTask");
    EXPECT_EQ(head["beam_width_deg"].as<double>(), sonar("micron").modes[0].beam_width_deg);
    EXPECT_EQ(head["beam_height_deg"].as<double>(), sonar("micron").modes[0].beam_height_deg);
    EXPECT_EQ(head["frequency_khz"].as<double>(), sonar("micron").modes[0].frequency_khz);
    const YAML::Node scanner = deployed("hil_ping360.yml", "sonar::ScanningSonarTask");
    EXPECT_EQ(scanner["beam_width_deg"].as<double>(), sonar("ping360").modes[0].beam_width_deg);
    EXPECT_EQ(scanner["beam_height_deg"].as<double>(), sonar("ping360").modes[0].beam_height_deg);
    EXPECT_EQ(scanner["absorption"]["frequency_khz"].as<double>(), sonar("ping360").modes[0].frequency_khz);
    const YAML::Node sounder = deployed("hil_ping360.yml", "sonar::AltimeterTask");
    EXPECT_EQ(sounder["beam_width_deg"].as<double>(), sonar("ping1d").modes[0].beam_width_deg);
    EXPECT_EQ(sounder["absorption"]["frequency_khz"].as<double>(), sonar("ping1d").modes[0].frequency_khz);
    EXPECT_EQ(device::Ping1dConfig{}.max_range, sonar("ping1d").modes[0].range_max);
}

}  // namespace
}  // namespace insonify::sonars
