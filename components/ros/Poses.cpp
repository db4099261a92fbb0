#include "components/ros/Poses.hpp"

#include <cmath>
#include <glm/matrix.hpp>
#include <numbers>

#include "components/ros/Stamps.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::ros {
namespace {

using Covariance3 = std::array<double, 9>;

Vector3 toVector(glm::dvec3 v) { return {v.x, v.y, v.z}; }
glm::dvec3 fromRos(const Vector3& v) { return {v.x, v.y, v.z}; }

/** Returns the covariance by rows. The first element is -1 if the value itself is unknown. */
Covariance3 getRows(const glm::dmat3& covariance, bool value_known, double unknown) {
    Covariance3 rows;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            rows[static_cast<size_t>(3 * row + column)] = isUnknown(covariance) ? unknown : covariance[column][row];
    if (!value_known) rows[0] = -1;
    return rows;
}

glm::dmat3 toMatrix(const Covariance3& rows, double unknown) {
    glm::dmat3 matrix{0};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) matrix[column][row] = rows[static_cast<size_t>(3 * row + column)];
    Covariance3 none;
    none.fill(unknown);
    return rows[0] == -1 || rows == none ? types::Pose::unknownMatrix() : matrix;
}

/** Writes a vector of the body, and its covariance. */
void report(glm::dvec3 value, const glm::dmat3& covariance, WorldFrame frame, Vector3& reported, Covariance3& rows) {
    const auto body = [frame](glm::dvec3 v) { return types::Axes{frame}.body(v); };
    reported = isUnknown(value) ? Vector3{} : toVector(body(value));
    rows = getRows(both(covariance, body), !isUnknown(value), 0);
}

void read(const Vector3& reported, const Covariance3& rows, WorldFrame frame, glm::dvec3& value,
          glm::dmat3& covariance) {
    const auto body = [frame](glm::dvec3 v) { return types::Axes{frame}.body(v); };
    value = rows[0] == -1 ? glm::dvec3(types::Pose::unknown) : body(fromRos(reported));
    covariance = both(toMatrix(rows, 0), body);
}

/** Converts from axes with z up to an instrument's axes, whose z is its look direction, and back. */
glm::dvec3 turnedOver(glm::dvec3 v) { return {v.x, -v.y, -v.z}; }

void writeBeam(const types::Dvl& dvl, size_t beam, Dvl& message) {
    const double range = dvl.beam_ranges[beam], variance = dvl.beam_velocity_variances[beam];
    message.beam_unit_vec[beam] = toVector(turnedOver(dvl.beam_directions[beam]));
    message.range[beam] = range;
    message.beam_quality[beam] = std::isfinite(range) ? 1.0f : 0.0f;
    message.beam_velocity[beam] = static_cast<float>(dvl.beam_velocities[beam]);
    message.beam_velocity_covar[beam] = std::isnan(variance) ? -1.0f : static_cast<float>(variance);
}

void clearBeams(Dvl& message) {
    message.beam_unit_vec.fill({});
    message.range.fill(types::Pose::unknown);
    message.range_covar.fill(-1);
    message.beam_quality.fill(0);
    message.beam_velocity.fill(std::numeric_limits<float>::quiet_NaN());
    message.beam_velocity_covar.fill(-1);
}

using types::Axes;

template <class Xyz>
Xyz known(glm::dvec3 v) {
    if (isUnknown(v)) return {0, 0, 0};
    return {v.x, v.y, v.z};
}

/** Sets block 0 or 1 of the diagonal. */
void setBlock(size_t block, bool value_known, const glm::dmat3& covariance, Covariance& all) {
    for (size_t row = 0; row < 3; ++row)
        for (size_t column = 0; column < 3; ++column)
            all[(3 * block + row) * 6 + 3 * block + column] =
                isUnknown(covariance) ? 0 : covariance[static_cast<int>(column)][static_cast<int>(row)];
    if (!value_known) all[21 * block] = -1;
}

glm::dmat3 getBlock(size_t block, const Covariance& all) {
    glm::dmat3 covariance{0};
    for (size_t row = 0; row < 3; ++row)
        for (size_t column = 0; column < 3; ++column)
            covariance[static_cast<int>(column)][static_cast<int>(row)] =
                all[(3 * block + row) * 6 + 3 * block + column];
    return covariance == glm::dmat3(0) || all[21 * block] == -1 ? types::Pose::unknownMatrix() : covariance;
}

