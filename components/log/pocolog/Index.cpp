#include "components/log/pocolog/Index.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

namespace insonify::log::pocolog {
namespace {

constexpr std::string_view index_magic = "POCOSIM_INDEX";
constexpr uint32_t index_version = 3;
constexpr uint64_t stream_entry_size = 8 * sizeof(uint64_t);
constexpr uint64_t sample_entry_size = 2 * sizeof(uint64_t);

void putBigEndian(std::vector<char>& bytes, auto value) {
    for (size_t i = sizeof value; i-- > 0;) bytes.push_back(static_cast<char>(value >> (8 * i)));
}

void put(std::vector<char>& bytes, uint64_t value) { putBigEndian(bytes, value); }
void put(std::vector<char>& bytes, types::Time time) { put(bytes, static_cast<uint64_t>(time.microseconds)); }

/** Returns the earliest and latest time, 0 without samples. The earliest need not be the first sample's: the clock may
 *  have been set back, and offsets from it are not negative. */
std::pair<types::Time, types::Time> spanOf(const StreamIndex& stream) {
    if (stream.samples.empty()) return {};
    const auto [first, last] = std::ranges::minmax_element(stream.samples, {}, &StreamIndex::Entry::time);
    return {first->time, last->time};
}

void putStream(std::vector<char>& bytes, const StreamIndex& stream, uint64_t data_position) {
    put(bytes, stream.declaration);
    const auto [first, last] = spanOf(stream);
    put(bytes, data_position);
    put(bytes, first);
    put(bytes, stream.samples.size());
    put(bytes, stream.first_received);
    put(bytes, stream.last_received);
    put(bytes, first);
    put(bytes, last);
}

}  // namespace

std::filesystem::path indexPath(const std::filesystem::path& log) {
    return std::filesystem::path(log).replace_extension(".idx");
}

std::vector<char> indexBytes(const std::vector<StreamIndex>& streams, uint64_t log_size, types::Time log_modified) {
    std::vector<char> bytes(index_magic.begin(), index_magic.end());
    putBigEndian(bytes, index_version);
    put(bytes, log_size);
    put(bytes, log_modified);
    put(bytes, streams.size());
    uint64_t data_position = bytes.size() + streams.size() * stream_entry_size, size = data_position;
    for (const StreamIndex& stream : streams) size += stream.samples.size() * sample_entry_size;
    bytes.reserve(size);
    for (const StreamIndex& stream : streams) {
        putStream(bytes, stream, data_position);
        data_position += stream.samples.size() * sample_entry_size;
    }
    for (const StreamIndex& stream : streams) {
        const types::Time first = spanOf(stream).first;
        for (const StreamIndex::Entry& sample : stream.samples) {
            put(bytes, sample.position);
            put(bytes, sample.time - first);
        }
    }
    return bytes;
}

void writeIndex(const std::filesystem::path& log, const std::vector<StreamIndex>& streams) {
    struct stat status {};
    if (stat(log.c_str(), &status) != 0) return;
    const types::Time modified{int64_t{status.st_mtim.tv_sec} * 1'000'000 + status.st_mtim.tv_nsec / 1000};
    const std::vector<char> bytes = indexBytes(streams, static_cast<uint64_t>(status.st_size), modified);
    std::ofstream file(indexPath(log), std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) std::filesystem::remove(indexPath(log));
}

}  // namespace insonify::log::pocolog
