#include "components/study/fit/FitReport.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "components/output/PictureFiles.hpp"
#include "components/study/likeness/Likeness.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/Describe.hpp"

namespace insonify::study {
namespace {

using Text = std::back_insert_iterator<std::string>;

template <class Enum>
std::string getName(Enum value) {
    return std::string(types::EnumNames<Enum>::names[static_cast<size_t>(value)]);
}

std::string getBlock(const acoustics::BeamLaw& law) {
    std::string text =
        fmt::format("{{weighting: {}, width_deg: {:.4g}",
                    getName(law.weighting.value_or(acoustics::Weighting::Uniform)), law.width_deg.value_or(1));
    if (law.sidelobe_db) text += fmt::format(", sidelobe_db: {:.4g}", *law.sidelobe_db);
    if (law.nbar) text += fmt::format(", nbar: {}", *law.nbar);
    return text + "}";
}

std::string getBlock(const acoustics::PulseConfig& pulse) {
    const std::string ringing = pulse.ring_down
                                    ? fmt::format(", ring_down: {{level_db: {:.2f}, decay_db_per_m: {:.4g}}}",
                                                  *pulse.ring_down->level_db, *pulse.ring_down->decay_db_per_m)
                                    : "";
    if (pulse.duration_us) return fmt::format("{{duration_us: {:.4g}{}}}", *pulse.duration_us, ringing);
    return fmt::format("{{bandwidth_khz: {:.4g}, window: {}{}}}", pulse.bandwidth_khz.value_or(0),
                       getName(pulse.window.value_or(acoustics::PulseWindow::None)), ringing);
}

std::string getBlock(const sonar::SpeckleConfig& speckle) {
    std::string text = "{coherent: true";
    if (speckle.scatterers_per_m2) text += fmt::format(", scatterers_per_m2: {:.4g}", *speckle.scatterers_per_m2);
    return text + fmt::format(", scatterers_per_cell: {}}}", speckle.scatterers_per_cell);
}

std::string getBlock(const receiver::CodeConfig& code) {
    std::string text =
        fmt::format("{{bits: {}, law: {}, full_scale_db: {:.2f}", code.bits, getName(code.law), code.full_scale_db);
    if (code.law == receiver::CodeLaw::Log) text += fmt::format(", dynamic_range_db: {:.4g}", code.dynamic_range_db);
    return text + (code.gamma != 1 ? fmt::format(", gamma: {:.4g}}}", code.gamma) : "}");
}

/** Returns a curve of the plot of levels over range. */
std::string polyline(const LevelBlocks& blocks, const char* colour, double low, double high) {
    constexpr double width = 800, height = 300;
    std::string points;
    for (size_t slice = 0; slice < blocks.slices; ++slice) {
        double sum = 0;
        for (size_t block = 0; block < blocks.beam_blocks; ++block) sum += std::pow(10, blocks.at(block, slice) / 10);
        const double level = 10 * std::log10(std::max(sum / static_cast<double>(blocks.beam_blocks), 1e-40));
        fmt::format_to(Text(points), "{:.1f},{:.1f} ", width * blocks.ranges[slice] / blocks.ranges.back(),
                       height * std::clamp((high - level) / (high - low), 0.0, 1.0));
    }
    return fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"2\" points=\"{}\"/>\n", colour, points);
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    if (!(file << text).flush()) throw std::runtime_error(path.string() + " cannot be written");
}

/** Returns the comment of a property in a fitted deployment. */
std::string comment(const RecordingFit& fit, const std::string& name) {
    const Finding* finding = fit.finding(name);
    return finding ? name + ": " + finding->text() : "";
}

/** Adds the pattern of a side-scan across its track: the azimuth pattern of the fan that represents it in the chain. */
void addAcross(const RecordingFit& fit, const std::string& task, std::vector<FitSetting>& all) {
    const sonar::SonarConfig& fan = fit.chain.sonar;
    if (fit.levels.water_db)
        all.push_back({task + ".volume", fmt::format("{{strength_db: {:.2f}}}", *fan.volume.front().strength_db),
                       comment(fit, "water")});
    if (!fit.levels.pitch_deg) return;
    all.push_back({task + ".depression_deg", fmt::format("{:.4g}", 90 - std::abs(fan.bearings_deg.front())),
                   comment(fit, "depression")});
    all.push_back({task + ".beam_height_deg", fmt::format("{:.4g}", *fan.beam_width_deg), ""});
    all.push_back({task + ".beam_pattern.receive.elevation", getBlock(*fan.beam_pattern->receive.azimuth),
                   comment(fit, "elevation width")});
}

void addSonar(const RecordingFit& fit, const std::string& task, std::vector<FitSetting>& all) {
    const sonar::SonarConfig& sonar = fit.chain.sonar;
    const auto set = [&](const char* property, const std::string& value, const std::string& why) {
        all.push_back({task + "." + property, value, why});
    };
    set("range", fmt::format("{:.9g}", sonar.range), "as recorded");
    set("bin_count", fmt::format("{}", sonar.bin_count), "as recorded");
    set("range_rounding", "exact", "bins as deep as recorded");
    set("speed_of_sound", fmt::format("{:.7g}", sonar.speedOfSound()), "as recorded");
    set("frequency_khz", fmt::format("{:.7g}", *sonar.frequency_khz), "as recorded");
    set("pulse", getBlock(*sonar.pulse), comment(fit, "pulse length"));
    set("speckle", sonar.speckle ? getBlock(*sonar.speckle) : "null",
        sonar.speckle ? comment(fit, "scatterers per cell") : "speckle is made by the noise task");
    set("absorption", fmt::format("{{db_per_m: {:.4g}}}", *sonar.absorption->db_per_m), comment(fit, "absorption"));
    if (fit.chain.isSideScan()) return addAcross(fit, task, all);
    set("field_of_view_deg", "null", "");
    std::vector<std::string> bearings;
    for (const double bearing : sonar.bearings_deg) bearings.push_back(fmt::format("{:.6g}", bearing));
    set("bearings_deg", fmt::format("[{}]", fmt::join(bearings, ", ")), "as recorded");
    set("beam_width_deg", fmt::format("{:.6g}", *sonar.beam_width_deg), "distance of the beams");
    set("beam_height_deg", fmt::format("{:.6g}", sonar.beam_height_deg), "");
    const sonar::BeamPatternConfig& pattern = *sonar.beam_pattern;
    set("beam_pattern.receive.azimuth", getBlock(*pattern.receive.azimuth), comment(fit, "beam width"));
    if (fit.levels.elevation_deg)
        set("beam_pattern.transmit.elevation", getBlock(*pattern.transmit.elevation), comment(fit, "elevation width"));
}

void addNoise(const RecordingFit& fit, const std::string& task, std::vector<FitSetting>& all) {
    const noise::NoiseConfig& noise = fit.chain.noise;
    const auto set = [&](const char* property, const std::string& value, const std::string& why) {
        all.push_back({task + "." + property, value, why});
    };
    if (!noise.speckle)
        set("speckle", "null", "");
    else
        set("speckle",
            noise.speckle->shape ? fmt::format("{{law: k, shape: {:.3g}}}", *noise.speckle->shape) : "{law: rayleigh}",
            comment(fit, "shape of K"));
    set("additive", "null", "");
    set("ambient", fmt::format("{{level_db: {:.2f}}}", *noise.ambient->level_db), comment(fit, "noise"));
    if (!noise.filter) return set("filter", "null", "");
    std::vector<std::string> parts;
    if (noise.filter->looks > 1) parts.push_back(fmt::format("looks: {}", noise.filter->looks));
    if (noise.filter->correlation_beams)
        parts.push_back(fmt::format("correlation_beams: {:.3g}", *noise.filter->correlation_beams));
    if (noise.filter->correlation_bins)
        parts.push_back(fmt::format("correlation_bins: {:.3g}", *noise.filter->correlation_bins));
    set("filter", fmt::format("{{{}}}", fmt::join(parts, ", ")),
        noise.filter->looks > 1 ? comment(fit, "looks") : "noise that neighbouring beams and bins share");
}

}  // namespace

