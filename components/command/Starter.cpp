#include "components/command/Starter.hpp"

#include <fmt/format.h>

#include <sstream>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/SoundSpeed.hpp"

// The files are embedded in the command, so that an installed command needs no path to them.
#define INSONIFY_EMBED(symbol, file)                                                                     \
    __asm__(".pushsection .rodata\n.balign 16\n" #symbol "_begin:\n.incbin \"" INSONIFY_STARTER "/" file \
            "\"\n" #symbol "_end:\n.byte 0\n.popsection\n");                                             \
    extern "C" const char symbol##_begin[], symbol##_end[];

INSONIFY_EMBED(insonify_starter_scene, "scene.glb")
INSONIFY_EMBED(insonify_starter_script, "make_scene.py")
INSONIFY_EMBED(insonify_starter_pass, "pass.csv")
INSONIFY_EMBED(insonify_starter_hover, "hover.csv")
INSONIFY_EMBED(insonify_starter_fan, "fan.yml")
INSONIFY_EMBED(insonify_starter_scanning, "scanning.yml")
INSONIFY_EMBED(insonify_starter_grid, "grid.yml")
INSONIFY_EMBED(insonify_starter_sweep, "sweep.yml")

namespace insonify::command {

namespace {

std::string_view between(const char* begin, const char* end) { return {begin, static_cast<size_t>(end - begin)}; }

const acoustics::Water water{.temperature_celsius = 12, .salinity_psu = 35, .depth = 8, .ph = 8.1};

/** Returns the speed of sound as pings state it [m/s]. */
double speedOfSound() { return static_cast<double>(static_cast<float>(acoustics::soundSpeed(water))); }

/** Returns the duration of a tone with the maker's range resolution [s]. */
double toneSeconds(const SonarPreset& preset) { return 2 * preset.range_resolution / speedOfSound(); }

/** Returns the template for a sonar of its kind. */
std::string_view templateFor(const SonarPreset& preset) {
    if (preset.isGrid()) return between(insonify_starter_grid_begin, insonify_starter_grid_end);
    if (preset.isFan()) return between(insonify_starter_fan_begin, insonify_starter_fan_end);
    return between(insonify_starter_scanning_begin, insonify_starter_scanning_end);
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

std::string absorptionBlock(const SonarPreset& preset, double db_per_m) {
    constexpr double highest_khz = 1000;  // limit of Francois and Garrison's law
    if (preset.frequency_khz > highest_khz)
        return fmt::format("{{db_per_m: {:.2f}}}  # one way; laws of absorption are for up to {:g} kHz", db_per_m,
                           highest_khz);
    return "{law: francois_garrison}";
}

/** Returns a chirp or a tone with the maker's resolution: ACOUSTICS.md 5.10. */
std::string pulseBlock(const SonarPreset& preset) {
    constexpr double chirp_width = 0.886;
    const double seconds = toneSeconds(preset);
    const std::string pulse = preset.sends_tones ? fmt::format("duration_us: {:.3g}", 1e6 * seconds)
                                                 : fmt::format("bandwidth_khz: {:.3g}", 1e-3 * chirp_width / seconds);
    return fmt::format("{{{}}}  # resolves {:.3g} mm", pulse, 1e3 * preset.range_resolution);
}

/** Returns the bandwidth of the noise behind the matched filter, 1 / duration of the pulse [kHz]. */
double noiseBandwidth(const SonarPreset& preset) {
    constexpr double of_chirps = 30;  // no data sheet has their duration
    return preset.sends_tones ? 1e-3 / toneSeconds(preset) : of_chirps;
}

}  // namespace

double SonarPreset::range() const { return bin_count * 1e-6 * bin_us * speedOfSound(); }

std::string starterDeployment(const SonarPreset& preset) {
    const double db_per_m = acoustics::francoisGarrison(preset.frequency_khz, water);
    using fmt::arg;
    return aligned(fmt::format(
        fmt::runtime(templateFor(preset)), arg("name", preset.name), arg("title", preset.title),
        arg("source", preset.source), arg("summary", preset.summary), arg("frequency", preset.frequency_khz),
        arg("range", fmt::format("{:.10g}", preset.range())), arg("range_min", preset.range_min),
        arg("range_max", preset.range_max), arg("bins", preset.bin_count), arg("bin_us", preset.bin_us),
        arg("width", preset.beam_width_deg), arg("height", preset.beam_height_deg), arg("period", preset.period_s),
        arg("columns", preset.columns_per_beam), arg("beams", preset.beam_count), arg("fov", preset.field_of_view_deg),
        arg("spacing", preset.field_of_view_deg / preset.beam_count), arg("pitch", preset.pitch_deg),
        arg("step", preset.step_deg), arg("speed", preset.step_deg / preset.period_s),
        arg("turn", preset.step_deg > 0 ? static_cast<int>(90 / preset.step_deg) : 0), arg("rows", preset.row_count),
        arg("rows_fov", preset.rows_field_of_view_deg), arg("absorption", fmt::format("{:.2f}", db_per_m)),
        arg("absorption_block", absorptionBlock(preset, db_per_m)), arg("pulse", pulseBlock(preset)),
        arg("noise_note",
            preset.sends_tones ? "" : ", 33 us as a guess: a matched filter passes no more noise of a chirp"),
        arg("noise_khz", fmt::format("{:.3g}", noiseBandwidth(preset))), arg("reference", preset.reference_db)));
}

std::vector<StarterFile> starterFiles(const SonarPreset& preset) {
    std::vector<StarterFile> files{
        {"scene.glb", between(insonify_starter_scene_begin, insonify_starter_scene_end)},
        {"make_scene.py", between(insonify_starter_script_begin, insonify_starter_script_end)},
        {"pass.csv", between(insonify_starter_pass_begin, insonify_starter_pass_end)},
        {"hover.csv", between(insonify_starter_hover_begin, insonify_starter_hover_end)}};
    if (preset.isFan())
        files.push_back({"sweep.yml", between(insonify_starter_sweep_begin, insonify_starter_sweep_end)});
    return files;
}

}  // namespace insonify::command
