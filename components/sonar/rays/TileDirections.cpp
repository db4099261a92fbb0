#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "components/sonar/rays/TileCells.hpp"
#include "types/Check.hpp"
#include "types/VectorMath.hpp"

namespace insonify::sonar {

TileDirections::TileDirections(const TracedView& view, int strip_columns)
    : tile_(view.shape.all),
      strip_columns_(strip_columns),
      tiles_across_(static_cast<size_t>((strip_columns + tile_.columns - 1) / tile_.columns)) {
    const AngularView& cells = view.cells;
    for (int strip = 0; strip < cells.columns(); strip += strip_columns) {
        const int end = std::min(strip + strip_columns, cells.columns());
        for (int first = strip; first < strip + strip_columns; first += tile_.columns) {
            Angles& angles = columns_.emplace_back();
            for (int i = 0; i < tile_samples; ++i) {
                const int column = first + view.shape.at[i].columns;
                angles.at[i] = std::min(column, end - 1);
                angles.active |= static_cast<uint32_t>(column < end) << i;
                const AngularView::Direction& azimuth = cells.azimuths[cells.at(angles.at[i]) + 1];
                angles.cosine[i] = azimuth.cosine;
                angles.sine[i] = azimuth.sine;
            }
        }
    }
    for (int first = 0; first < cells.rows; first += tile_.rows) {
        Angles& angles = rows_.emplace_back();
        for (int i = 0; i < tile_samples; ++i) {
            const int row = first + view.shape.at[i].rows;
            angles.at[i] = std::min(row, cells.rows - 1);
            angles.active |= static_cast<uint32_t>(row < cells.rows) << i;
            const AngularView::Elevation& elevation = cells.elevations[static_cast<size_t>(2 * angles.at[i] + 1)];
            angles.cosine[i] = elevation.cosine;
            angles.sine[i] = elevation.sine;
        }
    }
}

INSONIFY_VECTOR_CLONES TileRays TileDirections::product(const Angles& across, const Angles& up) {
    TileRays rays;
    for (int i = 0; i < tile_samples; ++i) {
        rays.x[i] = static_cast<float>(up.cosine[i] * across.cosine[i]);
        rays.y[i] = static_cast<float>(up.cosine[i] * across.sine[i]);
        rays.z[i] = static_cast<float>(up.sine[i]);
    }
    return rays;
}

TileRays TileDirections::rays(const AngularView& view, int column, int row) const {
    INSONIFY_CHECK(row >= 0 && static_cast<size_t>(row / tile_.rows) < rows_.size(), row, tile_.rows, rows_.size());
    INSONIFY_CHECK(column >= 0 && static_cast<size_t>(column / strip_columns_ + 1) * tiles_across_ <= columns_.size(),
                   column, strip_columns_, columns_.size());
    const auto tile = static_cast<size_t>(column % strip_columns_ / tile_.columns);
    const Angles& across = columns_[static_cast<size_t>(column / strip_columns_) * tiles_across_ + tile];
    const Angles& up = rows_[static_cast<size_t>(row / tile_.rows)];
    TileRays rays = product(across, up);
    rays.active = across.active & up.active;
    const glm::vec3 first(rays.x[0], rays.y[0], rays.z[0]);
    INSONIFY_CHECK(std::abs(glm::length(first) - 1) < 1e-5f, first);
    if (!view.conical) return rays;
    for (int i = 0; i < tile_samples; ++i) {
        const glm::vec3 ray(view.direction(across.at[i], up.at[i]));
        rays.x[i] = ray.x;
        rays.y[i] = ray.y;
        rays.z[i] = ray.z;
    }
    return rays;
}

}  // namespace insonify::sonar
