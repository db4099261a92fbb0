#include "components/gazebo/Messages.hpp"

#include <fmt/format.h>
#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <stdexcept>
#include <vector>

namespace insonify::gazebo {
namespace {

void add(wire::Header& header, const char* key, const std::vector<std::string>& values) {
    wire::Header::Map& entry = *header.add_data();
    entry.set_key(key);
    for (const std::string& value : values) entry.add_value(value);
}

void fill(wire::Header& header, const Stamp& stamp) {
    constexpr int64_t per_second = 1'000'000;
    int64_t seconds = stamp.time.microseconds / per_second, rest = stamp.time.microseconds % per_second;
    if (rest < 0) --seconds, rest += per_second;
    header.mutable_stamp()->set_sec(seconds);
    header.mutable_stamp()->set_nsec(static_cast<int32_t>(rest * 1000));
    add(header, "frame_id", {stamp.frame_id});
}

/** The value of Gazebo's enum of pixels. */
uint32_t pixelFormat(const std::string& encoding) {
    if (encoding == "mono8") return 1;
    if (encoding == "mono16") return 2;
    if (encoding == "rgb8") return 3;
    if (encoding == "bgr8") return 8;
    throw std::invalid_argument("is a picture of " + encoding + ", which Gazebo's Image does not have");
}

/** The value of Gazebo's enum of fields, which begins with INT8 = 0; that of ROS with INT8 = 1. */
uint32_t fieldType(uint8_t datatype) {
    if (datatype < 1 || datatype > 8) throw std::invalid_argument("has a field of an unknown type");
    return datatype - 1u;
}

}  // namespace

std::string encode(const ros::Image& picture, const Stamp& stamp) {
    wire::Image message;
    fill(*message.mutable_header(), stamp);
    message.set_width(picture.width);
    message.set_height(picture.height);
    message.set_step(picture.step);
    message.set_pixel_format_type(pixelFormat(picture.encoding));
    message.mutable_data()->assign(picture.data.begin(), picture.data.end());
    return message.SerializeAsString();
}

std::string encode(const ros::LaserScan& scan, const Stamp& stamp) {
    wire::LaserScan message;
    fill(*message.mutable_header(), stamp);
    message.set_frame(stamp.frame_id);
    message.set_angle_min(scan.angle_min);
    message.set_angle_max(scan.angle_max);
    message.set_angle_step(scan.angle_increment);
    message.set_range_min(scan.range_min);
    message.set_range_max(scan.range_max);
    message.set_count(static_cast<uint32_t>(scan.ranges.size()));
    for (const float range : scan.ranges) message.add_ranges(range);
    for (const float intensity : scan.intensities) message.add_intensities(intensity);
    return message.SerializeAsString();
}

std::string encode(const ros::PointCloud2& cloud, const Stamp& stamp) {
    wire::PointCloudPacked message;
    fill(*message.mutable_header(), stamp);
    for (const ros::PointField& field : cloud.fields) {
        wire::PointCloudPacked::Field& written = *message.add_field();
        written.set_name(field.name);
        written.set_offset(field.offset);
        written.set_datatype(fieldType(field.datatype));
        written.set_count(field.count);
    }
    message.set_height(cloud.height);
    message.set_width(cloud.width);
    message.set_is_bigendian(cloud.is_bigendian);
    message.set_point_step(cloud.point_step);
    message.set_row_step(cloud.row_step);
    message.mutable_data()->assign(cloud.data.begin(), cloud.data.end());
    message.set_is_dense(cloud.is_dense);
    return message.SerializeAsString();
}

std::string encode(const types::Sonar& ping, const Stamp& stamp) {
    if (const char* wrong = ping.diagnostic()) throw std::invalid_argument(wrong);
    wire::FloatV message;
    fill(*message.mutable_header(), stamp);
    wire::Header& header = *message.mutable_header();
    add(header, "beam_count", {std::to_string(ping.beam_count)});
    add(header, "bin_count", {std::to_string(ping.bin_count)});
    add(header, "bin_width", {fmt::format("{}", ping.binWidth())});
    add(header, "speed_of_sound", {fmt::format("{}", ping.speed_of_sound)});
    std::vector<std::string> bearings;
    for (const types::Angle& bearing : ping.bearings) bearings.push_back(fmt::format("{}", bearing.rad));
    add(header, "bearings", bearings);
    message.mutable_data()->Add(ping.bins.begin(), ping.bins.end());
    return message.SerializeAsString();
}

}  // namespace insonify::gazebo
