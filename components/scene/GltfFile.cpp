#include "components/scene/GltfFile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string_view>

#include "types/ConfigError.hpp"

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

/** Replaces callbacks of tinygltf, which would search the working folder as well, expand shell variables in names, and
 *  allocate the size that a folder reports. */
bool fileExists(const std::string& file, void* folder) {
    std::error_code error;
    return file.starts_with(*static_cast<const std::string*>(folder)) && std::filesystem::is_regular_file(file, error);
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
Callbacks callbacksIn(std::string& folder) {
    Callbacks callbacks{};
    callbacks.FileExists = fileExists;
    callbacks.ExpandFilePath = unexpanded;
    callbacks.ReadWholeFile = readWhole;
    callbacks.WriteWholeFile = writeNothing;
    callbacks.user_data = &folder;
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

/** Returns false and fills `errors` when tinygltf refuses the file. Exceptions that it throws on bad input are
 *  converted to errors. */
bool parse(GltfFile& gltf, const std::string& bytes, std::string folder, std::string& errors) try {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keepEncoded, nullptr);
    loader.SetFsCallbacks(callbacksIn<tinygltf::FsCallbacks>(folder));
    std::string warnings;
    const auto size = static_cast<unsigned>(bytes.size());
    return isBinary(bytes)
               ? loader.LoadBinaryFromMemory(&gltf.model, &errors, &warnings,
                                             reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
               : loader.LoadASCIIFromString(&gltf.model, &errors, &warnings, bytes.data(), size, folder);
} catch (const std::exception& failure) {
    errors += types::reasonOf(failure);
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
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    const bool parsed = parse(gltf, bytes, folder.string(), errors);
    checkExtensions(gltf);
    if (!parsed) throw types::ConfigError(gltf.name, "", fmt::format("cannot be read as glTF 2.0: {}", reason(errors)));
    if (const std::string& version = gltf.model.asset.version; !version.starts_with("2."))
        throw types::ConfigError(gltf.name, "asset.version",
                                 fmt::format("is \"{}\"; must be 2.0: export the model as glTF 2.0", version));
    return gltf;
}

}  // namespace insonify::scene
