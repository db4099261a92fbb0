#include "components/sonar/Silence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "types/Angle.hpp"
#include "types/Extent.hpp"

namespace insonify::sonar {
namespace {

/** Without digits of rounding. */
std::string text(const glm::dvec3& v) {
    const glm::dvec3 rounded = glm::round(v * 1e6) / 1e6 + 0.0;
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", rounded.x, rounded.y, rounded.z);
}

double degrees(double radians) { return radians / types::radians(1); }

/** "heading 90 deg (0: north, positive to the west), 12 deg down" of a direction in the world. */
std::string directionText(const glm::dvec3& ahead) {
    const double down = degrees(std::asin(std::clamp(-ahead.z, -1.0, 1.0)));
    return fmt::format("looks towards {} (yaw {:.4g} deg, {:.4g} deg {})", text(ahead),
                       degrees(std::atan2(ahead.y, ahead.x)), std::abs(down), down >= 0 ? "down" : "up");
}

/** What keeps the sonar from hearing a point, given in its own frame; empty when nothing does that is known here. */
std::string hindranceText(const SonarConfig& config, const Coverage& reach, const glm::dvec3& point) {
    const double range = glm::length(point);
    if (range > reach.range_max) return fmt::format("beyond the range of {:.4g} m", reach.range_max);
    if (range < config.range_min) return fmt::format("nearer than range_min, {:g} m", config.range_min);
    const double bearing = degrees(std::atan2(point.y, point.x));
    const double elevation = degrees(std::asin(std::clamp(point.z / std::max(range, 1e-12), -1.0, 1.0)));
    if (std::abs(elevation) > config.beam_height_deg / 2)
        return fmt::format("{:.4g} deg {} the sonar's plane, where the aperture reaches {:g} deg to either side",
                           std::abs(elevation), elevation < 0 ? "below" : "above", config.beam_height_deg / 2);
    if (std::abs(bearing) > reach.covered_deg / 2)
        return fmt::format("at a bearing of {:.4g} deg to {}, where the fan covers {:g} deg to either side",
                           std::abs(bearing), bearing > 0 ? "port" : "starboard", reach.covered_deg / 2);
    return "";
}

}  // namespace

std::string silenceText(const SonarConfig& config, const Coverage& reach, const types::Snapshot& scene) {
    const glm::dvec3& place = scene.sonar.position;
    const glm::dvec3 ahead = scene.sonar.orientation * glm::dvec3(1, 0, 0);
    const std::string sonar =
        fmt::format("hears nothing. The sonar is at {} and {}", text(place), directionText(ahead));
    const types::Extent extent = types::extentOf(scene);
    if (extent.isEmpty()) return sonar + "; the scene has no triangles";
    const types::NearestPoint nearest = types::nearestPoint(scene, place);
    const glm::dvec3 in_sonar = glm::conjugate(scene.sonar.orientation) * (nearest.point - place);
    const std::string hindrance = hindranceText(config, reach, in_sonar);
    return fmt::format("{}; the scene lies from {} to {}, its nearest point {:.4g} m away at {} of {}{}{}", sonar,
                       text(extent.low), text(extent.high), nearest.distance, text(nearest.point),
                       scene.geometry->objects[nearest.object].name, hindrance.empty() ? "" : ": ", hindrance);
}

}  // namespace insonify::sonar
