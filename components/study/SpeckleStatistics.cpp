#include "components/study/SpeckleStatistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

constexpr size_t patch = 16;             ///< Bins and beams of a patch, and of a block of the jackknife.
constexpr double clipped_at_max = 0.02;  ///< Max fraction of a patch's bins with code 0 or the max code [1].
constexpr size_t fewest_blocks = 4;

/** Intensities on any scale, with marks for those that an instrument has clipped. */
struct Intensities {
    size_t beam_count, bin_count;
    std::vector<double> values = {};
    std::vector<bool> clipped = {};
};

Intensities getIntensities(const CodedPing& ping) {
    Intensities all{.beam_count = ping.beam_count, .bin_count = ping.bin_count};
    const double step = 1 / (std::pow(2, ping.bits) - 1);
    for (size_t i = 0; i < ping.codes.size(); ++i) {
        const float code = ping.codes[i];
        const bool clipped = code <= 0 || static_cast<double>(code) > 1 - 1.5 * step;
        // A code represents all levels that are rounded to it: evenly, by the hash of its place.
        const double within = clipped ? 0 : step * (types::unit(types::hashed(ping.bits, i, 0) >> 32) - 0.5);
        const auto spread = static_cast<float>(static_cast<double>(code) + within);
        all.values.push_back(std::pow(10, ping.levelDb(spread) / 10));
        all.clipped.push_back(clipped);
    }
    return all;
}

Intensities getIntensities(const types::Sonar& ping) {
    Intensities all{.beam_count = ping.beam_count, .bin_count = ping.bin_count};
    for (const float bin : ping.bins) all.values.push_back(static_cast<double>(bin));
    for (const float bin : ping.bins) all.clipped.push_back(!(bin > 0));
    return all;
}

SpeckleField emptyField(size_t beams, size_t bins) {
    return {.beam_count = beams, .bin_count = bins, .relative = std::vector<double>(beams * bins, NAN)};
}

/** Bins and beams from (beam, bin) on. */
struct Patch {
    const Intensities& all;
    size_t beam, bin;

    size_t place(size_t i, size_t j) const { return (beam + i) * all.bin_count + bin + j; }
    double meanAmplitude(size_t from_i, size_t from_j, size_t size) const {
        double sum = 0;
        for (size_t i = 0; i < size; ++i)
            for (size_t j = 0; j < size; ++j) sum += std::sqrt(all.values[place(from_i + i, from_j + j)]);
        return sum / static_cast<double>(size * size);
    }
    /** @param alike max relative difference of a quarter's mean amplitude from the patch's [1] */
    bool isOneKind(double alike) const {
        size_t clipped = 0;
        for (size_t i = 0; i < patch; ++i)
            for (size_t j = 0; j < patch; ++j) clipped += all.clipped[place(i, j)];
        if (static_cast<double>(clipped) > clipped_at_max * patch * patch) return false;
        const double mean = meanAmplitude(0, 0, patch);
        for (const size_t i : {size_t{0}, patch / 2})
            for (const size_t j : {size_t{0}, patch / 2})
                if (std::abs(meanAmplitude(i, j, patch / 2) - mean) > alike * mean) return false;
        return mean > 0;
    }
    void divideInto(SpeckleField& field) const {
        double sum = 0;
        for (size_t i = 0; i < patch; ++i)
            for (size_t j = 0; j < patch; ++j) sum += all.values[place(i, j)];
        for (size_t i = 0; i < patch; ++i)
            for (size_t j = 0; j < patch; ++j)
                field.relative[place(i, j)] = all.values[place(i, j)] * patch * patch / sum;
    }
};

SpeckleField overPatches(const Intensities& all, double alike) {
    SpeckleField field = emptyField(all.beam_count, all.bin_count);
    for (size_t beam = 0; beam + patch <= all.beam_count; beam += patch)
        for (size_t bin = 0; bin + patch <= all.bin_count; bin += patch)
            if (const Patch each{all, beam, bin}; each.isOneKind(alike)) each.divideInto(field);
    return field;
}

