#include "components/sonar/bins/Beamformer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

constexpr size_t tile_rows = 16, tile_bins = 256;  ///< Rows of a tile fit the first cache of a core [1].

/** Returns the mean of a beam's pattern over a cell, by Simpson's rule; for fields the root of the mean power, with the
 *  sign of the middle. */
double meanOver(const Beamformer::Rules& rules, const Beam& whole, double bearing) {
    Beam cell = whole;
    double share = 1;
    if (std::isfinite(rules.half_box)) {
        const double from =
            bearing + 2 * std::numbers::pi * std::round((whole.centre - bearing) / (2 * std::numbers::pi));
        cell.low = std::max(whole.low, from - rules.half_box);
        cell.high = std::min(whole.high, from + rules.half_box);
        share = (cell.high - cell.low) / (whole.high - whole.low);
        if (!(share > 1e-9)) return 0;
        if (share > 1 - 1e-9) share = 1, cell = whole;
        cell.centre = 0.5 * (cell.low + cell.high);
    }
    const double low = rules.pattern(cell.low, bearing), middle = rules.pattern(cell.centre, bearing),
                 high = rules.pattern(cell.high, bearing);
    if (!rules.of_fields) return share * (low + 4 * middle + high) / 6;
    return std::copysign(std::sqrt(share * (low * low + 4 * middle * middle + high * high) / 6), middle);
}

double computeWidth(const Beam& cell) { return cell.high - cell.low; }

/** Returns the first cell of each group, and the number of cells. */
std::vector<size_t> groupBy(const Fan& cells) {
    const double narrow = 1.5 * computeWidth(*std::ranges::min_element(cells, {}, computeWidth));
    std::vector<size_t> starts{0};
    for (size_t i = 1; i < cells.size(); ++i)
        if (i - starts.back() == Beamformer::group_cells || computeWidth(cells[i]) > narrow ||
            computeWidth(cells[i - 1]) > narrow)
            starts.push_back(i);
    starts.push_back(cells.size());
    return starts;
}

/** Removes weights below the floor from both ends. */
void trim(auto& run, double floor) {
    const auto received = [&](float weight) { return std::abs(static_cast<double>(weight)) >= floor; };
    const auto last = std::find_if(run.weights.rbegin(), run.weights.rend(), received);
    run.weights.erase(last.base(), run.weights.end());
    const auto first = std::ranges::find_if(run.weights, received);
    run.first += static_cast<size_t>(first - run.weights.begin());
    run.weights.erase(run.weights.begin(), first);
}

/** bins[j] += sum of weights[i] rows[i * stride + j]. */
INSONIFY_VECTOR_CLONES void addRows(const float* rows, size_t stride, std::span<const float> weights,
                                    float* __restrict bins, size_t count) {
    size_t i = 0;
    for (; i + 8 <= weights.size(); i += 8) {
        const float* row = rows + i * stride;
        const float a = weights[i], b = weights[i + 1], c = weights[i + 2], d = weights[i + 3], e = weights[i + 4],
                    f = weights[i + 5], g = weights[i + 6], h = weights[i + 7];
        for (size_t j = 0; j < count; ++j)
            bins[j] = bins[j] +
                      ((a * row[j] + b * row[stride + j]) + (c * row[2 * stride + j] + d * row[3 * stride + j])) +
                      ((e * row[4 * stride + j] + f * row[5 * stride + j]) +
                       (g * row[6 * stride + j] + h * row[7 * stride + j]));
    }
    for (; i + 4 <= weights.size(); i += 4) {
        const float* row = rows + i * stride;
        const float a = weights[i], b = weights[i + 1], c = weights[i + 2], d = weights[i + 3];
        for (size_t j = 0; j < count; ++j)
            bins[j] += (a * row[j] + b * row[stride + j]) + (c * row[2 * stride + j] + d * row[3 * stride + j]);
    }
    for (; i < weights.size(); ++i)
        for (size_t j = 0; j < count; ++j) bins[j] += weights[i] * rows[i * stride + j];
}

}  // namespace

Beamformer::Beamformer(const Fan& beams, const Fan& cells, size_t bin_count, const Rules& rules)
    : groups_(groupBy(cells)), bin_count_(bin_count), grouped_(groupCount() * bin_count) {
    const auto addBands = [&](size_t end, const Rules& own) {
        BandsTo& bands = bands_.emplace_back(BandsTo{end, {}});
        for (const Beam& beam : beams) bands.of_beams.push_back(computeBand(beam, cells, own));
    };
    for (const Zone& zone : rules.nearer)
        addBands(zone.end, {zone.pattern, zone.near, rules.floor, rules.of_fields, rules.half_box});
    addBands(bin_count, rules);
}

