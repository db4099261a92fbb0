#pragma once
// The frame of a pocolog v2 file: a prologue, then blocks back to back. All integers are little endian.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/Stream.hpp"
#include "types/Time.hpp"

namespace insonify::log::pocolog {

inline constexpr std::string_view magic{"POCOSIM", 8};  ///< Including its terminating zero.
inline constexpr uint32_t format_version = 2;
inline constexpr uint32_t big_endian_flag = 1;

struct Prologue {
    std::array<char, 8> magic_bytes{};
    uint32_t version = format_version;
    uint32_t flags = 0;
};
static_assert(sizeof(Prologue) == 16);

enum class BlockType : uint8_t { Stream = 1, Data = 2, Control = 3 };

struct BlockHeader {
    BlockType type{};
    uint8_t padding = 0xff;
    uint16_t stream = 0;
    uint32_t size = 0;  ///< Without the header [B].
};
static_assert(sizeof(BlockHeader) == 8);

/** Precedes each sample; 21 bytes in the file, without C++'s padding at the end. */
struct DataHeader {
    uint32_t received_s = 0, received_us = 0;  ///< When it was logged.
    uint32_t time_s = 0, time_us = 0;          ///< When it was true in the world.
    uint32_t size = 0;                         ///< Size of the sample as stored in the file [B].
    uint8_t compressed = 0;                    ///< 1: a zlib stream.

    types::Time received() const { return joined(received_s, received_us); }
    types::Time time() const { return joined(time_s, time_us); }

private:
    static types::Time joined(uint32_t s, uint32_t us) { return {int64_t{s} * 1'000'000 + us}; }
};
inline constexpr size_t data_header_size = 21;

/** The last time that the format can store, in the year 2106. */
inline constexpr types::Time latest_time{int64_t{std::numeric_limits<uint32_t>::max()} * 1'000'000 + 999'999};

/** The declaration in a block, and the positions of its four texts in the file [B]. */
struct Declaration {
    std::string name, type, registry;
    std::string yaml;  ///< Metadata as written.
    uint64_t name_at = 0, type_at = 0, registry_at = 0, yaml_at = 0;
};

/** An open file, read block by block. */
class BlockFile : public InputFile {
public:
    using InputFile::InputFile;

    // Each throws FormatError if the expected structure is not there.
    BlockHeader header(uint64_t block) const;
    Declaration declaration(uint64_t block, const BlockHeader& header) const;
    DataHeader data(uint64_t block, const BlockHeader& header) const;
};

/** Decompresses a zlib stream; throws FormatError when it is damaged or grows beyond 4 GiB. */
void inflateTo(std::vector<char>& out, std::vector<char>& in);

}  // namespace insonify::log::pocolog