size_t sliceAt(size_t bin, size_t bin_count) { return bin * speckle_slices / bin_count; }

size_t loudestSlice(const Intensities& all) {
    std::array<double, speckle_slices> sums{}, counts{};
    for (size_t i = 0; i < all.values.size(); ++i) {
        if (std::isnan(all.values[i])) continue;
        sums[sliceAt(i % all.bin_count, all.bin_count)] += all.values[i];
        counts[sliceAt(i % all.bin_count, all.bin_count)] += 1;
    }
    for (size_t slice = 0; slice < speckle_slices; ++slice) sums[slice] /= std::max(1.0, counts[slice]);
    return static_cast<size_t>(std::ranges::max_element(sums) - sums.begin());
}

/** Sums for scintillation, texture and contrast; they can be added and subtracted. */
struct Sums {
    double count = 0, intensity = 0, square = 0, amplitude = 0, logarithm = 0, weighted = 0;

    void add(double x) {
        const double log_x = std::log(std::max(x, 1e-30));
        count += 1, intensity += x, square += x * x, amplitude += std::sqrt(x), logarithm += log_x;
        weighted += x * log_x;
    }
    Sums plus(const Sums& other, double sign) const {
        return {count + sign * other.count,         intensity + sign * other.intensity,
                square + sign * other.square,       amplitude + sign * other.amplitude,
                logarithm + sign * other.logarithm, weighted + sign * other.weighted};
    }
    double scintillation() const { return square * count / (intensity * intensity) - 1; }
    double texture() const { return weighted / intensity - logarithm / count - 1; }
    double contrast() const { return std::sqrt(intensity * count / (amplitude * amplitude) - 1); }
};

std::vector<Sums> makeBlocks(const SpeckleField& field) {
    const size_t rows = (field.beam_count + patch - 1) / patch, columns = (field.bin_count + patch - 1) / patch;
    std::vector<Sums> blocks(rows * columns);
    for (size_t beam = 0; beam < field.beam_count; ++beam)
        for (size_t bin = 0; bin < field.bin_count; ++bin)
            if (const double x = field.at(beam, bin); !std::isnan(x))
                blocks[beam / patch * columns + bin / patch].add(x);
    std::erase_if(blocks, [](const Sums& block) { return block.count == 0; });
    if (blocks.size() < fewest_blocks)
        throw std::invalid_argument("too few bins show speckle: no four patches of 16 x 16 are one kind of bottom");
    return blocks;
}

/** Returns a statistic of all blocks, and its spread when each block is omitted in turn. */
Estimate jackknife(const Sums& total, const std::vector<Sums>& blocks, const auto& figure) {
    const auto count = static_cast<double>(blocks.size());
    double mean = 0, squares = 0;
    for (const Sums& block : blocks) mean += figure(total.plus(block, -1)) / count;
    for (const Sums& block : blocks) squares += std::pow(figure(total.plus(block, -1)) - mean, 2);
    return {figure(total), std::sqrt(squares * (count - 1) / count)};
}

/** Sums over pairs of values. */
struct Pairs {
    double count = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(double x, double y) { count += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y; }
    double correlation() const {
        const double both = (aa - a * a / count) * (bb - b * b / count);
        return both > 0 ? (ab - a * b / count) / std::sqrt(both) : NAN;
    }
};

double lagged(const SpeckleField& field, size_t beams, size_t bins) {
    Pairs pairs;
    for (size_t beam = 0; beam + beams < field.beam_count; ++beam)
        for (size_t bin = 0; bin + bins < field.bin_count; ++bin) {
            const double here = field.at(beam, bin), there = field.at(beam + beams, bin + bins);
            if (!std::isnan(here) && !std::isnan(there)) pairs.add(here, there);
        }
    return pairs.correlation();
}