glm::dvec3 getValue(size_t block, const Vector3& v, const Covariance& all) {
    return all[21 * block] == -1 ? glm::dvec3(types::Pose::unknown) : glm::dvec3(v.x, v.y, v.z);
}

void fillPose(const types::Pose& pose, Axes axes, Header& header, Pose& message) {
    header.stamp = toRos(pose.time);
    header.frame_id = pose.target_frame;
    const glm::dvec3 p = axes.worldFromRock(pose.position);
    const glm::dquat q = axes.orientationFromRock(pose.orientation);
    message.position = {p.x, p.y, p.z};
    message.orientation = {q.x, q.y, q.z, q.w};
}

void fillCovariance(const types::Pose& pose, Axes axes, Covariance& all) {
    const glm::dquat rock_from_body = glm::normalize(pose.orientation);
    setBlock(0, true, both(pose.cov_position, [&](glm::dvec3 v) { return axes.worldFromRock(v); }), all);
    setBlock(1, true, both(pose.cov_orientation, [&](glm::dvec3 v) { return axes.worldFromRock(rock_from_body * v); }),
             all);
}

void readCovariance(const Covariance& all, Axes axes, types::Pose& pose) {
    const glm::dquat body_from_rock = glm::inverse(glm::normalize(pose.orientation));
    pose.cov_position = both(getBlock(0, all), [&](glm::dvec3 v) { return axes.rockFromWorld(v); });
    pose.cov_orientation = both(getBlock(1, all), [&](glm::dvec3 v) { return body_from_rock * axes.rockFromWorld(v); });
}

void readPose(const Header& header, const Pose& message, Axes axes, types::Pose& pose) {
    pose.time = fromRos(header.stamp);
    pose.target_frame = header.frame_id;
    const Point& p = message.position;
    const Quaternion& q = message.orientation;
    pose.position = axes.rockFromWorld({p.x, p.y, p.z});
    pose.orientation = axes.rockFromOrientation(glm::dquat(q.w, q.x, q.y, q.z));
}

}  // namespace

void convert(const types::Imu& imu, WorldFrame frame, const std::string& frame_id, Imu& message) {
    message.header = {toRos(imu.time), frame_id};
    const bool is_known = !std::isnan(glm::length(imu.orientation));
    const glm::dquat q = is_known ? types::Axes{frame}.orientationFromRock(imu.orientation) : glm::dquat(1, 0, 0, 0);
    message.orientation = {q.x, q.y, q.z, q.w};
    const auto to_world = [&](glm::dvec3 v) { return types::Axes{frame}.worldFromRock(imu.orientation * v); };
    message.orientation_covariance = getRows(both(imu.cov_orientation, to_world), is_known, 0);
    report(imu.angular_velocity, imu.cov_angular_velocity, frame, message.angular_velocity,
           message.angular_velocity_covariance);
    report(imu.linear_acceleration, imu.cov_linear_acceleration, frame, message.linear_acceleration,
           message.linear_acceleration_covariance);
}

void convert(const Imu& message, WorldFrame frame, types::Imu& imu) {
    imu = {};
    imu.time = fromRos(message.header.stamp);
    const Quaternion& q = message.orientation;
    if (message.orientation_covariance[0] != -1)
        imu.orientation = types::Axes{frame}.rockFromOrientation(glm::dquat(q.w, q.x, q.y, q.z));
    const auto from_world = [&](glm::dvec3 v) {
        return glm::inverse(imu.orientation) * types::Axes{frame}.rockFromWorld(v);
    };
    imu.cov_orientation = both(toMatrix(message.orientation_covariance, 0), from_world);
    read(message.angular_velocity, message.angular_velocity_covariance, frame, imu.angular_velocity,
         imu.cov_angular_velocity);
    read(message.linear_acceleration, message.linear_acceleration_covariance, frame, imu.linear_acceleration,
         imu.cov_linear_acceleration);
}

void convert(const types::ImuSensors& sensors, WorldFrame frame, const std::string& frame_id, Imu& message) {
    types::Imu imu;
    imu.time = sensors.time;
    imu.angular_velocity = sensors.gyro;
    imu.linear_acceleration = sensors.acc;
    convert(imu, frame, frame_id, message);
}

void convert(const Imu& message, WorldFrame frame, types::ImuSensors& sensors) {
    types::Imu imu;
    convert(message, frame, imu);
    sensors = {};
    sensors.time = imu.time;
    sensors.acc = imu.linear_acceleration;
    sensors.gyro = imu.angular_velocity;
}