Beamformer::Band Beamformer::computeBand(const Beam& beam, const Fan& cells, const Rules& rules) const {
    const auto computeWeight = [&](size_t cell) { return meanOver(rules, cells[cell], beam.centre); };
    const double narrow = computeWidth(*std::ranges::min_element(cells, {}, computeWidth));
    const auto addGroup = [&](size_t group, Run& run) {
        const Beam &first = cells[groups_[group]], &last = cells[groups_[group + 1] - 1];
        const auto parts = static_cast<size_t>((last.high - first.low) / narrow + 0.5);
        const double part = (last.high - first.low) / static_cast<double>(parts);
        double sum = 0;
        for (size_t i = 0; i < parts; ++i) {
            const double weight = rules.pattern(first.low + (static_cast<double>(i) + 0.5) * part, beam.centre);
            sum += rules.of_fields ? weight * weight : weight;
        }
        const double mean = sum / static_cast<double>(parts);
        run.weights.push_back(static_cast<float>(rules.of_fields ? std::sqrt(mean) : mean));
    };
    const auto groupAt = [&](double azimuth) {
        size_t group = groupCount() - 1;
        while (group > 0 && cells[groups_[group]].low > azimuth) --group;
        return group;
    };
    constexpr double turn = 2 * std::numbers::pi;
    const double low = beam.centre - rules.near, high = beam.centre + rules.near;
    const size_t from = groupAt(low), to = groupAt(high) + 1;
    // Groups [0, start) and [end, groupCount()) are near as well, across the seam.
    const size_t start = cells.isRound() && high > cells.high() ? std::min(groupAt(high - turn) + 1, from) : 0;
    const size_t end = cells.isRound() && low < cells.low() ? std::max(groupAt(low + turn), to) : groupCount();
    Band band;
    const auto addCells = [&](size_t first, size_t last, Run& run) {
        run.first = groups_[first];
        for (size_t c = groups_[first]; c < groups_[last]; ++c)
            run.weights.push_back(static_cast<float>(computeWeight(c)));
    };
    const auto addGroups = [&](size_t first, size_t last, Run& run) {
        run.first = first;
        for (size_t g = first; g < last; ++g) addGroup(g, run);
    };
    addCells(from, to, band.cells[0]);
    if (start > 0) addCells(0, start, band.cells[1]);
    if (start == 0) addCells(end, groupCount(), band.cells[1]);
    if (!std::isfinite(rules.half_box)) {
        addGroups(start, from, band.groups[0]);
        addGroups(to, start > 0 ? groupCount() : end, band.groups[1]);
    }
    for (Run& run : band.cells) trim(run, rules.floor);
    for (Run& run : band.groups) trim(run, rules.floor);
    return band;
}

void Beamformer::sumGroup(size_t group, std::span<const float> echoes) {
    INSONIFY_CHECK(group < groupCount() && cellsIn(group) <= group_cells, group, groupCount());
    static constexpr float items[group_cells] = {1, 1, 1, 1, 1, 1, 1, 1};
    float* sum = &grouped_[group * bin_count_];
    std::fill(sum, sum + bin_count_, 0.0f);
    addRows(&echoes[groups_[group] * bin_count_], bin_count_, {items, cellsIn(group)}, sum, bin_count_);
}

void Beamformer::addTile(const Tile& tile, const BandsTo& bands, const auto& run, const float* rows,
                         std::span<float> bins) const {
    const std::span beams(&bands.of_beams[tile.first_beam], tile.beams);
    size_t low = groups_.back(), high = 0;
    for (const Band& band : beams) {
        if (run(band).weights.empty()) continue;
        low = std::min(low, run(band).first);
        high = std::max(high, run(band).first + run(band).weights.size());
    }
    for (size_t row = low; row < high; row += tile_rows)
        for (size_t i = 0; i < beams.size(); ++i) {
            const Run& own = run(beams[i]);
            if (own.weights.empty()) continue;
            // Rows are added in fours from the run's first, in all tiles.
            const auto countTo = [&](size_t end) {
                return std::min(own.weights.size(), end > own.first ? (end - own.first + 3) / 4 * 4 : 0);
            };
            const size_t from = countTo(row), to = countTo(row + tile_rows);
            addRows(rows + (own.first + from) * bin_count_ + tile.first_bin, bin_count_,
                    std::span(own.weights).subspan(from, to - from), &bins[i * bin_count_ + tile.first_bin], tile.bins);
        }
}

void Beamformer::form(size_t first, size_t count, std::span<const float> echoes, std::span<float> bins) const {
    INSONIFY_CHECK(bins.size() == count * bin_count_, bins.size(), count, bin_count_);
    INSONIFY_CHECK(echoes.size() == groups_.back() * bin_count_, echoes.size(), groups_.back(), bin_count_);
    std::ranges::fill(bins, 0.0f);
    size_t from = 0;
    for (const BandsTo& bands : bands_) {
        for (; from < bands.end; from += std::min(tile_bins, bands.end - from)) {
            const Tile tile{first, count, from, std::min(tile_bins, bands.end - from)};
            for (const size_t side : {0, 1})
                addTile(
                    tile, bands, [&](const Band& band) -> const Run& { return band.cells[side]; }, echoes.data(), bins);
            for (const size_t side : {0, 1})
                addTile(
                    tile, bands, [&](const Band& band) -> const Run& { return band.groups[side]; }, grouped_.data(),
                    bins);
        }
    }
}

std::vector<double> Beamformer::weights(size_t beam) const {
    std::vector<double> all(groups_.back());
    const Band& band = bands_.back().of_beams[beam];
    for (const Run& run : band.cells)
        for (size_t i = 0; i < run.weights.size(); ++i) all[run.first + i] = static_cast<double>(run.weights[i]);
    for (const Run& run : band.groups)
        for (size_t i = 0; i < run.weights.size(); ++i)
            for (size_t c = groups_[run.first + i]; c < groups_[run.first + i + 1]; ++c)
                all[c] = static_cast<double>(run.weights[i]);
    return all;
}

}  // namespace insonify::sonar
