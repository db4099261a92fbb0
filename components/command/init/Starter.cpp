#include "components/command/init/Starter.hpp"

#include <fmt/format.h>

#include <sstream>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/SoundSpeed.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/Embed.hpp"

INSONIFY_EMBED(insonify_starter_scene, INSONIFY_STARTER
               "/"
               "scene.glb")
INSONIFY_EMBED(insonify_starter_script, INSONIFY_STARTER
               "/"
               "make_scene.py")
INSONIFY_EMBED(insonify_starter_pass, INSONIFY_STARTER
               "/"
               "pass.csv")
INSONIFY_EMBED(insonify_starter_hover, INSONIFY_STARTER
               "/"
               "hover.csv")
INSONIFY_EMBED(insonify_starter_fan, INSONIFY_STARTER
               "/"
               "fan.yml")
INSONIFY_EMBED(insonify_starter_scanning, INSONIFY_STARTER
               "/"
               "scanning.yml")
INSONIFY_EMBED(insonify_starter_grid, INSONIFY_STARTER
               "/"
               "grid.yml")
INSONIFY_EMBED(insonify_starter_sweep, INSONIFY_STARTER
               "/"
               "sweep.yml")

namespace insonify::command {

using framework::embedded, sonars::SonarFigures, sonars::SonarMode, sonars::SonarStarter;

namespace {

const acoustics::Water water{.temperature_celsius = 12, .salinity_psu = 35, .depth = 8, .ph = 8.1};

/** Returns the speed of sound as pings state it [m/s]. */
double speedOfSound() { return static_cast<double>(static_cast<float>(acoustics::soundSpeed(water))); }

/** Returns the duration of a tone with the maker's range resolution [s]. */
double toneSeconds(const SonarFigures& sonar) { return 2 * sonar.modes.front().range_resolution / speedOfSound(); }

/** Returns the template for a sonar of its kind. */
std::string_view templateFor(const SonarFigures& sonar) {
    if (sonar.isGrid()) return embedded(insonify_starter_grid_begin, insonify_starter_grid_end);
    if (sonar.isFan()) return embedded(insonify_starter_fan_begin, insonify_starter_fan_end);
    return embedded(insonify_starter_scanning_begin, insonify_starter_scanning_end);
}

/** Aligns comments behind values in one column, where they fit. */
std::string aligned(const std::string& text) {
    constexpr size_t column = 44;
    std::string all, line;
    for (std::istringstream lines(text); std::getline(lines, line);) {
        const size_t hash = line.find("  # ");
        if (hash != std::string::npos && line.find_first_not_of(' ') < hash && hash + 2 < column)
            line.insert(hash, column - hash - 2, ' ');
        all += line + "\n";
    }
    return all;
}

std::string absorptionBlock(double frequency_khz, double db_per_m) {
    constexpr double highest_khz = 1000;  // limit of Francois and Garrison's law
    if (frequency_khz > highest_khz)
        return fmt::format("{{db_per_m: {:.2f}}}  # one way; laws of absorption are for up to {:g} kHz", db_per_m,
                           highest_khz);
    return "{law: francois_garrison}";
}

/** Returns a chirp or a tone with the maker's resolution: ACOUSTICS.md 5.10. */
std::string pulseBlock(const SonarFigures& sonar) {
    constexpr double chirp_width = 0.886;
    const double seconds = toneSeconds(sonar);
    const std::string pulse = sonar.starter->sends_tones
                                  ? fmt::format("duration_us: {:.3g}", 1e6 * seconds)
                                  : fmt::format("bandwidth_khz: {:.3g}", 1e-3 * chirp_width / seconds);
    return fmt::format("{{{}}}  # resolves {:.3g} mm", pulse, 1e3 * sonar.modes.front().range_resolution);
}

/** Returns the bandwidth of the noise behind the matched filter, 1 / duration of the pulse [kHz]. */
double noiseBandwidth(const SonarFigures& sonar) {
    constexpr double of_chirps = 30;  // no data sheet has their duration
    return sonar.starter->sends_tones ? 1e-3 / toneSeconds(sonar) : of_chirps;
}

}  // namespace

std::vector<const SonarFigures*> starterSonars() {
    std::vector<const SonarFigures*> all;
    for (const SonarFigures& sonar : sonars::sonars())
        if (sonar.starter) all.push_back(&sonar);
    return all;
}

const SonarFigures& starterSonar(const std::string& name) {
    std::vector<std::string> known;
    for (const SonarFigures* sonar : starterSonars()) {
        if (sonar->name == name) return *sonar;
        known.push_back(sonar->name);
    }
    throw types::ConfigError("", "--sonar", "there is no sonar " + name + "; " + framework::suggestion(name, known));
}

double starterRange(const SonarFigures& sonar) {
    return sonar.starter->bin_count * 1e-6 * sonar.starter->bin_us * speedOfSound();
}

std::string starterDeployment(const SonarFigures& sonar) {
    const SonarMode& mode = sonar.modes.front();
    const SonarStarter& starter = *sonar.starter;
    const double db_per_m = acoustics::francoisGarrison(mode.frequency_khz, water);
    using fmt::arg;
    return aligned(fmt::format(
        fmt::runtime(templateFor(sonar)), arg("name", sonar.name), arg("title", sonar.title),
        arg("source", starter.note), arg("summary", starter.summary), arg("frequency", mode.frequency_khz),
        arg("range", fmt::format("{:.10g}", starterRange(sonar))), arg("range_min", mode.range_min),
        arg("range_max", mode.range_max), arg("bins", starter.bin_count), arg("bin_us", starter.bin_us),
        arg("width", mode.beam_width_deg), arg("height", mode.beam_height_deg), arg("period", starter.period),
        arg("columns", starter.columns_per_beam), arg("beams", mode.beam_count), arg("fov", mode.field_of_view_deg),
        arg("spacing", mode.field_of_view_deg / mode.beam_count), arg("pitch", starter.pitch_deg),
        arg("step", mode.step_deg), arg("speed", mode.step_deg / starter.period),
        arg("turn", mode.step_deg > 0 ? static_cast<int>(90 / mode.step_deg) : 0), arg("rows", mode.row_count),
        arg("rows_fov", mode.rows_field_of_view_deg), arg("absorption", fmt::format("{:.2f}", db_per_m)),
        arg("absorption_block", absorptionBlock(mode.frequency_khz, db_per_m)), arg("pulse", pulseBlock(sonar)),
        arg("noise_note",
            starter.sends_tones ? "" : ", 33 us as a guess: a matched filter passes no more noise of a chirp"),
        arg("noise_khz", fmt::format("{:.3g}", noiseBandwidth(sonar))), arg("reference", starter.reference_db)));
}

std::vector<StarterFile> starterFiles(const SonarFigures& sonar) {
    std::vector<StarterFile> files{
        {"scene.glb", embedded(insonify_starter_scene_begin, insonify_starter_scene_end)},
        {"make_scene.py", embedded(insonify_starter_script_begin, insonify_starter_script_end)},
        {"pass.csv", embedded(insonify_starter_pass_begin, insonify_starter_pass_end)},
        {"hover.csv", embedded(insonify_starter_hover_begin, insonify_starter_hover_end)}};
    if (sonar.isFan())
        files.push_back({"sweep.yml", embedded(insonify_starter_sweep_begin, insonify_starter_sweep_end)});
    return files;
}

}  // namespace insonify::command
