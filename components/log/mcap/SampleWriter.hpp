#pragma once
#include <map>
#include <optional>

#include "components/log/Writer.hpp"
#include "components/log/mcap/ChunkWriter.hpp"
#include "components/log/mcap/Reader.hpp"
#include "components/log/mcap/Transforms.hpp"
#include "components/ros/Samples.hpp"

namespace insonify::log::mcap {

/** Writes samples to an MCAP file as ROS 2 messages, with metadata.yaml next to it for `ros2 bag`.
 *
 *  Stream "task.port" is topic /task/port, unless `McapConfig::streams` names another topic. The metadata of the first
 *  stream are in a record named "insonify", different values of other streams in their channels' metadata. Log time is
 *  when a sample was received, publish time when it was true. /tf, /tf_static and /clock are derived from the samples,
 *  unless `McapConfig::transforms` is false. */
class SampleWriter final : public log::Writer {
public:
    /** Throws as createLog, and ConfigError when the folder has the metadata.yaml of another bag. */
    SampleWriter(std::filesystem::path path, const McapConfig& config);
    ~SampleWriter() override;

    /** Throws ConfigError for a topic that another stream has. */
    size_t add(size_t sample, const std::string& name, const Metadata& metadata) override;
    /** Throws std::runtime_error for a sample without a message: a compressed picture, a time after 2038. */
    void put(size_t stream, types::Time received, types::Time time, types::SampleView sample) override;
    size_t addLike(const log::Reader& log, size_t stream, const Metadata& more = {}) override;
    void copy(size_t stream, log::Reader& log, const SampleRef& at) override;

    void flush() override;  ///< The first writes metadata.yaml as well.
    void sync() override;   ///< The first of a file writes metadata.yaml as well.
    void close() override;
    void next(std::filesystem::path path) override;

    bool isOpen() const override { return out_.isOpen(); }
    const std::filesystem::path& path() const override { return out_.path(); }
    uint64_t size() const override { return out_.size(); }
    uint64_t kept() const override { return out_.kept(); }

private:
    /** @param metadata of the stream */
    size_t declare(const Schema* schema, Channel channel, const Metadata& metadata);
    void writeMessage(size_t stream, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes);
    [[noreturn]] void fail(size_t stream, const std::string& why) const;

    /** How samples become the messages of one channel. */
    struct Options : ros::MessageOptions {
        std::optional<std::string> world_frame_id, child_frame_id;  ///< Instead of a sample's frames.
    };
    Options getOptions(const std::string& stream, const Metadata& metadata) const;
    std::string getTopic(const std::string& stream) const;
    void checkTopic(const std::string& stream) const;

    McapConfig config_;
    Bag bag_;
    ChunkWriter out_;
    Transforms transforms_;
    bool closed_ = false, described_ = false, description_synced_ = false;
    bool is_begun_ = true;            ///< Whether the present file could be opened.
    std::vector<uint16_t> channels_;  ///< For each stream.
    std::vector<Options> options_;    ///< For each stream.
    std::map<Schema, uint16_t> schemas_;
    Metadata metadata_;           ///< Metadata of the record that all streams share.
    ros::MessageTypes messages_;  ///< Reused for converting.
    std::vector<char> bytes_;
};

}  // namespace insonify::log::mcap