void convert(const types::Dvl& dvl, const std::string& frame_id, Dvl& message) {
    types::requireSound(dvl, "a velocity log's sample");
    const glm::dvec3 v = turnedOver(dvl.velocity);
    message.header = {toRos(dvl.time), frame_id};
    message.velocity_mode = Dvl::bottom;
    message.dvl_type = Dvl::piston;
    message.velocity = toVector(v);
    message.velocity_covar = getRows(both(dvl.cov_velocity, turnedOver), true, -1);
    message.altitude = dvl.altitude;
    message.course_gnd = std::atan2(v.y, v.x);
    message.speed_gnd = std::hypot(v.x, v.y);
    message.num_good_beams = static_cast<uint8_t>(dvl.goodBeams());
    message.sound_speed = static_cast<float>(dvl.speed_of_sound);
    message.beam_ranges_valid = dvl.goodBeams() > 0;
    message.beam_velocities_valid = dvl.hasBottomLock();
    clearBeams(message);
    for (size_t beam = 0; beam < dvl.beam_directions.size(); ++beam) writeBeam(dvl, beam, message);
}

void convert(const Dvl& message, types::Dvl& dvl) {
    dvl = {};
    dvl.time = fromRos(message.header.stamp);
    dvl.velocity = turnedOver(fromRos(message.velocity));
    dvl.cov_velocity = both(toMatrix(message.velocity_covar, -1), turnedOver);
    dvl.altitude = message.altitude;
    dvl.speed_of_sound = static_cast<double>(message.sound_speed);
    for (size_t beam = 0; beam < Dvl::beams; ++beam) {
        if (message.beam_unit_vec[beam] == Vector3{}) continue;
        const double variance = static_cast<double>(message.beam_velocity_covar[beam]);
        dvl.beam_directions.push_back(turnedOver(fromRos(message.beam_unit_vec[beam])));
        dvl.beam_ranges.push_back(message.range[beam]);
        dvl.beam_velocities.push_back(static_cast<double>(message.beam_velocity[beam]));
        dvl.beam_velocity_variances.push_back(variance == -1 ? types::Pose::unknown : variance);
    }
}

void convert(const types::Pressure& pressure, const std::string& frame_id, FluidPressure& message) {
    message.header = {toRos(pressure.time), frame_id};
    message.fluid_pressure = static_cast<double>(pressure.pascal);
    message.variance = 0;
}

void convert(const FluidPressure& message, types::Pressure& pressure) {
    pressure.time = fromRos(message.header.stamp);
    pressure.pascal = static_cast<float>(message.fluid_pressure);
}

void convert(const types::Fix& fix, const std::string& frame_id, NavSatFix& message) {
    using Kind = types::FixKind;
    message = {};
    message.header = {toRos(fix.time), frame_id};
    const bool is_rtk = fix.kind == Kind::RtkFixed || fix.kind == Kind::RtkFloat;
    message.status.status = !fix.hasPosition()               ? NavSatStatus::no_fix
                            : is_rtk                         ? NavSatStatus::gbas_fix
                            : fix.kind == Kind::Differential ? NavSatStatus::sbas_fix
                                                             : NavSatStatus::fix;
    message.status.service = NavSatStatus::gps;
    message.latitude = fix.latitude;
    message.longitude = fix.longitude;
    message.altitude = fix.place().height_m;
    const glm::dvec3 deviations(fix.deviation_longitude, fix.deviation_latitude, fix.deviation_altitude);
    if (isUnknown(deviations)) return;
    for (size_t axis = 0; axis < 3; ++axis) {
        const double deviation = deviations[static_cast<int>(axis)];
        message.position_covariance[4 * axis] = deviation * deviation;
    }
    message.position_covariance_type = NavSatFix::diagonal_known;
}

void convert(const NavSatFix& message, types::Fix& fix) {
    using Kind = types::FixKind;
    fix = {};
    fix.time = fromRos(message.header.stamp);
    const int8_t status = message.status.status;
    fix.kind = status <= NavSatStatus::no_fix     ? Kind::NoSolution
               : status == NavSatStatus::fix      ? Kind::Autonomous
               : status == NavSatStatus::sbas_fix ? Kind::Differential
                                                  : Kind::RtkFixed;
    fix.latitude = message.latitude;
    fix.longitude = message.longitude;
    fix.altitude = message.altitude;
    if (message.position_covariance_type == NavSatFix::unknown) return;
    fix.deviation_longitude = std::sqrt(message.position_covariance[0]);
    fix.deviation_latitude = std::sqrt(message.position_covariance[4]);
    fix.deviation_altitude = std::sqrt(message.position_covariance[8]);
}

