#include "components/study/TargetShapes.hpp"

#include <cmath>
#include <complex>
#include <glm/ext/matrix_transform.hpp>
#include <numbers>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"

namespace insonify::study {
namespace {

using std::numbers::pi;

double decibels(double section) { return 10 * std::log10(section); }

/** Returns a rigid body without a Lambertian part. */
types::GeometryPtr shiny(types::Mesh mesh, const glm::dmat4& place) {
    const auto scene = makeCopy(makeScene({std::move(mesh)}));
    scene->objects[0].world_from_object = place;
    scene->materials[0].lambert_db = -200;
    scene->materials[0].reflection = 1;
    scene->materials[0].roughness_slope = 0;
    return scene;
}

glm::dmat4 movedTo(double x, double y = 0, double z = 0) { return glm::translate(glm::dmat4(1), glm::dvec3(x, y, z)); }

/** Returns the cross-section of two radii of curvature at normal incidence by geometric optics, from a range [m^2]. */
double curvedSection(double range, double one, double other) {
    return 1 / ((1 / one + 1 / range) * (1 / other + 1 / range)) / 4;
}

/** Returns the power of a flat length's end-on interference relative to broadside; beyond the main lobe its mean. */
double diffraction(double beta) {
    if (beta == 0) return 1;
    return beta < 0.75 * pi ? std::pow(std::sin(beta) / beta, 2) : 0.5 / (beta * beta);
}

}  // namespace

types::Mesh revolved(const std::vector<glm::dvec2>& profile, int around, double turn, double arc) {
    const bool closed = arc >= 2 * pi;
    const int steps = closed ? around : static_cast<int>(std::ceil(around * arc / (2 * pi)));
    const int places = closed ? around : steps + 1;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (const glm::dvec2& at : profile)
        for (int j = 0; j < places; ++j) {
            const double angle = pi + 2 * pi * (j + turn - (closed ? 0 : steps / 2)) / around;
            positions.push_back(glm::dvec3(at.x * std::cos(angle), at.x * std::sin(angle), at.y));
        }
    const auto at = [&](size_t i, int j) {
        return static_cast<uint32_t>(i) * static_cast<uint32_t>(places) + static_cast<uint32_t>(j % places);
    };
    for (size_t i = 0; i + 1 < profile.size(); ++i)
        for (int j = 0; j < steps; ++j) {
            if (profile[i].x > 0) indices.insert(indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j)});
            if (profile[i + 1].x > 0) indices.insert(indices.end(), {at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    return getMesh(std::move(positions), std::move(indices));
}

Target ellipsoidTarget(const Encounter& encounter, double ahead, double aside, double up) {
    constexpr int whole_up_to = 256;  // finer facets only about the nearest point
    const double arc = encounter.around > whole_up_to ? pi / 4 : pi;
    std::vector<glm::dvec2> profile;
    const int rings = std::max(2, static_cast<int>(std::ceil(encounter.around / 2.0 * arc / pi)));
    for (int i = 0; i <= rings; ++i) {
        const double polar = pi / 2 + arc * (static_cast<double>(i) / rings - 0.5);
        const bool pole = arc >= pi && (i == 0 || i == rings);
        profile.push_back({pole ? 0 : std::sin(polar), -std::cos(polar)});
    }
    const glm::dmat4 place = glm::scale(movedTo(encounter.range + ahead), glm::dvec3(ahead, aside, up));
    return {shiny(revolved(profile, encounter.around, encounter.turn, 2 * arc), place), 2 * std::max(aside, up),
            decibels(curvedSection(encounter.range, aside * aside / ahead, up * up / ahead))};
}

Target cylinderTarget(const Encounter& encounter, double radius, double length, double tilt) {
    const glm::dmat4 place = glm::rotate(movedTo(encounter.range + radius), tilt, glm::dvec3(0, 1, 0));
    const double far = radius * length * length / (2 * encounter.wavelength()) * std::pow(std::cos(tilt), 2) *
                       diffraction(2 * pi / encounter.wavelength() * length * std::sin(tilt));
    const double near = curvedSection(encounter.range, radius, INFINITY);
    return {
        shiny(revolved({{radius, -length / 2}, {radius, length / 2}}, encounter.around, encounter.turn, 2 * pi), place),
        length, decibels(tilt != 0 || encounter.fresnelNumber(length) < 1 ? far : near)};
}

Target plateTarget(const Encounter& encounter, double width, double height) {
    const auto half_width = static_cast<float>(width / 2), half_height = static_cast<float>(height / 2);
    const double far = std::pow(width * height / encounter.wavelength(), 2),
                 near = curvedSection(encounter.range, INFINITY, INFINITY);
    return {shiny(quad({0, -half_width, -half_height}, {0, 2 * half_width, 0}, {0, 0, 2 * half_height}),
                  movedTo(encounter.range)),
            std::max(width, height), decibels(encounter.fresnelNumber(std::max(width, height)) < 1 ? far : near)};
}

Target coneTarget(const Encounter& encounter, double radius, double height) {
    const double slope = std::atan(radius / height), side = std::hypot(radius, height);
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), -slope, glm::dvec3(0, 1, 0));
    const glm::dvec4 middle = turned * glm::dvec4(-radius / 2, 0, height / 2, 0);
    glm::dmat4 place = turned;
    place[3] = glm::dvec4(encounter.range, 0, 0, 1) - middle;
    const double far = 2 * std::pow(side, 3) * std::tan(slope) / (9 * encounter.wavelength());
    const double near = curvedSection(encounter.range, radius / 2 / std::cos(slope), INFINITY);
    return {shiny(revolved({{radius, 0}, {0, height}}, encounter.around, encounter.turn, 2 * pi), place), side,
            decibels(encounter.fresnelNumber(side) < 1 ? far : near)};
}

