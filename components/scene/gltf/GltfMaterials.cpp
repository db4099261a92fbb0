#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stb_image.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>

#include "components/scene/Acoustics.hpp"
#include "components/scene/SurfaceMaps.hpp"
#include "components/scene/gltf/GltfMesh.hpp"
#include "types/NamedFile.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

/** Max size of images, checked before they are decoded [pixels a side]. */
constexpr int max_image_side = 8192;

/** Adds the values of a JSON object by key, and the values of a nested object by "name.key". */
void addValues(const tinygltf::Value& object, const std::string& prefix, AcousticValues& values) {
    for (const std::string& key : object.Keys()) {
        const tinygltf::Value& json = object.Get(key);
        if (json.IsObject() && prefix.empty() && !json.Keys().empty()) {
            addValues(json, key + ".", values);
            continue;
        }
        AcousticValue& value = values[prefix + key];
        if (json.IsNumber()) value = json.GetNumberAsDouble();
        if (json.IsString()) value = json.Get<std::string>();
        if (json.IsBool()) value = json.Get<bool>();
    }
}

void readExtras(const tinygltf::Value& extras, const std::filesystem::path& folder, types::Material& material,
                types::Diagnostics& diagnostics) {
    if (!extras.IsObject() || !extras.Has("acoustics")) return;
    const tinygltf::Value& json = extras.Get("acoustics");
    if (!json.IsObject())
        return diagnostics.push_back({"", "must be an object such as {\"sediment\": \"medium_sand\"}"});
    AcousticValues values;
    addValues(json, "", values);
    std::erase_if(values, [](const auto& value) { return value.first == "map" || value.first.starts_with("map."); });
    readAcoustics(values, folder, diagnostics, {"map"}).applyTo(material);
}

/** Returns the bytes of an encoded image; empty if its file was not found. */
std::pair<const uint8_t*, const uint8_t*> encoded(const tinygltf::Image& image, int index,
                                                  const GltfAccessors& accessors) {
    if (image.bufferView >= 0) return accessors.bytes(image.bufferView, fmt::format("images[{}]", index));
    return {image.image.data(), image.image.data() + image.image.size()};
}

/** Pixels of an image with the requested number of channels: 8 bits each, or 16 if the image has them. */
struct Pixels {
    int width = 0, height = 0;
    std::vector<uint8_t> bytes;
    std::vector<uint16_t> words;  ///< Used for 16 bits, instead of bytes.
};

Pixels decode(std::pair<const uint8_t*, const uint8_t*> encoded, int channels, bool wide) {
    const auto [begin, end] = encoded;
    if (begin == end) throw std::runtime_error("its image file was not found or is empty");
    const auto size = static_cast<int>(end - begin);
    Pixels pixels;
    int own_channels = 0;
    const bool is_known = isPngOrJpeg({reinterpret_cast<const char*>(begin), static_cast<size_t>(size)});
    if (!is_known || !stbi_info_from_memory(begin, size, &pixels.width, &pixels.height, &own_channels))
        throw std::runtime_error("its image is neither PNG nor JPEG");
    if (pixels.width > max_image_side || pixels.height > max_image_side)
        throw std::runtime_error(fmt::format("its image has {} x {} pixels; may have up to {} a side", pixels.width,
                                             pixels.height, max_image_side));
    const auto take = [&]<class Number>(Number* loaded, std::vector<Number>& numbers) {
        const std::unique_ptr<Number, decltype(&stbi_image_free)> kept(loaded, stbi_image_free);
        if (!kept) throw std::runtime_error(fmt::format("its image is damaged ({})", stbi_failure_reason()));
        numbers.assign(loaded, loaded + static_cast<size_t>(channels) * static_cast<size_t>(pixels.width) *
                                            static_cast<size_t>(pixels.height));
    };
    if (wide && stbi_is_16_bit_from_memory(begin, size))
        take(stbi_load_16_from_memory(begin, size, &pixels.width, &pixels.height, &own_channels, channels),
             pixels.words);
    else
        take(stbi_load_from_memory(begin, size, &pixels.width, &pixels.height, &own_channels, channels), pixels.bytes);
    return pixels;
}

/** Returns an item of a list of the file. */
template <class T>
const T& getItem(const GltfFile& gltf, const std::vector<T>& items, int index, const char* what) {
    if (index < 0 || static_cast<size_t>(index) >= items.size())
        throw types::ConfigError(gltf.name, fmt::format("{}[{}]", what, index),
                                 fmt::format("does not exist; the file has {}", items.size()));
    return items[static_cast<size_t>(index)];
}

