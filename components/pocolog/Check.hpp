#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace insonify::pocolog {

/** The first byte of a file that is not as it must be. */
struct Wrong {
    std::filesystem::path file;  ///< The log, or its index.
    uint64_t byte = 0;           ///< From the beginning of the file [B].
    std::string what;            ///< What it is, and what it may be.
};

/** What a strict reader finds. */
struct Verdict {
    size_t streams = 0, samples = 0;  ///< Up to there.
    std::optional<Wrong> wrong;       ///< Nothing: the log is one that both of Rock's readers take.
};

/** Reads a log as strictly as Rock's strictest reader, and what they pass over as well: prologue, order and sizes of
 *  blocks, declarations (numbers in order, names once, a registry that holds the type, flat metadata), times that do
 * not run backwards, samples of known types to the last byte, and the index beside it, if there is one, but for the
 *  modification time in it. Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

}  // namespace insonify::pocolog
