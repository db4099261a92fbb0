#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

#include "components/sonar/rays/Scatterers.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Makes patches of tiles, a batch at a time. */
class TilePatches {
public:
    TilePatches(const EchoRules& rules, const TracedView& view, const PlacedScene& scene, const EchoSums& to)
        : conical_(rules.features.has(Feature::Conical)),
          mapped_(rules.features.has(Feature::NormalMap)),
          has_maps_(rules.has_maps),
          has_own_(!rules.own.empty()),
          echoes_from_misses_(rules.echoes_from_misses && !to.behind_walls),
          view_(view.cells),
          shape_(view.shape),
          scene_(scene),
          deposit_(rules, scene.water, false, to),
          cells_(deposit_.cells),
          fields_(rules, to.sums),
          column_bits_(std::countr_zero(static_cast<uint32_t>(shape_.all.columns))) {
        for (int i = 0; i < tile_samples; ++i) {
            place_[i] = shape_.at[i].rows * shape_.all.columns + shape_.at[i].columns;
            sample_[place_[i]] = i;
        }
    }

    void add(const TracedTile& tile) {
        uint32_t hits = 0;
        for (int i = 0; i < tile_samples; ++i) {
            command_[place_[i]] = tile.hits->command[i];
            triangle_[place_[i]] = tile.hits->triangle[i];
            hits |= static_cast<uint32_t>(tile.hits->command[i] != TileHits::nothing) << place_[i];
        }
        for (uint32_t left = echoes_from_misses_ ? ~hits & 0xffff : 0; left != 0; left &= left - 1)
            addMiss(tile, std::countr_zero(left));
        while (hits != 0) {
            const int first = std::countr_zero(hits);
            uint32_t same = 0;
            for (int i = 0; i < tile_samples; ++i)
                same |= static_cast<uint32_t>((command_[i] == command_[first]) & (triangle_[i] == triangle_[first]))
                        << i;
            same = tile.apparent ? 1u << first : getPart(tile, same & hits);
            addPatch(tile, same);
            hits &= ~same;
        }
    }

    void finish() {
        relateSizes(view_, cells_);
        if (mapped_) in_map_.setCosines(scene_, 0, cells_.count, cells_);
        deposit_.cover();
        for (int i = 0; i < cells_.count; ++i)
            if (deposit_.covered.pixel[i] > 0 && cells_.width[i] > 0)  // no direction beyond a cone's end
                fields_.deposit(makePatch(i));
        deposit_.finish();
    }

private:
    /** Samples are numbered row by row here: bit all.columns * row + column. */
    int getColumn(int place) const { return place & (shape_.all.columns - 1); }
    int getRow(int place) const { return place >> column_bits_; }
    uint32_t bits(int column, int columns, int row, int rows) const {
        uint32_t all = 0;
        for (int up = row; up < row + rows; ++up) all |= ((1u << columns) - 1) << (up * shape_.all.columns + column);
        return all;
    }
    SampleRectangle around(const TracedTile& tile, uint32_t samples) const {
        uint32_t columns = 0;
        for (uint32_t left = samples; left != 0; left >>= shape_.all.columns) columns |= left;
        columns &= (1u << shape_.all.columns) - 1;
        const int column = std::countr_zero(columns), row = getRow(std::countr_zero(samples));
        return {view_, tile.first_column + column, static_cast<int>(std::bit_width(columns)) - column,
                tile.first_row + row, getRow(static_cast<int>(std::bit_width(samples)) - 1) - row + 1};
    }
    int beamAt(const TracedTile& tile, int place) const {
        return view_.beam_of[static_cast<size_t>(tile.first_column + getColumn(place))];
    }

    /** Returns the samples of one patch with the lowest sample, among samples that hit the same triangle. Where beams
     *  do not join, a patch has one beam. Where effects have their own sums, which need whole cells, it is a rectangle
     *  of one beam. */
    uint32_t getPart(const TracedTile& tile, uint32_t same) const {
        const int first = std::countr_zero(same);
        if (has_own_ || !view_.joined) {
            int column = getColumn(first), end = column + 1;
            const auto isNeighbour = [&](int other) {
                return other >= 0 && other < shape_.all.columns && beamAt(tile, other) == beamAt(tile, first);
            };
            while (isNeighbour(end)) ++end;
            while (isNeighbour(column - 1)) --column;
            same &= bits(column, end - column, 0, shape_.all.rows);
        }
        const int row = getRow(first);
        if (has_own_) {
            int column = getColumn(first), end = column + 1;
            while (end < shape_.all.columns && (same & bits(end, 1, row, 1)) != 0) ++end;
            int top = row + 1;
            const auto row_bits = [&](int up) { return bits(column, end - column, up, 1); };
            while (top < shape_.all.rows && (same & row_bits(top)) == row_bits(top)) ++top;
            return bits(column, end - column, row, top - row);
        }
        if (isRectangle(around(tile, same), same)) return same;
        return same & bits(0, shape_.all.columns, row, std::min(Patch::max_rows, shape_.all.rows - row));
    }
    static bool isRectangle(const SampleRectangle& all, uint32_t samples) {
        return std::popcount(samples) == all.columns * all.rows;
    }

