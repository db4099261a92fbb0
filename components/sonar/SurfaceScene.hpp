#pragma once
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/sonar/Interface.hpp"
#include "components/sonar/MaterialLaws.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** What each facet of a mesh adds to the mean square slope of a lobe (ACOUSTICS.md 3.6) [1]: half the square of the
 *  step to its neighbours' normals, so that the lobes of a curved surface's facets join, and lambda^2 / (4 pi A) of the
 *  flat part of area A that it belongs to. Steeper than 60 deg an edge is an edge, and no curve. `scale`: metres of the
 *  world to a unit of the mesh; `wavelength` [m], 0: none is known. */
std::vector<float> facetSlopes(const types::Mesh& mesh, double scale, double wavelength);

/** Whether any triangle of a mesh has a material whose law has a lobe. */
bool hasLobes(const types::Mesh& mesh, const MaterialLaws& laws);
/** World metres to a unit of a mesh, as the first object that it is places it; 1 where there is none. */
double scaleOf(const types::Geometry& geometry, size_t mesh);
/** Planes of a mesh's triangles, with what facets add to lobes where it has some. */
std::vector<PlaneRecord> planesOf(const types::Mesh& mesh, double scale, const MaterialLaws& laws);
/** Planes of all meshes' triangles, mesh after mesh, without those that stand for patches: as SurfaceScene::planes().
 */
std::vector<PlaneRecord> planesOf(const types::Geometry& geometry, const MaterialLaws& laws);

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
    /** Attributes and indices of a context's vertex array. */
    void describe(const gpu::VertexArray& vertices) const;
    /** Binds planes, which the device is told when they are first bound, and materials. */
    void bindRecords() const;
    /** Binds the normal map of a material; the flat map when it has none. */
    void bindNormalMap(int map) const;

private:
    void uploadVertices(const types::Geometry& geometry);
    void uploadNormalMaps(const types::Geometry& geometry);

    bool with_normal_maps_;
    std::vector<MeshPlace> places_;
    std::vector<PlaneRecord> plane_list_;
    gpu::Buffer positions_, normals_, tangents_, uvs_, indices_, materials_;
    mutable gpu::Buffer planes_;             ///< Empty until a deposit on the device asks for them.
    std::vector<gpu::Texture> normal_maps_;  ///< The last one is flat.
};

}  // namespace insonify::sonar
