#include <fmt/format.h>

#include "components/command/Starter.hpp"
#include "components/framework/ConfigReader.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

// Numbers and lengths of bins, columns, pitch and the level of white are chosen for the starter's scene.
const std::vector<SonarPreset> presets{
    {.name = "oculus_m750d",
     .title = "Blueprint Subsea Oculus M750d, low frequency",
     .source =
         "Blueprint Subsea, Oculus M-series data sheet: 750 kHz, 130 x 20 deg, 512 beams of 1.0 deg, 0.1 to 120 m, "
         "range resolution 4 mm",
     .summary = "130 x 20 degrees, 512 beams at 750 kHz",
     .frequency_khz = 750,
     .range_min = 0.1,
     .range_max = 120,
     .bin_count = 750,
     .bin_us = 27,
     .beam_width_deg = 1,
     .beam_height_deg = 20,
     .range_resolution = 0.004,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 512,
     .field_of_view_deg = 130,
     .pitch_deg = 12,
     .reference_db = -16},
    {.name = "oculus_m1200d",
     .title = "Blueprint Subsea Oculus M1200d, low frequency",
     .source =
         "Blueprint Subsea, Oculus M-series data sheet: 1200 kHz, 130 x 20 deg, 512 beams of 0.6 deg, 0.1 to 40 m, "
         "range resolution 2.5 mm",
     .summary = "130 x 20 degrees, 512 beams at 1200 kHz",
     .frequency_khz = 1200,
     .range_min = 0.1,
     .range_max = 40,
     .bin_count = 900,
     .bin_us = 15,
     .beam_width_deg = 0.6,
     .beam_height_deg = 20,
     .range_resolution = 0.0025,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 512,
     .field_of_view_deg = 130,
     .pitch_deg = 12,
     .reference_db = -21},
    {.name = "gemini_720is",
     .title = "Tritech Gemini 720is",
     .source = "Tritech, Gemini 720is manual 0703-SOM-00002: 720 kHz, 120 x 20 deg, beams of 1.0 deg 0.25 deg "
               "apart; its data sheet: 512 beams, 0.2 to 120 m, range resolution 8 mm",
     .summary = "120 x 20 degrees, 512 beams at 720 kHz",
     .frequency_khz = 720,
     .range_min = 0.2,
     .range_max = 120,
     .bin_count = 750,
     .bin_us = 27,
     .beam_width_deg = 1,
     .beam_height_deg = 20,
     .range_resolution = 0.008,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 512,
     .field_of_view_deg = 120,
     .pitch_deg = 12,
     .reference_db = -17},
    {.name = "m3",
     .title = "Kongsberg Mesotech M3, imaging",
     .source = "Kongsberg Mesotech, M3 Sonar data sheet: 500 kHz, 120 x 30 deg, 256 beams of 1.6 deg, 0.2 to 150 m, "
               "range resolution 1 cm",
     .summary = "120 x 30 degrees, 256 beams at 500 kHz",
     .frequency_khz = 500,
     .range_min = 0.2,
     .range_max = 150,
     .bin_count = 600,
     .bin_us = 34,
     .beam_width_deg = 1.6,
     .beam_height_deg = 30,
     .range_resolution = 0.01,
     .period_s = 0.1,
     .columns_per_beam = 6,
     .beam_count = 256,
     .field_of_view_deg = 120,
     .pitch_deg = 15,
     .reference_db = -14},
    {.name = "blueview_p900_130",
     .title = "Teledyne BlueView P900-130",
     .source = "Teledyne BlueView, P900 series data sheet: 900 kHz, 130 x 20 deg, 768 beams of 1 deg 0.18 deg apart, "
               "2 to 60 m (at most 100), range resolution 2.54 cm, 15 Hz",
     .summary = "130 x 20 degrees, 768 beams at 900 kHz",
     .frequency_khz = 900,
     .range_min = 0.5,
     .range_max = 100,
     .bin_count = 1200,
     .bin_us = 17,
     .beam_width_deg = 1,
     .beam_height_deg = 20,
     .range_resolution = 0.0254,
     .period_s = 0.1,
     .columns_per_beam = 2,
     .beam_count = 768,
     .field_of_view_deg = 130,
     .pitch_deg = 12,
     .reference_db = -18},
    {.name = "aris_3000",
     .title = "Sound Metrics ARIS Explorer 3000, identification mode",
     .source = "Sound Metrics, ARIS Explorer 3000 data sheet: 3.0 MHz, 30 x 15 deg, 128 beams of 0.25 deg, 0.7 to 5 m, "
               "downrange resolution 3 mm, 15 Hz",
     .summary = "30 x 15 degrees, 128 beams at 3 MHz",
     .frequency_khz = 3000,
     .range_min = 0.7,
     .range_max = 5,
     .bin_count = 1100,
     .bin_us = 3,
     .beam_width_deg = 0.25,
     .beam_height_deg = 15,
     .range_resolution = 0.003,
     .period_s = 0.1,
     .columns_per_beam = 4,
     .beam_count = 128,
     .field_of_view_deg = 30,
     .pitch_deg = 48,
     .reference_db = -51,
     .sends_tones = true},
    {.name = "sonar_3d_15",
     .title = "Water Linked Sonar 3D-15, navigation mode",
     .source = "Water Linked, Sonar 3D-15 documentation: 1.2 MHz, 90 x 40 deg, 15 m, range images of 256 x 64; "
               "width of beams and range resolution are guesses",
     .summary = "90 x 40 degrees, 256 x 64 beams at 1200 kHz",
     .frequency_khz = 1200,
     .range_min = 0.2,
     .range_max = 15,
     .bin_count = 900,
     .bin_us = 11,
     .beam_width_deg = 0.6,
     .beam_height_deg = 0.6,
     .range_resolution = 0.0075,
     .period_s = 0.2,
     .columns_per_beam = 4,
     .beam_count = 256,
     .field_of_view_deg = 90,
     .pitch_deg = 15,
     .row_count = 64,
     .rows_field_of_view_deg = 40},
    {.name = "ping360",
     .title = "Blue Robotics Ping360",
     .source = "Blue Robotics, Ping360 technical details: 750 kHz, 2 x 25 deg, steps of 0.9 deg, 1200 samples, "
               "0.75 to 50 m; pulses as its viewer sets them, 8 us per metre of range",
     .summary = "a beam of 2 x 25 degrees at 750 kHz",
     .frequency_khz = 750,
     .range_min = 0.75,
     .range_max = 50,
     .bin_count = 1200,
     .bin_us = 11,
     .beam_width_deg = 2,
     .beam_height_deg = 25,
     .range_resolution = 0.118,
     .period_s = 0.05,
     .columns_per_beam = 6,
     .step_deg = 0.9,
     .sends_tones = true},
    {.name = "micron",
     .title = "Tritech Micron",
     .source = "Tritech, Micron data sheet: CHIRP 650 to 750 kHz, 3 x 35 deg, steps of 0.45 to 1.8 deg, 0.3 to 75 m, "
               "range resolution 7.5 mm",
     .summary = "a beam of 3 x 35 degrees at 700 kHz",
     .frequency_khz = 700,
     .range_min = 0.3,
     .range_max = 75,
     .bin_count = 400,
     .bin_us = 34,
     .beam_width_deg = 3,
     .beam_height_deg = 35,
     .range_resolution = 0.0075,
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

}  // namespace insonify::command
