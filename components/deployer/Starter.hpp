#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace insonify::deployer {

/** A sonar as its public data sheet describes it, ready for a deployment. */
struct SonarPreset {
    const char* name;     ///< "oculus_m750d"
    const char* title;    ///< Maker and model.
    const char* source;   ///< Where the figures are from, and which are not from there.
    const char* summary;  ///< "130 x 20 degrees, 512 beams at 750 kHz"
    double frequency_khz;
    double range, range_min, range_max;      ///< As deployed; as the maker has it at this frequency [m].
    int bin_count, bin_us;                   ///< Whole microseconds, one way, that reach `range` and no further.
    double beam_width_deg, beam_height_deg;  ///< Half power, one way.
    double range_resolution;                 ///< Of its pulse, as the maker has it [m].
    double period_s;                         ///< From ping to ping.
    int columns_per_beam;
    int beam_count = 1;                 ///< More than one: a fan.
    double field_of_view_deg = 0;       ///< Of a fan.
    double pitch_deg = 0;               ///< Of the mount, down; of a fan.
    double step_deg = 0;                ///< Of a scanning head.
    int row_count = 1;                  ///< More than one: a grid of beams, so many above each other.
    double rows_field_of_view_deg = 0;  ///< Of a grid, in elevation.
    bool sends_tones = false;           ///< Else chirps.
    bool isGrid() const { return row_count > 1; }
    bool isFan() const { return beam_count > 1 && !isGrid(); }
};

/** Every preset; the first is what `init` takes when none is named. */
const std::vector<SonarPreset>& sonarPresets();
/** Throws types::ConfigError where there is none of that name. */
const SonarPreset& sonarPreset(const std::string& name);

/** The deployment for a sonar in the starter's scene, with comments. */
std::string starterDeployment(const SonarPreset& preset);

/** A file that travels in the command: scene.glb, make_scene.py, pass.csv or hover.csv. */
struct StarterFile {
    const char* name;
    std::string_view bytes;
};
const std::vector<StarterFile>& starterFiles();

}  // namespace insonify::deployer
