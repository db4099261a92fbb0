#pragma once
// Bytes on the wire: numbers, little endian like the supported processors, and addresses.
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

/** Returns the number at a place, which must be within the bytes. */
template <class T>
T read(std::span<const uint8_t> bytes, size_t at) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** Overwrites bytes with a number. */
template <class T>
void write(Bytes& bytes, size_t at, T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

/** Appends a number. Not inlined, because g++ 12 then warns falsely about consecutive numbers. */
[[gnu::noinline]] void append(Bytes& bytes, auto value) {
    bytes.resize(bytes.size() + sizeof value);
    write(bytes, bytes.size() - sizeof value, value);
}

/** Reads numbers one after the other; they must be within the bytes. */
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

/** Appends numbers one after the other. */
struct NumberWriter {
    template <class... T>
    void operator()(const T&... values) {
        (append(bytes, values), ...);
    }
    Bytes bytes;
};

using Ipv4 = std::array<uint8_t, 4>;

/** Returns the address in a text such as "192.168.2.3"; none for anything else. */
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
