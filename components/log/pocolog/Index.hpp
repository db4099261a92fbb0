#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <vector>

#include "types/Time.hpp"

namespace insonify::log::pocolog {

/** Where the samples of one stream stand in the file, as Rock's `.idx` tells it. */
struct StreamIndex {
    struct Entry {
        uint64_t position = 0;  ///< Of the block's header in the file [B].
        types::Time time;
    };
    uint64_t declaration = 0;  ///< Position of the block that declares the stream [B].
    types::Time first_received{}, last_received{};
    std::deque<Entry> samples{};  ///< All that a writer keeps of each; a deque, which grows without a copy of itself.
};

/** `x.0.log` -> `x.0.idx`. */
std::filesystem::path indexPath(const std::filesystem::path& log);

/** The bytes of a `.idx` file, version 3, big endian, for a log of this size [B] and modification time. */
std::vector<char> indexBytes(const std::vector<StreamIndex>& streams, uint64_t log_size, types::Time log_modified);

/** Writes the index of a finished log beside it, so that Rock's tools need not scan it. It is only a cache: where it
 *  cannot be written there is none. */
void writeIndex(const std::filesystem::path& log, const std::vector<StreamIndex>& streams);

}  // namespace insonify::log::pocolog
