#pragma once
#include <string>
#include <variant>

#include "components/ros/Options.hpp"
#include "components/viewer/Foxglove.hpp"
#include "components/viewer/Frame.hpp"
#include "types/Image.hpp"
#include "types/Pose.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::viewer {

/** What can be shown. */
using AnySample = std::variant<types::SonarPtr, types::Pose, types::ImagePtr, types::SnapshotPtr>;
enum class SampleKind { Ping, Pose, Image, Snapshot };  ///< In the order of AnySample.

/** The channel of a source: "noise.noisy" is /noise/noisy. Pings are ProjectedSonarImage, pictures Image, poses and the
 *  sonar's pose in snapshots PoseStamped. */
FoxgloveChannel channelOf(const std::string& source, SampleKind kind);

/** Samples as ROS 2 messages. */
class Messages {
public:
    Messages(ros::SonarOptions options, ros::WorldFrame world) : options_(std::move(options)), world_(world) {}
    /** CDR. Throws std::invalid_argument and std::out_of_range for what ROS cannot hold. */
    Bytes encode(const AnySample& sample) const;

private:
    ros::SonarOptions options_;
    ros::WorldFrame world_;
};

/** Its stamp [ns]; 0 for one before the epoch. */
uint64_t nanosecondsOf(const AnySample& sample);

}  // namespace insonify::viewer
