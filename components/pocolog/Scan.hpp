#pragma once
#include "components/pocolog/Reader.hpp"

namespace insonify::pocolog {

/** What one pass over the block headers of a file finds. */
struct Scan {
    uint64_t bytes = 0;  ///< Size of the file [B].
    std::string fault;   ///< Why and where the pass ended early; empty: it did not.
    std::vector<Stream> streams;
    std::vector<SampleRef> samples;
};

/** Reads exactly `size` bytes at `position`; false at the end of the file or on an error of the system. */
bool readAt(int file, uint64_t position, void* to, size_t size);

/** Passes over an open file. Throws ConfigError that names `path` when it is no pocolog v2 file. */
Scan scan(int file, const std::filesystem::path& path);

}  // namespace insonify::pocolog