std::vector<FitSetting> getFoundSettings(const FitChain& chain, const FitTasks& tasks) {
    constexpr size_t every = 4;
    std::vector<std::string> points;
    const std::vector<types::Pose>& lines = chain.lines;
    const glm::dquat fan = glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
    const auto add = [&](size_t i) {
        const glm::dquat body = lines[i].orientation * glm::inverse(fan);
        const glm::dvec3 at = lines[i].position - body * tasks.mount.position;
        const types::Turns turns = types::toTurns(body);
        points.push_back(
            fmt::format("{{time: {:.6g}, position: [{:.6g}, {:.6g}, {:.6g}], yaw_deg: {:.6g}, pitch_deg: {:.4g}}}",
                        static_cast<double>(i) * tasks.period, at.x, at.y, at.z, types::degrees(turns.yaw),
                        types::degrees(turns.pitch)));
    };
    for (size_t i = 0; i + 1 < lines.size(); i += every) add(i);
    if (!lines.empty()) add(lines.size() - 1);
    std::vector<FitSetting> all{
        {tasks.vehicle + ".file", "null", ""},
        {tasks.vehicle + ".waypoints", fmt::format("[{}]", fmt::join(points, ", ")),
         "a straight way, as high above the floor and pitched as the recording states; every fourth line"}};
    const auto level = [&](const char* turn, double is_deg) {
        if (is_deg != 0)
            all.push_back({tasks.scene + ".mount." + turn, "0", "the recorded pitch is that of the sonar"});
    };
    level("roll_deg", tasks.mount.roll_deg);
    level("pitch_deg", tasks.mount.pitch_deg);
    level("yaw_deg", tasks.mount.yaw_deg);
    return all;
}

