#pragma once
// Pings built in code, and numbers that compare pings.
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>

#include "types/geometry/Angle.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::test {

/** A ping of bins of 0.1 m, all of one intensity, in beams of 2 deg ahead. */
inline types::Sonar makePing(uint32_t beams, uint32_t bins, float value = 1, int64_t time = 1000000) {
    types::Sonar ping;
    ping.time.microseconds = time;
    ping.bin_duration.microseconds = 100;
    ping.speed_of_sound = 1000;
    ping.beam_width = types::Angle::fromDeg(2);
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.bearings.assign(beams, types::Angle{0});
    ping.bins.assign(size_t{beams} * bins, value);
    return ping;
}

/** An empty ping of 50 m range whose beams cover `field_of_view_deg` evenly. */
inline types::Sonar emptyPing(double field_of_view_deg, uint32_t beams, uint32_t bins = 100) {
    types::Sonar ping = makePing(beams, bins, 0);
    ping.speed_of_sound = 1500;
    ping.bin_duration = {static_cast<int64_t>(50.0 / bins / 1500 * 1e6 + 0.5)};
    ping.beam_width = types::Angle::fromDeg(field_of_view_deg / beams);
    for (uint32_t beam = 0; beam < beams; ++beam)
        ping.bearings[beam] = types::Angle::fromDeg(((beam + 0.5) / beams - 0.5) * field_of_view_deg);
    return ping;
}

inline types::Sonar withEcho(types::Sonar ping, uint32_t beam, uint32_t bin, float value = 1) {
    ping.bins[size_t{beam} * ping.bin_count + bin] = value;
    return ping;
}

inline types::SonarPtr shared(const types::Sonar& ping) { return std::make_shared<const types::Sonar>(ping); }

/** Returns the relative L2 of the difference. */
inline double relativeL2(std::span<const float> got, std::span<const float> expected) {
    double error = 0, norm = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
        error += std::pow(double{got[i]} - double{expected[i]}, 2);
        norm += std::pow(double{expected[i]}, 2);
    }
    return std::sqrt(error / norm);
}
inline double relativeL2(const types::Sonar& got, const types::Sonar& expected) {
    return relativeL2(got.bins, expected.bins);
}

inline double computeSum(const types::Sonar& ping) { return std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0); }

/** Returns all numbers of a truth, as bits: NaN equals NaN. */
inline std::vector<uint32_t> getBits(const types::SonarTruth& truth) {
    std::vector<uint32_t> all;
    types::SonarTruth::forEachArray(truth, [&](const char*, const auto& numbers, auto) {
        for (const auto number : numbers)
            if constexpr (std::is_same_v<decltype(number), const float>)
                all.push_back(std::bit_cast<uint32_t>(number));
            else
                all.push_back(static_cast<uint32_t>(number));
    });
    return all;
}

}  // namespace insonify::test
