#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace insonify::device {

using Bytes = std::vector<uint8_t>;

// Numbers as they lie on the wire: little endian, as on the processors that this runs on.

/** The number at byte `at`; the caller has seen to it that it is there. */
template <class T>
T read(std::span<const uint8_t> bytes, size_t at) {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** Puts a number where there is room for it. */
template <class T>
void write(Bytes& bytes, size_t at, T value) {
    static_assert(std::is_arithmetic_v<T>);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
void append(Bytes& bytes, T value) {
    bytes.resize(bytes.size() + sizeof value);
    write(bytes, bytes.size() - sizeof value, value);
}

}  // namespace insonify::device
