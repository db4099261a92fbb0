#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include "components/log/mcap/Contents.hpp"

namespace insonify::log::mcap {
namespace {

constexpr uint64_t max_bytes = uint64_t{256} << 20;  // limit of a decompressed chunk, which is in memory [B]

/** Returns the number of bytes written; 0: damaged. */
size_t unzstd(std::span<const char> from, std::span<char> to) {
    const size_t size = ZSTD_decompress(to.data(), to.size(), from.data(), from.size());
    return ZSTD_isError(size) ? 0 : size;
}

size_t unlz4(std::span<const char> from, std::span<char> to) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return 0;
    size_t taken = 0, given = 0, left = 1;
    while (left != 0) {
        size_t out = to.size() - given, in = from.size() - taken;
        left = LZ4F_decompress(context, to.data() + given, &out, from.data() + taken, &in, nullptr);
        if (LZ4F_isError(left) || (in == 0 && out == 0)) break;
        taken += in;
        given += out;
    }
    LZ4F_freeDecompressionContext(context);
    return left == 0 ? given : 0;
}

}  // namespace

void RecordWriter::raw(std::string_view data) { bytes_.insert(bytes_.end(), data.begin(), data.end()); }

uint32_t checksum(std::span<const char> bytes, uint32_t before) {
    if (bytes.empty()) return before;  // zlib would restart
    return static_cast<uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::span<const char> getRecords(const ChunkInfo& chunk, std::span<const char> stored, std::vector<char>& room) {
    std::span<const char> records = stored;
    if (!chunk.compression.empty()) {
        if (chunk.compression != "lz4" && chunk.compression != "zstd")
            throw FormatError(chunk.start,
                              "a chunk is compressed by '" + chunk.compression + "'; lz4 and zstd are read");
        if (chunk.size > max_bytes)
            throw FormatError(chunk.start, "a compressed chunk of more than 256 MiB is not read");
        room.resize(chunk.size);
        const size_t size = chunk.compression == "lz4" ? unlz4(stored, room) : unzstd(stored, room);
        if (size != chunk.size)
            throw FormatError(chunk.records_at, "a chunk cannot be decompressed by " + chunk.compression);
        records = room;
    }
    if (records.size() != chunk.size)
        throw FormatError(chunk.start, "a chunk has " + std::to_string(records.size()) +
                                           " bytes of records, and its header has " + std::to_string(chunk.size));
    if (const uint32_t crc = checksum(records); chunk.crc != 0 && crc != chunk.crc)
        throw FormatError(chunk.records_at, "the checksum of a chunk is " + std::to_string(crc) + ", and must be " +
                                                std::to_string(chunk.crc));
    return records;
}

}  // namespace insonify::log::mcap
