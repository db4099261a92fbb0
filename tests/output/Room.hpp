#pragma once
// A scanning sonar that moves and turns in a room of four walls, and a measure of how straight a picture shows them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tests/output/Pixels.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::test {

struct Room {
    double north = 13.2, west = 9;  ///< Places of two walls; the others are at the negative [m].

    /** Returns the slant range of the wall in a direction of the world [m]. */
    double range(const glm::dvec3& from, double heading) const {
        const double x = std::cos(heading), y = std::sin(heading);
        return std::min(((x > 0 ? north : -north) - from.x) / x, ((y > 0 ? west : -west) - from.y) / y);
    }
};

/** Returns the vehicle's pose at a `share` (0 to 1) of one turn of the head: it moves 6 m and turns by 180 degrees. */
inline types::Pose poseInRoom(double share) {
    types::Pose pose;
    pose.time = types::Time::fromSeconds(1 + 20 * share);
    pose.position = {-3 + 5 * share, -2 + 3.5 * share, -1};
    pose.orientation = glm::angleAxis(-std::numbers::pi * share, glm::dvec3(0, 0, 1));
    return pose;
}

constexpr int pings_in_room = 400;
constexpr double room_bin = 0.2;  ///< [m]

/** Returns a ping of a head that turns by 0.9 degrees per ping: 1 in the bins where the beam meets the wall. */
inline types::Sonar pingInRoom(const Room& room, int number) {
    const double step = types::radians(0.9), bearing = std::numbers::pi - number * step;
    const types::Pose pose = poseInRoom(static_cast<double>(number) / pings_in_room);
    types::Sonar ping;
    ping.time = pose.time;
    ping.speed_of_sound = 1500;
    ping.bin_count = 120;
    ping.bin_duration = types::Time::fromSeconds(room_bin / 1500);
    ping.beam_count = 1;
    ping.beam_width.rad = step;
    ping.bearings = {types::Angle::fromRad(bearing)};
    ping.bins.assign(ping.bin_count, 0);
    const double heading = bearing + 2 * std::atan2(pose.orientation.z, pose.orientation.w);
    const double right = room.range(pose.position, heading - step / 2),
                 left = room.range(pose.position, heading + step / 2);
    const auto first = static_cast<uint32_t>(std::min(left, right) / ping.binStart(1)),
               last = static_cast<uint32_t>(std::max(left, right) / ping.binStart(1));
    for (uint32_t bin = first; bin <= last; ++bin) ping.bins[bin] = 1;
    return ping;
}

/** Returns centres of gravity of bright pixels between two rows, in pieces of `piece` columns. */
inline std::vector<cv::Point2d> ridge(const cv::Mat& gray, cv::Rect part, int piece = 1) {
    std::vector<cv::Point2d> points;
    for (int column = part.x; column + piece <= part.x + part.width; column += piece) {
        cv::Mat bright;
        cv::threshold(gray(cv::Rect(column, part.y, piece, part.height)), bright, 150, 255, cv::THRESH_TOZERO);
        const cv::Moments moments = cv::moments(bright);
        if (moments.m00 > 0)
            points.emplace_back(column + moments.m10 / moments.m00, part.y + moments.m01 / moments.m00);
    }
    return points;
}

/** The line nearest to points, the max distance of a point from it, and their rms [px]. */
struct LineFit {
    cv::Point2d middle, direction;
    double farthest = 0, rms = 0;

    explicit LineFit(const std::vector<cv::Point2d>& points) {
        cv::Vec4d line;
        cv::fitLine(std::vector<cv::Point2f>(points.begin(), points.end()), line, cv::DIST_L2, 0, 1e-3, 1e-4);
        direction = {line[0], line[1]};
        middle = {line[2], line[3]};
        for (const cv::Point2d& point : points) {
            const double off = std::abs((point - middle).cross(direction));
            farthest = std::max(farthest, off);
            rms += off * off / static_cast<double>(points.size());
        }
        rms = std::sqrt(rms);
    }
};

}  // namespace insonify::test
