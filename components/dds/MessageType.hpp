#pragma once
#include <string_view>
#include <type_traits>

#include "components/ros/Messages.hpp"

namespace insonify::dds {

/** What is sent. */
enum class MessageType {
    ProjectedSonarImage,
    RawSonarImage,
    SonarRanges,
    PointCloud2,
    LaserScan,
    Image,
    Odometry,
    PoseStamped,
    Clock
};

/** Calls `use(std::type_identity<Message>{})` for the message of that type. */
template <class Use>
decltype(auto) withMessage(MessageType type, Use&& use) {
    switch (type) {
        case MessageType::ProjectedSonarImage: return use(std::type_identity<ros::ProjectedSonarImage>{});
        case MessageType::RawSonarImage: return use(std::type_identity<ros::RawSonarImage>{});
        case MessageType::SonarRanges: return use(std::type_identity<ros::SonarRanges>{});
        case MessageType::PointCloud2: return use(std::type_identity<ros::PointCloud2>{});
        case MessageType::LaserScan: return use(std::type_identity<ros::LaserScan>{});
        case MessageType::Image: return use(std::type_identity<ros::Image>{});
        case MessageType::Odometry: return use(std::type_identity<ros::Odometry>{});
        case MessageType::PoseStamped: return use(std::type_identity<ros::PoseStamped>{});
        case MessageType::Clock: break;
    }
    return use(std::type_identity<ros::Clock>{});
}

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::MessageType> {
    static constexpr std::string_view names[] = {"marine_acoustic_msgs/ProjectedSonarImage",
                                                 "marine_acoustic_msgs/RawSonarImage",
                                                 "marine_acoustic_msgs/SonarRanges",
                                                 "sensor_msgs/PointCloud2",
                                                 "sensor_msgs/LaserScan",
                                                 "sensor_msgs/Image",
                                                 "nav_msgs/Odometry",
                                                 "geometry_msgs/PoseStamped",
                                                 "rosgraph_msgs/Clock"};
};
