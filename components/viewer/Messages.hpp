#pragma once
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>

#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"
#include "components/viewer/Foxglove.hpp"
#include "components/viewer/Frame.hpp"
#include "types/Snapshot.hpp"

namespace insonify::viewer {

/** What can be shown: a snapshot or any sample. */
template <class Samples>
struct WithSnapshots;
template <class... Sample>
struct WithSnapshots<std::tuple<Sample...>> {
    using type = std::tuple<types::Snapshot, Sample...>;
};
using ShownTypes = WithSnapshots<types::SampleTypes>::type;
using AnySample = types::Variants<ShownTypes>::Carried;  ///< As it travels.

/** Whether pages show a T; Foxglove shows all. */
template <class T>
inline constexpr bool on_pages =
    std::is_same_v<T, types::Sonar> || std::is_same_v<T, types::Pose> || std::is_same_v<T, types::Snapshot>;

/** What Foxglove gets of a T: poses, and the sonar's in snapshots, as PoseStamped, others as in a log. */
template <class T>
struct ShownMessage {
    using type = ros::LoggedMessage<T>;
};
template <>
struct ShownMessage<types::Pose> {
    using type = ros::PoseStamped;
};
template <>
struct ShownMessage<types::Snapshot> {
    using type = ros::PoseStamped;
};

/** "/noise/noisy" of "noise.noisy". */
std::string topicOf(const std::string& source);

/** The channel of a source of T. */
template <class T>
FoxgloveChannel channelOf(const std::string& source) {
    using Message = typename ShownMessage<T>::type;
    return {topicOf(source), ros::shortName(Message::type_name), ros::schemaOf<Message>()};
}

/** Samples as ROS 2 messages. */
class Messages {
public:
    Messages(ros::SonarOptions options, ros::WorldFrame world);
    /** CDR. Throws std::invalid_argument and std::out_of_range for what ROS cannot hold. */
    Bytes encode(const AnySample& sample) const;

private:
    ros::MessageOptions options_;
};

/** Its stamp; of one that bears none, `otherwise`. */
types::Time stampOf(const AnySample& sample, types::Time otherwise);

}  // namespace insonify::viewer
