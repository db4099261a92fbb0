#include "components/scene/GltfAccessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

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
    forEach(from, base, path,
            [&](size_t i, const uint8_t* bytes) { result[i] = loadIndex(bytes, from.componentType); });
    return result;
}

uint32_t GltfAccessors::restartIndex(int accessor) const {
    const size_t size = componentSize(checked(accessor, fmt::format("accessors[{}]", accessor)).componentType);
    return std::numeric_limits<uint32_t>::max() >> (32 - 8 * size);
}

}  // namespace insonify::scene
