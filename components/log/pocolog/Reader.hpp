#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/log/Reader.hpp"
#include "components/log/pocolog/BlockFile.hpp"

namespace insonify::log::pocolog {

/** Reads a pocolog v2 file, of Insonify or Rock. Streams of unknown types are listed. */
class Reader final : public log::Reader {
public:
    /** Throws ConfigError when the file cannot be read or is not a pocolog v2 file. */
    explicit Reader(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop);

    uint64_t bytes() const override { return file_.size(); }
    std::span<const char> bytesOf(const SampleRef& at) override;
    const std::string& layout(size_t stream) const override { return registries_[stream]; }
    /** Its metadata as written. */
    const std::string& yaml(size_t stream) const { return yamls_[stream]; }

private:
    struct Stored {
        uint32_t size;  ///< In the file [B].
        bool compressed;
    };

    void decode(const SampleRef& at, types::SampleRoom room) override;

    BlockFile file_;
    std::vector<std::string> registries_, yamls_;
    std::vector<Stored> stored_;  ///< One per sample.
    std::vector<char> buffer_, inflated_;
};

/** Returns the index in types::SampleTypes of the type with this name in typelib or Rock's C++; none: unknown. */
std::optional<size_t> sampleOf(const std::string& type);

/** Fills a sample from its bytes as typelib marshals them. Throws FormatError for invalid bytes. */
void decode(std::span<const char> bytes, types::SampleRoom room);

}  // namespace insonify::log::pocolog
