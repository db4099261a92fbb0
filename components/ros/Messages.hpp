#pragma once
// The list of all messages.
#include <tuple>
#include <type_traits>

#include "components/ros/GeometryMessages.hpp"
#include "components/ros/InsonifyMessages.hpp"
#include "components/ros/SensorMessages.hpp"
#include "components/ros/SonarMessages.hpp"
#include "components/ros/StdMessages.hpp"

namespace insonify::ros {

using MessageTypes =
    std::tuple<Bool, Int32, Int64, Float32, Float64, String, Time, Header, Clock, Vector3, Point, Quaternion, Pose,
               PoseStamped, PoseWithCovariance, Twist, TwistWithCovariance, Odometry, Transform, TransformStamped,
               TFMessage, Image, LaserScan, PointField, PointCloud2, Range, PingInfo, SonarImageData,
               ProjectedSonarImage, RawSonarImage, DetectionFlag, SonarRanges, SonarTruth, SonarReturns, SonarElements,
               SonarSettings, Imu, FluidPressure, Dvl>;

/** Calls `use(std::type_identity<T>{})` for each message. */
void forEachMessage(auto&& use) {
    [&]<class... T>(std::type_identity<std::tuple<T...>>) {
        (use(std::type_identity<T>{}), ...);
    }(std::type_identity<MessageTypes>{});
}

}  // namespace insonify::ros
