#include "components/sonar/bins/Beamformer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

constexpr size_t lanes = 16;                       ///< Floats of the widest register [1].
constexpr size_t tile_rows = 16, tile_bins = 256;  ///< Rows of a tile fit the first cache of a core [1].

using Field = std::complex<double>;

/** The means of one beam's pattern over cells. Cells that follow each other share the pattern at their common edge. */
class CellMeans {
public:
    CellMeans(const Beamformer::Rules& rules, const Fan& cells, double bearing)
        : rules_(rules), cells_(cells), bearing_(bearing) {}

    /** Returns the mean over a cell, by Simpson's rule; for fields the root of the mean power of either part, with the
     *  sign of the part in the middle. */
    Field over(size_t number) {
        const Beam& whole = cells_[number];
        if (!std::isfinite(rules_.half_box)) return over(whole, 1);
        const double from =
            bearing_ + 2 * std::numbers::pi * std::round((whole.centre - bearing_) / (2 * std::numbers::pi));
        Beam cell = whole;
        cell.low = std::max(whole.low, from - rules_.half_box);
        cell.high = std::min(whole.high, from + rules_.half_box);
        const double share = (cell.high - cell.low) / (whole.high - whole.low);
        if (!(share > 1e-9)) return 0;
        if (share > 1 - 1e-9) return over(whole, 1);
        cell.centre = 0.5 * (cell.low + cell.high);
        return over(cell, share);
    }

private:
    Field over(const Beam& cell, double share) {
        // Only complex patterns, which are costly, are shared: of others all bits are those of each cell alone.
        const bool is_shared = rules_.is_complex && std::abs(cell.low - edge_) <= 1e-9 * (cell.high - cell.low);
        const Field low = is_shared ? at_edge_ : rules_.pattern(cell.low, bearing_),
                    middle = rules_.pattern(cell.centre, bearing_), high = rules_.pattern(cell.high, bearing_);
        edge_ = cell.high;
        at_edge_ = high;
        const auto mean = [&](double a, double b, double c) {
            if (!rules_.of_fields) return share * (a + 4 * b + c) / 6;
            return std::copysign(std::sqrt(share * (a * a + 4 * b * b + c * c) / 6), b);
        };
        return {mean(low.real(), middle.real(), high.real()),
                rules_.is_complex ? mean(low.imag(), middle.imag(), high.imag()) : 0};
    }

    const Beamformer::Rules& rules_;
    const Fan& cells_;
    double bearing_;
    double edge_ = std::numeric_limits<double>::infinity();  ///< Upper edge of the last cell [rad].
    Field at_edge_;                                          ///< Pattern there.
};

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
    : groups_(groupBy(cells)), bin_count_(bin_count), grouped_(groupCount() * bin_count), supports_(groupCount()) {
    for (size_t group = 0; group < groupCount(); ++group) group_of_.resize(groups_[group + 1], group);
    const auto addBands = [&](size_t end, const Rules& own) {
        BandsTo& bands = bands_.emplace_back(BandsTo{end, {}});
        for (const Beam& beam : beams) {
            Bands of_beam = computeBands(beam, cells, own);
            for (const Part part : {Real, Imaginary}) {
                for (const Run& run : of_beam[part].groups) has_groups_ = has_groups_ || !run.weights.empty();
                if (part == Real || rules.is_complex) bands.of_beams[part].push_back(std::move(of_beam[part]));
            }
        }
    };
    for (const Zone& zone : rules.nearer)
        addBands(zone.end, {zone.pattern, zone.near, rules.floor, rules.of_fields, rules.half_box, rules.is_complex});
    addBands(bin_count, rules);
}

