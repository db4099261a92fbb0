#include <fmt/format.h>

#include "components/deployer/Starter.hpp"
#include "components/framework/ConfigReader.hpp"

namespace insonify::deployer {

namespace {

// Ranges are as deployed in the starter's scene, at a sound speed of 1496 m/s, that of its water.
const std::vector<SonarPreset> presets{
    {.name = "oculus_m750d",
     .title = "Blueprint Subsea Oculus M750d, low frequency",
     .source = "Blueprint Subsea, Oculus M-series data sheet: 750 kHz, 130 x 20 deg, 512 beams of 1.0 deg, 120 m",
     .summary = "130 x 20 degrees, 512 beams at 750 kHz",
     .frequency_khz = 750,
     .range = 30.2,
     .range_min = 0.1,
     .range_max = 120,
     .bin_count = 750,
     .bin_us = 27,
     .beam_width_deg = 1,
     .beam_height_deg = 20,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 512,
     .field_of_view_deg = 130,
     .pitch_deg = 12},
    {.name = "oculus_m1200d",
     .title = "Blueprint Subsea Oculus M1200d, low frequency",
     .source = "Blueprint Subsea, Oculus M-series data sheet: 1200 kHz, 130 x 20 deg, 512 beams of 0.6 deg, 40 m",
     .summary = "130 x 20 degrees, 512 beams at 1200 kHz",
     .frequency_khz = 1200,
     .range = 20.2,
     .range_min = 0.1,
     .range_max = 40,
     .bin_count = 900,
     .bin_us = 15,
     .beam_width_deg = 0.6,
     .beam_height_deg = 20,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 512,
     .field_of_view_deg = 130,
     .pitch_deg = 12},
    {.name = "gemini_720is",
     .title = "Tritech Gemini 720is",
     .source = "Tritech, Gemini 720is manual 0703-SOM-00002: 720 kHz, 120 x 20 deg, beams of 1.0 deg 0.25 deg "
               "apart; its data sheet: 0.2 to 120 m",
     .summary = "120 x 20 degrees, 512 beams at 720 kHz",
     .frequency_khz = 720,
     .range = 30.2,
     .range_min = 0.2,
     .range_max = 120,
     .bin_count = 750,
     .bin_us = 27,
     .beam_width_deg = 1,
     .beam_height_deg = 20,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 512,
     .field_of_view_deg = 120,
     .pitch_deg = 12},
    {.name = "m3",
     .title = "Kongsberg Mesotech M3, imaging",
     .source = "Kongsberg Mesotech, M3 Sonar data sheet: 500 kHz, 120 x 30 deg, 256 beams of 1.6 deg, 0.2 to 150 m",
     .summary = "120 x 30 degrees, 256 beams at 500 kHz",
     .frequency_khz = 500,
     .range = 30.5,
     .range_min = 0.2,
     .range_max = 150,
     .bin_count = 600,
     .bin_us = 34,
     .beam_width_deg = 1.6,
     .beam_height_deg = 30,
     .period_s = 0.1,
     .columns_per_beam = 6,
     .beam_count = 256,
     .field_of_view_deg = 120,
     .pitch_deg = 15},
    {.name = "ping360",
     .title = "Blue Robotics Ping360",
     .source = "Blue Robotics, Ping360 technical details: 750 kHz, 2 x 25 deg, steps of 0.9 deg, 1200 samples, "
               "0.75 to 50 m",
     .summary = "a beam of 2 x 25 degrees at 750 kHz",
     .frequency_khz = 750,
     .range = 19.7,
     .range_min = 0.75,
     .range_max = 50,
     .bin_count = 1200,
     .bin_us = 11,
     .beam_width_deg = 2,
     .beam_height_deg = 25,
     .period_s = 0.05,
     .columns_per_beam = 6,
     .step_deg = 0.9},
    {.name = "micron",
     .title = "Tritech Micron",
     .source = "Tritech, Micron data sheet: CHIRP 650 to 750 kHz, 3 x 35 deg, steps of 0.45 to 1.8 deg, 0.3 to 75 m",
     .summary = "a beam of 3 x 35 degrees at 700 kHz",
     .frequency_khz = 700,
     .range = 20.3,
     .range_min = 0.3,
     .range_max = 75,
     .bin_count = 400,
     .bin_us = 34,
     .beam_width_deg = 3,
     .beam_height_deg = 35,
     .period_s = 0.05,
     .columns_per_beam = 8,
     .step_deg = 1.8}};

}  // namespace

const std::vector<SonarPreset>& sonarPresets() { return presets; }

const SonarPreset& sonarPreset(const std::string& name) {
    std::vector<std::string> known;
    for (const SonarPreset& preset : sonarPresets()) {
        if (preset.name == name) return preset;
        known.emplace_back(preset.name);
    }
    throw types::ConfigError("", "--sonar", "there is no sonar " + name + "; " + framework::suggestion(name, known));
}

}  // namespace insonify::deployer