Target hullTarget(const Encounter& encounter, double radius, double length) {
    const double nose = 2 * radius, tail = 3 * radius;
    std::vector<glm::dvec2> profile = {{0, -length / 2 - tail}};
    const int rings = std::clamp(encounter.around / 4, 4, 64);
    for (int i = 0; i <= rings; ++i) {
        const double angle = pi / 2 * i / rings;
        if (i == 0) profile.push_back({radius, -length / 2});
        profile.push_back({i < rings ? radius * std::cos(angle) : 0, length / 2 + nose * std::sin(angle)});
    }
    // Physical optics: stationary phase around the body, all of the profile along it.
    std::complex<double> sum = 0;
    constexpr int steps = 200000;
    const double step = (tail + length + nose) / steps;
    for (int i = 0; i < steps; ++i) {
        const double z = -length / 2 - tail + (i + 0.5) * step, beyond = std::abs(z) - length / 2;
        const double at = beyond <= 0 ? radius
                          : z < 0     ? radius * (1 - beyond / tail)
                                      : radius * std::sqrt(std::max(0.0, 1 - std::pow(beyond / nose, 2)));
        sum += std::sqrt(at) * step * std::polar(1.0, 4 * pi / encounter.wavelength() * (radius - at));
    }
    const double far = std::norm(sum) / (2 * encounter.wavelength()),
                 near = curvedSection(encounter.range, radius, INFINITY);
    return {shiny(revolved(profile, encounter.around, encounter.turn, 2 * pi), movedTo(encounter.range + radius)),
            length + 2 * tail, decibels(encounter.fresnelNumber(length) < 1 ? far : near)};
}

sonar::SonarConfig targetSonar(const Encounter& encounter, const Target& target, int samples) {
    sonar::SonarConfig config;
    config.speed_of_sound = 1500;
    config.range_rounding = sonar::RangeRounding::Exact;
    config.bin_count = static_cast<int>(encounter.range + target.size) + 2;
    config.range = config.bin_count;
    config.beam_count = 1;
    config.field_of_view_deg = config.beam_height_deg = 2 * std::atan(0.6 * target.size / encounter.range) * 180 / pi;
    config.frequency_khz = encounter.frequency_khz;
    config.visibility = sonar::Visibility::Cpu;
    setSamples(config, samples, samples);
    return config;
}

double targetError(const Encounter& encounter, const Target& target, const sonar::SonarConfig& config) {
    Probe received;
    sonar::SonarRenderer(config, target.scene).render(lookingAt(target.scene), received.ping);
    return decibels(received.energy() * std::pow(encounter.range, 4)) - target.strength_db;
}

}  // namespace insonify::study
