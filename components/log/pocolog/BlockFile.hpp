#pragma once
#include <string>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/Stream.hpp"
#include "components/log/pocolog/Block.hpp"

namespace insonify::log::pocolog {

/** What a block declares, and where its four texts begin in the file [B]. */
struct Declaration {
    std::string name, type, registry;
    std::string yaml;  ///< Metadata as written.
    uint64_t name_at = 0, type_at = 0, registry_at = 0, yaml_at = 0;
};

/** An open file, taken block by block. */
class BlockFile : public InputFile {
public:
    using InputFile::InputFile;

    // Each throws FormatError for what stands there instead.
    BlockHeader header(uint64_t block) const;
    Declaration declaration(uint64_t block, const BlockHeader& header) const;
    DataHeader data(uint64_t block, const BlockHeader& header) const;
};

/** Decompresses a zlib stream; throws FormatError when it is damaged or grows beyond 4 GiB. */
void inflateTo(std::vector<char>& out, std::vector<char>& in);

}  // namespace insonify::log::pocolog
