#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insonify::command {

/** A sonar by its public data sheet, ready for a deployment. */
struct SonarPreset {
    const char* name;     ///< "oculus_m750d"
    const char* title;    ///< Maker and model.
    const char* source;   ///< Sources of the values, and the values without a source.
    const char* summary;  ///< "130 x 20 degrees, 512 beams at 750 kHz"
    double frequency_khz;
    double range_min, range_max;             ///< Limits by the maker, at this frequency [m].
    int bin_count, bin_us;                   ///< Whole microseconds, one way.
    double beam_width_deg, beam_height_deg;  ///< Half power, one way.
    double range_resolution;                 ///< Range resolution of its pulse, by the maker [m].
    double period_s;                         ///< Between pings.
    int columns_per_beam;
    int beam_count = 1;                 ///< More than one: a fan.
    double field_of_view_deg = 0;       ///< Field of view of a fan.
    double pitch_deg = 0;               ///< Pitch of the mount, down; of a fan.
    double reference_db = 0;            ///< Level of white in the pictures of a fan.
    double step_deg = 0;                ///< Step of a scanning head.
    int row_count = 1;                  ///< More than one: a grid of beams with this many rows.
    double rows_field_of_view_deg = 0;  ///< Field of view of a grid, in elevation.
    bool sends_tones = false;           ///< Else chirps.
    double range() const;               ///< Range of the bins in the starter's water [m].
    bool isGrid() const { return row_count > 1; }
    bool isFan() const { return beam_count > 1 && !isGrid(); }
};

/** Every preset; the first is the default of `init`. */
const std::vector<SonarPreset>& sonarPresets();
/** Throws types::ConfigError when there is no preset of that name. */
const SonarPreset& sonarPreset(const std::string& name);

/** Returns the deployment for a sonar in the starter's scene, with comments. */
std::string starterDeployment(const SonarPreset& preset);

/** A file embedded in the command: scene.glb, make_scene.py, pass.csv, hover.csv or sweep.yml. */
struct StarterFile {
    const char* name;
    std::string_view bytes;
};
/** Returns the files next to a sonar's deployment. A sweep for data sets belongs to fans alone. */
std::vector<StarterFile> starterFiles(const SonarPreset& preset);

}  // namespace insonify::command
