#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "components/sonar/echo/Interface.hpp"
#include "components/sonar/echo/MaterialLaws.hpp"
#include "components/sonar/echo/StraightEdges.hpp"
#include "components/sonar/places/BoxTree.hpp"
#include "components/sonar/places/SharedValues.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** What sonars derive from a mesh and nothing else, made when it is first asked for. All sonars of a process, and all
 *  geometries that share the mesh, have the same MeshFacts. Several threads may ask at a time. */
class MeshFacts {
public:
    using Planes = std::shared_ptr<const std::vector<PlaneRecord>>;
    using Facets = std::shared_ptr<const std::vector<FacetRecord>>;
    using Curves = std::shared_ptr<const std::vector<CurveRecord>>;
    using Edges = std::shared_ptr<const StraightEdges>;

    static constexpr size_t leaf_triangles = 4;  ///< Triangles below a leaf of triangles(), neighbours in the indices.

    /** Returns the facts of a mesh; they keep it. */
    static std::shared_ptr<MeshFacts> of(const types::MeshPtr& mesh);
    /** Returns the facts of each mesh of a geometry. */
    static std::vector<std::shared_ptr<MeshFacts>> ofAll(const types::Geometry& geometry);
    explicit MeshFacts(types::MeshPtr mesh) : mesh_(std::move(mesh)) {}

    /** Takes the mesh as it is now, after its vertices have moved: all that has been asked for, but facets, curves and
     *  edges, is made again in place. For the owner of the mesh, while nobody asks. */
    void renew();

    /** The box of all positions, in the mesh's axes [m]. */
    const Box& box();
    /** Of all triangles [m]. */
    double longestEdge();
    /** A tree over runs of leaf_triangles triangles. */
    const BoxTree& triangles();
    /** A plane for each triangle, as planesOf() makes it. */
    Planes planes();
    /** How each triangle spreads a lobe, as facetLobes() finds it; null where no material of the mesh has one. */
    Facets facets(const glm::dmat3& world_from_mesh, const MaterialLaws& laws);
    /** The same of a mesh as it is now, made anew. */
    static Facets facetsNow(const types::Mesh& mesh, const glm::dmat3& world_from_mesh, const MaterialLaws& laws);
    /** How each triangle bends, as facetCurves() finds it; empty where no part of the mesh is a smooth body. */
    Curves curves(const glm::dmat3& world_from_mesh);
    /** The straight edges of at least a turn [rad], as straightEdges() finds them; null where no material of the mesh
     *  has a lobe. */
    Edges edges(const glm::dmat3& world_from_mesh, const MaterialLaws& laws, double min_turn);

    /** For each triangle, lengths in its map's coordinates per metre, the mean of all directions [1/m]; 0 where it has
     *  no area. The mesh must have uvs. */
    const std::vector<float>& mapDensity();

private:
    types::MeshPtr mesh_;
    Lazy<Box> box_;
    Lazy<double> longest_edge_;
    Lazy<BoxTree> triangles_;
    Lazy<std::shared_ptr<std::vector<PlaneRecord>>> planes_;
    Lazy<std::vector<float>> map_density_;
    /** By matrix, wavelength [m] and turn of sharp edges [rad]. */
    SharedValues<std::array<double, 11>, const std::vector<FacetRecord>> facets_;
    SharedValues<std::array<double, 9>, const std::vector<CurveRecord>> curves_;  ///< By matrix.
    SharedValues<std::array<double, 10>, const StraightEdges> edges_;             ///< By matrix and turn [rad].
};

}  // namespace insonify::sonar
