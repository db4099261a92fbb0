#include "components/study/fit/FitChain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/noise/Noise.hpp"
#include "components/receiver/Receiver.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

/** Distance from ping to ping, and from line to line if the recording has no places [m]: far beyond the length of an
 *  aperture. */
constexpr double sideways = 0.37;

/** Returns the median distance of neighbouring beams [deg]. */
double spacingDeg(const std::vector<double>& bearings) {
    std::vector<double> steps;
    for (size_t i = 0; i + 1 < bearings.size(); ++i)
        steps.push_back(types::degrees(std::abs(bearings[i + 1] - bearings[i])));
    const auto middle = steps.begin() + static_cast<long>(steps.size() / 2);
    std::ranges::nth_element(steps, middle);
    return *middle;
}

/** Returns the beam of a side-scan's line on this side. */
size_t getBeam(const types::Sonar& line, double side) {
    return line.beam_count > 1 && (line.bearings[0].rad > 0) != (side > 0) ? 1 : 0;
}

/** Returns lines of a side-scan as the beams of one sample. */
types::Sonar stacked(const std::vector<types::Sonar>& lines, double side) {
    types::Sonar all = lines.front();
    all.beam_count = static_cast<uint32_t>(lines.size());
    all.bins.clear();
    all.bearings.assign(lines.size(), lines.front().bearings[getBeam(lines.front(), side)]);
    for (const types::Sonar& line : lines) {
        const auto first = line.bins.begin() + static_cast<long>(getBeam(line, side) * line.bin_count);
        all.bins.insert(all.bins.end(), first, first + line.bin_count);
    }
    return all;
}

/** Returns the orientation of the fan that represents a side-scan: straight down, across the track. */
glm::dquat abeam(double yaw, double pitch) {
    return glm::angleAxis(yaw, glm::dvec3(0, 0, 1)) * glm::angleAxis(pitch, glm::dvec3(0, 1, 0)) *
           glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
}

/** Returns at most `count` of the lines, evenly distributed. */
std::vector<types::Pose> evenly(const std::vector<types::Pose>& lines, size_t count) {
    if (lines.size() <= count) return lines;
    std::vector<types::Pose> few;
    for (size_t i = 0; i < count; ++i) few.push_back(lines[(2 * i + 1) * lines.size() / (2 * count)]);
    return few;
}

/** Returns the lines that are simulated. Lines share no speckle, so statistics of coherent speckle, which takes
 * longest, do not need all of them. */
std::vector<types::Pose> simulatedLines(const FitChain& chain) {
    constexpr size_t enough = 128;
    return chain.sonar.speckle ? evenly(chain.lines, enough) : chain.lines;
}

}  // namespace

void layLines(const CodedPing& recorded, FitChain& chain) {
    types::Pose at = chain.snapshot.sonar;
    const glm::dvec3 bow = at.orientation * glm::dvec3(1, 0, 0);
    const double yaw = std::atan2(bow.y, bow.x);
    const glm::dvec3 ahead(std::cos(yaw), std::sin(yaw), 0);
    const std::optional<double> floor = floorBelow(chain);
    if (!floor) throw types::ConfigError("", "scene", "has no floor below the deployment's sonar");
    const double height = *floor;
    at.orientation = abeam(yaw, 0);
    chain.snapshot.sonar = at;
    const auto known = std::ranges::find_if(recorded.places, [](const LinePlace& place) { return place.altitude > 0; });
    double altitude = known == recorded.places.end() ? height : known->altitude;
    for (size_t i = 0; i < recorded.beam_count; ++i) {
        const LinePlace place =
            i < recorded.places.size() ? recorded.places[i] : LinePlace{.along = sideways * static_cast<double>(i)};
        if (place.altitude > 0) altitude = place.altitude;
        types::Pose& line = chain.lines.emplace_back(at);
        line.orientation = abeam(yaw, place.pitch);
        line.position += ahead * place.along;
        line.position.z += altitude - height;
    }
    chain.side = recorded.bearings.front();
    FitChain end = chain;
    end.snapshot.sonar = chain.lines.back();
    if (!floorBelow(end))
        throw types::ConfigError(
            "", "scene",
            fmt::format("has no floor below the last of {} lines, {:.0f} m ahead of the first; cut "
                        "the recording (insonify log cut), or use a larger scene",
                        chain.lines.size(), glm::distance(chain.lines.front().position, chain.lines.back().position)));
}

