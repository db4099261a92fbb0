#pragma once
// Bytes of the wire, little endian as the processors that this runs on.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace insonify::device {

using Bytes = std::vector<uint8_t>;

/** The number at a place that the caller knows to be there. */
template <class T>
T read(std::span<const uint8_t> bytes, size_t at) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** Writes a number over bytes that are there. */
template <class T>
void write(Bytes& bytes, size_t at, T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

/** Writes a number behind the last byte. */
template <class T>
void append(Bytes& bytes, T value) {
    bytes.resize(bytes.size() + sizeof value);
    write(bytes, bytes.size() - sizeof value, value);
}

}  // namespace insonify::device
