#include "components/scene/MeshFile.hpp"

#include <fmt/format.h>

#include "components/scene/Clusters.hpp"
#include "components/scene/Gltf.hpp"
#include "components/scene/MeshProcess.hpp"
#include "components/scene/Surface.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** The meshes of a file, by their index there; without triangles where there is none that can be drawn. */
std::vector<types::Mesh> meshesOf(FileMeshes& from, std::vector<std::string>& notices) {
    std::vector<types::Mesh> meshes(from.parts.size());
    DroppedTriangles dropped;
    for (size_t i = 0; i < meshes.size(); ++i) {
        Surface surface = std::move(from.parts[i].surface);
        cleanUp(surface, dropped);
        meshes[i].name = from.parts[i].name;
        if (surface.indices.empty()) continue;
        appendSurface(surface, static_cast<int>(from.parts[i].material), meshes[i]);
        buildClusters(meshes[i]);
    }
    dropped.addTo(notices);
    return meshes;
}

types::GeometryPtr readApart(const std::filesystem::path& file, bool is_y_up) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw types::ConfigError(file.string(), "", "is not a file; give the path of a .dae, .obj or .stl file");
    const ReadLimits limits = ReadLimits::forFile(std::filesystem::file_size(file, error));
    FileMeshes from = readMeshesApart(file, is_y_up, limits);
    auto geometry = std::make_shared<types::Geometry>();
    for (const std::string& name : from.materials) geometry->materials.emplace_back().name = name;
    geometry->meshes = meshesOf(from, geometry->notices);
    for (const FileMeshes::Placing& placing : from.placings)
        if (!geometry->meshes[placing.part].indices.empty())
            geometry->objects.push_back({placing.name, static_cast<int>(placing.part), placing.world_from_part});
    if (geometry->objects.empty()) throw types::ConfigError(file.string(), "", "has no triangles");
    return geometry;
}

}  // namespace

types::GeometryPtr readMeshFile(const std::filesystem::path& file) {
    const std::string extension = extensionOf(file);
    if (extension == ".gltf" || extension == ".glb") return readGltf(file).geometry;
    if (extension == ".dae") return readApart(file, true);  // turned to y-up and metres by its importer
    if (extension == ".obj" || extension == ".stl") return readApart(file, false);
    throw types::ConfigError(file.string(), "",
                             fmt::format("has extension \"{}\"; may be .dae, .obj, .stl, .gltf or .glb", extension));
}

}  // namespace insonify::scene
