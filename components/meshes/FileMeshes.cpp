#include "components/meshes/FileMeshes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace insonify::meshes {

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
