#pragma once
// Pings whose beams are at random bearings: in any order, with gaps and overlaps, across +-180 degrees.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/support/Pings.hpp"

namespace insonify::test {

/** A ping, and the same beams in ascending order. */
struct RandomFan {
    std::string name;
    types::Sonar ping, ascending;
    std::vector<uint32_t> order;  ///< Beam of `ping` at each place of `ascending`.
};

/** The beams of a ping in another order. */
inline types::Sonar reordered(const types::Sonar& ping, const std::vector<uint32_t>& order) {
    types::Sonar other;
    other.copyHeader(ping);
    for (size_t i = 0; i < order.size(); ++i) {
        other.bearings[i] = ping.bearings[order[i]];
        std::copy_n(&ping.bins[size_t{order[i]} * ping.bin_count], ping.bin_count, &other.bins[i * ping.bin_count]);
    }
    return other;
}

/** Angle between two directions, at most pi [rad]. */
inline double apart(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

/** The min of these angles to a beam of a ping [rad]. */
inline double nearestBeam(const types::Sonar& ping, double bearing) {
    double minimum = 10;
    for (const types::Angle& each : ping.bearings) minimum = std::min(minimum, apart(each.rad, bearing));
    return minimum;
}

/** Fans of every kind, `rounds` of each. Bins are random, from 0.1 to 1. */
inline std::vector<RandomFan> randomFans(int rounds, uint32_t bins) {
    std::mt19937 random(7);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    std::vector<RandomFan> fans;
    const auto add = [&](const std::string& name, std::vector<double> bearings_deg, double width_deg, bool shuffled) {
        if (shuffled) std::ranges::shuffle(bearings_deg, random);
        RandomFan fan{name, makePing(static_cast<uint32_t>(bearings_deg.size()), bins), {}, {}};
        fan.ping.beam_width = types::Angle::fromDeg(width_deg);
        for (size_t i = 0; i < bearings_deg.size(); ++i) fan.ping.bearings[i] = types::Angle::fromDeg(bearings_deg[i]);
        for (float& bin : fan.ping.bins) bin = static_cast<float>(any(0.1, 1));
        fan.order.resize(bearings_deg.size());
        std::iota(fan.order.begin(), fan.order.end(), 0);
        std::ranges::sort(fan.order, {}, [&](uint32_t beam) { return fan.ping.bearings[beam].rad; });
        fan.ascending = reordered(fan.ping, fan.order);
        fans.push_back(std::move(fan));
    };
    const auto regular = [](double from, double step, int count) {
        std::vector<double> all;
        for (int i = 0; i < count; ++i) all.push_back(from + step * i);
        return all;
    };
    const auto irregular = [&](double from, double to, int count) {
        std::vector<double> all;
        for (int i = 0; i < count; ++i) all.push_back(any(from, to));
        return all;
    };
    for (int round = 0; round < rounds; ++round) {
        const double step = any(2, 6);
        add("descending", regular(20 * step / 2, -step, 20), step, false);
        add("shuffled", regular(-20 * step / 2, step, 20), step, true);
        add("gaps", irregular(-100, 100, 9), any(1, 6), true);
        add("overlaps", irregular(-60, 60, 30), any(10, 40), true);
        add("across the seam", regular(180 - 6 * step, step, 12), step, false);
        add("across the seam, shuffled with gaps", irregular(120, 260, 9), any(1, 8), true);
        add("all around", regular(any(-180, 180), 360 / 24.0, 24), 15, round % 2 == 0);
        add("all around, uneven", irregular(-180, 180, 40), any(4, 40), true);
        add("few, far apart", irregular(-180, 180, 3), any(1, 10), true);
        add("one", {any(-180, 180)}, any(1, 90), false);
    }
    return fans;
}

}  // namespace insonify::test
