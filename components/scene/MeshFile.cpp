#include "components/scene/MeshFile.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "components/scene/Clusters.hpp"
#include "components/scene/Gltf.hpp"
#include "components/scene/Surface.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

static_assert(std::is_same_v<ai_real, float>);

Surface surfaceOf(const aiMesh& from) {
    Surface surface;
    for (unsigned i = 0; i < from.mNumVertices; ++i)
        surface.positions.emplace_back(from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z);
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
        const aiFace& face = from.mFaces[i];
        const auto exists = [&from](unsigned index) { return index < from.mNumVertices; };
        if (face.mNumIndices == 3 && std::all_of(face.mIndices, face.mIndices + 3, exists))
            surface.indices.insert(surface.indices.end(), face.mIndices, face.mIndices + 3);
    }
    return surface;
}

/** The meshes of a file, by their index there; without triangles where there is none that can be drawn. */
std::vector<types::Mesh> meshesOf(const aiScene& from, std::vector<std::string>& notices) {
    std::vector<types::Mesh> meshes(from.mNumMeshes);
    DroppedTriangles dropped;
    for (unsigned i = 0; i < from.mNumMeshes; ++i) {
        Surface surface = surfaceOf(*from.mMeshes[i]);
        cleanUp(surface, dropped);
        meshes[i].name = from.mMeshes[i]->mName.C_Str();
        if (surface.indices.empty()) continue;
        appendSurface(surface, static_cast<int>(from.mMeshes[i]->mMaterialIndex), meshes[i]);
        buildClusters(meshes[i]);
    }
    dropped.addTo(notices);
    return meshes;
}

/** Adds an object for each mesh of each node, without recursion. */
void placeMeshes(const aiScene& from, const glm::dmat4& file_from_root, types::Geometry& geometry) {
    struct Visit {
        const aiNode* node;
        glm::dmat4 file_from_parent;
    };
    std::vector<Visit> waiting = {{from.mRootNode, file_from_root}};
    while (!waiting.empty()) {
        const auto [node, file_from_parent] = waiting.back();
        waiting.pop_back();
        const glm::dmat4 file_from_node =
            file_from_parent * glm::transpose(glm::dmat4(glm::make_mat4(&node->mTransformation.a1)));
        for (unsigned i = 0; i < node->mNumMeshes; ++i)
            if (const auto mesh = static_cast<int>(node->mMeshes[i]);
                !geometry.meshes[static_cast<size_t>(mesh)].indices.empty())
                geometry.objects.push_back({node->mName.C_Str(), mesh, file_from_node});
        for (unsigned i = 0; i < node->mNumChildren; ++i) waiting.push_back({node->mChildren[i], file_from_node});
    }
}

types::GeometryPtr readAssimp(const std::filesystem::path& file, bool is_y_up) {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);  // not ids
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                            aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                            aiComponent_TEXTURES);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* from = importer.ReadFile(file.string(), aiProcess_RemoveComponent | aiProcess_Triangulate |
                                                               aiProcess_SortByPType | aiProcess_JoinIdenticalVertices);
    if (!from || !from->mRootNode)
        throw types::ConfigError(file.string(), "", fmt::format("cannot be read: {}", importer.GetErrorString()));
    auto geometry = std::make_shared<types::Geometry>();
    for (unsigned i = 0; i < from->mNumMaterials; ++i)
        geometry->materials.emplace_back().name = from->mMaterials[i]->GetName().C_Str();
    geometry->meshes = meshesOf(*from, geometry->notices);
    placeMeshes(*from, is_y_up ? z_up_from_y_up : glm::dmat4(1), *geometry);
    if (geometry->objects.empty()) throw types::ConfigError(file.string(), "", "has no triangles");
    return geometry;
}

}  // namespace

types::GeometryPtr readMeshFile(const std::filesystem::path& file) {
    const std::string extension = extensionOf(file);
    if (extension == ".gltf" || extension == ".glb") return readGltf(file).geometry;
    if (extension == ".dae") return readAssimp(file, true);  // turned to y-up and metres by its importer
    if (extension == ".obj" || extension == ".stl") return readAssimp(file, false);
    throw types::ConfigError(file.string(), "",
                             fmt::format("has extension \"{}\"; may be .dae, .obj, .stl, .gltf or .glb", extension));
}

}  // namespace insonify::scene
