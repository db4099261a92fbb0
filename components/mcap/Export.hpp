#pragma once
#include "components/mcap/Config.hpp"
#include "components/pocolog/Reader.hpp"

namespace insonify::mcap {

/** Writes one stream of a log, or with an empty name all of known types, into an MCAP file and metadata.yaml beside it.
 *  Gives the number of messages. Throws ConfigError for a stream that is not there or cannot be told as messages, and
 *  as SampleWriter. */
size_t exportLog(pocolog::Reader& log, const std::string& stream, const std::filesystem::path& to,
                 const McapConfig& config);

}  // namespace insonify::mcap
