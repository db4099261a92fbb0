#include "components/device/OculusEncoder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace insonify::device {

void OculusEncoder::bend(double gamma) {
    if (gamma == gamma_) return;
    gamma_ = gamma;
    bent_.resize(size_t{largest_in_} + 1);
    for (size_t code = 0; code < bent_.size(); ++code)
        bent_[code] = std::pow(static_cast<double>(code) / largest_in_, gamma);
}

std::vector<uint32_t> OculusEncoder::order(const types::Sonar& codes) {
    std::vector<uint32_t> beams(codes.beam_count);
    std::iota(beams.begin(), beams.end(), 0);
    std::ranges::stable_sort(beams, std::greater(), [&](uint32_t beam) { return codes.bearings[beam].rad; });
    return beams;
}

uint32_t OculusEncoder::indexOf(float code) const {
    if (!(code > 0)) return 0;  // what is not known as well
    return code < static_cast<float>(largest_in_) ? static_cast<uint32_t>(code + 0.5f) : largest_in_;
}

template <class Code>
void OculusEncoder::rows(const types::Sonar& codes, const std::vector<uint32_t>& beams, OculusResult& result) const {
    constexpr double largest = std::numeric_limits<Code>::max();
    uint8_t* to = result.image.data();
    std::vector<double> row(beams.size());
    for (size_t bin = 0; bin < codes.bin_count; ++bin) {
        for (size_t i = 0; i < beams.size(); ++i)
            row[i] = bent_[indexOf(codes.bins[size_t{beams[i]} * codes.bin_count + bin])];
        double scale = largest;
        if (result.gainBytes() > 0) {
            const double most = std::ranges::max(row);
            const auto gain = static_cast<uint32_t>(std::clamp(1 / (most * most), 1.0, 4294967295.0));
            std::memcpy(to, &gain, sizeof gain);
            to += sizeof gain;
            scale *= std::sqrt(gain);
        }
        for (const double share : row) {
            const auto code = static_cast<Code>(std::min(share * scale + 0.5, largest));
            std::memcpy(to, &code, sizeof code);
            to += sizeof code;
        }
    }
}

void OculusEncoder::encode(const types::Sonar& codes, OculusResult& result) {
    bend(result.fire.gammaExponent());
    result.code_size = static_cast<uint8_t>(result.fire.codeBytes() - 1);
    result.beam_count = static_cast<uint16_t>(codes.beam_count);
    result.bin_count = static_cast<uint16_t>(codes.bin_count);
    const std::vector<uint32_t> beams = order(codes);
    result.bearings.clear();
    for (const uint32_t beam : beams)
        result.bearings.push_back(static_cast<int16_t>(std::lround(-100 * codes.bearings[beam].deg())));
    result.image.resize(result.bin_count * result.rowBytes());
    switch (result.fire.codeBytes()) {
        case 1: return rows<uint8_t>(codes, beams, result);
        case 2: return rows<uint16_t>(codes, beams, result);
        default: return rows<uint32_t>(codes, beams, result);
    }
}

}  // namespace insonify::device
