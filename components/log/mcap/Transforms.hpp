#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "components/log/Stream.hpp"
#include "components/log/mcap/ChunkWriter.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::log::mcap {

/** Text of a channel whose messages are derived from other channels. Reader omits these channels. */
inline constexpr const char* derived_key = "insonify_derived";
/** Text of a channel of pings: the frame in its messages. */
inline constexpr const char* frame_id_key = "insonify_frame_id";

/** Writes the topics with which RViz and Foxglove place the pings of a file in the world.
 *
 *  /tf has the poses of each Odometry channel. /tf_static has the mount of each channel of pings, relative to the body
 *  whose poses the sonar follows. The mount is metadatum `insonify_mount` of the stream; the stream of poses is
 *  `insonify_body`, else the first one. /clock has the newest stamp of both.
 *
 *  A frame has one parent: the first stream that places a frame keeps it. A pose of the sonar itself, whose child is
 *  the frame of pings, is turned to the axes of that frame. A topic that a stream of the file has is not written. */
class Transforms {
public:
    /** @param taken topics that streams have or will have */
    Transforms(ChunkWriter& out, std::set<std::string> taken) : out_(out), taken_(std::move(taken)) {}

    /** Follows a channel, if it has pings or poses. @param stream metadata of its stream */
    void follow(uint16_t channel, const Metadata& stream);
    /** Writes what is derived from a message, before the message itself. Times since 1970 [ns]. */
    void before(uint16_t channel, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes);
    /** Writes the mounts whose poses have not arrived, before a file ends. */
    void finish();
    /** Writes the mounts again in the next file. */
    void nextFile();

private:
    struct Pings {
        std::string frame, body;
        std::optional<types::Mount> mount;  ///< None: unknown, or written.
        ros::SensorFrame axes = ros::SensorFrame::ZForward;
        ros::WorldFrame world = ros::WorldFrame::Enu;
    };
    struct Poses {
        std::string name, child;  ///< Names of the stream and of the frame that it places; empty: unknown so far.
        std::optional<uint64_t> last_ns;
    };
    enum class AtEnd { Yes, No };

    void addPose(uint16_t channel, Poses& poses, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes);
    /** Turns the pose of a sonar to the axes of its pings. False: the frame is not that of pings. */
    bool turnToPings(ros::TransformStamped& placed) const;
    /** Returns the frame that carries a sonar; empty: unknown so far. */
    std::string getBody(const Pings& pings, AtEnd at_end) const;
    /** Writes the mounts whose bodies are known and whose frames have no parent. */
    void placeMounts(uint64_t log_ns, AtEnd at_end);
    void writeMounts(uint64_t log_ns);
    template <class Message>
    void write(const std::string& topic, uint64_t log_ns, uint64_t publish_ns, const Message& message);

    ChunkWriter& out_;
    std::set<std::string> taken_;
    std::map<std::string, uint16_t> schemas_, channels_;  ///< Numbers by message and by topic.
    std::map<uint16_t, Pings> pings_;                     ///< By channel.
    std::map<uint16_t, Poses> poses_;
    std::map<std::string, uint16_t> owners_;  ///< The channel that places a frame.
    ros::TFMessage mounts_;
    bool mounts_due_ = false;
    std::optional<uint64_t> first_ns_;  ///< Log time of the first message of the file.
    std::optional<uint64_t> clock_ns_;
    ros::Odometry odometry_;
    std::vector<char> bytes_;
};

}  // namespace insonify::log::mcap
