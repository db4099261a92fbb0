#include "components/scene/gltf/GltfFile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <regex>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

#include "types/NamedFile.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** Max nesting of JSON: deeper JSON would overflow the stack of the recursive parser. */
constexpr int max_nesting = 200;
/** tinygltf and .glb count bytes in 32 bits; its sizes are cast to int. */
constexpr uintmax_t max_bytes = 0x7fffffff;

/** Extensions that a file may require: supported, or without influence on shape. */
constexpr std::string_view supported_extensions[] = {"KHR_mesh_quantization",
                                                     "KHR_texture_transform",
                                                     "EXT_mesh_gpu_instancing",
                                                     "KHR_lights_punctual",
                                                     "KHR_materials_unlit",
                                                     "KHR_materials_emissive_strength",
                                                     "KHR_materials_clearcoat",
                                                     "KHR_materials_ior",
                                                     "KHR_materials_sheen",
                                                     "KHR_materials_specular",
                                                     "KHR_materials_transmission",
                                                     "KHR_materials_volume",
                                                     "KHR_materials_iridescence",
                                                     "KHR_materials_anisotropy",
                                                     "KHR_materials_pbrSpecularGlossiness",
                                                     "KHR_materials_variants",
                                                     "KHR_xmp_json_ld"};

std::string readBytes(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        throw std::runtime_error("does not exist; give the path of a .gltf or .glb file");
    if (!std::filesystem::is_regular_file(file, error))
        throw std::runtime_error("is not a file; give the path of a .gltf or .glb file");
    const uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size > max_bytes) throw std::runtime_error("is larger than 2 GiB; split it");
    std::string bytes(static_cast<size_t>(size), '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
        throw std::runtime_error("cannot be read; check its permissions");
    return bytes;
}

/** The files that a scene names. */
struct NamedFiles {
    std::filesystem::path scene;
    std::string folder;               ///< Of the scene, to which tinygltf appends the names.
    std::set<std::string> foreign{};  ///< Those that do not belong to the scene.
};

/** Replaces callbacks of tinygltf, which would search the working folder as well, expand shell variables in names,
 *  allocate the size that a folder reports, and read any file of the machine. */
bool fileExists(const std::string& file, void* user_data) {
    auto& named = *static_cast<NamedFiles*>(user_data);
    if (!file.starts_with(named.folder)) return false;
    if (!types::belongsTo(file, named.scene))
        return named.foreign.insert(file.substr(std::min(named.folder.size() + 1, file.size()))), false;
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
}
std::string unexpanded(const std::string& file, void*) { return file; }
bool readWhole(std::vector<unsigned char>* bytes, std::string* error, const std::string& file, void*) try {
    const std::string read = readBytes(file);
    bytes->assign(read.begin(), read.end());
    return true;
} catch (const std::exception& failure) {
    *error = failure.what();
    return false;
}

bool writeNothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

/** Sets all callbacks: tinygltf from 2.9 on also asks for sizes, and accepts either all callbacks or none. */
template <class Callbacks>
Callbacks callbacksFor(NamedFiles& files) {
    Callbacks callbacks{};
    callbacks.FileExists = fileExists;
    callbacks.ExpandFilePath = unexpanded;
    callbacks.ReadWholeFile = readWhole;
    callbacks.WriteWholeFile = writeNothing;
    callbacks.user_data = &files;
    if constexpr (requires { callbacks.GetFileSizeInBytes; })
        callbacks.GetFileSizeInBytes = [](size_t* size, std::string* failure, const std::string& file, void*) {
            std::error_code error;
            *size = std::filesystem::file_size(file, error);
            if (error) *failure = error.message();
            return !error;
        };
    return callbacks;
}

/** Keeps an image encoded. Images in a bufferView stay there: its bounds are not checked yet. */
bool keepEncoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                 int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

bool isBinary(std::string_view bytes) { return bytes.starts_with("glTF"); }

