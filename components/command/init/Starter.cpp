#include "components/command/init/Starter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <sstream>
#include <utility>

#include "components/acoustics/Absorption.hpp"
#include "components/acoustics/AmbientNoise.hpp"
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

using framework::embedded, sonars::SonarDevice, sonars::SonarFigures, sonars::SonarMode, sonars::SonarStarter;

namespace {

const acoustics::Water water{.temperature_celsius = 12, .salinity_psu = 35, .depth = 8, .ph = 8.1};

constexpr double wind_m_s = 5;  ///< Above the water, which makes its noise.

/** Returns the speed of sound as pings state it [m/s]. */
double speedOfSound() { return static_cast<double>(static_cast<float>(acoustics::soundSpeed(water))); }

/** Returns the duration of the device's tone, or of a tone with the maker's range resolution [s]. */
double toneSeconds(const SonarFigures& sonar) {
    if (sonar.device->pulse_us > 0) return 1e-6 * sonar.device->pulse_us;
    return 2 * sonar.modes.front().range_resolution / speedOfSound();
}

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

/** Returns a chirp or a tone with the maker's resolution or the device's duration: ACOUSTICS.md 5.10. */
std::string pulseBlock(const SonarFigures& sonar) {
    constexpr double chirp_width = 0.886;
    const double seconds = toneSeconds(sonar);
    const std::string pulse = sonar.starter->sends_tones
                                  ? fmt::format("duration_us: {:.3g}", 1e6 * seconds)
                                  : fmt::format("bandwidth_khz: {:.3g}", 1e-3 * chirp_width / seconds);
    return fmt::format("{{{}}}  # resolves {:.3g} mm", pulse, 1e3 * seconds * speedOfSound() / 2);
}

/** Returns a block of the keys whose values are not 0: "{gain_error_db: 1, phase_error_deg: 5}"; empty if all are. */
std::string writeBlock(std::initializer_list<std::pair<const char*, double>> values) {
    std::string block;
    for (const auto& [key, value] : values)
        if (value != 0) block += fmt::format("{}{}: {:g}", block.empty() ? "" : ", ", key, value);
    return block.empty() ? block : "{" + block + "}";
}

/** Returns a line of a task's properties, or nothing where the block is empty. */
std::string writeLine(const char* key, const std::string& block, const std::string& comment = "") {
    return block.empty() ? "" : fmt::format("      {}: {}{}\n", key, block, comment.empty() ? "" : "  # " + comment);
}

/** Returns the errors of this device's elements and beams. */
std::string errorBlock(const SonarDevice& device) {
    return writeBlock({{"gain_error_db", device.gain_error_db},
                       {"phase_error_deg", device.phase_error_deg},
                       {"beam_gain_error_db", device.beam_gain_error_db}});
}

/** Returns the speckle of a sonar whose echoes interfere. */
std::string speckleLine(const SonarDevice& device) {
    if (device.scatterers == 0) return "";
    return writeLine("speckle", fmt::format("{{coherent: true, scatterers_per_cell: {:g}}}", device.scatterers),
                     "echoes interfere: the same view has the same grain");
}

/** Returns the speckle that the noise task draws, where the sonar's echoes do not interfere, and its filter. */
std::string noiseLines(const SonarDevice& device) {
    return writeLine("speckle", device.scatterers > 0 ? "" : "{law: rayleigh}") +
           writeLine("filter",
                     writeBlock({{"looks", device.looks == 1 ? 0 : device.looks},
                                 {"correlation_bins", device.correlation_bins},
                                 {"correlation_beams", device.correlation_beams}}),
                     "noise of neighbours is correlated");
}

/** Returns the bandwidth of the noise behind the matched filter, 1 / duration of the pulse [kHz]. */
double noiseBandwidth(const SonarFigures& sonar) {
    constexpr double of_chirps = 30;  // no data sheet has their duration
    return sonar.starter->sends_tones ? 1e-3 / toneSeconds(sonar) : of_chirps;
}

/** Returns the range for which gain and noise are set: a third of that of the bins [m]. */
double referenceRange(const SonarFigures& sonar) { return starterRange(sonar) / 3; }

double absorptionDb(const SonarFigures& sonar) {
    return acoustics::francoisGarrison(sonar.modes.front().frequency_khz, water);
}

/** Returns the level of white [dB], in whole numbers. A white body faces the sonar and scatters all sound by Lambert's
 *  law, 1 / pi for each square metre of the cell of beam and bin (or tone, if longer) at that range. By the exponential
 *  law of speckle of one look, exp(-x) = 0.01, it exceeds white in one of a hundred bins. */
double whiteDb(const SonarFigures& sonar) {
    const double range = referenceRange(sonar), bin = 1e-6 * sonar.starter->bin_us;
    const double depth = std::max(bin, toneSeconds(sonar) / 2) * speedOfSound();
    const double cell = range * sonar.modes.front().beam_width_deg * std::numbers::pi / 180 * depth;
    return std::round(10 * std::log10(cell / std::numbers::pi * std::log(100)) +
                      (sonar.device->tvg - 40) * std::log10(range) + sonar.device->headroom_db);
}

/** Returns the source level with which the noise has the device's median below white at that range [dB], in whole
 *  numbers. */
double sourceLevelDb(const SonarFigures& sonar) {
    const SonarDevice& device = *sonar.device;
    const double range = referenceRange(sonar), median = 10 * std::log10(std::log(2));
    const double noise = acoustics::coatesSpectrumDb(sonar.modes.front().frequency_khz, wind_m_s, 0.5) +
                         10 * std::log10(1e3 * noiseBandwidth(sonar)) - device.directivity_index_db + median;
    const double gain = device.tvg * std::log10(range) + 2 * absorptionDb(sonar) * range;
    return std::round(noise + gain - whiteDb(sonar) - device.noise_db);
}

/** Returns the codes of the device; nothing where its samples are none. */
std::string codeLines(const SonarFigures& sonar) {
    const SonarDevice& device = *sonar.device;
    if (device.code_bits == 0) return "";
    const std::string law = device.gamma > 0 ? fmt::format("law: sqrt, gamma: {:g}", device.gamma)
                                             : fmt::format("law: log, dynamic_range_db: {:g}", device.dynamic_range_db);
    return "      output: code\n" +
           writeLine("code",
                     fmt::format("{{bits: {}, {}, full_scale_db: {:g}}}", device.code_bits, law, whiteDb(sonar)),
                     fmt::format("what an operator's gain sets: white is {}a white body at {:.2g} m",
                                 device.headroom_db == 0 ? "" : fmt::format("{:g} dB above ", device.headroom_db),
                                 referenceRange(sonar)));
}

/** Returns how pictures show the samples. */
std::string pictureKeys(const SonarFigures& sonar) {
    if (sonar.device->code_bits > 0) return fmt::format("scale: code, code_bits: {}", sonar.device->code_bits);
    return fmt::format("dynamic_range_db: 45, reference_db: {:g}", whiteDb(sonar));
}

/** Returns a comment for each document, with what it gives. */
std::string sourceLines(const SonarFigures& sonar) {
    std::string lines = "# From where its figures are:\n";
    for (const sonars::SonarSource& source : sonar.sources)
        lines += fmt::format("#   {}: {} ({})\n", fmt::join(source.gives, ", "), source.document, source.read);
    return lines;
}

constexpr double floor_z = -8, pass_z = -4.4;    // of the scene and of pass.csv [m]
constexpr double mount_x = 0.4, mount_z = -0.2;  // of the templates [m]
constexpr double degree = std::numbers::pi / 180;

/** The floor that a fan sees from a height: slant range where it begins, and from where to where it is ahead [m]. */
struct FloorInView {
    double begins, from, to;
};
FloorInView seeFloor(const SonarFigures& sonar, double height) {
    const SonarMode& mode = sonar.modes.front();
    const double half = std::max(mode.beam_height_deg, mode.rows_field_of_view_deg) / 2;
    const double lower = (sonar.starter->pitch_deg + half) * degree, upper = (sonar.starter->pitch_deg - half) * degree;
    return {height / std::sin(lower), height / std::tan(lower), height / std::tan(upper)};
}

/** Where the vehicle flies, and which objects the sweep places in its view; in YAML. */
struct Course {
    std::string vehicle, heights, objects;
};

/** Returns the course for a sonar: that of pass.csv, or, where the floor then begins beyond half of its range, one so
 *  near the floor that it begins at 0.6 of it. */
Course planCourse(const SonarFigures& sonar) {
    constexpr double too_far = 0.5, near = 0.6, spread = 0.12;  // shares of the range, and of the height
    const double range = starterRange(sonar), pass = pass_z + mount_z - floor_z, begins = seeFloor(sonar, pass).begins;
    if (begins <= too_far * range)
        return {"{file: pass.csv}  # north at 0.6 m/s, 3.5 m above the floor", "[-5.5, -4]",
                "names: [tire_*], count: [1, 3], x: [4, 18], y: [-8, 6]"};
    const double height = near * range / begins * pass, z = floor_z - mount_z + height, drawn = spread * height;
    const double from = seeFloor(sonar, height - drawn).from, to = seeFloor(sonar, height + drawn).to;
    const double across = to * std::tan(sonar.modes.front().field_of_view_deg / 2 * degree);
    return {
        fmt::format(" # from pass.csv the floor begins at {:.2g} m, of {:.2g} m\n"
                    "      waypoints:  # over the pipeline, stones and a pile at 0.4 m/s, {:.2g} m above the floor\n"
                    "        - {{time: 0, position: [21, 8.2, {:.2f}], yaw_deg: 8}}\n"
                    "        - {{time: 12, position: [25.75, 8.87, {:.2f}], yaw_deg: 8}}",
                    begins, range, height - mount_z, z, z),
        fmt::format("[{:.3g}, {:.3g}]", z - drawn, z + drawn),
        fmt::format("names: [tire_*, stone_7*], count: [1, 2], x: [{:.2f}, {:.2f}], y: [{:.2f}, {:.2f}]",
                    mount_x + from, mount_x + to, -across, across)};
}

/** Returns the sweep, which shows samples as the device does, and draws what its operator sets. */
std::string starterSweep(const SonarFigures& sonar) {
    const SonarDevice& device = *sonar.device;
    const double source_level = sourceLevelDb(sonar);
    const Course course = planCourse(sonar);
    return fmt::format(fmt::runtime(embedded(insonify_starter_sweep_begin, insonify_starter_sweep_end)),
                       fmt::arg("height", sonar.starter->picture_height), fmt::arg("picture", pictureKeys(sonar)),
                       fmt::arg("heights", course.heights), fmt::arg("objects", course.objects),
                       fmt::arg("smooth", device.smooth ? ", smooth: true" : ""), fmt::arg("tvg_low", device.tvg - 5),
                       fmt::arg("tvg_high", device.tvg + 5), fmt::arg("quiet", source_level + 8),
                       fmt::arg("loud", source_level - 8),
                       fmt::arg("gamma", device.gamma > 0 ? "  receiver.code.gamma: {uniform: [0.4, 0.6]}\n" : ""));
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
    const double db_per_m = absorptionDb(sonar);
    const SonarDevice& device = *sonar.device;
    using fmt::arg;
    return aligned(fmt::format(
        fmt::runtime(templateFor(sonar)), arg("name", sonar.name), arg("title", sonar.title),
        arg("source", starter.note), arg("sources", sourceLines(sonar)), arg("summary", starter.summary),
        arg("frequency", mode.frequency_khz), arg("range", fmt::format("{:.10g}", starterRange(sonar))),
        arg("vehicle", planCourse(sonar).vehicle), arg("range_min", mode.range_min), arg("range_max", mode.range_max),
        arg("bins", starter.bin_count), arg("bin_us", starter.bin_us), arg("width", mode.beam_width_deg),
        arg("height", mode.beam_height_deg), arg("sidelobe", device.sidelobe_db), arg("speckle", speckleLine(device)),
        arg("errors", errorBlock(device)), arg("noise", noiseLines(device)), arg("code", codeLines(sonar)),
        arg("picture", pictureKeys(sonar)), arg("tvg", device.tvg), arg("source_level", sourceLevelDb(sonar)),
        arg("wind", wind_m_s), arg("directivity", device.directivity_index_db), arg("period", starter.period),
        arg("columns", starter.columns_per_beam), arg("beams", mode.beam_count), arg("fov", mode.field_of_view_deg),
        arg("spacing", mode.field_of_view_deg / mode.beam_count), arg("pitch", starter.pitch_deg),
        arg("step", mode.step_deg), arg("speed", mode.step_deg / starter.period),
        arg("step_error", device.step_error_deg), arg("turn", mode.step_deg > 0 ? std::lround(360 / mode.step_deg) : 0),
        arg("rows", mode.row_count), arg("rows_fov", mode.rows_field_of_view_deg),
        arg("absorption", fmt::format("{:.2f}", db_per_m)),
        arg("absorption_block", absorptionBlock(mode.frequency_khz, db_per_m)), arg("pulse", pulseBlock(sonar)),
        arg("noise_note",
            starter.sends_tones ? "" : ", 33 us as a guess: a matched filter passes no more noise of a chirp"),
        arg("noise_khz", fmt::format("{:.3g}", noiseBandwidth(sonar)))));
}

std::vector<StarterFile> starterFiles(const SonarFigures& sonar) {
    const auto text = [](const auto& begin, const auto& end) { return std::string(embedded(begin, end)); };
    std::vector<StarterFile> files{{"scene.glb", text(insonify_starter_scene_begin, insonify_starter_scene_end)},
                                   {"make_scene.py", text(insonify_starter_script_begin, insonify_starter_script_end)},
                                   {"pass.csv", text(insonify_starter_pass_begin, insonify_starter_pass_end)},
                                   {"hover.csv", text(insonify_starter_hover_begin, insonify_starter_hover_end)}};
    if (sonar.isFan()) files.push_back({"sweep.yml", starterSweep(sonar)});
    return files;
}

}  // namespace insonify::command