std::vector<FitSetting> getSettings(const RecordingFit& fit, const FitTasks& tasks) {
    std::vector<FitSetting> all;
    if (fit.chain.isSideScan()) all = getFoundSettings(fit.chain, tasks);
    if (fit.levels.pitch_deg && !fit.chain.isSideScan()) {
        all.push_back({tasks.scene + ".mount.pitch_deg",
                       fmt::format("{:.4g}", tasks.mount.pitch_deg + fit.levels.pitch_deg->value),
                       comment(fit, "pitch")});
        all.push_back({tasks.scene + ".mount.position",
                       fmt::format("[{:.6g}, {:.6g}, {:.6g}]", tasks.mount.position.x, tasks.mount.position.y,
                                   tasks.mount.position.z + fit.levels.height_m->value),
                       comment(fit, "height")});
    }
    addSonar(fit, tasks.sonar, all);
    addNoise(fit, tasks.noise, all);
    const receiver::TvgConfig& tvg = *fit.chain.receiver.tvg;
    all.push_back({tasks.receiver + ".tvg.log_coefficient", fmt::format("{:.4g}", tvg.log_coefficient),
                   comment(fit, "TVG logarithm")});
    all.push_back({tasks.receiver + ".tvg.db_per_m", fmt::format("{:.4g}", tvg.db_per_m), comment(fit, "TVG slope")});
    all.push_back({tasks.receiver + ".code", getBlock(fit.chain.code()), comment(fit, "full scale")});
    return all;
}

std::string makePage(const RecordingFit& fit, const std::vector<CodedPing>& recorded, const std::string& picture) {
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Fitted sonar</title>\n"
        "<style>body{{font-family:sans-serif;max-width:80em;margin:1em auto}}td,th{{padding:.2em .8em;text-align:left;"
        "border-bottom:1px solid #ccc}}img{{max-width:100%}}</style></head><body>\n"
        "<h1>Fitted sonar</h1>\n<p>Left: {}, recorded. Right: the same shape, simulated with what was found. "
        "Codes are grey levels.</p>\n<img src=\"{}\" alt=\"recorded and simulated\">\n",
        recorded.front().name, picture);
    page += "<h2>What was found</h2>\n<table><tr><th></th><th>value</th><th>95 %</th><th>unit</th><th></th></tr>\n";
    for (const Finding& finding : fit.findings)
        page +=
            finding.is_determined
                ? fmt::format("<tr><td>{}</td><td>{:.4g}</td><td>{:.4g} to {:.4g}</td><td>{}</td><td>{}</td></tr>\n",
                              finding.name, finding.found.value, finding.found.low, finding.found.high, finding.unit,
                              finding.note)
                : fmt::format(
                      "<tr><td>{}</td><td colspan=\"3\">not determined by this recording</td><td>{}</td></tr>\n",
                      finding.name, finding.note);
    const LevelBlocks real = makeBlocks(recorded.front()), made = makeBlocks(fit.simulated_pings.front());
    const auto [low, high] = std::ranges::minmax(real.level);
    page += fmt::format(
        "</table>\n<h2>Level over range</h2>\n<p>Blue: recorded, red: simulated; {:.0f} to {:.0f} dB relative to the "
        "largest code, "
        "over 0 to {:.3g} m.</p>\n<svg viewBox=\"0 0 800 300\" width=\"800\" style=\"background:#f4f4f4\">\n",
        low, high, real.ranges.back());
    page += polyline(real, "#1f5fbf", low, high) + polyline(made, "#c0392b", low, high);
    return page + "</svg>\n</body></html>\n";
}

std::filesystem::path writePage(const RecordingFit& fit, const std::vector<CodedPing>& recorded,
                                const std::filesystem::path& deployment) {
    std::filesystem::path page = deployment, picture = deployment;
    page.replace_extension(".html");
    picture.replace_extension(".png");
    output::writePng(picture, drawFans({recorded.front(), fit.simulated_pings.front()}));
    write(page, makePage(fit, recorded, picture.filename().string()));
    return page;
}

}  // namespace insonify::study