/** Returns the JSON of a .gltf, or of the first chunk of a .glb, possibly truncated. */
std::string_view jsonPart(std::string_view bytes) {
    if (!isBinary(bytes)) return bytes;
    if (bytes.size() < 20) return {};
    uint32_t length;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    return bytes.substr(20, length);
}

/** Returns the max nesting of arrays and objects, without recursion. */
int nesting(std::string_view json) {
    int depth = 0, deepest = 0;
    bool in_string = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '[' || c == '{'))
            deepest = std::max(deepest, ++depth);
        else if (!in_string && (c == ']' || c == '}'))
            --depth;
    }
    return deepest;
}

void checkBytes(const std::string& bytes) {
    if (bytes.empty()) throw std::runtime_error("is empty; must be a glTF 2.0 file (.gltf or .glb)");
    if (const int depth = nesting(jsonPart(bytes)); depth > max_nesting)
        throw std::runtime_error(fmt::format("nests JSON {} levels deep; may be up to {}", depth, max_nesting));
    if (isBinary(bytes) && bytes.size() >= 12) {
        uint32_t length;
        std::memcpy(&length, bytes.data() + 8, sizeof length);
        if (length > bytes.size())
            throw std::runtime_error(
                fmt::format("is truncated: it has {} of {} bytes; export or copy it again", bytes.size(), length));
    }
}

std::string remedy(const std::string& extension) {
    if (extension == "KHR_draco_mesh_compression")
        return "decompress it: `gltf-transform copy in.glb out.glb`, or export without Draco";
    if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression")
        return "decompress it: `gltf-transform copy in.glb out.glb`, or run gltfpack without -c";
    if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp" || extension == "EXT_texture_avif")
        return "convert its images to PNG or JPEG: `gltf-transform png in.glb out.glb`";
    return "export the model without it";
}

void checkExtensions(GltfFile& gltf) {
    types::Diagnostics refused;
    const auto supported = [](const std::string& name) { return std::ranges::count(supported_extensions, name) > 0; };
    const auto& required = gltf.model.extensionsRequired;
    for (const std::string& name : required)
        if (!supported(name))
            refused.push_back(
                {"extensionsRequired", fmt::format("{} cannot be read; {}", name, remedy(name)), gltf.name});
    if (!refused.empty()) throw types::ConfigError(std::move(refused));
    for (const std::string& name : gltf.model.extensionsUsed)
        if (!supported(name))
            gltf.notices.push_back(fmt::format("extension {} is not read; its fallback is used", name));
}

/** Returns a glTF text in which names with a percent sign that are files as they stand have it encoded: tinygltf
 * decodes all names. */
std::string withFilesAsNamed(std::string text, const std::string& folder) {
    if (isBinary(text) || text.find('%') == std::string::npos) return text;
    static const std::regex uri("\"uri\"\\s*:\\s*\"([^\"\\\\]{1,1024})\"");
    std::string out;
    auto from = text.cbegin();
    for (std::sregex_iterator found(text.cbegin(), text.cend(), uri), none; found != none; ++found) {
        std::string name = (*found)[1].str();
        std::error_code error;
        if (name.find('%') == std::string::npos || !std::filesystem::is_regular_file(folder + "/" + name, error))
            continue;
        for (size_t at = 0; (at = name.find('%', at)) != std::string::npos; at += 3) name.replace(at, 1, "%25");
        out.append(from, (*found)[1].first).append(name);
        from = (*found)[1].second;
    }
    return out.append(from, text.cend());
}

/** Returns false and fills `errors` when tinygltf refuses the file. Exceptions that it throws on bad input are
 *  converted to errors. */
