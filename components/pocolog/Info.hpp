#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "components/pocolog/Reader.hpp"

namespace insonify::pocolog {

/** What `insonify log info` tells of a stream. */
struct StreamInfo {
    std::string name, type;
    size_t count = 0;    ///< [1]
    double first_s = 0;  ///< World time of the first sample; 0 without samples [s].
    double last_s = 0;   ///< [s]
    double rate_hz = 0;  ///< Mean rate between them; 0 where there is none [Hz].
};

struct LogInfo {
    uint64_t bytes = 0;     ///< Size of the file [B].
    bool complete = false;  ///< False: cut off or damaged, read up to there.
    std::vector<StreamInfo> streams;
};

LogInfo info(const Reader& log);

}  // namespace insonify::pocolog
