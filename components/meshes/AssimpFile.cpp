#include "components/meshes/AssimpFile.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Exceptional.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <new>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "components/scene/gltf/Gltf.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::meshes {

using namespace scene;
namespace {

static_assert(std::is_same_v<ai_real, float>);

/** Triangles of a mesh with a vertex that is not a finite number, as assimp would join it to any other: it moves to the
 *  first vertex. */
std::vector<unsigned> takeUnplaced(aiMesh& mesh) {
    std::vector<bool> unplaced(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        aiVector3D& at = mesh.mVertices[i];
        unplaced[i] = !std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z);
        if (unplaced[i]) at = i > 0 ? mesh.mVertices[0] : aiVector3D();
    }
    std::vector<unsigned> faces;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const std::span all(mesh.mFaces[i].mIndices, mesh.mFaces[i].mNumIndices);
        const auto is = [&](unsigned index) { return index < mesh.mNumVertices && unplaced[index]; };
        if (std::ranges::any_of(all, is)) faces.push_back(i);
    }
    return faces;
}

/** @param unplaced of takeUnplaced(); these triangles get a vertex that is not a number */
Surface getSurface(const aiMesh& from, const std::vector<unsigned>& unplaced) {
    Surface surface;
    surface.positions.reserve(from.mNumVertices);
    for (unsigned i = 0; i < from.mNumVertices; ++i)
        surface.positions.emplace_back(from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z);
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
        const aiFace& face = from.mFaces[i];
        const auto exists = [&from](unsigned index) { return index < from.mNumVertices; };
        if (face.mNumIndices == 3 && std::all_of(face.mIndices, face.mIndices + 3, exists))
            surface.indices.insert(surface.indices.end(), face.mIndices, face.mIndices + 3);
        else
            continue;
        if (std::ranges::binary_search(unplaced, i)) surface.indices.back() = from.mNumVertices;
    }
    if (!unplaced.empty()) surface.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
    return surface;
}

constexpr char in_name = '\x1f';  ///< In place of a space in a name, which assimp would cut there.

/** Returns a text with `in_name` for each blank within a name: "o left wall" of an .obj, "solid left wall" of an .stl.
 */
std::string withMarkedNames(std::string text, std::string_view keyword) {
    constexpr std::string_view blanks = " \t";
    for (size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
        end = std::min(text.find_first_of("\r\n", begin), text.size());
        const size_t at = std::min(text.find_first_not_of(blanks, begin), end);
        const std::string_view line(text.data() + at, end - at);
        if (!line.starts_with(keyword) || line.size() == keyword.size() ||
            blanks.find(line[keyword.size()]) == blanks.npos)
            continue;
        const size_t first = text.find_first_not_of(blanks, at + keyword.size());
        if (first >= end) continue;
        const size_t comment = std::min(text.find(" #", first), end);
        const size_t last = text.find_last_not_of(blanks, comment - 1);
        for (size_t i = first; i < last; ++i)
            if (blanks.find(text[i]) != blanks.npos) text[i] = in_name;
    }
    return text;
}

std::string withSpaces(std::string name) {
    std::ranges::replace(name, in_name, ' ');
    return name;
}

/** Returns a placing for each mesh of each node, without recursion. */
std::vector<FileMeshes::Placing> getPlacings(const aiScene& from, const glm::dmat4& world_from_file) {
    struct Visit {
        const aiNode* node;
        glm::dmat4 world_from_parent;
    };
    std::vector<FileMeshes::Placing> placings;
    std::vector<Visit> waiting = {{from.mRootNode, world_from_file}};
    while (!waiting.empty()) {
        const auto [node, world_from_parent] = waiting.back();
        waiting.pop_back();
        const glm::dmat4 world_from_node =
            world_from_parent * glm::transpose(glm::dmat4(glm::make_mat4(&node->mTransformation.a1)));
        for (unsigned i = 0; i < node->mNumMeshes; ++i)
            placings.push_back({withSpaces(node->mName.C_Str()), node->mMeshes[i], world_from_node});
        for (unsigned i = 0; i < node->mNumChildren; ++i) waiting.push_back({node->mChildren[i], world_from_node});
    }
    return placings;
}

/** Rethrows an exception that assimp caught. From its later steps it keeps only the text of the exception. */
void rethrow(const Assimp::Importer& importer) {
    if (importer.GetException()) std::rethrow_exception(importer.GetException());
    const std::string text = importer.GetErrorString();
    if (text == std::bad_alloc().what()) throw std::bad_alloc();
    if (text.find(' ') == std::string::npos || text.find("::") != std::string::npos) throw std::logic_error(text);
}

/** Shortens a text: assimp cites unreadable input, which may be the rest of the file. */
std::string shortened(const std::string& text) {
    constexpr size_t maximum = 160;
    return text.size() <= maximum ? text : text.substr(0, maximum) + "...";
}

