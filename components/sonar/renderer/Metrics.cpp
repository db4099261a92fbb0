#include "components/sonar/renderer/Metrics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace insonify::sonar {
namespace {

constexpr double floor_ratio = 1e-6;      ///< -60 dB of the maximum.
constexpr double return_ratio = 0.01;     ///< -20 dB.
constexpr int shadow_neighbourhood = 50;  ///< Bins to either side whose mean a shadow is compared with.

double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

/** Energies of one beam from the first compared bin on. */
using BeamBins = std::vector<double>;

struct Comparison {
    std::vector<BeamBins> got, reference;
    int first_bin;
};

template <class T>
std::vector<BeamBins> getBeams(std::span<const T> energies, const Layout& layout, int first_bin) {
    std::vector<BeamBins> beams;
    for (int beam = 0; beam < layout.beams; ++beam) {
        const auto row = energies.subspan(static_cast<size_t>(beam * layout.bins + first_bin),
                                          static_cast<size_t>(layout.bins - first_bin));
        beams.emplace_back(row.begin(), row.end());
    }
    return beams;
}

double total(const BeamBins& beam) {
    double sum = 0;
    for (const double e : beam) sum += e;
    return sum;
}

/** Squares of difference and reference, each bin weighted by its central range to the power given. */
struct Squares {
    double error = 0, reference = 0;
    Squares& operator+=(const Squares& other) {
        error += other.error;
        reference += other.reference;
        return *this;
    }
    double relative() const { return error == 0 ? 0 : std::sqrt(error / reference); }
};

Squares squares(const BeamBins& got, const BeamBins& reference, int first_bin, double power) {
    Squares result;
    for (size_t k = 0; k < got.size(); ++k) {
        const double weight = std::pow(first_bin + static_cast<double>(k) + 0.5, power);
        result += {std::pow(weight * (got[k] - reference[k]), 2), std::pow(weight * reference[k], 2)};
    }
    return result;
}

void addNorms(const Comparison& c, Metrics& metrics) {
    Squares plain, flattened;
    int received = 0;
    for (size_t b = 0; b < c.got.size(); ++b) {
        const Squares beam = squares(c.got[b], c.reference[b], c.first_bin, 0);
        plain += beam;
        flattened += squares(c.got[b], c.reference[b], c.first_bin, 5);
        if (beam.reference > 0) {
            metrics.mean_rel_l2 += beam.relative();
            ++received;
        }
    }
    metrics.rel_l2 = plain.relative();
    metrics.rel_l2_tvg = flattened.relative();
    metrics.mean_rel_l2 /= std::max(1, received);
}

void addLevels(const Comparison& c, Metrics& metrics) {
    double maximum = 0;
    for (const BeamBins& beam : c.reference) maximum = std::max(maximum, *std::ranges::max_element(beam));
    const double floor = maximum * floor_ratio;
    std::vector<double> off;
    for (size_t b = 0; b < c.got.size(); ++b)
        for (size_t k = 0; k < c.got[b].size(); ++k) {
            const double got = c.got[b][k], reference = c.reference[b][k];
            metrics.missing_bins += reference > floor && !(got > 0);
            metrics.ghost_bins += got > floor && !(reference > 0);
            if (reference > floor && got > 0) off.push_back(std::abs(10 * std::log10(got / reference)));
        }
    double sum = 0;
    for (const double db : off) sum += db * db;
    metrics.db_rmse = off.empty() ? 0 : std::sqrt(sum / static_cast<double>(off.size()));
    metrics.db_p95 = percentile(off, 0.95);
}

int firstReturn(const BeamBins& beam) {
    const double threshold = return_ratio * *std::ranges::max_element(beam);
    return static_cast<int>(std::ranges::find_if(beam, [&](double e) { return e > 0 && e >= threshold; }) -
                            beam.begin());
}

/** Bins between the first and the last return that are 20 dB below the mean around them. */
std::vector<bool> shadow(const BeamBins& beam) {
    std::vector<double> sums(beam.size() + 1);
    for (size_t k = 0; k < beam.size(); ++k) sums[k + 1] = sums[k] + beam[k];
    std::vector<bool> dark(beam.size());
    const auto received = [](double e) { return e > 0; };
    const auto first = std::ranges::find_if(beam, received) - beam.begin();
    const auto last = std::find_if(beam.rbegin(), beam.rend(), received).base() - beam.begin();
    for (auto k = first; k < last; ++k) {
        const auto low = std::max<std::ptrdiff_t>(0, k - shadow_neighbourhood);
        const auto high = std::min(static_cast<std::ptrdiff_t>(beam.size()), k + shadow_neighbourhood + 1);
        const double mean =
            (sums[static_cast<size_t>(high)] - sums[static_cast<size_t>(low)]) / static_cast<double>(high - low);
        dark[static_cast<size_t>(k)] = beam[static_cast<size_t>(k)] < return_ratio * mean;
    }
    return dark;
}

void addShapes(const Comparison& c, Metrics& metrics) {
    std::vector<double> returns;
    for (size_t b = 0; b < c.got.size(); ++b) {
        if (!(total(c.reference[b]) > 0)) continue;
        returns.push_back(std::abs(firstReturn(c.got[b]) - firstReturn(c.reference[b])));
        const std::vector<bool> got = shadow(c.got[b]), reference = shadow(c.reference[b]);
        for (size_t k = 0; k < got.size(); ++k) metrics.shadow_bins += got[k] != reference[k];
    }
    metrics.shadow_bins /= static_cast<double>(std::max<size_t>(1, returns.size()));
    metrics.first_return_bins = percentile(returns, 0.95);
}

void addEnergies(const Comparison& c, Metrics& metrics) {
    double got = 0, reference = 0, ripple = 0;
    int received = 0;
    for (size_t b = 0; b < c.got.size(); ++b) {
        const double beam = total(c.got[b]), wanted = total(c.reference[b]);
        got += beam;
        reference += wanted;
        if (!(wanted > 0)) continue;
        ripple += std::pow(beam / wanted - 1, 2);
        ++received;
    }
    metrics.energy_bias = got == reference ? 0 : got / reference - 1;
    metrics.ripple = std::sqrt(ripple / std::max(1, received));
}

double correlation(const Comparison& c) {
    double got = 0, reference = 0, count = 0;
    for (size_t b = 0; b < c.got.size(); ++b) {
        got += total(c.got[b]);
        reference += total(c.reference[b]);
        count += static_cast<double>(c.got[b].size());
    }
    double got_squares = 0, reference_squares = 0, products = 0;
    for (size_t b = 0; b < c.got.size(); ++b)
        for (size_t k = 0; k < c.got[b].size(); ++k) {
            const double x = c.got[b][k] - got / count, y = c.reference[b][k] - reference / count;
            got_squares += x * x;
            reference_squares += y * y;
            products += x * y;
        }
    if (c.got == c.reference) return 1;
    return got_squares > 0 && reference_squares > 0 ? products / std::sqrt(got_squares * reference_squares) : 0;
}

/** Levels of all bins, weakest first [dB]. */
std::vector<double> sortedLevels(const std::vector<BeamBins>& beams, double floor) {
    std::vector<double> levels;
    for (const BeamBins& beam : beams)
        for (const double e : beam) levels.push_back(10 * std::log10(std::max(e, floor)));
    std::ranges::sort(levels);
    return levels;
}

double levelDistance(const Comparison& c) {
    double maximum = 0;
    for (const BeamBins& beam : c.reference) maximum = std::max(maximum, *std::ranges::max_element(beam));
    const double floor = std::max(maximum * floor_ratio, std::numeric_limits<double>::min());
    const std::vector<double> got = sortedLevels(c.got, floor), reference = sortedLevels(c.reference, floor);
    double sum = 0;
    for (size_t i = 0; i < got.size(); ++i) sum += std::abs(got[i] - reference[i]);
    return sum / static_cast<double>(got.size());
}

/** Like FNV-1a of 64 bits, but a word of 32 bits at a time. */
uint64_t computeHash(std::span<const float> values) {
    uint64_t hash = 14695981039346656037ull;
    for (const float value : values) hash = (hash ^ std::bit_cast<uint32_t>(value)) * 1099511628211ull;
    return hash;
}

}  // namespace

Metrics compare(std::span<const float> got, std::span<const double> reference, const Layout& layout) {
    const int first_bin =
        std::clamp(static_cast<int>(std::ceil(layout.range_from / layout.bin_width - 1e-9)), 0, layout.bins - 1);
    const Comparison comparison{getBeams(got, layout, first_bin), getBeams(reference, layout, first_bin), first_bin};
    Metrics metrics;
    addNorms(comparison, metrics);
    addLevels(comparison, metrics);
    addShapes(comparison, metrics);
    addEnergies(comparison, metrics);
    metrics.correlation = correlation(comparison);
    metrics.level_distance = levelDistance(comparison);
    metrics.hash = computeHash(got);
    return metrics;
}

}  // namespace insonify::sonar
