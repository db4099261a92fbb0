#pragma once
// A square wall ahead of a small sonar, for the tests of the sonar tasks.
#include <limits>
#include <memory>

#include "components/sonar/config/SonarConfig.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::sonar {

/** Eight beams of 10 deg, a hundred bins of 0.15 m, rasterised in software. */
inline SonarConfig smallSonar() {
    SonarConfig config;
    config.range = 15;
    config.beam_count = 8;
    config.bin_count = 100;
    config.field_of_view_deg = 80;
    config.quality.rows = 64;
    config.quality.columns_per_beam = 4;
    config.device = "software";
    return config;
}

/** A wall of 20 x 20 m in the plane x = distance, one material without acoustic values. */
inline types::GeometryPtr wallAt(float distance) {
    types::Geometry geometry;
    geometry.materials.push_back({});
    types::Mesh wall;
    wall.positions = {{distance, -10, -10}, {distance, 10, -10}, {distance, 10, 10}, {distance, -10, 10}};
    wall.indices = {0, 1, 2, 0, 2, 3};
    wall.clusters = {
        {.first_index = 0, .index_count = 6, .material = 0, .centre = {distance, 0, 0}, .half = {0, 15, 15}}};
    geometry.meshes.push_back(wall);
    geometry.objects.push_back({.name = "wall"});
    return std::make_shared<types::Geometry>(geometry);
}

/** Seven seconds into the run, at the origin, with the wall ahead. */
inline types::Snapshot facingWall(float distance) {
    types::Snapshot snapshot;
    snapshot.time = types::Time{7'000'000};
    snapshot.geometry = wallAt(distance);
    return snapshot;
}

/** Returns the start of the first bin of a beam with an echo [m]; infinite without an echo. */
inline double firstEcho(const types::Sonar& ping, uint32_t beam) {
    for (uint32_t k = 0; k < ping.bin_count; ++k)
        if (ping.bins[beam * ping.bin_count + k] > 0) return ping.binStart(k);
    return std::numeric_limits<double>::infinity();
}

}  // namespace insonify::sonar