/** Throws assimp's message. Messages of the standard library are replaced, as they do not describe the file. */
[[noreturn]] void refuse(const Assimp::Importer& importer) {
    try {
        rethrow(importer);
    } catch (const DeadlyErrorBase&) {
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::length_error&) {
        throw std::bad_alloc();
    } catch (...) {
        throw std::runtime_error("a number, a count or an index in it is not what its format allows");
    }
    throw std::runtime_error(shortened(importer.GetErrorString()));
}

std::string toText(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/** Returns a .dae with a colour in place of each texture: assimp refuses whole files for pictures that are not named,
 *  which no sonar needs. */
std::string withoutTextures(const std::filesystem::path& file) {
    std::string text = toText(file);
    constexpr std::string_view colour = "<color>1 1 1 1</color>";
    for (size_t at = 0; (at = text.find("<texture", at)) != std::string::npos; at += colour.size()) {
        const size_t end = text.find('>', at);
        if (end == std::string::npos) break;
        const size_t closing = text.find("</texture>", end);
        const size_t last = text[end - 1] == '/' || closing == std::string::npos ? end + 1 : closing + 10;
        text.replace(at, last - at, colour);
    }
    return text;
}

/** Refuses what assimp would refuse for another reason: text in UTF-16, and a binary .stl that was cut. */
void checkBegin(const std::filesystem::path& file) {
    constexpr size_t head_size = 84, triangle_size = 50;  // of a binary .stl [bytes]
    std::string head(head_size, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<size_t>(stream.gcount()));
    if (types::isUtf16(head)) throw std::runtime_error(std::string("it ") + types::utf16_refusal);
    if (scene::getExtension(file) != ".stl" || head.size() < head_size || head.find('\0') == head.npos ||
        head.starts_with("solid"))
        return;
    uint32_t count;
    std::memcpy(&count, head.data() + 80, sizeof count);
    const uintmax_t size = std::filesystem::file_size(file), needed = head_size + uintmax_t{count} * triangle_size;
    if (size < needed)
        throw std::runtime_error(
            fmt::format("it is a binary .stl of {} triangles, which take {} bytes, and has {}", count, needed, size));
}

/** Opens the mesh file alone. Of an .obj's library of materials a sonar needs nothing: `usemtl` has their names, and
 *  assimp would give surfaces without a name its last one. */
class OnlyThisFile final : public Assimp::DefaultIOSystem {
public:
    explicit OnlyThisFile(std::string file) : file_(std::move(file)) {}

    bool Exists(const char* named) const override { return file_ == named && DefaultIOSystem::Exists(named); }
    Assimp::IOStream* Open(const char* named, const char* mode) override {
        if (file_ != named) return nullptr;
        const std::string extension = scene::getExtension(file_);
        if (extension != ".obj" && extension != ".stl") return DefaultIOSystem::Open(named, mode);
        if (text_.empty()) {  // the file is opened more than once
            text_ = toText(file_);
            if (text_.starts_with("\xef\xbb\xbf"))
                text_.erase(0, 3);  // a mark of UTF-8, which would hide the first line
            if (text_.find('\0') == text_.npos)
                text_ = withMarkedNames(std::move(text_), extension == ".obj" ? "o" : "solid");
        }
        return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(text_.data()), text_.size(), false);
    }

private:
    const std::string file_;
    std::string text_;  ///< Of an .obj or .stl; streams refer to it.
};

}  // namespace

FileMeshes readByAssimp(const std::filesystem::path& file, MeshAxes axes) {
    checkBegin(file);
    Assimp::Importer importer;
    importer.SetIOHandler(new OnlyThisFile(file.string()));  // the importer deletes it
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, axes == MeshAxes::AsStored);  // else y-up
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);                          // not ids
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                            aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                            aiComponent_TEXTURES);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    constexpr unsigned steps = aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType;
    const aiScene* from = importer.ReadFile(file.string(), steps);
    if (!from && std::string_view(importer.GetErrorString()).find("texture") != std::string_view::npos) {
        const std::string text = withoutTextures(file);
        from = importer.ReadFileFromMemory(text.data(), text.size(), steps, "dae");
    }
    if (!from || !from->mRootNode) refuse(importer);
    std::vector<std::vector<unsigned>> unplaced;
    for (unsigned i = 0; i < from->mNumMeshes; ++i) unplaced.push_back(takeUnplaced(*from->mMeshes[i]));
    from = importer.ApplyPostProcessing(aiProcess_JoinIdenticalVertices);
    if (!from) refuse(importer);
    FileMeshes meshes;
    for (unsigned i = 0; i < from->mNumMaterials; ++i)
        meshes.materials.push_back(from->mMaterials[i]->GetName().C_Str());
    for (unsigned i = 0; i < from->mNumMeshes; ++i) {
        const aiMesh& mesh = *from->mMeshes[i];
        meshes.parts.push_back({withSpaces(mesh.mName.C_Str()), mesh.mMaterialIndex, getSurface(mesh, unplaced[i])});
    }
    meshes.placings = getPlacings(*from, axes == MeshAxes::ZUp ? z_up_from_y_up : glm::dmat4(1));
    return meshes;
}

}  // namespace insonify::meshes
