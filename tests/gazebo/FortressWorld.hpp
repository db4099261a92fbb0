#pragma once
// A replacement of Gazebo Fortress: publishers and services of its own transport.
#include <ignition/msgs/empty.pb.h>
#include <ignition/msgs/odometry.pb.h>
#include <ignition/msgs/pose_v.pb.h>
#include <ignition/msgs/scene.pb.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <ignition/transport/Node.hh>
#include <string>

#include "tests/gazebo/Partition.hpp"

namespace insonify::gazebo {

inline void setStamp(ignition::msgs::Header& header, double seconds) {
    const auto whole = static_cast<int64_t>(seconds);
    header.mutable_stamp()->set_sec(whole);
    header.mutable_stamp()->set_nsec(static_cast<int32_t>((seconds - static_cast<double>(whole)) * 1e9));
}

inline void setPose(ignition::msgs::Pose& pose, const std::string& name, double x, double y, double z, double yaw) {
    pose.set_name(name);
    pose.mutable_position()->set_x(x);
    pose.mutable_position()->set_y(y);
    pose.mutable_position()->set_z(z);
    pose.mutable_orientation()->set_w(std::cos(yaw / 2));
    pose.mutable_orientation()->set_z(std::sin(yaw / 2));
}

/** A world's poses, as Gazebo's scene broadcaster sends them: models and, within them, their links. */
class FortressWorld {
public:
    explicit FortressWorld(const std::string& topic = "/world/sea/pose/info")
        : poses_(node_.Advertise<ignition::msgs::Pose_V>(topic)),
          odometry_(node_.Advertise<ignition::msgs::Odometry>("/model/rov/odometry")) {
        static const int registered = on_exit(end, nullptr);
        static_cast<void>(registered);
    }
    /** Publishes red at x along the world's x axis, and blue 12 m beyond red. */
    void publish(double seconds, double x) {
        ignition::msgs::Pose_V message;
        setStamp(*message.mutable_header(), seconds);
        setPose(*message.add_pose(), "sea_floor", 0, 0, -9, 0);
        setPose(*message.add_pose(), "red", x, 2, -5, 0.5);
        setPose(*message.add_pose(), "link", 0, 0, 0, 0);
        setPose(*message.add_pose(), "blue", x + 12, 4, -5, 0);
        setPose(*message.add_pose(), "link", 0.1, 0, 0, 0);
        send(message);
    }
    void send(const ignition::msgs::Pose_V& message) { poses_.Publish(message); }
    void send(const ignition::msgs::Odometry& message) { odometry_.Publish(message); }

    /** Answers the service of a world's models. */
    bool serve(const std::string& service, std::function<bool(ignition::msgs::Scene&)> fill) {
        return node_.Advertise(service, fill);
    }

private:
    /** Ends the process before the destructors of Fortress's libraries: its threads of discovery run until the end,
     *  and a message that arrives then would use what is destroyed. */
    static void end(int status, void*) {
        std::fflush(nullptr);
        std::_Exit(status);
    }

    ignition::transport::Node node_;
    ignition::transport::Node::Publisher poses_, odometry_;
};

}  // namespace insonify::gazebo
