#pragma once
#include <compare>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "components/scene/Acoustics.hpp"
#include "components/scene/Surface.hpp"
#include "types/geometry/Extent.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::meshes {

/** The material of a visual. */
struct Look {
    std::string name;                 ///< Name of its material script; empty: the mesh's own, or "default".
    scene::AcousticValues acoustics;  ///< Already validated.
    auto operator<=>(const Look&) const = default;
};

/** A mesh in a visual. */
struct Placing {
    int mesh = 0;  ///< Index into Geometry::meshes.
    glm::dmat4 visual_from_object{1};
};

/** Makes the meshes of a world's visuals. A mesh that several visuals use with the same material is made once. */
class VisualMeshes {
public:
    explicit VisualMeshes(types::Geometry& geometry) : geometry_(geometry) {}

    /** Returns the mesh of a key and material. Calls `make()` for the first visual with them. */
    Placing shape(const std::string& key, const Look& look, auto make) {
        const auto [known, is_new] = shapes_.try_emplace({key, look}, -1);
        if (is_new) known->second = add(make(), key, look);
        return {known->second};
    }
    /** Returns the objects of a mesh file, or only the objects whose name or mesh name is `submesh`; empty if there are
     *  none. Throws types::ConfigError for a file that cannot be read. */
    const std::vector<Placing>& file(const std::filesystem::path& path, const std::string& submesh, const Look& look);

    /** Returns the box of placings, in the visual's axes [m]. */
    types::Extent extent(const std::vector<Placing>& placings) const;
    /** Returns placings moved so that the centre of their box is the origin. */
    std::vector<Placing> centred(std::vector<Placing> placings) const;

private:
    /** The result of reading a mesh file. A file that cannot be read is not tried again for each visual. */
    struct FileRead {
        types::GeometryPtr geometry;
        std::optional<types::ConfigError> failure;
    };

    const types::GeometryPtr& readOnce(const std::filesystem::path& path);
    int add(scene::Surface surface, const std::string& name, const Look& look);
    int material(types::Material material, const Look& look);
    std::vector<Placing> merge(const types::Geometry& from, const std::string& submesh, const Look& look);
    int mergeMesh(const types::Geometry& from, int mesh, const Look& look, std::map<int, int>& materials);

    types::Geometry& geometry_;
    std::map<Look, int> materials_;  ///< Materials of shapes.
    std::map<std::pair<std::string, Look>, int> shapes_;
    std::map<std::string, FileRead> files_;
    std::map<std::tuple<std::string, std::string, Look>, std::vector<Placing>> placings_;
};

}  // namespace insonify::meshes
