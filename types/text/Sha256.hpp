#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace insonify::types {

/** The SHA-256 of bytes added in pieces (FIPS 180-4). */
class Sha256 {
public:
    void add(std::string_view bytes);
    /** Returns 64 hexadecimal digits, as sha256sum prints them. Nothing may be added afterwards. */
    std::string hex();

private:
    void addBlock(const unsigned char* block);

    std::array<uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                   0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> block_{};
    size_t filled_ = 0;    ///< Filled part of the block [B].
    uint64_t length_ = 0;  ///< So far [B].
};

std::string sha256(std::string_view bytes);
/** Throws std::runtime_error when the file cannot be read. */
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace insonify::types
