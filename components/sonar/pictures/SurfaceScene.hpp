#pragma once
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/sonar/echo/FacetLobes.hpp"
#include "components/sonar/echo/Interface.hpp"
#include "components/sonar/echo/MaterialLaws.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Planes of a mesh's triangles. */
std::vector<PlaneRecord> planesOf(const types::Mesh& mesh);
/** The same into a list of as many. */
void findPlanes(const types::Mesh& mesh, std::vector<PlaneRecord>& planes);
/** Planes of all meshes' triangles, mesh after mesh, without those that stand for patches: as SurfaceScene::planes().
 */
std::vector<PlaneRecord> planesOf(const types::Geometry& geometry);

/** A geometry on the device: all meshes behind one another, a plane for each triangle, materials, normal maps. */
class SurfaceScene {
public:
    /** Where a mesh begins in the shared buffers. */
    struct MeshPlace {
        uint32_t first_vertex, first_index, first_triangle;
    };

    SurfaceScene(const types::Geometry& geometry, const MaterialLaws& laws, bool with_normal_maps);
    const MeshPlace& place(int mesh) const { return places_[static_cast<size_t>(mesh)]; }
    bool withNormalMaps() const { return with_normal_maps_; }
    /** Of each triangle. */
    const std::vector<PlaneRecord>& planes() const { return plane_list_; }
    /** Of each triangle; empty where no material has a lobe. */
    const std::vector<FacetRecord>& facets() const { return facet_list_; }
    /** Attributes and indices of a context's vertex array. */
    void describe(const gpu::VertexArray& vertices) const;
    /** Binds materials, and the planes with the facets behind them, which the device gets when they are first bound. */
    void bindRecords() const;
    /** Binds the normal map of a material; the flat map when it has none. */
    void bindNormalMap(int map) const;

private:
    void uploadVertices(const types::Geometry& geometry);
    void uploadNormalMaps(const types::Geometry& geometry);

    bool with_normal_maps_;
    std::vector<MeshPlace> places_;
    std::vector<PlaneRecord> plane_list_;
    std::vector<FacetRecord> facet_list_;
    gpu::Buffer positions_, normals_, tangents_, uvs_, indices_, materials_;
    mutable gpu::Buffer triangles_;  ///< Planes, then facets; empty until a deposit on the device asks for them.
    std::vector<gpu::Texture> normal_maps_;  ///< The last one is flat.
};

}  // namespace insonify::sonar
