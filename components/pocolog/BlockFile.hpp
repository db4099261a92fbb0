#pragma once
#include "components/pocolog/Block.hpp"
#include "components/pocolog/Reader.hpp"

namespace insonify::pocolog {

/** What is wrong in a file, and the first byte that is. */
struct Fault : std::runtime_error {
    Fault(uint64_t at, const std::string& what) : std::runtime_error(what), byte(at) {}
    uint64_t byte;
};

/** What a block declares, and where its four texts begin in the file. */
struct Declaration {
    Stream stream;
    std::string yaml;  ///< Metadata as written.
    uint64_t name_at = 0, type_at = 0, registry_at = 0, yaml_at = 0;
};

/** An open file, taken block by block. All positions are in bytes from its beginning. */
class BlockFile {
public:
    /** Throws ConfigError when it cannot be read or is no file. */
    explicit BlockFile(const std::filesystem::path& path);
    ~BlockFile();
    BlockFile(const BlockFile&) = delete;
    BlockFile& operator=(const BlockFile&) = delete;

    uint64_t size() const { return size_; }
    /** False at the end of the file or on an error of the system. */
    bool read(uint64_t position, void* to, size_t size) const;

    // Each throws Fault for what stands there instead.
    BlockHeader header(uint64_t block) const;
    Declaration declaration(uint64_t block, const BlockHeader& header) const;
    DataHeader data(uint64_t block, const BlockHeader& header) const;

private:
    int file_ = -1;
    uint64_t size_ = 0;
};

}  // namespace insonify::pocolog