bool parse(GltfFile& gltf, std::string given, NamedFiles& files, std::string& errors) try {
    const std::string bytes = withFilesAsNamed(std::move(given), files.folder);
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keepEncoded, nullptr);
    loader.SetFsCallbacks(callbacksFor<tinygltf::FsCallbacks>(files));
    std::string warnings;
    const auto size = static_cast<unsigned>(bytes.size());
    return isBinary(bytes)
               ? loader.LoadBinaryFromMemory(&gltf.model, &errors, &warnings,
                                             reinterpret_cast<const unsigned char*>(bytes.data()), size, files.folder)
               : loader.LoadASCIIFromString(&gltf.model, &errors, &warnings, bytes.data(), size, files.folder);
} catch (const std::exception& failure) {
    errors += types::getReason(failure);
    return false;
}

/** Returns the first line of tinygltf's errors, without the kind of exception that its JSON parser puts before them.
 *  The errors may be empty. */
std::string reason(const std::string& errors) {
    size_t begin = errors.find_first_not_of(" \n");
    if (begin == std::string::npos) return "a required property is missing or of the wrong type";
    if (errors.compare(begin, 6, "[json.") == 0) begin = std::min(errors.find("] ", begin), errors.size() - 2) + 2;
    return errors.substr(begin, errors.find('\n', begin) - begin);
}

/** An accessor without data costs a file nothing, so its count needs a limit of its own. */
constexpr size_t max_empty_count = size_t{1} << 24;

size_t componentSize(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
        default: return 0;
    }
}

