// Samples whose sonar has settings of earlier samples behind it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "tests/dataset/HarbourDeployment.hpp"
#include "tests/deployer/Command.hpp"

using namespace insonify::deployer;
using insonify::dataset::deployment;

namespace {

const std::string drawn_sweep = R"(seed: 3
poses:
  random: {count: 8, x: {uniform: [0, 20]}, y: {uniform: [-8, 0]}, z: -5.5, yaw_deg: {uniform: [-60, 30]}}
classes: {pile: pile_*, wreck: hull, rock: rock_*}
settings:
  sonar.imperfections.seed: {choice: [1, 2, 3]}
  sonar.imperfections.gain_error_db: {choice: [0, 2]}
  sonar.imperfections.focus_m: {choice: [4, 8]}
  sonar.range: {uniform: [15, 25]}
  sonar.beam_count: {choice: [16, 24]}
  sonar.frequency_khz: {uniform: [250, 350]}
  noise.seed: {choice: [5, 6]}
  receiver.tvg.log_coefficient: {uniform: [20, 40]}
  scene.water_surface: {choice: [0, 0, 0, 1]}
)";

const std::string imperfect_device = R"(
      frequency_khz: 300
      pulse: {bandwidth_khz: 5}
      beam_pattern: {receive: {azimuth: {weighting: taylor, width_deg: 3}}}
      imperfections: {phase_error_deg: 10, crosstalk_db: -30})";

/** Bytes of all files of a folder, by name. */
std::map<std::string, std::string> readAllFiles(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) files[entry.path().filename()] = readFile(entry.path());
    return files;
}

TEST(DrawnSettingsTest, SettingsInAnyOrderLeaveNothingInTheSonarForTheNextSample) {
    const std::string few_rows = "quality: {rows: 32, columns_per_beam: 1}";
    for (const std::string& sonar :
         {few_rows + "\n      speckle: {coherent: true}", few_rows, std::string("quality: {target_error: 0.2}")}) {
        const TestFolder folder;
        const std::string quality = "quality: {rows: 128, columns_per_beam: 1}";
        std::string text = deployment;
        writeFile(folder / "d.yml", text.replace(text.find(quality), quality.size(), sonar + imperfect_device));
        // Shadows are of a second simulation, which must have the same settings; one of the sonars suffices.
        writeFile(folder / "sweep.yml", drawn_sweep + (sonar == few_rows ? "annotations: {shadows: true}\n" : ""));
        const auto make = [&](const std::string& out, const std::string& shard) {
            return callInsonify(folder, {"dataset", "d.yml", "--sweep", "sweep.yml", "--format", "npz", "--out", out,
                                         "--shard", shard});
        };
        ASSERT_EQ(make("one", "0/1").code, 0) << sonar;
        for (int i = 0; i < 8; ++i)  // a process, and so a sonar, for each sample
            ASSERT_EQ(make("fresh", fmt::format("{}/8", i)).code, 0);
        EXPECT_TRUE(readAllFiles(folder / "one") == readAllFiles(folder / "fresh")) << sonar;
    }
}

}  // namespace
