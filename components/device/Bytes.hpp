#pragma once
// Bytes of the wire: numbers, little endian as the processors that this runs on, and addresses.
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
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

/** Writes a number behind the last byte. Not inlined, because g++ 12 then warns falsely of numbers in a row. */
template <class T>
[[gnu::noinline]] void append(Bytes& bytes, T value) {
    bytes.resize(bytes.size() + sizeof value);
    write(bytes, bytes.size() - sizeof value, value);
}

/** Reads numbers that the caller knows to be there, one after the other. */
class NumberReader {
public:
    explicit NumberReader(std::span<const uint8_t> bytes, size_t at = 0) : bytes_(bytes), at_(at) {}
    template <class... T>
    void operator()(T&... values) {
        ((values = read<T>(bytes_, std::exchange(at_, at_ + sizeof values))), ...);
    }

private:
    std::span<const uint8_t> bytes_;
    size_t at_;
};

/** Writes numbers behind the last byte, one after the other. */
struct NumberWriter {
    template <class... T>
    void operator()(const T&... values) {
        (append(bytes, values), ...);
    }
    Bytes bytes;
};

using Ipv4 = std::array<uint8_t, 4>;

/** Of "192.168.2.3"; none for anything else. */
inline std::optional<Ipv4> ipv4(std::string_view text) {
    Ipv4 bytes{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (size_t i = 0; i < bytes.size(); ++i) {
        const auto [next, error] = std::from_chars(at, end, bytes[i]);
        if (error != std::errc() || (i < 3 ? next == end || *next != '.' : next != end)) return std::nullopt;
        at = next + (i < 3 ? 1 : 0);
    }
    return bytes;
}

}  // namespace insonify::device
