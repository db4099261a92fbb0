#include "components/sonar/multipath/Mirrors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "components/sonar/beams/BeamFan.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
namespace {

std::string noSurface(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "multipath.surface is given, and the scene task has no water_surface";
}
std::string aboveSurface(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "the sonar was above the water surface at the first ping";
}
std::string beyondRange(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("the water surface was {:.4g} m away at the first ping, beyond {:.4g} m", what.value,
                       what.bound);
}

}  // namespace

double reflectedPower(const types::Material& material, int bounces) {
    constexpr double min_reflection = 0.5, steepest = 0.3;
    const double reflection = std::abs(static_cast<double>(material.reflection));
    if (material.mirror && bounces > 0) return reflection > 0 ? reflection * reflection : 1;
    const bool smooth = material.roughness_slope && static_cast<double>(*material.roughness_slope) < steepest;
    return bounces > 1 && smooth && !material.shell && reflection > min_reflection ? reflection * reflection : 0;
}

int countBounces(const SonarConfig& config) { return config.tracesPaths() ? config.multipath->bounces : 0; }

double slopeOfSea(double wind) {
    if (!(wind > 0)) return 0;
    constexpr double calm = 0.0034;
    return wind < 1 ? calm : std::max(calm, 4.6e-3 * std::log(2.1 * wind * wind));
}

double coherentReflection(double wind, double wavelength, double sine_grazing) {
    const double height = 0.0053 * wind * wind;
    const double roughness = 4 * std::numbers::pi / wavelength * height * sine_grazing;
    return std::exp(-roughness * roughness / 2);
}

WaterMirror::WaterMirror(const SonarConfig& config)
    : wanted_(config.tracesPaths() && config.multipath->surface),
      slope_(wanted_ ? std::sqrt(slopeOfSea(config.multipath->surface->wind_m_s) / 2) : 0) {}

void WaterMirror::place(const types::Snapshot& snapshot, double range_max) {
    const WaterView water = waterView(snapshot);
    ping_ = static_cast<uint64_t>(snapshot.time.microseconds);
    plane_ = {water.up, -water.height};
    omitted_.reset();
    if (wanted_ && !snapshot.water_surface)
        omitted_ = Omitted{.effect = "multipath", .reason = Reason::Lacking, .words = noSurface};
    else if (wanted_ && !(plane_.distance > 0))
        omitted_ = Omitted{.effect = "multipath", .reason = Reason::Other, .words = aboveSurface};
    else if (wanted_ && plane_.distance > range_max)
        omitted_ = Omitted{"multipath", Reason::Other, plane_.distance, range_max, beyondRange};
    reflects_ = wanted_ && !omitted_;
}

double WaterMirror::distance(const glm::dvec3& from, const glm::dvec3& direction) const {
    constexpr double level = 1e-9;
    const double rise = glm::dot(plane_.normal, direction);
    if (!reflects_ || !(rise > level)) return std::numeric_limits<double>::infinity();
    return std::max(0.0, (plane_.distance - glm::dot(plane_.normal, from)) / rise);
}

MirrorPlane WaterMirror::facet(const glm::dvec3& at, const glm::dvec3& direction, uint64_t key) const {
    if (slope_ == 0) return plane_;
    const glm::dvec3& up = plane_.normal;
    const glm::dvec3 level =
        glm::normalize(std::abs(up.x) < 0.5 ? glm::cross(up, glm::dvec3(1, 0, 0)) : glm::cross(up, {0, 1, 0}));
    const auto uniform = [&](uint64_t number) { return types::unit(types::hashed(ping_, key, number) >> 32); };
    const double size = slope_ * std::sqrt(-2 * std::log(uniform(0)));
    const double turn = 2 * std::numbers::pi * uniform(1);
    const glm::dvec3 slope = size * (std::cos(turn) * level + std::sin(turn) * glm::cross(up, level));
    const glm::dvec3 tilted = glm::dot(up + slope, direction) > 0 ? up + slope : up - slope;
    const MirrorPlane facet{glm::normalize(tilted), glm::dot(glm::normalize(tilted), at)};
    return glm::dot(facet.turned(direction), up) < 0 ? facet : plane_;
}

}  // namespace insonify::sonar
