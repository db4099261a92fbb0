#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace insonify::device {

static_assert(std::endian::native == std::endian::little, "wire formats here are little endian, as the processor is");

using Bytes = std::vector<uint8_t>;

/** The value at a place that the caller has found to be within the bytes. */
template <class T>
T read(std::span<const uint8_t> bytes, size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** Overwrites what stands at a place that the caller has found to be within the bytes. */
template <class T>
void write(Bytes& bytes, size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
void append(Bytes& bytes, T value) {
    bytes.resize(bytes.size() + sizeof value);
    write(bytes, bytes.size() - sizeof value, value);
}

}  // namespace insonify::device
