#pragma once
#include <limits>
#include <set>
#include <string>

#include "components/pocolog/Reader.hpp"

namespace insonify::pocolog {

/** What of a log is wanted. */
struct Selection {
    std::set<std::string> streams{};  ///< Empty: all.
    types::Time from{std::numeric_limits<int64_t>::min()};
    types::Time until{std::numeric_limits<int64_t>::max()};  ///< World times, the second not included.
    size_t first = 0,
           last = std::numeric_limits<size_t>::max();  ///< Numbers within these streams, `last` not included.
};

/** What came of a copy. */
struct Copied {
    size_t samples = 0;
    std::vector<std::string> lost;  ///< What could not be copied, a sentence each.
};

/** Writes the selected samples of a log, or of the files of one in order (x.0.log, x.1.log...), into a new log, with
 * all that its streams declare, and its index. Samples are copied byte for byte, compressed ones decompressed (Rock's
 * C++ reader fails on them); those of known types are decoded to see that they are whole. What is damaged is told, and
 * what stands behind it looked for or not. Throws ConfigError for a file that is no log or without a stream, for
 * streams that are nowhere, when one of the same name is of another type in another file, and when `to` is one of the
 * files or cannot be created, std::runtime_error on a full disk.
 */
Copied copy(const std::vector<std::filesystem::path>& logs, AtDamage at_damage, const Selection& selection,
            const std::filesystem::path& to);

}  // namespace insonify::pocolog