    /** Adds a miss: only effects process it. */
    void addMiss(const TracedTile& tile, int place) {
        const int column = tile.first_column + getColumn(place), row = tile.first_row + getRow(place);
        if (column >= tile.end_column || row >= view_.rows) return;
        cells_.setMiss(cells_.count);
        cells_.gain[cells_.count] = 1;
        in_map_.placeMiss(cells_.count);
        setLookDirection(view_, conical_, {view_, column, 1, row, 1}, cells_.count, cells_);
        count();
    }

    void addPatch(const TracedTile& tile, uint32_t samples) {
        const int i = cells_.count, first = std::countr_zero(samples);
        const SampleRectangle all = around(tile, samples);
        const CommandRecord& command = scene_.commands[command_[first]];
        cells_.setPlane(i, scene_.ranges[command_[first]], triangle_[first]);
        setLookDirection(view_, conical_, all, i, cells_);
        if (tile.passed) cells_.size[i] *= meanPassed(tile, samples);
        if (has_maps_) cells_.gain[i] = meanGain(tile, samples);
        if (tile.isApparent(sample_[first])) putApparent(cells_, i, tile.apparent[sample_[first]]);
        if (tile.late) moveAway(cells_, i, meanLate(tile, samples));
        sources_[i] = {all, samplesIn(all, samples, tile), command.object, command.lattice};
        if (mapped_) placeInMap(i, *tile.hits, samples);
        count();
    }

    /** Returns the mean of `passed` of some samples [1]. */
    double meanPassed(const TracedTile& tile, uint32_t samples) const {
        double sum = 0;
        for (uint32_t left = samples; left != 0; left &= left - 1)
            sum += tile.meanPassed(sample_[std::countr_zero(left)], 1);
        return sum / std::popcount(samples);
    }

    /** Returns the mean factor of some samples by surface maps [1]. */
    double meanGain(const TracedTile& tile, uint32_t samples) const {
        double sum = 0;
        for (uint32_t left = samples; left != 0; left &= left - 1)
            sum += tile.meanGain(sample_[std::countr_zero(left)], 1);
        return sum / std::popcount(samples);
    }

    /** Returns the mean slant range of some samples beyond that of their surface [m]. */
    double meanLate(const TracedTile& tile, uint32_t samples) const {
        double sum = 0;
        for (uint32_t left = samples; left != 0; left &= left - 1)
            sum += tile.meanLate(sample_[std::countr_zero(left)], 1);
        return sum / std::popcount(samples);
    }

    /** Returns samples numbered as in Patch::seen. */
    uint32_t samplesIn(const SampleRectangle& all, uint32_t samples, const TracedTile& tile) const {
        const uint32_t row_bits = (1u << all.columns) - 1;
        if (isRectangle(all, samples)) return row_bits;
        uint32_t seen = 0;
        for (int row = 0; row < all.rows; ++row) {
            const int place = (all.first_row - tile.first_row + row) * shape_.all.columns;
            seen |= (samples >> (place + all.first_column - tile.first_column) & row_bits) << Patch::max_columns * row;
        }
        return seen;
    }

