#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace insonify::log {

/** The first wrong byte of a file. */
struct Diagnostic {
    std::filesystem::path file;  ///< The log, or its index.
    uint64_t byte = 0;           ///< From the beginning of the file [B].
    std::string message;         ///< What the byte is, and what it may be.
};

/** The result of a strict reader. */
struct Verdict {
    size_t streams = 0, samples = 0;  ///< Before the wrong byte.
    size_t set_backs = 0;             ///< Steps back of streams' times by more than types::max_lateness.
    std::optional<Diagnostic>
        diagnostic;  ///< None: for a pocolog file without set_backs, both of Rock's readers accept it.
};

/** Reads a log strictly: a pocolog file as pocolog::check, an MCAP file with each record, checksum, index and message.
 *  Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

namespace pocolog {

/** Reads a log as strictly as Rock's strictest reader, and checks what Rock's readers skip as well: the prologue; order
 *  and sizes of blocks; declarations (numbers in order, unique names, a registry with the type, flat metadata); times
 *  in order except where the clock was set back; samples of known types to the last byte; and the index next to the
 * log, if there is one, except the modification time in it. Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

}  // namespace pocolog
}  // namespace insonify::log
