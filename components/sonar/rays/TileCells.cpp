#include "components/sonar/rays/TileCells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Makes cells of tiles, a batch at a time. */
class TileCells {
public:
    TileCells(const EchoRules& rules, const CastView& view, const PlacedScene& scene, const EchoSums& to)
        : conical_(rules.features.has(Feature::Conical)),
          mapped_(rules.features.has(Feature::NormalMap)),
          hears_misses_(rules.hears_misses),
          view_(view.cells),
          shape_(view.shape),
          scene_(scene),
          deposit_(rules, scene.water, scene.paths, to),
          cells_(deposit_.cells) {}

    void add(const CastTile& tile) {
        for (int i = 0; i < tile_samples;) {
            const bool met = tile.hits->command[i] != TileHits::nothing;
            const int merged = met ? sameFrom(*tile.hits, i) : 1;
            if (met)
                addCell(tile, i, merged);
            else if (hears_misses_)
                addMiss(tile, i);
            i += merged;
        }
    }
    void finish() { deposit_.flush(); }

private:
    /** Samples from i on that are a rectangle of one triangle in one beam. */
    int sameFrom(const TileHits& hits, int i) const {
        const auto alignment = static_cast<uint32_t>(i == 0 ? tile_samples : i & -i);
        const int most = scene_.paths ? 1 : std::min(static_cast<int>(alignment), shape_.max_merged);
        int run = 1;
        while (run < most && hits.triangle[i + run] == hits.triangle[i] && hits.command[i + run] == hits.command[i])
            ++run;
        return static_cast<int>(std::bit_floor(static_cast<uint32_t>(run)));
    }

    void addCell(const CastTile& tile, int sample, int merged) {
        const PlacedRun& run = scene_.ranges[tile.hits->command[sample]];
        const CommandRecord& command = scene_.commands[tile.hits->command[sample]];
        const uint32_t object = command.object;
        const int i = cells_.count;
        cells_.setPlane(i, run, tile.hits->triangle[sample]);
        aim(tile, sample, merged);
        if (mapped_) cells_.mapped[i] = mappedCosine(tile, sample, merged);
        if (scene_.paths) bend(static_cast<double>(tile.hits->range[sample]), scene_.paths->drift(object));
        if (deposit_.to().truth) {
            cells_.object[i] = object;
            cells_.hits[i] = static_cast<uint32_t>(merged);
        }
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Adds a sample that meets nothing: effects alone hear it. */
    void addMiss(const CastTile& tile, int sample) {
        const int column = tile.first_column + shape_.at[sample].columns, i = cells_.count;
        if (column >= view_.columns() || tile.first_row + shape_.at[sample].rows >= view_.rows) return;
        cells_.setMiss(i);
        aim(tile, sample, 1);
        if (++cells_.count == Cells::capacity) finish();
    }

    /** Puts the plane that the cell seems to be of, at about a range [m], in the place of the true one. */
    void bend(double range, const Drift* drift) {
        const int i = cells_.count;
        const glm::dvec3 ray(cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i],
                             cells_.sin_el[i]);
        const ApparentPlane plane = scene_.paths->apparent({cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]},
                                                           cells_.distance[i], ray, range, drift);
        cells_.normal_x[i] = plane.normal.x;
        cells_.normal_y[i] = plane.normal.y;
        cells_.normal_z[i] = plane.normal.z;
        cells_.distance[i] = 1;
        cells_.focus[i] = plane.focus;
        if (!mapped_ || !(cells_.mapped[i] > 0)) cells_.mapped[i] = plane.cosine;
        cells_.near_limit[i] = scene_.paths->nearLimit(cells_.near_limit[i]);
        cells_.far_limit[i] = 0;  // bent rays may take any way round
    }

    /** Of the middle of the cell that aim() has just put down; 0 where its material has no map. */
    double mappedCosine(const CastTile& tile, int sample, int merged) const {
        const CommandRecord& command = scene_.commands[tile.hits->command[sample]];
        if (!scene_.normal_maps.isMapped(static_cast<int>(command.material))) return 0;
        const int i = cells_.count;
        float u = 0, v = 0;
        for (int k = sample; k < sample + merged; ++k) u += tile.hits->u[k], v += tile.hits->v[k];
        const auto per_sample = 1 / static_cast<float>(merged);
        const glm::dvec3 ray(cells_.cos_el[i] * cells_.cos_az[i], cells_.cos_el[i] * cells_.sin_az[i],
                             cells_.sin_el[i]);
        const glm::dvec3 normal(cells_.normal_x[i], cells_.normal_y[i], cells_.normal_z[i]);
        const double range = std::abs(cells_.distance[i]) / std::max(std::abs(glm::dot(normal, ray)), 1e-6);
        return static_cast<double>(scene_.normal_maps.cosine(
            scene_.objects[command.object],
            {command.object, tile.hits->triangle[sample], static_cast<int>(command.material), u * per_sample,
             v * per_sample, glm::vec3(ray), static_cast<float>(range * std::max(cells_.width[i], cells_.height[i]))}));
    }

    /** Direction, extent and solid angle of a cell of `merged` samples. */
    void aim(const CastTile& tile, int sample, int merged) {
        const AngularView& view = view_;
        const int column = tile.first_column + shape_.at[sample].columns, i = cells_.count;
        const int across = shape_.size[merged].columns, last = column + across - 1;
        const size_t left = view.at(column), right = view.at(last) + 2;
        const size_t middle = across > 1 ? view.at(column + across / 2) : left + 1;
        const size_t low = 2 * static_cast<size_t>(tile.first_row + shape_.at[sample].rows);
        const auto up = static_cast<size_t>(shape_.size[merged].rows);
        cells_.beam[i] = view.beam_of[static_cast<size_t>(column)];
        const AngularView::Elevation& elevation = view.elevations[low + up];
        cells_.cos_el[i] = elevation.cosine;
        cells_.sin_el[i] = elevation.sine;
        cells_.height[i] = view.height(low / 2, up);
        if (conical_) {
            const double at = elevation.angle;
            const double azimuth = coneAzimuth(view.bearings[middle], at);
            cells_.cos_az[i] = std::cos(azimuth);
            cells_.sin_az[i] = std::sin(azimuth);
            cells_.width[i] = coneAzimuth(view.bearings[right], at) - coneAzimuth(view.bearings[left], at);
            cells_.lean[i] = std::abs(azimuth) < 1.5 ? std::tan(azimuth) * elevation.sine / elevation.cosine : 0;
        } else {
            cells_.cos_az[i] = view.azimuths[middle].cosine;
            cells_.sin_az[i] = view.azimuths[middle].sine;
            cells_.width[i] = view.bearings[right] - view.bearings[left];
            cells_.lean[i] = 0;
        }
        cells_.size[i] =
            cells_.width[i] * (view.elevations[low + 2 * up].weighted - view.elevations[low].weighted) / view.cell();
    }

    bool conical_, mapped_, hears_misses_;
    const AngularView& view_;
    const TileShape& shape_;
    const PlacedScene& scene_;
    CellDeposit deposit_;
    Cells& cells_;
};

}  // namespace

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void depositTiles(const EchoRules& rules, const CastView& view,
                                                                  const PlacedScene& scene,
                                                                  std::span<const CastTile> tiles, const EchoSums& to) {
    TileCells cells(rules, view, scene, to);
    for (const CastTile& tile : tiles) cells.add(tile);
    cells.finish();
}

}  // namespace insonify::sonar
