#pragma once
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"
#include "components/viewer/Foxglove.hpp"
#include "components/viewer/FoxgloveMessages.hpp"
#include "components/viewer/Frame.hpp"
#include "components/viewer/SceneUpdates.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::viewer {

/** Draws pings as sensor_msgs/Image, mono8: the fan as seen from above, ahead is up and port is left. A pixel shows the
 *  strongest of the echoes that it covers, as a level of components/ros/Pings.hpp; 0 is no echo, and outside the fan.
 *
 *  A table maps pixels to bins until bearings, widths, bins or range change. */
class FanPicture {
public:
    static constexpr uint32_t longest_side = 720;  ///< [px]

    /** Throws std::invalid_argument for a ping whose lists do not match its counts, and std::out_of_range for a time
     *  that ROS cannot represent. */
    void draw(const types::Sonar& ping, const ros::SonarOptions& options, ros::Image& message);

private:
    /** The bins of one beam that a pixel covers. */
    struct Covered {
        uint32_t first = 0, count = 0;  ///< Index into the bins of a ping; 0: none.
    };
    bool fits(const types::Sonar& ping) const;
    void build(const types::Sonar& ping);

    std::vector<types::Angle> bearings_;
    types::Angle beam_width_;
    uint32_t bin_count_ = 0;
    double bin_m_ = 0;
    uint32_t width_ = 0, height_ = 0;
    std::vector<Covered> table_;
};

/** Types that can be shown: snapshots and all samples. */
template <class Samples>
struct WithSnapshots;
template <class... Sample>
struct WithSnapshots<std::tuple<Sample...>> {
    using type = std::tuple<types::Snapshot, Sample...>;
};
using ShownTypes = WithSnapshots<types::SampleTypes>::type;
using AnySample = types::Variants<ShownTypes>::Carried;  ///< As passed on by ports.

/** Whether pages show a T; Foxglove shows all types. */
template <class T>
inline constexpr bool on_pages =
    std::is_same_v<T, types::Sonar> || std::is_same_v<T, types::Pose> || std::is_same_v<T, types::Snapshot>;

/** The message of a T for Foxglove: PoseStamped for poses, and for the sonar in snapshots; else the message of logs. */
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

/** A form of a sample for Foxglove; each has a separate channel. */
enum class Form {
    Message,     ///< See ShownMessage.
    Picture,     ///< A ping as sensor_msgs/Image: the fan, see FanPicture.
    Points,      ///< A ping as sensor_msgs/PointCloud2: every bin that is a return.
    Transforms,  ///< A pose, or the sonar's pose in a snapshot, as foxglove_msgs/FrameTransforms.
    Scene        ///< A snapshot as foxglove_msgs/SceneUpdate, see SceneUpdates.
};

/** A form that a source offers to Foxglove. */
struct FoxgloveForm {
    Form form;
    FoxgloveChannel channel;
};

/** Returns "/noise/noisy" for "noise.noisy". */
std::string getTopic(const std::string& source);

template <class Message>
FoxgloveChannel getChannel(const std::string& topic) {
    return {topic, ros::shortName(Message::type_name), ros::describeSchema<Message>()};
}

/** Whether T is a type of pings. */
template <class T>
inline constexpr bool is_ping =
    std::is_same_v<T, types::Sonar> || std::is_same_v<T, types::SonarBeam> || std::is_same_v<T, types::SonarScan>;

/** Returns the forms of a source of T: its message first, then those that built-in panels draw. */
template <class T>
std::vector<FoxgloveForm> getForms(const std::string& source) {
    const std::string topic = getTopic(source);
    std::vector<FoxgloveForm> forms{{Form::Message, getChannel<typename ShownMessage<T>::type>(topic)}};
    if constexpr (is_ping<T>) {
        forms.push_back({Form::Picture, getChannel<ros::Image>(topic + "/image")});
        forms.push_back({Form::Points, getChannel<ros::PointCloud2>(topic + "/points")});
    }
    if constexpr (std::is_same_v<T, types::Pose> || std::is_same_v<T, types::Snapshot>)
        forms.push_back({Form::Transforms, getChannel<foxglove::FrameTransforms>(topic + "/transforms")});
    if constexpr (std::is_same_v<T, types::Snapshot>)
        forms.push_back({Form::Scene, getChannel<foxglove::SceneUpdate>(topic + "/scene")});
    return forms;
}

/** Encodes the samples of one source as CDR messages. Not thread-safe. */
class Messages {
public:
    Messages(ros::SonarOptions options, ros::WorldFrame world, size_t max_triangles = 500'000);
    /** Encodes any form except Scene. Throws std::invalid_argument and std::out_of_range for values that ROS cannot
     *  represent. */
    Bytes encode(const AnySample& sample, Form form = Form::Message);
    SceneUpdates& scene() { return scene_; }

private:
    void append(const auto& sample, Form form, std::vector<char>& bytes);

    ros::MessageOptions options_;
    FanPicture picture_;
    SceneUpdates scene_;
};

/** Returns the sample's stamp; `otherwise` if it has none. */
types::Time getStamp(const AnySample& sample, types::Time otherwise);

}  // namespace insonify::viewer
