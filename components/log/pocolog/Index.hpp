#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <vector>

#include "types/Time.hpp"

namespace insonify::log::pocolog {

/** The places of one stream's samples in the file, as in Rock's `.idx`. */
struct StreamIndex {
    struct Entry {
        uint64_t position = 0;  ///< Position of the block's header in the file [B].
        types::Time time;
    };
    uint64_t declaration = 0;  ///< Position of the block that declares the stream [B].
    types::Time first_received{}, last_received{};
    std::deque<Entry> samples{};  ///< The only data that a writer keeps per sample; a deque grows without copying.
};

/** `x.0.log` -> `x.0.idx`. */
std::filesystem::path indexPath(const std::filesystem::path& log);

/** Returns the bytes of a `.idx` file, version 3, big endian, for a log of this size [B] and modification time. */
std::vector<char> indexBytes(const std::vector<StreamIndex>& streams, uint64_t log_size, types::Time log_modified);

/** Writes the index of a finished log next to it, so that Rock's tools need not scan it. It is only a cache; a failure
 *  is ignored. */
void writeIndex(const std::filesystem::path& log, const std::vector<StreamIndex>& streams);

}  // namespace insonify::log::pocolog