void copyShape(const CodedPing& recorded, FitChain& chain) {
    sonar::SonarConfig& sonar = chain.sonar;
    if (recorded.resolution > 0) sonar.range = recorded.resolution * static_cast<double>(recorded.bin_count);
    sonar.bin_count = static_cast<int>(recorded.bin_count);
    sonar.range_rounding = sonar::RangeRounding::Exact;
    if (recorded.speed_of_sound > 0) sonar.speed_of_sound = recorded.speed_of_sound;
    if (recorded.frequency_khz > 0) sonar.frequency_khz = recorded.frequency_khz;
    if (!recorded.is_waterfall) {
        sonar.bearings_deg.clear();
        for (const double bearing : recorded.bearings) sonar.bearings_deg.push_back(types::degrees(bearing));
        sonar.beam_count = static_cast<int>(recorded.beam_count);
        sonar.field_of_view_deg.reset();
        sonar.beam_width_deg = spacingDeg(recorded.bearings);
    }
    receiver::CodeConfig& code = chain.receiver.code.emplace(chain.code());
    const double full_scale = code.full_scale_db;
    if (recorded.law_known) {
        code = recorded.law;
        code.full_scale_db = full_scale;
    }
    code.bits = recorded.bits;
}

types::Sonar meanEchoes(const FitChain& chain) {
    sonar::SonarConfig config = chain.sonar;
    config.speckle.reset();
    config.elements.reset();
    config.absorption.reset();
    if (config.pulse) config.pulse->ring_down.reset();
    if (chain.isSideScan()) config.quality.columns_per_beam = 192, config.quality.rows = 2;
    types::Sonar ping;
    sonar::SonarRenderer renderer(config, chain.snapshot.geometry);
    renderer.render(chain.snapshot, ping);
    if (!chain.isSideScan()) return ping;
    constexpr size_t few = 24;  // three for each block of levels
    std::vector<types::Sonar> lines;
    types::Snapshot snapshot = chain.snapshot;
    for (const types::Pose& line : evenly(chain.lines, few)) {
        snapshot.sonar = line;
        renderer.render(snapshot, ping);
        lines.push_back(ping);
    }
    return stacked(lines, chain.side);
}

std::optional<double> floorBelow(const FitChain& chain) {
    FitChain down = chain;
    down.lines.clear();
    sonar::SonarConfig& sonar = down.sonar;
    sonar.range *= 20;
    sonar.bin_count = 20000;
    sonar.bearings_deg = {0};
    sonar.beam_count = 1;
    sonar.beam_width_deg = sonar.beam_height_deg = 4;
    sonar.beam_pattern.reset();
    sonar.pulse.reset();  // which would begin before the floor
    sonar.volume = {};
    down.snapshot.sonar.orientation = glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
    const types::Sonar ping = meanEchoes(down);
    const auto echo = std::ranges::find_if(ping.bins, [](float bin) { return bin > 0; });
    if (echo == ping.bins.end()) return std::nullopt;
    return sonar.range * static_cast<double>(echo - ping.bins.begin()) / sonar.bin_count;
}

std::vector<CodedPing> simulatedPings(const FitChain& chain, size_t count) {
    sonar::SonarRenderer renderer(chain.sonar, chain.snapshot.geometry);
    noise::Noise noise(chain.noise);
    receiver::Receiver receiver(chain.receiver);
    types::Sonar clean, noisy, received;
    std::vector<CodedPing> pings;
    std::vector<types::Sonar> lines;
    types::Snapshot snapshot = chain.snapshot;
    for (const types::Pose& line : simulatedLines(chain)) {
        snapshot.sonar = line;
        snapshot.time.microseconds += 100'000;
        renderer.render(snapshot, clean);
        noise.add(clean, noisy);
        receiver.receive(noisy, lines.emplace_back());
    }
    const double resolution = sonar::makeBinGrid(chain.sonar).bin_width;  // that of a sample is rounded
    if (chain.isSideScan()) {
        pings = codedLines(lines, chain.code(), "simulated");
        std::erase_if(pings, [&](const CodedPing& ping) { return ping.bearings.front() * chain.side < 0; });
        pings.front().resolution = resolution;
        return pings;
    }
    for (size_t i = 0; i < count; ++i) {
        snapshot = chain.snapshot;
        snapshot.time.microseconds += static_cast<int64_t>(100'000 * i);
        snapshot.sonar.position += snapshot.sonar.orientation * glm::dvec3(0, sideways * static_cast<double>(i), 0);
        renderer.render(snapshot, clean);
        noise.add(clean, noisy);
        receiver.receive(noisy, received);
        pings.push_back(codedPing(received, chain.code(), fmt::format("simulated_{}", i)));
        pings.back().resolution = resolution;
    }
    return pings;
}

types::Pose moved(const types::Pose& pose, double pitch, double up) {
    types::Pose changed = pose;
    changed.orientation = pose.orientation * glm::angleAxis(pitch, glm::dvec3(0, 1, 0));
    changed.position.z += up;
    return changed;
}

}  // namespace insonify::study