Beamformer::Bands Beamformer::computeBands(const Beam& beam, const Fan& cells, const Rules& rules) const {
    const double narrow = computeWidth(*std::ranges::min_element(cells, {}, computeWidth));
    const auto computeGroup = [&](size_t group) -> Field {
        const Beam &first = cells[groups_[group]], &last = cells[groups_[group + 1] - 1];
        const auto parts = static_cast<size_t>((last.high - first.low) / narrow + 0.5);
        const double part = (last.high - first.low) / static_cast<double>(parts);
        double real = 0, imaginary = 0;
        for (size_t i = 0; i < parts; ++i) {
            const Field weight = rules.pattern(first.low + (static_cast<double>(i) + 0.5) * part, beam.centre);
            real += rules.of_fields ? weight.real() * weight.real() : weight.real();
            imaginary += weight.imag() * weight.imag();
        }
        real /= static_cast<double>(parts), imaginary /= static_cast<double>(parts);
        return rules.of_fields ? Field(std::sqrt(real), std::sqrt(imaginary)) : Field(real);
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
    Bands bands;
    const auto addRun = [&](size_t first, size_t last, const auto& run, const auto& weight) {
        for (const Part part : {Real, Imaginary}) run(bands[part]).first = first;
        for (size_t i = first; i < last; ++i) {
            const Field all = weight(i);
            run(bands[Real]).weights.push_back(static_cast<float>(all.real()));
            if (rules.is_complex) run(bands[Imaginary]).weights.push_back(static_cast<float>(all.imag()));
        }
        for (const Part part : {Real, Imaginary}) trim(run(bands[part]), rules.floor);
    };
    CellMeans means(rules, cells, beam.centre);
    const auto addCells = [&](size_t first, size_t last, size_t side) {
        addRun(
            groups_[first], groups_[last], [side](Band& band) -> Run& { return band.cells[side]; },
            [&](size_t cell) { return means.over(cell); });
    };
    const auto addGroups = [&](size_t first, size_t last, size_t side) {
        addRun(
            first, last, [side](Band& band) -> Run& { return band.groups[side]; }, computeGroup);
    };
    addCells(from, to, 0);
    if (start > 0) addCells(0, start, 1);
    if (start == 0) addCells(end, groupCount(), 1);
    if (!std::isfinite(rules.half_box)) {
        addGroups(start, from, 0);
        addGroups(to, start > 0 ? groupCount() : end, 1);
    }
    return bands;
}

void Beamformer::sumGroup(size_t group, std::span<const float> echoes) {
    INSONIFY_CHECK(group < groupCount() && cellsIn(group) <= group_cells, group, groupCount());
    supports_[group] = findSupport(group, echoes);
    if (!has_groups_) return;
    static constexpr float items[group_cells] = {1, 1, 1, 1, 1, 1, 1, 1};
    float* sum = &grouped_[group * bin_count_];
    std::fill(sum, sum + bin_count_, 0.0f);
    addRows(&echoes[groups_[group] * bin_count_], bin_count_, {items, cellsIn(group)}, sum, bin_count_);
}

Beamformer::Support Beamformer::findSupport(size_t group, std::span<const float> echoes) const {
    const auto has_echo = [](float value) { return value != 0; };
    Support support{bin_count_, 0};
    for (size_t cell = groups_[group]; cell < groups_[group + 1]; ++cell) {
        const auto own = echoes.subspan(cell * bin_count_, bin_count_);
        const auto before = own.first(support.first);
        support.first = static_cast<size_t>(std::ranges::find_if(before, has_echo) - before.begin());
        const auto behind = own.subspan(support.end);
        const auto last = std::find_if(behind.rbegin(), behind.rend(), has_echo);
        support.end += static_cast<size_t>(last.base() - behind.begin());
    }
    return support;
}

void Beamformer::addTile(const Tile& tile, const std::vector<Band>& bands, const auto& run, const float* rows,
                         const auto& groupOf, std::span<float> bins) const {
    const std::span beams(&bands[tile.first_beam], tile.beams);
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
            if (from == to) continue;
            // Bins that are 0 in all rows change no bit.
            size_t first = tile.first_bin + tile.bins, end = 0;
            for (size_t g = groupOf(own.first + from); g <= groupOf(own.first + to - 1); ++g) {
                first = std::min(first, supports_[g].first);
                end = std::max(end, supports_[g].end);
            }
            first = std::max(first, tile.first_bin), end = std::min(end, tile.first_bin + tile.bins);
            if (first >= end) continue;
            first -= (first - tile.first_bin) % lanes;
            addRows(rows + (own.first + from) * bin_count_ + first, bin_count_,
                    std::span(own.weights).subspan(from, to - from), &bins[i * bin_count_ + first], end - first);
        }
}

void Beamformer::form(Part part, size_t first, size_t count, std::span<const float> echoes,
                      std::span<float> bins) const {
    INSONIFY_CHECK(bins.size() == count * bin_count_, bins.size(), count, bin_count_);
    INSONIFY_CHECK(echoes.size() == groups_.back() * bin_count_, echoes.size(), groups_.back(), bin_count_);
    std::ranges::fill(bins, 0.0f);
    size_t from = 0;
    for (const BandsTo& bands : bands_) {
        const std::vector<Band>& of_beams = bands.of_beams[part];
        for (; from < bands.end; from += std::min(tile_bins, bands.end - from)) {
            const Tile tile{first, count, from, std::min(tile_bins, bands.end - from)};
            for (const size_t side : {0, 1})
                addTile(
                    tile, of_beams, [&](const Band& band) -> const Run& { return band.cells[side]; }, echoes.data(),
                    [this](size_t cell) { return group_of_[cell]; }, bins);
            for (const size_t side : {0, 1})
                addTile(
                    tile, of_beams, [&](const Band& band) -> const Run& { return band.groups[side]; }, grouped_.data(),
                    [](size_t group) { return group; }, bins);
        }
    }
}

std::vector<double> Beamformer::weights(size_t beam) const {
    std::vector<double> all(groups_.back());
    const Band& band = bands_.back().of_beams[Real][beam];
    for (const Run& run : band.cells)
        for (size_t i = 0; i < run.weights.size(); ++i) all[run.first + i] = static_cast<double>(run.weights[i]);
    for (const Run& run : band.groups)
        for (size_t i = 0; i < run.weights.size(); ++i)
            for (size_t c = groups_[run.first + i]; c < groups_[run.first + i + 1]; ++c)
                all[c] = static_cast<double>(run.weights[i]);
    return all;
}

}  // namespace insonify::sonar
