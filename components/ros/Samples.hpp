#pragma once
// The messages of each type of sample, and conversions both ways. Used by MCAP files, DDS and the viewer's channels.
#include <string>
#include <tuple>
#include <type_traits>

#include "components/ros/Clouds.hpp"
#include "components/ros/InsonifyMessages.hpp"
#include "components/ros/MarineAcousticMessages.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Options.hpp"
#include "components/ros/Pings.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::ros {

/** Converts a picture to sensor_msgs/Image: grey of 8 or 16 bits, RGB, BGR. Throws std::invalid_argument for other
 *  modes, and for a picture without the pixels that it announces. */
void convert(const types::Image& picture, const std::string& frame_id, Image& message);

/** Converts back, for the same encodings. */
void convert(const Image& message, types::Image& picture);

// The list of all messages.
// ROS 2 messages of std_msgs that hold one value: see Messages.hpp.
struct Bool {
    static constexpr const char* type_name = "std_msgs/msg/Bool";
    bool data = false;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Int32 {
    static constexpr const char* type_name = "std_msgs/msg/Int32";
    int32_t data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Int64 {
    static constexpr const char* type_name = "std_msgs/msg/Int64";
    int64_t data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Float32 {
    static constexpr const char* type_name = "std_msgs/msg/Float32";
    float data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct Float64 {
    static constexpr const char* type_name = "std_msgs/msg/Float64";
    double data = 0;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

struct String {
    static constexpr const char* type_name = "std_msgs/msg/String";
    std::string data;

    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

using MessageTypes = std::tuple<Bool, Int32, Int64, Float32, Float64, String, Time, Header, Clock, Vector3, Point,
                                Quaternion, Pose, PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped, Twist,
                                TwistWithCovariance, Odometry, Transform, TransformStamped, TFMessage, Image, LaserScan,
                                PointField, PointCloud2, Range, PingInfo, SonarImageData, ProjectedSonarImage,
                                RawSonarImage, DetectionFlag, SonarRanges, SonarDetections, SonarTruth, SonarReturns,
                                SonarElements, SonarSettings, Imu, FluidPressure, NavSatStatus, NavSatFix, Dvl>;

/** Calls `use(std::type_identity<T>{})` for each message. */
void forEachMessage(auto&& use) {
    [&]<class... T>(std::type_identity<std::tuple<T...>>) {
        (use(std::type_identity<T>{}), ...);
    }(std::type_identity<MessageTypes>{});
}

/** `type`: the messages that a T can become; the first is used in logs. `read_as`: the type that this message is read
 *  back as. */
template <class T>
struct MessagesOf;
template <class T, class... Message>
struct Messages {
    using type = std::tuple<Message...>;
    using read_as = T;
};
template <>
struct MessagesOf<types::Sonar> : Messages<types::Sonar, ProjectedSonarImage, RawSonarImage, SonarRanges,
                                           SonarDetections, PointCloud2, LaserScan, Clock> {};
/** Rock's older sonar samples become the messages of pings. */
template <>
struct MessagesOf<types::SonarBeam> : MessagesOf<types::Sonar> {};
template <>
struct MessagesOf<types::SonarScan> : MessagesOf<types::Sonar> {};
template <>
struct MessagesOf<types::SonarTruth> : Messages<types::SonarTruth, SonarTruth, Clock> {};
template <>
struct MessagesOf<types::SonarReturns> : Messages<types::SonarReturns, SonarReturns, Clock> {};
template <>
struct MessagesOf<types::SonarElements> : Messages<types::SonarElements, SonarElements, Clock> {};
template <>
struct MessagesOf<types::SonarDetections> : Messages<types::SonarDetections, SonarDetections, Clock> {};
template <>
struct MessagesOf<types::SonarSettings> : Messages<types::SonarSettings, SonarSettings, Clock> {};
template <>
struct MessagesOf<types::Pose>
    : Messages<types::Pose, Odometry, PoseStamped, PoseWithCovarianceStamped, TFMessage, Clock> {};
template <>
struct MessagesOf<types::Image> : Messages<types::Image, Image, Clock> {};
template <>
struct MessagesOf<types::PointCloud> : Messages<types::PointCloud, PointCloud2, Clock> {};
template <>
struct MessagesOf<types::DepthMap> : Messages<types::DepthMap, PointCloud2, Clock> {};
template <>
struct MessagesOf<types::Range> : Messages<types::Range, Range, Clock> {};
template <>
struct MessagesOf<types::ImuSensors> : Messages<types::ImuSensors, Imu, Clock> {};
template <>
struct MessagesOf<types::Imu> : Messages<types::Imu, Imu, Clock> {};
template <>
struct MessagesOf<types::Dvl> : Messages<types::Dvl, Dvl, Clock> {};
template <>
struct MessagesOf<types::Pressure> : Messages<types::Pressure, FluidPressure, Clock> {};
template <>
struct MessagesOf<types::Fix> : Messages<types::Fix, NavSatFix, Clock> {};
template <>
struct MessagesOf<types::Time> : Messages<types::Time, Time> {};
template <>
struct MessagesOf<types::Angle> : Messages<types::Angle, Float64> {};
template <>
struct MessagesOf<double> : Messages<double, Float64> {};
template <>
struct MessagesOf<float> : Messages<float, Float32> {};
template <>
struct MessagesOf<int32_t> : Messages<int32_t, Int32> {};
template <>
struct MessagesOf<int64_t> : Messages<int64_t, Int64> {};
template <>
struct MessagesOf<bool> : Messages<bool, Bool> {};
template <>
struct MessagesOf<std::string> : Messages<std::string, String> {};

template <class T>
using LoggedMessage = std::tuple_element_t<0, typename MessagesOf<T>::type>;

/** Calls `use(std::type_identity<Message>{})` for each message that a T can become. */
template <class T, class Use>
void forEachMessageType(Use&& use) {
    [&]<class... Message>(std::type_identity<std::tuple<Message...>>) {
        (use(std::type_identity<Message>{}), ...);
    }(std::type_identity<typename MessagesOf<T>::type>{});
}

// Convert a sample to a message. Throw std::invalid_argument or std::out_of_range with a diagnostic if the message
// cannot represent the sample.

template <class Message>
auto toMessage(const types::Sonar& ping, const MessageOptions& options, Message& message)
    -> decltype(convert(ping, options, message)) {
    convert(ping, options, message);
}
template <class Beams, class Message>
requires(std::is_same_v<Beams, types::SonarBeam> || std::is_same_v<Beams, types::SonarScan>) &&
    requires(const types::Sonar& ping, const MessageOptions& options, Message& message) {
    convert(ping, options, message);
}
void toMessage(const Beams& beams, const MessageOptions& options, Message& message) {
    toMessage(toSonar(beams), options, message);
}
template <class Message>
auto toMessage(const types::Pose& pose, const MessageOptions& options, Message& message)
    -> decltype(convert(pose, options.world_frame, message)) {
    convert(pose, options.world_frame, message);
}
inline void toMessage(const types::Image& picture, const MessageOptions& options, Image& message) {
    convert(picture, options.frame_id, message);
}
inline void toMessage(const types::SonarTruth& truth, const MessageOptions& options, SonarTruth& message) {
    convert(truth, options.frame_id, message);
}
inline void toMessage(const types::SonarReturns& returns, const MessageOptions& options, SonarReturns& message) {
    convert(returns, options.frame_id, message);
}
inline void toMessage(const types::SonarElements& signals, const MessageOptions& options, SonarElements& message) {
    convert(signals, options.frame_id, message);
}
inline void toMessage(const types::SonarDetections& detections, const MessageOptions& options,
                      SonarDetections& message) {
    convert(detections, options, message);
}
inline void toMessage(const types::SonarSettings& settings, const MessageOptions& options, SonarSettings& message) {
    convert(settings, options.frame_id, message);
}
inline void toMessage(const types::PointCloud& cloud, const MessageOptions& options, PointCloud2& message) {
    convert(cloud, options.world_frame, message);
}
inline void toMessage(const types::DepthMap& map, const MessageOptions& options, PointCloud2& message) {
    convert(map, options.frame_id, message);
}
inline void toMessage(const types::Range& range, const MessageOptions& options, Range& message) {
    convert(range, options.frame_id, message);
}
inline void toMessage(const types::ImuSensors& sensors, const MessageOptions& options, Imu& message) {
    convert(sensors, options.world_frame, options.frame_id, message);
}
inline void toMessage(const types::Imu& imu, const MessageOptions& options, Imu& message) {
    convert(imu, options.world_frame, options.frame_id, message);
}
inline void toMessage(const types::Dvl& dvl, const MessageOptions& options, Dvl& message) {
    convert(dvl, options.frame_id, message);
}
inline void toMessage(const types::Pressure& pressure, const MessageOptions& options, FluidPressure& message) {
    convert(pressure, options.frame_id, message);
}
inline void toMessage(const types::Fix& fix, const MessageOptions& options, NavSatFix& message) {
    convert(fix, options.frame_id, message);
}
template <types::Stamped T>
void toMessage(const T& sample, const MessageOptions&, Clock& message) {
    message = toClock(sample.time);
}
inline void toMessage(types::Time time, const MessageOptions&, Time& message) { message = toRos(time); }
inline void toMessage(types::Angle angle, const MessageOptions&, Float64& message) { message.data = angle.rad; }
template <class T, class Message>
auto toMessage(const T& value, const MessageOptions&, Message& message)
    -> std::enable_if_t<std::is_same_v<T, decltype(message.data)>> {
    message.data = value;
}

// Convert back, for messages that represent all of the sample. Throw std::invalid_argument for a message that is not
// such a sample.

inline void toSample(const ProjectedSonarImage& message, const MessageOptions& options, types::Sonar& ping) {
    convert(message, {options.order, options.frame}, ping);
}
template <class Message>
auto toSample(const Message& message, const MessageOptions& options, types::Pose& pose)
    -> decltype(convert(message, options.world_frame, pose)) {
    convert(message, options.world_frame, pose);
}
inline void toSample(const SonarTruth& message, const MessageOptions&, types::SonarTruth& truth) {
    convert(message, truth);
}
inline void toSample(const SonarReturns& message, const MessageOptions&, types::SonarReturns& returns) {
    convert(message, returns);
}
inline void toSample(const SonarElements& message, const MessageOptions&, types::SonarElements& signals) {
    convert(message, signals);
}
inline void toSample(const SonarDetections& message, const MessageOptions&, types::SonarDetections& detections) {
    convert(message, detections);
}
inline void toSample(const SonarSettings& message, const MessageOptions&, types::SonarSettings& settings) {
    convert(message, settings);
}
inline void toSample(const Image& message, const MessageOptions&, types::Image& picture) { convert(message, picture); }
inline void toSample(const PointCloud2& message, const MessageOptions& options, types::PointCloud& cloud) {
    convert(message, options.world_frame, cloud);
}
inline void toSample(const PointCloud2& message, const MessageOptions&, types::DepthMap& map) { convert(message, map); }
inline void toSample(const Range& message, const MessageOptions&, types::Range& range) { convert(message, range); }
inline void toSample(const Imu& message, const MessageOptions& options, types::ImuSensors& sensors) {
    convert(message, options.world_frame, sensors);
}
inline void toSample(const Imu& message, const MessageOptions& options, types::Imu& imu) {
    convert(message, options.world_frame, imu);
}
inline void toSample(const Dvl& message, const MessageOptions&, types::Dvl& dvl) { convert(message, dvl); }
inline void toSample(const FluidPressure& message, const MessageOptions&, types::Pressure& pressure) {
    convert(message, pressure);
}
inline void toSample(const NavSatFix& message, const MessageOptions&, types::Fix& fix) { convert(message, fix); }
inline void toSample(const Time& message, const MessageOptions&, types::Time& time) { time = fromRos(message); }
inline void toSample(const Float64& message, const MessageOptions&, types::Angle& angle) { angle = {message.data}; }
template <class T, class Message>
auto toSample(const Message& message, const MessageOptions&, T& value)
    -> std::enable_if_t<std::is_same_v<T, std::remove_cvref_t<decltype(message.data)>>> {
    value = message.data;
}

/** Whether a T can be read from a message. */
template <class T, class Message>
concept ReadFrom = requires(const Message& message, const MessageOptions& options, T& sample) {
    toSample(message, options, sample);
};

/** Types that a message without a named type is never read as. It is read as a plain number, a plain cloud, or an IMU
 *  with an attitude. */
template <class T>
constexpr bool only_by_name =
    std::is_same_v<T, types::Angle> || std::is_same_v<T, types::DepthMap> || std::is_same_v<T, types::ImuSensors>;

}  // namespace insonify::ros