/** Returns the image of a texture, and sets whether it repeats. */
Pixels readTexture(const GltfFile& gltf, const GltfAccessors& accessors, int index, int channels, bool wide,
                   bool& repeat_u, bool& repeat_v) {
    const tinygltf::Texture& texture = getItem(gltf, gltf.model.textures, index, "textures");
    if (texture.source < 0) throw std::runtime_error("its texture has no PNG or JPEG image");
    Pixels pixels = decode(
        encoded(getItem(gltf, gltf.model.images, texture.source, "images"), texture.source, accessors), channels, wide);
    if (texture.sampler >= 0) {
        const tinygltf::Sampler& sampler = getItem(gltf, gltf.model.samplers, texture.sampler, "samplers");
        repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    }
    return pixels;
}

/** Normal maps of a file, each decoded once. */
class NormalMaps {
public:
    NormalMaps(const GltfFile& gltf, const GltfAccessors& accessors, types::Geometry& geometry)
        : gltf_(gltf), accessors_(accessors), geometry_(geometry) {}

    /** Returns the index of a texture's map, or -1 after a notice. */
    int find(int texture, const std::string& material) {
        const auto [known, is_new] = indices_.try_emplace(texture, -1);
        if (is_new) try {
                geometry_.normal_maps.push_back(load(texture));
                known->second = static_cast<int>(geometry_.normal_maps.size()) - 1;
            } catch (const types::ConfigError&) {
                throw;
            } catch (const std::runtime_error& failure) {
                geometry_.notices.push_back(
                    fmt::format("material \"{}\" is loaded without its normal map: {}", material, failure.what()));
            }
        return known->second;
    }

private:
    types::NormalMap load(int index) {
        types::NormalMap map;
        Pixels pixels = readTexture(gltf_, accessors_, index, 3, false, map.repeat_u, map.repeat_v);
        map.width = pixels.width, map.height = pixels.height;
        map.rgb = std::move(pixels.bytes);
        return map;
    }

    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    types::Geometry& geometry_;
    std::map<int, int> indices_;
};

glm::vec2 readPair(const tinygltf::Value& object, const char* key, glm::vec2 otherwise) {
    if (!object.Has(key) || object.Get(key).ArrayLen() != 2) return otherwise;
    const tinygltf::Value& array = object.Get(key);
    return {static_cast<float>(array.Get(0).GetNumberAsDouble()), static_cast<float>(array.Get(1).GetNumberAsDouble())};
}

/** Returns the transform of KHR_texture_transform: scaled, then turned counter-clockwise as seen with v pointing down,
 *  then shifted. The listing in the specification turns the other way (KhronosGroup/glTF issue 1563). */
NormalMapping mapping(const auto& texture) {
    NormalMapping result{texture.texCoord};
    const auto found = texture.extensions.find("KHR_texture_transform");
    if (found == texture.extensions.end() || !found->second.IsObject()) return result;
    const tinygltf::Value& json = found->second;
    if (json.Has("texCoord") && json.Get("texCoord").IsInt()) result.uv_set = json.Get("texCoord").GetNumberAsInt();
    const double angle = json.Has("rotation") ? json.Get("rotation").GetNumberAsDouble() : 0;
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    const glm::vec2 scale = readPair(json, "scale", glm::vec2(1));
    result.transform = {scale.x * glm::vec2(c, -s), scale.y * glm::vec2(s, c), readPair(json, "offset", glm::vec2(0))};
    return result;
}

/** Surface maps of a file's materials: `extras.acoustics.map`. */
class SurfaceMaps {
public:
    SurfaceMaps(const GltfFile& gltf, const GltfAccessors& accessors, types::Geometry& geometry,
                types::Diagnostics& diagnostics)
        : gltf_(gltf), accessors_(accessors), geometry_(geometry), diagnostics_(diagnostics) {}

