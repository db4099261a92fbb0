#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace insonify::log {

/** The first byte of a file that is not as it must be. */
struct Diagnostic {
    std::filesystem::path file;  ///< The log, or its index.
    uint64_t byte = 0;           ///< From the beginning of the file [B].
    std::string message;         ///< What it is, and what it may be.
};

/** What a strict reader finds. */
struct Verdict {
    size_t streams = 0, samples = 0;       ///< Up to there.
    std::optional<Diagnostic> diagnostic;  ///< Nothing: of a pocolog file, that both of Rock's readers take it.
};

/** Reads a log strictly. Of a pocolog file, see pocolog::check; of an MCAP file each record, checksum, index and
 *  message. Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

namespace pocolog {

/** Reads a log as strictly as Rock's strictest reader, and what they pass over as well: prologue, order and sizes of
 *  blocks, declarations (numbers in order, names once, a registry that holds the type, flat metadata), times that do
 *  not run backwards, samples of known types to the last byte, and the index beside it, if there is one, but for the
 *  modification time in it. Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

}  // namespace pocolog
}  // namespace insonify::log
