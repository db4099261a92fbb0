#include "types/samples/SonarReturns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonify::types {
namespace {

/** The fields of one return of a beam. */
struct Return {
    float& range;
    float& level;
    float& elevation;
};

void report(const Sonar& ping, const SonarTruth& truth, size_t at, const Return& reported) {
    reported.range = static_cast<float>(ping.binStart(static_cast<double>(at % ping.bin_count) + 0.5));
    reported.level = 10 * std::log10(ping.bins[at]);
    reported.elevation = truth.elevation[at];
}

}  // namespace

void SonarReturns::take(const Sonar& ping, const SonarTruth& truth, const std::vector<uint32_t>& strongest) {
    time = ping.time;
    bearings = ping.bearings;
    forEachArray(*this, [&](const char*, auto& numbers, auto) {
        numbers.assign(ping.beam_count, std::numeric_limits<float>::quiet_NaN());
    });
    for (size_t beam = 0; beam < ping.beam_count; ++beam) {
        const auto begin = static_cast<ptrdiff_t>(beam * ping.bin_count), end = begin + ping.bin_count;
        const auto shown = [&](ptrdiff_t bin) {
            const auto at = static_cast<size_t>(bin);
            return truth.object[at] != SonarTruth::no_object && !truth.isByMirror(at);
        };
        auto first = begin;
        while (first < end && !shown(first)) ++first;
        if (first < end)
            report(ping, truth, static_cast<size_t>(first),
                   {first_range[beam], first_level[beam], first_elevation[beam]});
        if (strongest[beam] < ping.bin_count)
            report(ping, truth, beam * ping.bin_count + strongest[beam],
                   {strongest_range[beam], strongest_level[beam], strongest_elevation[beam]});
    }
}

const char* SonarReturns::diagnostic() const {
    bool fits = true;
    forEachArray(*this,
                 [&](const char*, const auto& numbers, auto) { fits = fits && numbers.size() == bearings.size(); });
    return fits ? nullptr : "has other numbers of returns than bearings";
}

}  // namespace insonify::types