    void count() {
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Records the mean place of the samples of cell i in their triangle. */
    void placeInMap(int i, const TileHits& hits, uint32_t samples) {
        float u = 0, v = 0;
        for (uint32_t left = samples; left != 0; left &= left - 1) {
            const int sample = sample_[std::countr_zero(left)];
            u += hits.u[sample];
            v += hits.v[sample];
        }
        const float per_sample = 1 / static_cast<float>(std::popcount(samples));
        const int first = std::countr_zero(samples);
        in_map_.place(i, command_[first], triangle_[first], u * per_sample, v * per_sample);
    }

    /** Sets the columns' edges, which are tangents about the middle of the rectangle, or sines of cones; and their
     *  beams. */
    void setColumns(const SampleRectangle& all, Patch& patch) const {
        const AngularView::Direction& middle = patch.bearing;
        const auto first_beam = deposit_.to().first_beam;
        for (int k = 0; k <= all.columns; ++k) {
            const int column = all.first_column + std::min(k, all.columns - 1);
            const AngularView::Direction& edge = view_.azimuths[k < all.columns ? view_.at(column) : all.right];
            const double aside = edge.sine * middle.cosine - edge.cosine * middle.sine,
                         ahead = edge.cosine * middle.cosine + edge.sine * middle.sine;
            patch.columns[static_cast<size_t>(k)] = conical_ ? edge.sine : aside / std::max(ahead, 1e-9);
            if (k < Patch::max_columns)
                patch.beams[static_cast<size_t>(k)] =
                    static_cast<uint32_t>(view_.beam_of[static_cast<size_t>(column)] - first_beam);
        }
        for (auto k = static_cast<size_t>(all.columns); k < Patch::max_columns; ++k) {
            patch.columns[k + 1] = patch.columns[k];
            patch.beams[k] = patch.beams[k - 1];
        }
    }

    Patch makePatch(int i) const {
        const Source& source = sources_[i];
        const SampleRectangle& all = source.all;
        const AngularView::Elevation &low = view_.elevations[all.low], &high = view_.elevations[all.high];
        const auto direction = [&](size_t side, const AngularView::Elevation& up) {
            const AngularView::Direction around =
                conical_ ? AngularView::computeAzimuth(view_.bearings[side], up) : view_.azimuths[side];
            return glm::dvec3(up.cosine * around.cosine, up.cosine * around.sine, up.sine);
        };
        Patch patch{{cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]},
                    cells_.distance[i],
                    {cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i], cells_.sin_el[i]},
                    {direction(all.left, low), direction(all.left, high), direction(all.right, high),
                     direction(all.right, low)},
                    cells_.width[i],
                    cells_.height[i],
                    view_.azimuths[all.across(view_)],
                    {},
                    {},
                    source.seen,
                    {},
                    deposit_.covered.strength_range[i],
                    cells_.size[i] / (cells_.width[i] * (high.sine - low.sine)),
                    scene_.objects[source.object],
                    source.lattice,
                    conical_};
        // Cones are wider in azimuth towards their ends.
        for (size_t k = 1; conical_ && k < patch.corners.size(); ++k)
            for (size_t j = 0; j < k; ++j) {
                const glm::dvec3 &from = patch.corners[j], &to = patch.corners[k];
                patch.width = std::max(
                    patch.width, std::abs(std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y)));
            }
        setColumns(all, patch);
        const bool is_one_row = source.seen < 1u << Patch::max_columns;
        for (size_t k = 0; k < patch.rows.size(); ++k) {
            const size_t edge = is_one_row && k > 0 ? all.high : std::min(all.low + 2 * k, all.high);
            patch.rows[k] = view_.elevations[edge].sine;
        }
        return patch;
    }

    /** The samples and the object of a cell. */
    struct Source {
        SampleRectangle all;
        uint32_t seen;  ///< As in Patch.
        uint32_t object, lattice;
    };

    bool conical_, mapped_, has_maps_, has_own_, echoes_from_misses_;
    const AngularView& view_;
    const TileShape& shape_;
    const PlacedScene& scene_;
    CellDeposit deposit_;
    Cells& cells_;
    Scatterers fields_;
    int column_bits_;           ///< log2 of a tile's columns [1].
    int place_[tile_samples];   ///< Place of each sample, row by row.
    int sample_[tile_samples];  ///< Sample at each place.
    alignas(64) uint32_t command_[tile_samples],
        triangle_[tile_samples];  ///< Hits of the current tile, row by row.
    Source sources_[Cells::capacity];
    MappedCells in_map_;
};

}  // namespace

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void depositPatches(const EchoRules& rules, const TracedView& view,
                                                                    const PlacedScene& scene,
                                                                    std::span<const TracedTile> tiles,
                                                                    const EchoSums& to) {
    TilePatches patches(rules, view, scene, to);
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (i + 2 < tiles.size()) fetchPlanes(scene, tiles[i + 2]);
        patches.add(tiles[i]);
    }
    patches.finish();
}

}  // namespace insonify::sonar
