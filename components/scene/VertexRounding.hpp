#pragma once
#include <optional>

#include "types/Geometry.hpp"

namespace insonify::scene {

/** What the rounding of its coordinates to 32 bits does to a mesh that is far from its own origin. */
struct VertexRounding {
    double farthest = 0;  ///< Max coordinate [m].
    double step = 0;      ///< Step of coordinates there [m].
    double share = 0;     ///< Share of the surface whose normals may be off by max_tilt and more [1].
    double tilt = 0;      ///< Max error of the normals of that share, at most pi / 2 [rad].

    static constexpr double max_tilt = 0.01;   ///< Smooth metal, with the narrowest lobe, changes by 0.05 dB [rad].
    static constexpr double max_share = 0.01;  ///< Of the surface that may be off: slivers have no area [1].
};

/** Returns the rounding of a mesh that would be more exact about its own middle; none where its normals are good. */
std::optional<VertexRounding> roundingOf(const types::Mesh& mesh);

/** Adds a notice that names the objects whose vertices are too far from their origin, if there are any. */
void noteRounding(types::GeometryPtr& geometry);

}  // namespace insonify::scene