template <class T>
T load(const uint8_t* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class T>
float loadScaled(const uint8_t* from, bool normalized) {
    const auto value = static_cast<float>(load<T>(from));
    if constexpr (std::is_integral_v<T>)
        if (normalized) return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
    return value;
}

float loadFloat(const uint8_t* from, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return loadScaled<int8_t>(from, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return loadScaled<uint8_t>(from, normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return loadScaled<int16_t>(from, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return loadScaled<uint16_t>(from, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return loadScaled<uint32_t>(from, normalized);
        default: return loadScaled<float>(from, normalized);
    }
}

uint32_t loadIndex(const uint8_t* from, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return load<uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<uint16_t>(from);
        default: return load<uint32_t>(from);
    }
}

bool isIndexType(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

GltfFile readGltfFile(const std::filesystem::path& file) {
    GltfFile gltf;
    gltf.name = file.string();
    std::string bytes;
    try {
        bytes = readBytes(file);
        checkBytes(bytes);
    } catch (const std::runtime_error& failure) {
        throw types::ConfigError(gltf.name, "", failure.what());
    }
    std::string errors;
    NamedFiles files{file, file.has_parent_path() ? file.parent_path().string() : "."};
    const bool parsed = parse(gltf, std::move(bytes), files, errors);
    checkExtensions(gltf);
    for (const std::string& named : files.foreign) {
        const std::string text = fmt::format("names {}, which {}", named, types::not_its_own);
        if (!parsed) throw types::ConfigError(gltf.name, "", text);
        gltf.notices.push_back(types::warning(text));
    }
    if (!parsed) throw types::ConfigError(gltf.name, "", fmt::format("cannot be read as glTF 2.0: {}", reason(errors)));
    if (const std::string& version = gltf.model.asset.version; !version.starts_with("2."))
        throw types::ConfigError(gltf.name, "asset.version",
                                 fmt::format("is \"{}\"; must be 2.0: export the model as glTF 2.0", version));
    return gltf;
}

/** The place of elements in memory; `data` is null for zeros. */
struct GltfAccessors::Layout {
    const uint8_t* data = nullptr;
    size_t element_size = 0;
    size_t stride = 0;
};

void GltfAccessors::fail(const std::string& path, const std::string& message) const {
    throw types::ConfigError(file_, path, message);
}

const tinygltf::Accessor& GltfAccessors::checked(int accessor, const std::string& path) const {
    if (accessor < 0 || static_cast<size_t>(accessor) >= model_.accessors.size())
        fail(path, fmt::format("does not exist; the file has {} accessors", model_.accessors.size()));
    const tinygltf::Accessor& found = model_.accessors[static_cast<size_t>(accessor)];
    if (componentSize(found.componentType) == 0)
        fail(path + ".componentType", fmt::format("is {}; may be 5120 to 5123, 5125 or 5126", found.componentType));
    return found;
}

std::pair<const uint8_t*, const uint8_t*> GltfAccessors::bytes(int buffer_view, const std::string& path) const {
    if (buffer_view < 0 || static_cast<size_t>(buffer_view) >= model_.bufferViews.size())
        fail(path + ".bufferView", fmt::format("is {}; the file has {}", buffer_view, model_.bufferViews.size()));
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<size_t>(buffer_view)];
    const std::string view_path = fmt::format("bufferViews[{}]", buffer_view);
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model_.buffers.size())
        fail(view_path + ".buffer", fmt::format("is {}; the file has {}", view.buffer, model_.buffers.size()));
    const std::vector<unsigned char>& data = model_.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        fail(view_path, fmt::format("byteOffset {} + byteLength {} run over the buffer's {} bytes", view.byteOffset,
                                    view.byteLength, data.size()));
    const uint8_t* begin = data.data() + view.byteOffset;
    return {begin, begin + view.byteLength};
}

GltfAccessors::Layout GltfAccessors::locate(Layout layout, int buffer_view, size_t offset, size_t count,
                                            const std::string& path) const {
    const auto [begin, end] = bytes(buffer_view, path);
    const auto length = static_cast<size_t>(end - begin);
    const size_t stride = model_.bufferViews[static_cast<size_t>(buffer_view)].byteStride;
    layout.stride = stride == 0 ? layout.element_size : stride;
    if (layout.stride < layout.element_size)
        fail(path, fmt::format("byteStride is {}; its elements have {} bytes", stride, layout.element_size));
    const bool fits = count == 0 || (offset <= length && layout.element_size <= length - offset &&
                                     count - 1 <= (length - offset - layout.element_size) / layout.stride);
    if (!fits)
        fail(path, fmt::format("{} elements of {} bytes from byteOffset {} run over the bufferView's {} bytes", count,
                               layout.element_size, offset, length));
    layout.data = begin + offset;
    return layout;
}

GltfAccessors::Layout GltfAccessors::layout(const tinygltf::Accessor& accessor, const std::string& path) const {
    Layout layout;
    layout.element_size = componentSize(accessor.componentType) *
                          static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
    if (accessor.bufferView >= 0) return locate(layout, accessor.bufferView, accessor.byteOffset, accessor.count, path);
    if (accessor.count > max_empty_count)
        fail(path + ".count", fmt::format("is {} without data; may be up to {}", accessor.count, max_empty_count));
    return layout;
}

/** Returns whether elements are adjacent, and all in one place. */
bool GltfAccessors::isPacked(const tinygltf::Accessor& accessor, const Layout& base) {
    return base.stride == base.element_size && !accessor.sparse.isSparse;
}

/** Calls store(element, bytes) for each element that has data, sparse elements last. */
template <class Store>
void GltfAccessors::forEach(const tinygltf::Accessor& accessor, const Layout& base, const std::string& path,
                            Store store) const {
    for (size_t i = 0; base.data && i < accessor.count; ++i) store(i, base.data + i * base.stride);
    if (!accessor.sparse.isSparse) return;

    const auto& sparse = accessor.sparse;
    const int index_type = sparse.indices.componentType;
    if (!isIndexType(index_type))
        fail(path + ".sparse.indices.componentType", fmt::format("is {}; may be 5121, 5123 or 5125", index_type));
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        fail(path + ".sparse", "has a negative count or byteOffset");
    const auto count = static_cast<size_t>(sparse.count);
    const Layout indices = locate({nullptr, componentSize(index_type), 0}, sparse.indices.bufferView,
                                  static_cast<size_t>(sparse.indices.byteOffset), count, path + ".sparse.indices");
    const Layout values = locate({nullptr, base.element_size, 0}, sparse.values.bufferView,
                                 static_cast<size_t>(sparse.values.byteOffset), count, path + ".sparse.values");
    for (size_t i = 0; i < count; ++i) {
        const size_t element = loadIndex(indices.data + i * indices.stride, index_type);
        if (element >= accessor.count)
            fail(path + ".sparse.indices",
                 fmt::format("hold {}; the accessor has {} elements", element, accessor.count));
        store(element, values.data + i * values.stride);
    }
}

template <class Vector>
std::vector<Vector> GltfAccessors::vectors(int accessor) const {
    const std::string path = fmt::format("accessors[{}]", accessor);
    const tinygltf::Accessor& from = checked(accessor, path);
    if (tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type)) != Vector::length())
        fail(path + ".type", fmt::format("has the wrong number of components; must be VEC{}", Vector::length()));
    const Layout base = layout(from, path);
    std::vector<Vector> result(from.count, Vector(0));
    if (base.data && from.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && isPacked(from, base)) {
        std::memcpy(result.data(), base.data, from.count * base.element_size);
        return result;
    }
    const size_t step = componentSize(from.componentType);
    forEach(from, base, path, [&](size_t i, const uint8_t* bytes) {
        for (int c = 0; c < Vector::length(); ++c)
            result[i][c] = loadFloat(bytes + static_cast<size_t>(c) * step, from.componentType, from.normalized);
    });
    return result;
}
template std::vector<glm::vec2> GltfAccessors::vectors(int) const;
template std::vector<glm::vec3> GltfAccessors::vectors(int) const;
template std::vector<glm::vec4> GltfAccessors::vectors(int) const;