    void read(size_t material, MaterialMaps& maps) {
        const tinygltf::Material& from = gltf_.model.materials[material];
        if (!from.extras.IsObject() || !from.extras.Has("acoustics")) return;
        const tinygltf::Value& acoustics = from.extras.Get("acoustics");
        if (!acoustics.IsObject() || !acoustics.Has("map")) return;
        path_ = fmt::format("materials[{}].extras.acoustics.map", material);
        const size_t found = diagnostics_.size();
        const MapValues meaning = readValues(acoustics.Get("map"));
        if (diagnostics_.size() > found) return;
        std::vector<int> classes = getMaterials(meaning, path_ + ".classes", geometry_, diagnostics_);
        for (size_t i = found; i < diagnostics_.size(); ++i) diagnostics_[i].file = gltf_.name;
        if (diagnostics_.size() > found) return;
        try {
            maps.surface = std::make_shared<const types::SurfaceMap>(
                load(acoustics.Get("map"), from, meaning, std::move(classes), maps.on_surface));
            geometry_.materials[material].max_map_strength = meaning.maxStrength();
        } catch (const types::ConfigError&) {
            throw;
        } catch (const std::runtime_error& failure) {
            refuse("", failure.what());
        }
    }

private:
    void refuse(const std::string& key, const std::string& why) {
        diagnostics_.push_back({path_ + (key.empty() ? "" : "." + key), why, gltf_.name});
    }
    std::vector<double> getNumbers(const tinygltf::Value& map, const char* key, std::vector<double> otherwise) {
        if (!map.Has(key)) return otherwise;
        const tinygltf::Value& list = map.Get(key);
        std::vector<double> numbers;
        for (size_t i = 0; list.IsArray() && i < list.ArrayLen(); ++i)
            if (list.Get(i).IsNumber()) numbers.push_back(list.Get(i).GetNumberAsDouble());
        if (!list.IsArray() || numbers.size() != list.ArrayLen() || numbers.size() != 2)
            refuse(key, "must be two numbers, as in [-30, 0]");
        return numbers;
    }
    MapValues readValues(const tinygltf::Value& map) {
        static const std::vector<std::string> keys = {"image", "texcoord", "decibels", "values", "classes"};
        MapValues meaning;
        if (!map.IsObject()) {
            refuse("", "must be an object such as {\"decibels\": [-30, 0]}");
            return meaning;
        }
        for (const std::string& key : map.Keys())
            if (std::ranges::find(keys, key) == keys.end())
                refuse(key,
                       fmt::format("is not known; {}may be {}", types::didYouMean(key, keys), fmt::join(keys, ", ")));
        meaning.decibels = getNumbers(map, "decibels", {});
        meaning.values = getNumbers(map, "values", meaning.values);
        for (const double each : meaning.decibels)
            if (!(each >= -200 && each <= MapValues::max_db))
                refuse("decibels", fmt::format("has {:g}; may be -200 to {:g} dB", each, MapValues::max_db));
        if (map.Has("texcoord") && !(map.Get("texcoord").IsInt() && map.Get("texcoord").GetNumberAsInt() >= 0))
            refuse("texcoord", "must be a whole number from 0 on: the set of texture coordinates");
        if (map.Has("classes") && !map.Get("classes").IsObject())
            refuse("classes", "must be an object such as {\"0\": \"medium_sand\", \"255\": \"rock\"}");
        else if (map.Has("classes"))
            for (const std::string& value : map.Get("classes").Keys()) {
                const tinygltf::Value& name = map.Get("classes").Get(value);
                if (name.IsString())
                    meaning.classes[value] = name.Get<std::string>();
                else
                    refuse("classes." + value,
                           "must be the name of a sediment, of matter, or of a material of the file");
            }
        types::Diagnostics found;
        meaning.check(found);
        for (const types::Diagnostic& each : found) refuse(each.path, each.message);
        return meaning;
    }
    /** Loads the picture that the map names, else the texture of the material's base colour. */
    types::SurfaceMap load(const tinygltf::Value& map, const tinygltf::Material& from, const MapValues& meaning,
                           std::vector<int> classes, NormalMapping& on_surface) {
        bool repeat_u = true, repeat_v = true;
        Pixels pixels;
        if (map.Has("image")) {
            if (!map.Get("image").IsString()) throw std::runtime_error("has an image that is no path of a file");
            pixels = decodeFile(gltf_.name, map.Get("image").Get<std::string>());
        } else {
            const tinygltf::TextureInfo& texture = from.pbrMetallicRoughness.baseColorTexture;
            if (texture.index < 0)
                throw std::runtime_error(
                    "has no image, and the material no texture of its base colour; give one of them");
            pixels = readTexture(gltf_, accessors_, texture.index, 1, true, repeat_u, repeat_v);
            on_surface = mapping(texture);
        }
        if (map.Has("texcoord")) on_surface.uv_set = map.Get("texcoord").GetNumberAsInt();
        std::vector<float> values(pixels.bytes.begin(), pixels.bytes.end());
        for (const uint16_t word : pixels.words) values.push_back(static_cast<float>(word) * (255.0f / 65535));
        types::SurfaceMap result = surfaceMap(values, pixels.width, pixels.height, meaning, std::move(classes));
        result.repeat_u = repeat_u, result.repeat_v = repeat_v;
        noteUnknown(from.name, result);
        return result;
    }
    static Pixels decodeFile(const std::filesystem::path& scene, const std::string& name) {
        const std::filesystem::path file = scene.parent_path() / name;
        std::error_code error;
        if (!types::belongsTo(file, scene))
            throw std::runtime_error(fmt::format("has the image {}, which {}", name, types::not_its_own));
        if (!std::filesystem::is_regular_file(file, error))
            throw std::runtime_error(
                fmt::format("has the image {}; there is no such file in the folder of the scene", name));
        if (std::filesystem::file_size(file, error) > max_image_bytes)
            throw std::runtime_error(fmt::format("has the image {}, which is larger than 1 GiB", name));
        std::ifstream stream(file, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
        const auto* const begin = reinterpret_cast<const uint8_t*>(bytes.data());
        return decode({begin, begin + bytes.size()}, 1, true);
    }
    /** Reports texels without a class. */
    void noteUnknown(const std::string& material, const types::SurfaceMap& map) const {
        const auto unknown = std::ranges::count(map.classes, types::SurfaceMap::no_class);
        if (unknown > 0)
            geometry_.notices.push_back(fmt::format(
                "material \"{}\": {:.3g} % of its map has values without a class; there it is as without the map",
                material, 100 * static_cast<double>(unknown) / static_cast<double>(map.classes.size())));
    }

    static constexpr uintmax_t max_image_bytes = uintmax_t{1} << 30;
    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    types::Geometry& geometry_;
    types::Diagnostics& diagnostics_;
    std::string path_;  ///< Path of the current map.
};

/** Returns the alpha of a material's base colour as far as it is drawn: a texture can only lower it. */
float getOpacity(const tinygltf::Material& from) {
    const std::vector<double>& colour = from.pbrMetallicRoughness.baseColorFactor;
    const double alpha = colour.size() == 4 ? colour[3] : 1;
    if (from.alphaMode == "BLEND") return static_cast<float>(std::clamp(alpha, 0.0, 1.0));
    return from.alphaMode == "MASK" && alpha < from.alphaCutoff ? 0.0f : 1.0f;
}

}  // namespace

