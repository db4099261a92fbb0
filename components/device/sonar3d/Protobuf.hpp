#pragma once
// The wire format of Protocol Buffers, as far as devices here use it.
#include <optional>
#include <string_view>

#include "components/device/wire/Bytes.hpp"

namespace insonify::device {

/** Appends the fields of a message. Numbers that are 0 are omitted, as in proto3. */
class ProtobufWriter {
public:
    void number(uint32_t field, uint64_t value);
    void real(uint32_t field, float value);
    void bytes(uint32_t field, std::span<const uint8_t> value);
    void text(uint32_t field, std::string_view value);
    void packed(uint32_t field, std::span<const uint32_t> values);
    const Bytes& message() const { return message_; }

private:
    void varint(uint64_t value);
    void tag(uint32_t field, uint32_t wire_type) { varint(uint64_t{field} << 3 | wire_type); }

    Bytes message_;
};

/** One field: a number, or bytes. */
struct ProtobufField {
    enum class Kind { Number, Fixed32, Fixed64, Text };

    uint32_t number = 0;
    Kind kind = Kind::Number;
    uint64_t value = 0;              ///< A number, or the bits of a fixed-width value.
    std::span<const uint8_t> bytes;  ///< Content: text, bytes, a message or packed numbers.

    /** Returns the value of a float; 0 for other fields. */
    float real() const;
    std::string_view text() const;
};

/** Reads the fields of a message one after the other. */
class ProtobufReader {
public:
    explicit ProtobufReader(std::span<const uint8_t> message) : rest_(message) {}
    /** None at the end of the message, and where it is broken. */
    std::optional<ProtobufField> next();
    /** Reads a packed number; none at their end, and where they are broken. */
    std::optional<uint64_t> varint();
    bool isBroken() const { return broken_; }

private:
    /** Reads `count` bytes, if they are present. */
    std::optional<std::span<const uint8_t>> take(uint64_t count);
    std::optional<ProtobufField> readPayload(ProtobufField field, uint32_t wire_type);

    std::span<const uint8_t> rest_;
    bool broken_ = false;
};

}  // namespace insonify::device
