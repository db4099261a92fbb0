#include "components/scene/GltfMaterials.hpp"

#include <fmt/format.h>
#include <stb_image.h>

#include <cmath>
#include <map>
#include <memory>

#include "components/scene/Acoustics.hpp"
#include "components/scene/PictureFormat.hpp"
#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

/** Larger images are refused before they are decoded [pixels a side]. */
constexpr int max_image_side = 8192;

/** Adds the values of a JSON object by key, those of an object in it by "name.key". */
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
    readAcoustics(values, folder, diagnostics).applyTo(material);
}

/** Bytes of an encoded image; empty when its file was not found. */
std::pair<const uint8_t*, const uint8_t*> encoded(const tinygltf::Image& image, int index,
                                                  const GltfAccessors& accessors) {
    if (image.bufferView >= 0) return accessors.bytes(image.bufferView, fmt::format("images[{}]", index));
    return {image.image.data(), image.image.data() + image.image.size()};
}

types::NormalMap decode(std::pair<const uint8_t*, const uint8_t*> bytes) {
    const auto [begin, end] = bytes;
    if (begin == end) throw std::runtime_error("its image file was not found or is empty");
    const auto size = static_cast<int>(end - begin);
    types::NormalMap map;
    int channels = 0;
    const bool is_known = isPngOrJpeg({reinterpret_cast<const char*>(begin), static_cast<size_t>(size)});
    if (!is_known || !stbi_info_from_memory(begin, size, &map.width, &map.height, &channels))
        throw std::runtime_error("its image is neither PNG nor JPEG");
    if (map.width > max_image_side || map.height > max_image_side)
        throw std::runtime_error(fmt::format("its image has {} x {} pixels; may have up to {} a side", map.width,
                                             map.height, max_image_side));
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(begin, size, &map.width, &map.height, &channels, 3), stbi_image_free);
    if (!pixels) throw std::runtime_error(fmt::format("its image is damaged ({})", stbi_failure_reason()));
    map.rgb.assign(pixels.get(),
                   pixels.get() + size_t{3} * static_cast<size_t>(map.width) * static_cast<size_t>(map.height));
    return map;
}

/** Normal maps of a file, each decoded once. */
class NormalMaps {
public:
    NormalMaps(const GltfFile& gltf, const GltfAccessors& accessors, types::Geometry& geometry)
        : gltf_(gltf), accessors_(accessors), geometry_(geometry) {}

    /** Index of a texture's map, or -1 with a notice. */
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
        const tinygltf::Texture& texture = at(gltf_.model.textures, index, "textures");
        if (texture.source < 0) throw std::runtime_error("its texture has no PNG or JPEG image");
        types::NormalMap map =
            decode(encoded(at(gltf_.model.images, texture.source, "images"), texture.source, accessors_));
        if (texture.sampler >= 0) {
            const tinygltf::Sampler& sampler = at(gltf_.model.samplers, texture.sampler, "samplers");
            map.repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
            map.repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        }
        return map;
    }
    template <class T>
    const T& at(const std::vector<T>& items, int index, const char* what) const {
        if (index < 0 || static_cast<size_t>(index) >= items.size())
            throw types::ConfigError(gltf_.name, fmt::format("{}[{}]", what, index),
                                     fmt::format("does not exist; the file has {}", items.size()));
        return items[static_cast<size_t>(index)];
    }

    const GltfFile& gltf_;
    const GltfAccessors& accessors_;
    types::Geometry& geometry_;
    std::map<int, int> indices_;
};

glm::vec2 pairOf(const tinygltf::Value& object, const char* key, glm::vec2 otherwise) {
    if (!object.Has(key) || object.Get(key).ArrayLen() != 2) return otherwise;
    const tinygltf::Value& array = object.Get(key);
    return {static_cast<float>(array.Get(0).GetNumberAsDouble()), static_cast<float>(array.Get(1).GetNumberAsDouble())};
}

/** KHR_texture_transform: scaled, then turned counter-clockwise as seen, where v points down, then shifted. The listing
 *  in the specification turns the other way (KhronosGroup/glTF issue 1563). */
NormalMapping mapping(const tinygltf::NormalTextureInfo& texture) {
    NormalMapping result{texture.texCoord};
    const auto found = texture.extensions.find("KHR_texture_transform");
    if (found == texture.extensions.end() || !found->second.IsObject()) return result;
    const tinygltf::Value& json = found->second;
    if (json.Has("texCoord") && json.Get("texCoord").IsInt()) result.uv_set = json.Get("texCoord").GetNumberAsInt();
    const double angle = json.Has("rotation") ? json.Get("rotation").GetNumberAsDouble() : 0;
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    const glm::vec2 scale = pairOf(json, "scale", glm::vec2(1));
    result.transform = {scale.x * glm::vec2(c, -s), scale.y * glm::vec2(s, c), pairOf(json, "offset", glm::vec2(0))};
    return result;
}

}  // namespace

std::vector<std::optional<NormalMapping>> readMaterials(const GltfFile& gltf, const GltfAccessors& accessors,
                                                        types::Geometry& geometry) {
    std::vector<std::optional<NormalMapping>> mappings;
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
        mappings.push_back(material.normal_map < 0 ? std::nullopt : std::optional(mapping(from.normalTexture)));
        geometry.materials.push_back(std::move(material));
    }
    if (!diagnostics.empty()) throw types::ConfigError(std::move(diagnostics));
    return mappings;
}

}  // namespace insonify::scene
