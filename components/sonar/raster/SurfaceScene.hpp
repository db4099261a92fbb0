#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/sonar/base/Interface.hpp"
#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** A geometry on the device: all meshes in sequence, a plane for each triangle, materials, normal maps. */
class SurfaceScene {
public:
    /** Start of a mesh in the shared buffers. */
    struct MeshPlace {
        uint32_t first_vertex, first_index, first_triangle;
    };

    SurfaceScene(const types::Geometry& geometry, const MaterialLaws& laws, bool with_normal_maps);
    const MeshPlace& place(int mesh) const { return places_[static_cast<size_t>(mesh)]; }
    bool withNormalMaps() const { return with_normal_maps_; }
    /** Returns the plane of each triangle. */
    const std::vector<PlaneRecord>& planes() const { return plane_list_; }
    /** Returns the facet of each triangle; empty where no material has a lobe. */
    const std::vector<FacetRecord>& facets() const { return facet_list_; }
    /** Switches to the laws of the same materials in another plan. Uploads only what differs. */
    void updateLaws(const types::Geometry& geometry, const MaterialLaws& laws);
    /** Computes planes and facets of a mesh that has another shape now. Several threads may take different meshes. */
    void updateShape(const types::Geometry& geometry, const MaterialLaws& laws, size_t mesh);
    /** Uploads the shape of a mesh after updateShape(). */
    void uploadShape(const types::Mesh& mesh, size_t number);
    /** Sets the attributes and indices of a context's vertex array. */
    void describe(const gpu::VertexArray& vertices) const;
    /** Binds materials, and the planes followed by the facets, which are uploaded when they are first bound. */
    void bindRecords() const;
    /** Binds the normal map of a material; the flat map when it has none. */
    void bindNormalMap(int map) const;

private:
    void uploadVertices(const types::Geometry& geometry);
    void uploadNormalMaps(const types::Geometry& geometry);

    /** Returns the number of the first triangle behind a mesh. */
    size_t findEnd(size_t mesh) const;

    /** The part of the laws that facets and materials depend on. */
    struct UsedLaws {
        std::vector<MaterialRecord> records;
        std::optional<double> wavelength, sharp_turn;

        bool operator==(const UsedLaws& other) const {
            return wavelength == other.wavelength && sharp_turn == other.sharp_turn &&
                   std::ranges::equal(records, other.records, [](const MaterialRecord& a, const MaterialRecord& b) {
                       return a.values == b.values && a.law == b.law;
                   });
        }
    };

    bool with_normal_maps_;
    UsedLaws laws_;
    std::vector<std::vector<uint32_t>> sources_;  ///< Vertex of the mesh for each rasterised vertex, where it deforms.
    std::vector<MeshPlace> places_;
    std::vector<PlaneRecord> plane_list_;
    std::vector<FacetRecord> facet_list_;
    gpu::Buffer positions_, normals_, tangents_, uvs_, indices_, materials_;
    mutable gpu::Buffer triangles_;  ///< Planes, then facets; empty until a deposit on the device requests them.
    std::vector<gpu::Texture> normal_maps_;  ///< The last one is flat.
};

}  // namespace insonify::sonar