glm::dvec3 worldFromRock(WorldFrame frame, glm::dvec3 v) { return Axes{frame}.worldFromRock(v); }
glm::dvec3 rockFromWorld(WorldFrame frame, glm::dvec3 v) { return Axes{frame}.rockFromWorld(v); }

void convert(const types::Pose& pose, WorldFrame frame, PoseStamped& message) {
    fillPose(pose, {frame}, message.header, message.pose);
}

void convert(const types::Pose& pose, WorldFrame frame, PoseWithCovarianceStamped& message) {
    fillPose(pose, {frame}, message.header, message.pose.pose);
    fillCovariance(pose, {frame}, message.pose.covariance);
}

void convert(const types::Pose& pose, WorldFrame frame, TFMessage& message) {
    message.transforms.resize(1);
    TransformStamped& stamped = message.transforms[0];
    Pose placed;
    fillPose(pose, {frame}, stamped.header, placed);
    stamped.child_frame_id = pose.source_frame;
    stamped.transform = {{placed.position.x, placed.position.y, placed.position.z}, placed.orientation};
}

Transform toTransform(const types::Mount& mount, WorldFrame frame, SensorFrame axes) {
    constexpr double half = std::numbers::sqrt2 / 2;
    const glm::dquat body_from_rock = frame == WorldFrame::Ned ? glm::dquat(0, 1, 0, 0) : glm::dquat(1, 0, 0, 0),
                     ahead_from_z =
                         axes == SensorFrame::ZForward ? glm::dquat(0, half, 0, half) : glm::dquat(1, 0, 0, 0);
    const glm::dvec3 p = Axes{frame}.body(mount.position);
    const glm::dquat q = glm::normalize(body_from_rock * mount.orientation() * ahead_from_z);
    return {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

void convert(const types::Pose& pose, WorldFrame frame, Odometry& message) {
    const Axes axes{frame};
    fillPose(pose, axes, message.header, message.pose.pose);
    message.child_frame_id = pose.source_frame;
    const glm::dquat body_from_rock = glm::inverse(glm::normalize(pose.orientation));
    const auto body = [&](glm::dvec3 v) { return axes.body(v); };
    const auto to_body = [&](glm::dvec3 v) { return axes.body(body_from_rock * v); };
    fillCovariance(pose, axes, message.pose.covariance);
    message.twist.twist.linear = known<Vector3>(to_body(pose.velocity));
    message.twist.twist.angular = known<Vector3>(body(pose.angular_velocity));
    setBlock(0, !isUnknown(pose.velocity), both(pose.cov_velocity, to_body), message.twist.covariance);
    setBlock(1, !isUnknown(pose.angular_velocity), both(pose.cov_angular_velocity, body), message.twist.covariance);
}

void convert(const PoseStamped& message, WorldFrame frame, types::Pose& pose) {
    pose = {};
    readPose(message.header, message.pose, {frame}, pose);
}

void convert(const PoseWithCovarianceStamped& message, WorldFrame frame, types::Pose& pose) {
    pose = {};
    readPose(message.header, message.pose.pose, {frame}, pose);
    readCovariance(message.pose.covariance, {frame}, pose);
}

void convert(const Odometry& message, WorldFrame frame, types::Pose& pose) {
    const Axes axes{frame};
    readPose(message.header, message.pose.pose, axes, pose);
    pose.source_frame = message.child_frame_id;
    const glm::dquat rock_from_body = glm::normalize(pose.orientation);
    const auto body = [&](glm::dvec3 v) { return axes.body(v); };
    const auto from_body = [&](glm::dvec3 v) { return rock_from_body * axes.body(v); };
    const Covariance& of_twist = message.twist.covariance;
    readCovariance(message.pose.covariance, axes, pose);
    pose.velocity = from_body(getValue(0, message.twist.twist.linear, of_twist));
    pose.angular_velocity = body(getValue(1, message.twist.twist.angular, of_twist));
    pose.cov_velocity = both(getBlock(0, of_twist), from_body);
    pose.cov_angular_velocity = both(getBlock(1, of_twist), body);
}

}  // namespace insonify::ros
