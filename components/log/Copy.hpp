#pragma once
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/log/Writer.hpp"

namespace insonify::log {

/** What of a log is wanted. */
struct Selection {
    std::set<std::string> streams{};  ///< Empty: all.
    types::Time from{std::numeric_limits<int64_t>::min()};
    types::Time until{std::numeric_limits<int64_t>::max()};  ///< World times, the second not included.
    size_t first = 0,
           last = std::numeric_limits<size_t>::max();  ///< Numbers within these streams, `last` not included.
};

/** How a copy is made. */
struct CopyOptions {
    AtDamage at_damage = AtDamage::Stop;
    Selection selection{};
    std::optional<McapConfig> anew{};  ///< All samples are written anew, into an MCAP file so; else byte for byte.
};

/** What came of a copy. */
struct Copied {
    size_t samples = 0;
    std::vector<std::string> lost;  ///< What could not be copied, a sentence each.
};

/** Writes the selected samples of a log, or of the files of one in order (x.0.log, x.1.log...), into a new log, with
 *  all that its streams declare, and its index. Within one format samples are copied byte for byte, compressed ones
 *  decompressed (Rock's C++ reader fails on them); into the other they are written anew. Those of known types are
 *  decoded to see that they are whole. What is damaged is told, and what stands behind it looked for or not; so are
 *  streams of a type that the other format cannot hold. Throws ConfigError for a file that is no log or without a
 *  stream, for streams that are nowhere, when one of the same name is of another type in another file, and when `to` is
 *  one of the files or cannot be created, std::runtime_error on a full disk. */
Copied copyLog(const std::vector<std::filesystem::path>& logs, const std::filesystem::path& to,
               const CopyOptions& options = {});

/** Copies the log of properties that belongs to a log, see propertyLogOf, into the folder of another one, which was cut
 *  from it, unless it is there. Gives what the user is to know; empty: nothing. */
std::string copyProperties(const std::filesystem::path& log, const std::filesystem::path& to);

}  // namespace insonify::log