/** Returns the number of neighbours that share the information of one bin: the curve's sum over both sides, as far as
 *  it exceeds `floor`. */
double sharedBy(const LagCurve& curve, double floor) {
    double sum = 1;
    for (size_t lag = 1; lag < curve.size() && curve[lag] > floor; ++lag) sum += 2 * curve[lag];
    return sum;
}

double distanceOfExponential(const SpeckleField& field) {
    std::vector<double> values;
    for (const double x : field.relative)
        if (!std::isnan(x)) values.push_back(x);
    std::ranges::sort(values);
    const auto count = static_cast<double>(values.size());
    double worst = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        const double share = -std::expm1(-values[i]);
        worst = std::max({worst, share - static_cast<double>(i) / count, static_cast<double>(i + 1) / count - share});
    }
    return worst;
}

}  // namespace

SpeckleField overMeans(const types::Sonar& ping, const types::Sonar& means) {
    if (ping.beam_count != means.beam_count || ping.bin_count != means.bin_count)
        throw std::invalid_argument("a ping and its means differ in beams or bins");
    SpeckleField field = emptyField(ping.beam_count, ping.bin_count);
    for (size_t i = 0; i < ping.bins.size(); ++i)
        if (means.bins[i] > 0)
            field.relative[i] = static_cast<double>(ping.bins[i]) / static_cast<double>(means.bins[i]);
    return field;
}

SpeckleField overPatches(const CodedPing& ping, double alike) { return overPatches(getIntensities(ping), alike); }
SpeckleField overPatches(const types::Sonar& intensities) { return overPatches(getIntensities(intensities), 0.25); }

SpeckleField getSlice(const SpeckleField& field, size_t slice) {
    SpeckleField part = field;
    for (size_t i = 0; i < part.relative.size(); ++i)
        if (sliceAt(i % part.bin_count, part.bin_count) != slice) part.relative[i] = NAN;
    return part;
}

size_t loudestSlice(const CodedPing& ping) { return loudestSlice(getIntensities(ping)); }
size_t loudestSlice(const types::Sonar& intensities) { return loudestSlice(getIntensities(intensities)); }

SpeckleFigures computeFigures(const SpeckleField& field) {
    const std::vector<Sums> blocks = makeBlocks(field);
    Sums total;
    for (const Sums& block : blocks) total = total.plus(block, 1);
    SpeckleFigures figures;
    figures.bins = total.count;
    figures.contrast = total.contrast();
    figures.scintillation = jackknife(total, blocks, [](const Sums& sums) { return sums.scintillation(); });
    figures.texture = jackknife(total, blocks, [](const Sums& sums) { return sums.texture(); });
    for (size_t lag = 0; lag < speckle_lags; ++lag) {
        figures.along[lag] = lagged(field, 0, lag);
        figures.across[lag] = lagged(field, lag, 0);
    }
    const double floor = 3 / std::sqrt(total.count);
    figures.independent = total.count / (sharedBy(figures.along, floor) * sharedBy(figures.across, floor));
    figures.rayleigh_distance = distanceOfExponential(field) * std::sqrt(figures.independent);
    return figures;
}

double Likewise::noiseShare() const { return 1 - std::sqrt(std::clamp(intensities, 0.0, 1.0)); }

Likewise likewise(const SpeckleField& a, const SpeckleField& b) {
    if (a.beam_count != b.beam_count || a.bin_count != b.bin_count)
        throw std::invalid_argument("two pings have different beams or bins");
    Pairs amplitudes, intensities;
    for (size_t i = 0; i < a.relative.size(); ++i) {
        if (std::isnan(a.relative[i]) || std::isnan(b.relative[i])) continue;
        intensities.add(a.relative[i], b.relative[i]);
        amplitudes.add(std::sqrt(a.relative[i]), std::sqrt(b.relative[i]));
    }
    return {.amplitudes = amplitudes.correlation(), .intensities = intensities.correlation()};
}

}  // namespace insonify::study
