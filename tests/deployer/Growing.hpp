#pragma once
// A log during its writing.
#include <filesystem>
#include <string>

#include "components/log/pocolog/Reader.hpp"

namespace insonify::deployer {

/** Returns the number of readable samples of a stream; 0 for a missing file. */
inline uint64_t flushedSamples(const std::filesystem::path& log, const std::string& stream) {
    constexpr uintmax_t prologue = 16;  // [B]
    std::error_code absent;
    const uintmax_t size = std::filesystem::file_size(log, absent);
    if (absent || size < prologue) return 0;
    const log::pocolog::Reader reader(log);
    const log::Stream* const found = reader.find(stream);
    return found ? found->count : 0;
}

}  // namespace insonify::deployer
