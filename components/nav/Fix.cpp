#include "components/nav/Fix.hpp"

#include <cmath>

#include "types/geometry/WorldFrame.hpp"

namespace insonify::nav {
namespace {

constexpr uint64_t noise_of_fix = 400, wander_of_fix = 403;

constexpr types::Axes enu_axes{types::WorldFrame::Enu};

/** Returns the deviations of two kinds of errors along x, y and z [m]. */
std::array<std::array<double, 2>, 3> deviations(const FixErrors& errors) {
    return {{{errors.horizontal, errors.wander_horizontal},
             {errors.horizontal, errors.wander_horizontal},
             {errors.vertical, errors.wander_vertical}}};
}

WanderingBias makeWander(const FixConfig& config, size_t axis) {
    return {deviations(config.errors)[axis][1], config.errors.wander_time, config.sensor.randomSeed(),
            wander_of_fix + axis};
}

}  // namespace

FixReceiver::FixReceiver(const FixConfig& config)
    : config_(config), wander_{makeWander(config, 0), makeWander(config, 1), makeWander(config, 2)} {}

types::Pose FixReceiver::measure(const types::Pose& antenna) {
    types::Pose measured;
    measured.time = antenna.time;
    measured.source_frame = "fix";
    measured.target_frame = "world";
    measured.position = glm::dvec3(types::Pose::unknown);
    for (size_t axis = 0; axis < 3; ++axis) {
        const double wander = wander_[axis].at(antenna.time);  // also below the surface, where time passes as well
        const int i = static_cast<int>(axis);
        if (antenna.position.z < config_.water_surface) continue;
        const auto [noise, wandering] = deviations(config_.errors)[axis];
        measured.position[i] = antenna.position[i] + wander +
                               noise * normal(config_.sensor.randomSeed(), noise_of_fix + axis, antenna.time);
        measured.cov_position[i] = glm::dvec3(0);
        measured.cov_position[i][i] = noise * noise + wandering * wandering;
    }
    return measured;
}

types::Fix makeFix(const types::Pose& measured, const types::Datum& datum) {
    types::Fix fix;
    fix.time = measured.time;
    const types::Datum place = geodetic(datum, enu_axes.worldFromRock(measured.position));
    if (!std::isfinite(place.latitude_deg + place.longitude_deg + place.height_m)) return fix;
    fix.kind = types::FixKind::Autonomous;
    fix.latitude = place.latitude_deg;
    fix.longitude = place.longitude_deg;
    fix.altitude = place.height_m;
    fix.deviation_latitude = std::sqrt(measured.cov_position[0][0]);
    fix.deviation_longitude = std::sqrt(measured.cov_position[1][1]);
    fix.deviation_altitude = std::sqrt(measured.cov_position[2][2]);
    return fix;
}

}  // namespace insonify::nav
