#include "components/device/sonar3d/Protobuf.hpp"

#include <bit>

namespace insonify::device {
namespace {

constexpr uint32_t varint_type = 0, fixed64_type = 1, bytes_type = 2, fixed32_type = 5;
constexpr int longest_varint = 10;  // [bytes]

size_t varintSize(uint64_t value) {
    size_t size = 1;
    while (value >>= 7) ++size;
    return size;
}

}  // namespace

void ProtobufWriter::varint(uint64_t value) {
    for (; value > 0x7F; value >>= 7) message_.push_back(static_cast<uint8_t>(value | 0x80));
    message_.push_back(static_cast<uint8_t>(value));
}

void ProtobufWriter::number(uint32_t field, uint64_t value) {
    if (value == 0) return;
    tag(field, varint_type);
    varint(value);
}

void ProtobufWriter::real(uint32_t field, float value) {
    if (value == 0) return;
    tag(field, fixed32_type);
    append(message_, value);
}

void ProtobufWriter::bytes(uint32_t field, std::span<const uint8_t> value) {
    tag(field, bytes_type);
    varint(value.size());
    message_.insert(message_.end(), value.begin(), value.end());
}

void ProtobufWriter::text(uint32_t field, std::string_view value) {
    bytes(field, {reinterpret_cast<const uint8_t*>(value.data()), value.size()});
}

void ProtobufWriter::packed(uint32_t field, std::span<const uint32_t> values) {
    size_t size = 0;
    for (const uint32_t value : values) size += varintSize(value);
    tag(field, bytes_type);
    varint(size);
    message_.reserve(message_.size() + size);
    for (const uint32_t value : values) varint(value);
}

float ProtobufField::real() const {
    return kind == Kind::Fixed32 ? std::bit_cast<float>(static_cast<uint32_t>(value)) : 0.0F;
}

std::string_view ProtobufField::text() const { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::optional<uint64_t> ProtobufReader::varint() {
    if (rest_.empty() || broken_) return std::nullopt;
    uint64_t value = 0;
    for (int i = 0; i < longest_varint && static_cast<size_t>(i) < rest_.size(); ++i) {
        value |= uint64_t{rest_[static_cast<size_t>(i)] & 0x7Fu} << 7 * i;
        if (rest_[static_cast<size_t>(i)] & 0x80) continue;
        rest_ = rest_.subspan(static_cast<size_t>(i) + 1);
        return value;
    }
    broken_ = true;
    return std::nullopt;
}

std::optional<std::span<const uint8_t>> ProtobufReader::take(uint64_t count) {
    if (count > rest_.size()) {
        broken_ = true;
        return std::nullopt;
    }
    const auto taken = rest_.first(static_cast<size_t>(count));
    rest_ = rest_.subspan(static_cast<size_t>(count));
    return taken;
}

std::optional<ProtobufField> ProtobufReader::next() {
    const auto tag = varint();
    if (!tag) return std::nullopt;
    ProtobufField field;
    field.number = static_cast<uint32_t>(*tag >> 3);
    return readPayload(field, static_cast<uint32_t>(*tag & 7));
}

std::optional<ProtobufField> ProtobufReader::readPayload(ProtobufField field, uint32_t wire_type) {
    using Kind = ProtobufField::Kind;
    if (wire_type == varint_type || wire_type == bytes_type) {
        const auto value = varint();
        broken_ = broken_ || !value;
        if (!value) return std::nullopt;
        field.value = *value;
        if (wire_type == varint_type) return field;
        const auto bytes = take(*value);
        if (!bytes) return std::nullopt;
        field.kind = Kind::Text;
        field.bytes = *bytes;
        return field;
    }
    if (wire_type != fixed32_type && wire_type != fixed64_type) {
        broken_ = true;
        return std::nullopt;
    }
    const bool wide = wire_type == fixed64_type;
    const auto bytes = take(wide ? 8 : 4);
    if (!bytes) return std::nullopt;
    field.kind = wide ? Kind::Fixed64 : Kind::Fixed32;
    field.value = wide ? read<uint64_t>(*bytes, 0) : read<uint32_t>(*bytes, 0);
    return field;
}

}  // namespace insonify::device