std::vector<float> GltfAccessors::numbers(int accessor, int type) const {
    const std::string path = fmt::format("accessors[{}]", accessor);
    const tinygltf::Accessor& from = checked(accessor, path);
    if (from.type != type)
        fail(path + ".type",
             fmt::format("is not the one needed here; must be {}", type == TINYGLTF_TYPE_SCALAR ? "SCALAR"
                                                                   : type == TINYGLTF_TYPE_VEC3 ? "VEC3"
                                                                   : type == TINYGLTF_TYPE_VEC4 ? "VEC4"
                                                                                                : "MAT4"));
    const Layout base = layout(from, path);
    const size_t step = componentSize(from.componentType),
                 width = static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    std::vector<float> result(from.count * width, 0.0f);
    forEach(from, base, path, [&](size_t i, const uint8_t* bytes) {
        for (size_t c = 0; c < width; ++c)
            result[i * width + c] = loadFloat(bytes + c * step, from.componentType, from.normalized);
    });
    return result;
}

int GltfAccessors::componentType(int accessor) const {
    return checked(accessor, fmt::format("accessors[{}]", accessor)).componentType;
}

std::vector<uint32_t> GltfAccessors::indices(int accessor) const {
    const std::string path = fmt::format("accessors[{}]", accessor);
    const tinygltf::Accessor& from = checked(accessor, path);
    if (!isIndexType(from.componentType) || from.type != TINYGLTF_TYPE_SCALAR)
        fail(path, fmt::format("holds indices but has componentType {}; must be a SCALAR of 5121, 5123 or 5125",
                               from.componentType));
    const Layout base = layout(from, path);
    std::vector<uint32_t> result(from.count, 0);
    if (base.data && from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT && isPacked(from, base)) {
        std::memcpy(result.data(), base.data, from.count * base.element_size);
        return result;
    }
    forEach(from, base, path,
            [&](size_t i, const uint8_t* bytes) { result[i] = loadIndex(bytes, from.componentType); });
    return result;
}

uint32_t GltfAccessors::restartIndex(int accessor) const {
    const size_t size = componentSize(checked(accessor, fmt::format("accessors[{}]", accessor)).componentType);
    return std::numeric_limits<uint32_t>::max() >> (32 - 8 * size);
}

}  // namespace insonify::scene
