#include "types/samples/Sonar.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>

#include "types/geometry/VectorMath.hpp"

namespace insonify::types {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

bool isNormalised(Angle angle) {
    return angle.isUnknown() || (angle.rad > -std::numbers::pi && angle.rad <= std::numbers::pi);
}

INSONIFY_VECTOR_CLONES
bool anyBelowZero(const float* values, size_t count) {
    int below = 0;
    for (size_t i = 0; i < count; ++i) below |= values[i] < 0;
    return below != 0;
}

}  // namespace

bool Sonar::wellShaped() const {
    return bins.size() == uint64_t{beam_count} * bin_count && bearings.size() == beam_count &&
           (timestamps.empty() || timestamps.size() == beam_count);
}

const char* Sonar::notIntensities() const {
    if (bins.size() != uint64_t{beam_count} * bin_count) return "there are more or fewer bins than the counts say";
    return anyBelowZero(bins.data(), bins.size()) ? "bins are below 0, as decibels are: no intensities" : nullptr;
}

void Sonar::copyHeader(const Sonar& other) {
    time = other.time;
    timestamps = other.timestamps;
    static_cast<RangeBins&>(*this) = other;
    beam_width = other.beam_width;
    beam_height = other.beam_height;
    bearings = other.bearings;
    bin_count = other.bin_count;
    beam_count = other.beam_count;
    bins.resize(other.bins.size());
}

void Sonar::validate() const {
    std::string diagnostics;
    const auto require = [&](bool holds, const std::string& diagnostic) {
        if (!holds) diagnostics += (diagnostics.empty() ? "" : "; ") + diagnostic;
    };
    const auto has = [](const char* what, size_t count, uint64_t wanted) {
        return std::string("has ") + std::to_string(count) + " " + what + ", must have " + std::to_string(wanted);
    };
    const uint64_t cells = uint64_t{beam_count} * bin_count;
    require(bins.size() == cells, has("bins", bins.size(), cells));
    require(bearings.size() == beam_count, has("bearings", bearings.size(), beam_count));
    require(timestamps.empty() || timestamps.size() == beam_count,
            has("timestamps", timestamps.size(), beam_count) + " or none");
    require(std::all_of(bearings.begin(), bearings.end(), isNormalised), "has a bearing outside (-pi, pi]");
    require(bins.empty() || bin_duration.microseconds > 0, "has bins without a duration");
    require(bins.empty() || (speed_of_sound > 0 && std::isfinite(speed_of_sound)), "has bins without a speed of sound");
    if (!diagnostics.empty()) throw std::logic_error("a ping " + diagnostics);
}

void Sonar::resize(uint32_t bins_per_beam, uint32_t beams, bool per_beam_timestamps) {
    std::vector<float> moved(size_t{beams} * bins_per_beam, unknown);
    for (size_t beam = 0; wellShaped() && beam < std::min(beams, beam_count); ++beam)
        std::copy_n(bins.begin() + static_cast<ptrdiff_t>(beam * bin_count), std::min(bins_per_beam, bin_count),
                    moved.begin() + static_cast<ptrdiff_t>(beam * bins_per_beam));
    bins = std::move(moved);
    bin_count = bins_per_beam;
    beam_count = beams;
    bearings.resize(beams);
    timestamps.resize(per_beam_timestamps ? beams : 0);
}

void Sonar::setRegularBearings(Angle start, Angle interval) {
    bearings.resize(beam_count);
    for (size_t beam = 0; beam < beam_count; ++beam)
        bearings[beam] = Angle::fromRad(start.rad + static_cast<double>(beam) * interval.rad);
}

Time Sonar::beamStart(size_t beam) const {
    if (beam >= beam_count)
        throw std::out_of_range("beam " + std::to_string(beam) + " of a ping of " + std::to_string(beam_count));
    return timestamps.empty() ? time : timestamps.at(beam);
}

}  // namespace insonify::types
