#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/log/Reader.hpp"
#include "components/log/Stream.hpp"
#include "components/log/pocolog/BlockFile.hpp"
#include "types/Time.hpp"

namespace insonify::log::pocolog {

/** Returns the flat map of scalars that Rock's readers accept, as YAML: one `key: "value"` per line; line breaks and
 *  control characters escaped. */
std::string toYaml(const Metadata& metadata);

/** Returns the scalars of a YAML map; empty for other texts. */
Metadata metadataFromYaml(std::string_view yaml);

/** Returns where YAML stops being a flat map of scalars [byte]; none when it is one, or empty. */
std::optional<size_t> findNotFlat(std::string_view yaml);

/** The places of one stream's samples in the file, as in Rock's `.idx`. */
struct StreamIndex {
    struct Entry {
        uint64_t position = 0;  ///< Position of the block's header in the file [B].
        types::Time time;
    };
    uint64_t declaration = 0;  ///< Position of the block that declares the stream [B].
    types::Time first_received{}, last_received{};
    std::deque<Entry> samples{};  ///< The only data that a writer keeps per sample; a deque grows without copying.
};

/** `x.0.log` -> `x.0.idx`. */
std::filesystem::path indexPath(const std::filesystem::path& log);

/** Returns the bytes of a `.idx` file, version 3, big endian, for a log of this size [B] and modification time. */
std::vector<char> indexBytes(const std::vector<StreamIndex>& streams, uint64_t log_size, types::Time log_modified);

/** Writes the index of a finished log next to it, so that Rock's tools need not scan it. It is only a cache; a failure
 *  is ignored. */
void writeIndex(const std::filesystem::path& log, const std::vector<StreamIndex>& streams);

/** Reads a pocolog v2 file, of Insonify or Rock. Streams of unknown types are listed. */
class Reader final : public log::Reader {
public:
    /** Throws ConfigError when the file cannot be read or is not a pocolog v2 file. */
    explicit Reader(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop);

    uint64_t bytes() const override { return file_.size(); }
    std::span<const char> toBytes(const SampleRef& at) override;
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
std::optional<size_t> findSample(const std::string& type);

/** Fills a sample from its bytes as typelib marshals them. Throws FormatError for invalid bytes. */
void decode(std::span<const char> bytes, types::SampleRoom room);

}  // namespace insonify::log::pocolog
