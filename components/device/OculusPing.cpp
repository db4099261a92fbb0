#include "components/device/OculusPing.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "types/geometry/Angle.hpp"
#include "types/geometry/BeamArc.hpp"

namespace insonify::device {
namespace {

/** Transposes rows of all beams, one for each bin, to beams. */
void copyImage(const OculusResult& result, OculusPing& ping) {
    ping.codes.resize(size_t{result.beam_count} * result.bin_count);
    const size_t width = result.codeBytes(), gain = result.gainBytes();
    for (size_t k = 0; k < result.bin_count; ++k) {
        const size_t row = k * result.rowBytes();
        if (gain > 0) ping.row_gains.push_back(read<uint32_t>(result.image, row));
        for (size_t beam = 0; beam < result.beam_count; ++beam)
            std::memcpy(&ping.codes[beam * result.bin_count + k], result.image.data() + row + gain + beam * width,
                        width);
    }
}

/** Orders the beams from starboard to port, at bearings in hundredths of a degree within 16 bits. An arc too far beyond
 *  180 degrees begins astern instead. */
types::BeamArc wireArc(const types::Sonar& codes) {
    types::BeamArc arc(codes);
    if (arc.beams.empty() || types::degrees(arc.bearings.back()) < 327) return arc;
    const auto turned = std::ranges::upper_bound(arc.bearings, std::numbers::pi) - arc.bearings.begin();
    for (auto bearing = arc.bearings.begin() + turned; bearing != arc.bearings.end(); ++bearing)
        *bearing -= 2 * std::numbers::pi;
    std::ranges::rotate(arc.bearings, arc.bearings.begin() + turned);
    std::ranges::rotate(arc.beams, arc.beams.begin() + turned);
    return arc;
}

}  // namespace

OculusPing makePing(const OculusResult& result) {
    OculusPing ping;
    ping.number = result.number;
    ping.frequency_hz = result.frequency_hz;
    ping.speed_of_sound = result.speed_of_sound;
    ping.range_resolution = result.range_resolution;
    ping.gamma = result.fire.gammaExponent();
    ping.bits = static_cast<int>(8 * result.codeBytes());
    ping.bin_count = result.bin_count;
    for (const int16_t bearing : result.bearings)  // hundredths of a degree, positive to starboard
        ping.bearings.push_back(types::radians(-0.01 * bearing));
    copyImage(result, ping);
    return ping;
}

types::Sonar getSonar(const OculusPing& ping, types::Time time) {
    types::Sonar sonar;
    sonar.time = time;
    constexpr double usual_speed = 1500;  // [m/s]
    sonar.setBins(ping.range_resolution, ping.speed_of_sound > 0 ? ping.speed_of_sound : usual_speed);
    sonar.bin_count = ping.bin_count;
    sonar.beam_count = ping.beamCount();
    sonar.bins.reserve(ping.codes.size());
    std::vector<types::Angle> table;
    for (const double bearing : ping.bearings) table.push_back(types::Angle::fromRad(bearing));
    types::BeamArc arc;
    arc.take(table, {});
    for (const uint32_t beam : arc.beams) {
        sonar.bearings.push_back(table[beam]);
        for (size_t k = 0; k < ping.bin_count; ++k) {
            const double gain = ping.row_gains.empty() ? 1 : std::max(1u, ping.row_gains[k]);
            sonar.bins.push_back(static_cast<float>(ping.codes[size_t{beam} * ping.bin_count + k] / std::sqrt(gain)));
        }
    }
    return sonar;
}

void OculusEncoder::bend(double gamma) {
    if (gamma == gamma_) return;
    gamma_ = gamma;
    bent_.resize(size_t{max_code_} + 1);
    for (size_t code = 0; code < bent_.size(); ++code)
        bent_[code] = std::pow(static_cast<double>(code) / max_code_, gamma);
}

uint32_t OculusEncoder::findIndex(float code) const {
    if (!(code > 0)) return 0;  // also unknown values
    return code < static_cast<float>(max_code_) ? static_cast<uint32_t>(code + 0.5f) : max_code_;
}

template <class Code>
void OculusEncoder::rows(const types::Sonar& codes, const std::vector<uint32_t>& beams, OculusResult& result) const {
    constexpr double maximum = std::numeric_limits<Code>::max();
    uint8_t* to = result.image.data();
    std::vector<double> row(beams.size());
    for (size_t bin = 0; bin < codes.bin_count; ++bin) {
        for (size_t i = 0; i < beams.size(); ++i)
            row[i] = bent_[findIndex(codes.bins[size_t{beams[i]} * codes.bin_count + bin])];
        double scale = maximum;
        if (result.gainBytes() > 0) {
            const double max_code = row.empty() ? 1 : std::ranges::max(row);
            const auto gain = static_cast<uint32_t>(std::clamp(1 / (max_code * max_code), 1.0, 4294967295.0));
            std::memcpy(to, &gain, sizeof gain);
            to += sizeof gain;
            scale *= std::sqrt(gain);
        }
        for (const double share : row) {
            const auto code = static_cast<Code>(std::min(share * scale + 0.5, maximum));
            std::memcpy(to, &code, sizeof code);
            to += sizeof code;
        }
    }
}

void OculusEncoder::encode(const types::Sonar& codes, OculusResult& result) {
    bend(result.fire.gammaExponent());
    result.code_size = static_cast<uint8_t>(result.fire.codeBytes() - 1);
    types::BeamArc arc = wireArc(codes);
    std::ranges::reverse(arc.beams);
    std::ranges::reverse(arc.bearings);
    const std::vector<uint32_t>& beams = arc.beams;
    result.beam_count = static_cast<uint16_t>(beams.size());
    result.bin_count = static_cast<uint16_t>(codes.bin_count);
    result.bearings.clear();
    for (const double bearing : arc.bearings)
        result.bearings.push_back(static_cast<int16_t>(std::lround(-100 * types::Angle{bearing}.deg())));
    result.image.resize(result.bin_count * result.rowBytes());
    switch (result.fire.codeBytes()) {
        case 1: return rows<uint8_t>(codes, beams, result);
        case 2: return rows<uint16_t>(codes, beams, result);
        default: return rows<uint32_t>(codes, beams, result);
    }
}

}  // namespace insonify::device
