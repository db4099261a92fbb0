#pragma once
// Which message each sample of a log becomes, and back.
#include "components/mcap/Config.hpp"
#include "components/pocolog/SampleTypes.hpp"
#include "components/ros/FromSonar.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Pictures.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Times.hpp"
#include "components/ros/ToSonar.hpp"

namespace insonify::mcap {

/** Messages that hold a number, a truth value or a text as it is. */
template <class T>
struct Plain;
template <>
struct Plain<double> {
    using Message = ros::Float64;
};
template <>
struct Plain<float> {
    using Message = ros::Float32;
};
template <>
struct Plain<int32_t> {
    using Message = ros::Int32;
};
template <>
struct Plain<int64_t> {
    using Message = ros::Int64;
};
template <>
struct Plain<bool> {
    using Message = ros::Bool;
};
template <>
struct Plain<std::string> {
    using Message = ros::String;
};

/** The message of a sample, what it is read back as, and both ways between them. */
template <class T>
struct Conversion {
    using Message = typename Plain<T>::Message;
    using Sample = T;
    static void toMessage(const T& sample, const McapConfig&, Message& message) { message.data = sample; }
    static void toSample(const Message& message, const McapConfig&, T& sample) { sample = message.data; }
};

template <>
struct Conversion<types::Angle> {
    using Message = ros::Float64;
    using Sample = types::Angle;
    static void toMessage(types::Angle sample, const McapConfig&, Message& message) { message.data = sample.rad; }
    static void toSample(const Message& message, const McapConfig&, types::Angle& sample) { sample = {message.data}; }
};

template <>
struct Conversion<types::Time> {
    using Message = ros::Time;
    using Sample = types::Time;
    static void toMessage(types::Time sample, const McapConfig&, Message& message) { message = ros::toRos(sample); }
    static void toSample(const Message& message, const McapConfig&, types::Time& sample) {
        sample = ros::fromRos(message);
    }
};

template <>
struct Conversion<types::Sonar> {
    using Message = ros::ProjectedSonarImage;
    using Sample = types::Sonar;
    static void toMessage(const types::Sonar& sample, const McapConfig& config, Message& message) {
        ros::convert(sample, config, message);
    }
    static void toSample(const Message& message, const McapConfig& config, types::Sonar& sample) {
        ros::convert(message, {config.order, config.frame}, sample);
    }
};

/** Rock's older sonar samples come back as pings. */
template <class T>
requires pocolog::OneOf<T, types::SonarBeam, types::SonarScan>
struct Conversion<T> : Conversion<types::Sonar> {
    static void toMessage(const T& sample, const McapConfig& config, Message& message) {
        ros::convert(types::toSonar(sample), config, message);
    }
};

template <>
struct Conversion<types::Pose> {
    using Message = ros::Odometry;
    using Sample = types::Pose;
    static void toMessage(const types::Pose& sample, const McapConfig& config, Message& message) {
        ros::convert(sample, config.world_frame, message);
    }
    static void toSample(const Message& message, const McapConfig& config, types::Pose& sample) {
        ros::convert(message, config.world_frame, sample);
    }
};

/** Only read: what others log. */
struct StampedPoseConversion {
    using Message = ros::PoseStamped;
    using Sample = types::Pose;
    static void toSample(const Message& message, const McapConfig& config, types::Pose& sample) {
        ros::convert(message, config.world_frame, sample);
    }
};

template <>
struct Conversion<types::Image> {
    using Message = ros::Image;
    using Sample = types::Image;
    static void toMessage(const types::Image& sample, const McapConfig& config, Message& message) {
        ros::convert(sample, config.frame_id, message);
    }
    static void toSample(const Message& message, const McapConfig&, types::Image& sample) {
        ros::convert(message, sample);
    }
};

}  // namespace insonify::mcap
