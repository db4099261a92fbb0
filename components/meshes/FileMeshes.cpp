#include "components/meshes/FileMeshes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace insonify::meshes {
namespace {

bool isThere(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::exists(path, error);
}

}  // namespace

ModelPaths::ModelPaths(const std::filesystem::path& world) {
    for (const char* variable :
         {"INSONIFY_MODEL_PATH", "GAZEBO_MODEL_PATH", "SDF_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH"}) {
        const char* list = std::getenv(variable);
        std::istringstream stream(list ? list : "");
        for (std::string folder; std::getline(stream, folder, ':');)
            if (!folder.empty()) folders_.push_back(std::filesystem::absolute(folder));
    }
    const std::filesystem::path folder = std::filesystem::absolute(world).parent_path();
    folders_.push_back(folder);
    if (isThere(folder / "model.config")) folders_.push_back(folder.parent_path());
}

std::optional<std::filesystem::path> ModelPaths::find(const std::string& uri,
                                                      const std::filesystem::path& named_in) const {
    const size_t scheme_end = uri.find("://");
    const std::string scheme = scheme_end == std::string::npos ? "" : uri.substr(0, scheme_end);
    const std::filesystem::path path = scheme.empty() ? uri : uri.substr(scheme_end + 3);
    if (!scheme.empty() && scheme != "model" && scheme != "package" && scheme != "file") return {};
    if (path.empty()) return {};
    if (path.is_absolute()) return isThere(path) ? std::optional(path) : std::nullopt;
    if (scheme.empty() && named_in.is_absolute() && isThere(named_in.parent_path() / path))
        return named_in.parent_path() / path;
    for (const std::filesystem::path& folder : folders_)
        if (isThere(folder / path)) return folder / path;
    return {};
}

using namespace scene;
namespace {

constexpr std::string_view mesh_mark = "insonify meshes 1\n";

class Writer {
public:
    explicit Writer(std::FILE* file) : file_(file) {}

    void bytes(const void* data, size_t size) { good_ = good_ && std::fwrite(data, 1, size, file_) == size; }
    template <class T>
    void value(const T& value) {
        bytes(&value, sizeof value);
    }
    template <class Array>
    void array(const Array& items) {
        value(static_cast<uint64_t>(items.size()));
        bytes(items.data(), items.size() * sizeof(typename Array::value_type));
    }
    bool finish() { return std::fflush(file_) == 0 && good_; }

private:
    std::FILE* file_;
    bool good_ = true;
};

class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class T>
    T value() {
        T value;
        copy(&value, sizeof value);
        return value;
    }
    template <class Array>
    void array(Array& items) {
        constexpr size_t size = sizeof(typename Array::value_type);
        const auto count = value<uint64_t>();
        if (count > bytes_.size() / size) throw std::runtime_error("an array runs over the end");
        items.resize(count);
        copy(items.data(), count * size);
    }
    /** Reads a count of items that take at least one byte each. */
    size_t count() {
        const auto count = value<uint64_t>();
        if (count > bytes_.size()) throw std::runtime_error("more is announced than follows");
        return count;
    }
    void expectMark() {
        if (bytes_.size() < mesh_mark.size() || std::memcmp(bytes_.data(), mesh_mark.data(), mesh_mark.size()) != 0)
            throw std::runtime_error("the mark is missing");
        bytes_ = bytes_.subspan(mesh_mark.size());
    }
    void expectEnd() const {
        if (!bytes_.empty()) throw std::runtime_error("more follows than was announced");
    }

private:
    void copy(void* to, size_t size) {
        if (size > bytes_.size()) throw std::runtime_error("the end is missing");
        if (size > 0) std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }

    std::span<const std::byte> bytes_;
};

void check(const FileMeshes& meshes) {
    for (const FileMeshes::Part& part : meshes.parts) {
        const auto exists = [&part](uint32_t index) { return index < part.surface.positions.size(); };
        if (part.surface.indices.size() % 3 != 0 || !std::ranges::all_of(part.surface.indices, exists))
            throw std::runtime_error("an index has no vertex");
        if (part.material >= meshes.materials.size()) throw std::runtime_error("a part has no material");
    }
    for (const FileMeshes::Placing& placing : meshes.placings)
        if (placing.part >= meshes.parts.size()) throw std::runtime_error("a place has no part");
}

}  // namespace

bool writeReply(const MeshReply& reply, std::FILE* file) {
    Writer writer(file);
    writer.bytes(mesh_mark.data(), mesh_mark.size());
    writer.array(reply.refusal);
    writer.value(static_cast<uint64_t>(reply.meshes.materials.size()));
    for (const std::string& name : reply.meshes.materials) writer.array(name);
    writer.value(static_cast<uint64_t>(reply.meshes.parts.size()));
    for (const FileMeshes::Part& part : reply.meshes.parts) {
        writer.array(part.name);
        writer.value(part.material);
        writer.array(part.surface.positions);
        writer.array(part.surface.indices);
    }
    writer.value(static_cast<uint64_t>(reply.meshes.placings.size()));
    for (const FileMeshes::Placing& placing : reply.meshes.placings) {
        writer.array(placing.name);
        writer.value(placing.part);
        writer.value(placing.world_from_part);
    }
    return writer.finish();
}

MeshReply parseReply(std::span<const std::byte> bytes) {
    Reader reader(bytes);
    MeshReply reply;
    reader.expectMark();
    reader.array(reply.refusal);
    for (size_t left = reader.count(); left > 0; --left) reader.array(reply.meshes.materials.emplace_back());
    for (size_t left = reader.count(); left > 0; --left) {
        FileMeshes::Part& part = reply.meshes.parts.emplace_back();
        reader.array(part.name);
        part.material = reader.value<uint32_t>();
        reader.array(part.surface.positions);
        reader.array(part.surface.indices);
    }
    for (size_t left = reader.count(); left > 0; --left) {
        FileMeshes::Placing& placing = reply.meshes.placings.emplace_back();
        reader.array(placing.name);
        placing.part = reader.value<uint32_t>();
        placing.world_from_part = reader.value<glm::dmat4>();
    }
    reader.expectEnd();
    check(reply.meshes);
    return reply;
}

}  // namespace insonify::meshes
