#pragma once
#include "components/pocolog/BlockFile.hpp"

namespace insonify::pocolog {

/** What one pass over the block headers of a file finds. */
struct Scan {
    std::vector<Stream> streams;
    std::vector<SampleRef> samples;
    std::vector<Gap> gaps;  ///< What is no log, in file order.
};

/** Passes over a file. Throws ConfigError that names `path` when it is no pocolog v2 file. */
Scan scan(const BlockFile& file, const std::filesystem::path& path, AtDamage at_damage);

}  // namespace insonify::pocolog
