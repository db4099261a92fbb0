#include "components/sonar/bins/GridTruth.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace insonify::sonar {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/** Returns the elevation of a bin's echo, which is that of its beam; unknown for the water [rad]. */
double elevationOf(const types::SonarTruth& truth, size_t beam, size_t at) {
    return truth.path[at] == types::SonarTruth::water ? double{unknown} : truth.bearings[beam].rad;
}

void markShadows(size_t first, size_t bins, types::SonarTruth& truth) {
    bool echo_beyond = false;
    for (size_t at = first + bins; at-- > first;) {
        const bool received = truth.object[at] != types::SonarTruth::no_object || truth.hits[at] > 0;
        truth.shadow[at] = !received && echo_beyond;
        echo_beyond = echo_beyond || received;
    }
}

}  // namespace

void GridTruth::forget(size_t at, types::SonarTruth& truth) {
    truth.object[at] = types::SonarTruth::no_object;
    truth.share[at] = 0;
    truth.hits[at] = 0;
    truth.elevation[at] = truth.grazing[at] = unknown;
    truth.path[at] = truth.shadow[at] = 0;
}

void GridTruth::shape(const types::Sonar& ping, size_t rows, types::SonarTruth& azimuths, types::SonarTruth& returns) {
    azimuths.takeGrid(ping);
    types::Sonar grid;
    grid.time = ping.time;
    static_cast<types::RangeBins&>(grid) = ping;
    grid.bin_count = 1;
    grid.beam_count = static_cast<uint32_t>(rows * ping.beam_count);
    for (size_t row = 0; row < rows; ++row)
        grid.bearings.insert(grid.bearings.end(), ping.bearings.rbegin(), ping.bearings.rend());
    returns.takeGrid(grid);
    for (size_t cell = 0; cell < grid.beam_count; ++cell) forget(cell, returns);
}

void GridTruth::addTo(const types::Sonar& fan, const types::SonarTruth& truth, size_t column,
                      types::SonarTruth& azimuths) {
    const size_t bins = fan.bin_count;
    for (size_t bin = 0; bin < bins; ++bin) {
        echoes_.clear();
        double energy = 0;
        uint32_t hits = 0;
        for (size_t beam = 0; beam < fan.beam_count; ++beam) {
            const size_t at = beam * bins + bin;
            const auto received = static_cast<double>(fan.bins[at]);
            const bool has_label =
                truth.object[at] != types::SonarTruth::no_object || truth.path[at] == types::SonarTruth::water;
            if (!has_label || !(received > 0)) continue;
            energy += received;
            hits += truth.hits[at];
            const double share = received * static_cast<double>(truth.share[at]);
            const auto known = std::ranges::find_if(echoes_, [&](const Echo& echo) {
                return echo.object == truth.object[at] && echo.path == truth.path[at];
            });
            Echo& echo =
                known != echoes_.end() ? *known : echoes_.emplace_back(Echo{truth.object[at], truth.path[at], 0, 0, 0});
            echo.energy += share;
            echo.elevation += share * elevationOf(truth, beam, at);
            echo.grazing += share * static_cast<double>(truth.grazing[at]);
        }
        fillBin(column * bins + bin, energy, hits, azimuths);
    }
    markShadows(column * bins, bins, azimuths);
}

void GridTruth::fillBin(size_t at, double energy, uint32_t hits, types::SonarTruth& azimuths) const {
    if (echoes_.empty()) return forget(at, azimuths);
    const Echo& strongest = *std::ranges::max_element(
        echoes_, {}, [](const Echo& echo) { return std::tuple(echo.energy, -echo.path, -echo.object); });
    azimuths.object[at] = strongest.object;
    azimuths.path[at] = strongest.path;
    azimuths.share[at] = static_cast<float>(strongest.energy / energy);
    azimuths.hits[at] = hits;
    azimuths.elevation[at] = static_cast<float>(strongest.elevation / strongest.energy);
    azimuths.grazing[at] = static_cast<float>(strongest.grazing / strongest.energy);
}

void GridTruth::copyReturn(const types::SonarTruth& truth, size_t beam, size_t bin, size_t cell,
                           types::SonarTruth& returns) {
    const size_t at = beam * truth.bin_count + bin;
    returns.object[cell] = truth.object[at];
    returns.share[cell] = truth.share[at];
    returns.hits[cell] = truth.hits[at];
    returns.elevation[cell] = static_cast<float>(elevationOf(truth, beam, at));
    returns.grazing[cell] = truth.grazing[at];
    returns.path[cell] = truth.path[at];
}

}  // namespace insonify::sonar
