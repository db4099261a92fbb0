#pragma once
#include <memory>
#include <vector>

#include "components/log/Reader.hpp"
#include "components/log/mcap/Contents.hpp"

namespace insonify::log::mcap {

/** Whether a text of a channel's metadata is of its stream's, not of how its messages are written. */
bool isOfStream(const Texts& channel, const std::string& key);

/** Reads an MCAP file. Messages of known types in CDR are samples; other channels are streams of a type that is not
 *  known, except for those that Transforms wrote: these are omitted. Streams are named as they were written, or topic
 * /a/b is stream a.b; images and poses of others are taken as ours by default, poses as ENU (REP 103). */
class Reader final : public log::Reader {
public:
    /** Throws ConfigError when it cannot be read or is no MCAP file. */
    explicit Reader(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop);
    ~Reader() override;

    uint64_t bytes() const override { return file_.size(); }
    std::span<const char> bytesOf(const SampleRef& at) override;

    const std::string& layout(size_t stream) const override;
    /** How a stream's messages are declared; null: it has no schema. */
    const Schema* schema(size_t stream) const;
    const Channel& channel(size_t stream) const;
    const MessageRef& message(const SampleRef& at) const { return contents_.messages[at.number]; }
    /** Whether the file has topics that follow from its streams: /tf and others, which are no streams. */
    bool hasTransforms() const { return has_transforms_; }

private:
    class Decoder;
    template <class T, class Message>
    class TypedDecoder;

    void decode(const SampleRef& at, types::SampleRoom room) override;
    /** @param place of the channel among all of the file. */
    void addStream(const Channel& channel, size_t place);
    /** What a stream's messages are read as; null: not at all. */
    std::unique_ptr<Decoder> decoderFor(Stream& stream, const Channel& channel, const std::string& schema) const;

    File file_;
    Contents contents_;
    bool has_transforms_ = false;
    std::vector<uint16_t> channels_;                  ///< Number of each stream's channel.
    std::vector<std::unique_ptr<Decoder>> decoders_;  ///< Of each stream; null: its type is not known.
    std::vector<char> bytes_;
};

}  // namespace insonify::log::mcap