std::vector<MaterialMaps> readMaterials(const GltfFile& gltf, const GltfAccessors& accessors,
                                        types::Geometry& geometry) {
    std::vector<MaterialMaps> all;
    types::Diagnostics diagnostics;
    NormalMaps maps(gltf, accessors, geometry);
    for (const tinygltf::Material& from : gltf.model.materials) {
        const size_t index = geometry.materials.size();
        types::Material material;
        material.name = from.name.empty() ? fmt::format("material_{}", index) : from.name;
        material.double_sided = from.doubleSided;
        types::Diagnostics found;
        readExtras(from.extras, std::filesystem::path(gltf.name).parent_path(), material, found);
        for (const types::Diagnostic& each : found) {
            const std::string below = each.path.empty() ? "" : "." + each.path;
            diagnostics.push_back(
                {fmt::format("materials[{}].extras.acoustics{}", index, below), each.message, gltf.name});
        }
        if (from.normalTexture.index >= 0) {
            material.normal_map = maps.find(from.normalTexture.index, material.name);
            const auto scale = static_cast<float>(from.normalTexture.scale);
            material.normal_scale = std::isfinite(scale) ? scale : 1;
        }
        MaterialMaps& own = all.emplace_back();
        own.opacity = getOpacity(from);
        if (material.normal_map >= 0) own.normals = mapping(from.normalTexture);
        geometry.materials.push_back(std::move(material));
    }
    SurfaceMaps surfaces(gltf, accessors, geometry, diagnostics);  // their classes may name any material
    for (size_t i = 0; i < all.size(); ++i) surfaces.read(i, all[i]);
    if (!diagnostics.empty()) throw types::ConfigError(std::move(diagnostics));
    return all;
}

}  // namespace insonify::scene
