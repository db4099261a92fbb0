#pragma once
#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "types/text/Notice.hpp"

namespace insonify::scene {

/** A glTF file as parsed; encoded images are kept in Image::image, not decoded. */
struct GltfFile {
    std::string name;  ///< For messages.
    tinygltf::Model model;
    types::Notices notices;
};

/** Reads a .gltf or .glb and the files that it refers to. In the model, only the extensions are checked.
 *  Throws types::ConfigError if the file is missing, is no glTF, is nested too deeply, or needs an unsupported
 *  extension. */
GltfFile readGltfFile(const std::filesystem::path& file);

/** Reads the accessors of a model in which no number has been checked yet.
 *
 *  Strides, sparse values, absent bufferViews (zeros) and normalised integers are resolved; alignment does not matter.
 *  Any index, length or type that does not fit is a types::ConfigError that names the accessor and the bound. */
class GltfAccessors {
public:
    GltfAccessors(const tinygltf::Model& model, std::string file) : model_(model), file_(std::move(file)) {}

    /** Returns vectors; Vector sets the number of components. Integers are scaled to [-1, 1] if `normalized` is set. */
    template <class Vector>
    std::vector<Vector> vectors(int accessor) const;
    std::vector<uint32_t> indices(int accessor) const;
    /** All numbers of an accessor of one type, TINYGLTF_TYPE_SCALAR for example, element after element. */
    std::vector<float> numbers(int accessor, int type) const;
    /** The type of an accessor's components, TINYGLTF_COMPONENT_TYPE_FLOAT for example. */
    int componentType(int accessor) const;
    /** Returns the bytes [begin, end) of a bufferView. */
    std::pair<const uint8_t*, const uint8_t*> bytes(int buffer_view, const std::string& path) const;
    /** Returns the max value of the accessor's component type: the index that restarts a strip. */
    uint32_t restartIndex(int accessor) const;

private:
    struct Layout;
    const tinygltf::Accessor& checked(int accessor, const std::string& path) const;
    Layout layout(const tinygltf::Accessor& accessor, const std::string& path) const;
    Layout locate(Layout layout, int buffer_view, size_t offset, size_t count, const std::string& path) const;
    template <class Store>
    void forEach(const tinygltf::Accessor& accessor, const Layout& base, const std::string& path, Store store) const;
    static bool isPacked(const tinygltf::Accessor& accessor, const Layout& base);
    [[noreturn]] void fail(const std::string& path, const std::string& message) const;

    const tinygltf::Model& model_;
    std::string file_;
};

}  // namespace insonify::scene
