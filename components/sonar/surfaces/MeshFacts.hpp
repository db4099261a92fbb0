#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "components/sonar/base/BoxTree.hpp"
#include "components/sonar/base/Interface.hpp"
#include "components/sonar/base/SharedValues.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "components/sonar/surfaces/StraightEdges.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** Returns the longest edge of all triangles of a mesh, in its own coordinates [m]. */
double longestEdge(const types::Mesh& mesh);

/** Distances from the sonar to a mesh [m]. */
struct MeshDistances {
    double nearest = 0;   ///< To its nearest point.
    double farthest = 0;  ///< To its farthest corner.
};

/** Returns the distances to a mesh that is placed by `sonar_from_mesh`; 0 for a mesh without triangles. If very many
 *  triangles are about equally near or far, they are bounds: the distances to the nearest and to the farthest box of
 *  triangles. Allocates in `scratch` only. */
MeshDistances distancesTo(const types::Mesh& mesh, double longest_edge, const glm::dmat4& sonar_from_mesh,
                          std::vector<float>& scratch);

/** Returns the planes of a mesh's triangles. */
std::vector<PlaneRecord> extractPlanes(const types::Mesh& mesh);
/** Fills a list of that size with the planes of a mesh's triangles. */
void findPlanes(const types::Mesh& mesh, std::span<PlaneRecord> planes);
/** Returns the planes of all meshes' triangles, mesh after mesh, in their order. */
std::vector<PlaneRecord> extractPlanes(const types::Geometry& geometry);

/** Data that sonars derive from a mesh alone, each made when it is first requested. All sonars of a process, and all
 *  geometries that share the mesh, share its MeshFacts. Thread-safe. */
class MeshFacts {
public:
    using Planes = std::shared_ptr<const std::vector<PlaneRecord>>;
    using Facets = std::shared_ptr<const std::vector<FacetRecord>>;
    using Curves = std::shared_ptr<const std::vector<CurveRecord>>;
    using Edges = std::shared_ptr<const StraightEdges>;

    static constexpr size_t leaf_triangles = 4;  ///< Triangles below a leaf of triangles(), neighbours in the indices.

    /** Returns the facts of a mesh, which keep the mesh. */
    static std::shared_ptr<MeshFacts> of(const types::MeshPtr& mesh);
    /** Returns the facts of each mesh of a geometry. */
    static std::vector<std::shared_ptr<MeshFacts>> ofAll(const types::Geometry& geometry);
    explicit MeshFacts(types::MeshPtr mesh) : mesh_(std::move(mesh)) {}

    /** Recomputes, in place, all facts in use except facets, curves and edges, after vertices have moved. For the owner
     * of the mesh, while no other thread reads facts. */
    void renew();

    /** Returns the box of all positions, in the mesh's axes [m]. */
    const Box& box();
    /** Returns the longest edge of all triangles [m]. */
    double longestEdge();
    /** Returns a tree over runs of leaf_triangles triangles. */
    const BoxTree& triangles();
    /** Returns a plane for each triangle, from extractPlanes(). */
    Planes planes();
    /** Returns the lobe record of each triangle, from facetLobes(); null where no material of the mesh has a lobe. */
    Facets facets(const glm::dmat3& world_from_mesh, const MaterialLaws& laws);
    /** Returns the lobe records of a mesh as it is now, computed anew. */
    static Facets facetsNow(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, const MaterialLaws& laws);
    /** Returns the curvature of each triangle, from facetCurves(); empty where no part of the mesh is a smooth body. */
    Curves curves(const glm::dmat3& world_from_mesh);
    /** Returns the straight edges with at least a turn [rad], from straightEdges(); null where no material of the mesh
     *  has a lobe. */
    Edges edges(const glm::dmat3& world_from_mesh, const MaterialLaws& laws, double min_turn);

    /** Returns for each triangle the length in map coordinates per metre, averaged over all directions [1/m]; 0 where
     *  it has no area. The mesh must have uvs. */
    const std::vector<float>& mapDensity();

private:
    types::MeshPtr mesh_;
    Lazy<Box> box_;
    Lazy<double> longest_edge_;
    Lazy<BoxTree> triangles_;
    Lazy<std::shared_ptr<std::vector<PlaneRecord>>> planes_;
    Lazy<std::vector<float>> map_density_;
    /** Keys: matrix, wavelength [m] and turn of sharp edges [rad]. */
    SharedValues<std::array<double, 11>, const std::vector<FacetRecord>> facets_;
    SharedValues<std::array<double, 9>, const std::vector<CurveRecord>> curves_;  ///< Key: matrix.
    SharedValues<std::array<double, 10>, const StraightEdges> edges_;             ///< Key: matrix and turn [rad].
};

}  // namespace insonify::sonar
