#pragma once
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/log/Writer.hpp"

namespace insonify::log {

/** The selected part of a log. */
struct Selection {
    std::set<std::string> streams{};  ///< Empty: all.
    types::Time from{std::numeric_limits<int64_t>::min()};
    types::Time until{std::numeric_limits<int64_t>::max()};  ///< World times, `until` is excluded.
    size_t first = 0,
           last = std::numeric_limits<size_t>::max();  ///< Numbers within these streams, `last` is excluded.
};

/** Options of a copy. */
struct CopyOptions {
    AtDamage at_damage = AtDamage::Stop;
    Selection selection{};
    bool needs_samples = false;        ///< Leaves the copy's name as it was if no sample is selected.
    std::optional<McapConfig> anew{};  ///< Writes all samples again as messages of an MCAP file; none: byte for byte.
};

/** The result of a copy. */
struct Copied {
    size_t samples = 0;
    std::vector<std::string> lost;  ///< Parts that could not be copied, one sentence each.
};

/** Writes the selected samples of a log, or of its files in order (x.0.log, x.1.log...), to a new log with the
 *  declarations of its streams and an index. Within one format samples are copied byte for byte, but compressed samples
 *  are decompressed (Rock's C++ reader fails on them). For the other format samples are converted. Samples of known
 *  types are decoded to check that they are complete. Damaged parts are reported, and the samples behind them searched
 *  or not. Streams of a type that the other format cannot store are reported. Throws ConfigError for a file that is not
 *  a log or has no stream, for selected streams that do not exist, when streams of one name differ in type between
 *  files, and when `to` is one of the files or cannot be created. Throws std::runtime_error on a full disk. */
Copied copyLog(const std::vector<std::filesystem::path>& logs, const std::filesystem::path& to,
               const CopyOptions& options = {});

/** Copies the property log of a log, see propertyLog, to the folder of a log cut from it, unless it exists there.
 *  Returns a notice for the user; empty: none. */
std::string copyProperties(const std::filesystem::path& log, const std::filesystem::path& to);

}  // namespace insonify::log
