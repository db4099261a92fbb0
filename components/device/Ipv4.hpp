#pragma once
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace insonify::device {

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
