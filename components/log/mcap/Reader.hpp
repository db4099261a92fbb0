#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "components/log/MessageDecoder.hpp"
#include "components/log/Reader.hpp"
#include "components/log/mcap/ChunkWriter.hpp"
#include "components/log/mcap/Contents.hpp"

namespace insonify::log::mcap {

/** Reliable, volatile, the last ten. Channels and metadata.yaml have this text; where the two differ, readers may find
 *  no message. */
extern const std::string qos_profile;

/** The file metadata.yaml, with which `ros2 bag` reads a folder's MCAP files as one bag. */
class Bag {
public:
    /** Throws ConfigError when the folder of the bag's first file has the metadata.yaml of another bag.
     *  @param is_written false: this class writes nothing */
    explicit Bag(const std::filesystem::path& first_file, bool is_written = true);

    void add(const FileSummary& finished) { finished_.push_back(finished); }
    /** Writes metadata.yaml, with the present state of the open file. Throws std::runtime_error with the system's
     *  reason. */
    void write(const ChunkWriter& present) const;

private:
    std::string text(const ChunkWriter& present) const;

    std::filesystem::path path_;
    bool is_written_;
    std::vector<FileSummary> finished_;
};

/** Whether a text of a channel's metadata belongs to its stream, rather than describing how its messages are
 *  written. */
bool isOfStream(const Texts& channel, const std::string& key);

/** Reads an MCAP file. Messages of known types in CDR are samples. Other channels are streams of an unknown type,
 *  except those written by Transforms, which are omitted. Streams have their written names; else topic /a/b is stream
 *  a.b. Images of other programs are read with the default settings of this program. */
class Reader final : public log::Reader {
public:
    /** Throws ConfigError when the file cannot be read or is not an MCAP file.
     *  @param foreign axes of the poses of other programs; ENU in ROS (REP 103) */
    explicit Reader(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop,
                    types::WorldFrame foreign = types::WorldFrame::Enu);

    uint64_t bytes() const override { return file_.size(); }
    std::span<const char> toBytes(const SampleRef& at) override;

    const std::string& layout(size_t stream) const override;
    /** The schema of a stream's messages; null: it has none. */
    const Schema* schema(size_t stream) const;
    const Channel& channel(size_t stream) const;
    const MessageRef& message(const SampleRef& at) const { return contents_.messages[at.number]; }
    /** Whether the file has topics that follow from its streams: /tf and others, which are not streams. */
    bool hasTransforms() const { return has_transforms_; }

private:
    void decode(const SampleRef& at, types::SampleRoom room) override;
    /** @param place index of the channel among all of the file */
    void addStream(const Channel& channel, size_t place, types::WorldFrame foreign);

    File file_;
    Contents contents_;
    bool has_transforms_ = false;
    std::vector<uint16_t> channels_;                         ///< Number of each stream's channel.
    std::vector<std::unique_ptr<MessageDecoder>> decoders_;  ///< One per stream; null: unknown type.
    std::vector<char> bytes_;
};

}  // namespace insonify::log::mcap
