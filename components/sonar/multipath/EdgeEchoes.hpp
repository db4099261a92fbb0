#pragma once
#include <array>
#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "components/sonar/multipath/PointTargets.hpp"
#include "components/sonar/surfaces/Sightlines.hpp"

namespace insonify::sonar {

/** A straight edge in the world. */
struct PlacedEdge {
    glm::dvec3 from{0}, to{0};           ///< [m]
    std::array<glm::dvec3, 2> inward{};  ///< Unit, across the edge into each face.
    std::array<double, 2> widths{};      ///< Widths of the faces, across the edge [m].
    std::array<bool, 2> are_enclosed{};  ///< Whether edges have the faces' sidelobes (ACOUSTICS.md 3.12).
    double reflection = 0;               ///< Coefficient of the sound pressure, the mean of both faces, signed [1].
    double square_slope = 0;             ///< Mean square slope of the faces' relief [1].
    double wavelength = 0;               ///< [m]

    /** Returns the coefficient D of 3.12 for a sonar at a place [1]; 0 where the edge is hollow for it. */
    double coefficient(const glm::dvec3& sonar) const;
};

/** A point that represents a part of an edge. */
struct EdgeEcho {
    glm::dvec3 at;   ///< In the world [m].
    double section;  ///< Its backscattering cross section, TS = 10 log10 of it [m^2].
};

/** Appends the echoes of an edge, ignoring occlusion (ACOUSTICS.md 3.12). Appends none for a sonar within a
 *  wavelength of the edge's line.
 *  @param sonar  in the world [m]
 *  @param spacing  of the sonar's beams [rad] */
void appendEdgeEchoes(const PlacedEdge& edge, const glm::dvec3& sonar, double spacing, std::vector<EdgeEcho>& echoes);

/** Adds the echoes of a scene's straight edges to pings. */
class EdgeEchoes {
public:
    /** `plan`: its laws have a wavelength and a turn of sharp edges. Plan and geometry outlive it. */
    EdgeEchoes(const RenderPlan& plan, const types::Geometry& geometry);

    /** Finds the edges of the objects that the snapshot deforms. */
    void updateShapes(const types::Snapshot& snapshot);
    /** Adds the echoes once the bins, or `field` if there is one, are filled. Returns the number of edges with an echo
     *  in any beam. */
    size_t add(PingInMaking& to);
    size_t count() const { return edges_.size(); }  ///< Edges of the scene [1].

private:
    /** An edge in the axes of its object. */
    struct OwnEdge {
        size_t object;
        PlacedEdge edge;
    };
    void addObject(size_t object);

    const RenderPlan& plan_;
    const types::Geometry& geometry_;
    PointTargets points_;
    Sightlines sightlines_;
    WallSights walls_;
    std::vector<std::shared_ptr<const StraightEdges>> of_meshes_;
    std::vector<OwnEdge> edges_;
    std::vector<glm::dmat4> still_, places_;  ///< Places of the objects in the geometry, and in the ping.
    std::vector<EdgeEcho> echoes_;            ///< Echoes of one edge.
    double spacing_;                          ///< Angle between beams [rad].
};

}  // namespace insonify::sonar
