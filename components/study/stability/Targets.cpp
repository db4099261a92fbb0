#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "components/study/Probe.hpp"
#include "components/study/TargetShapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

using Shape = std::function<Target(const Encounter&)>;

constexpr int samples = 512;
constexpr double tolerance = 0.5;       ///< [dB]
constexpr double tilted_tolerance = 1;  ///< For means over sidelobes, which are smeared for bodies of finite range [dB]

/** Returns the max error over facets around and frequencies; `numbers` are Fresnel numbers of a flat length [m];
 *  without it, at ranges of 5 and 100 m. */
Outcome errorOf(const Shape& shape, double length, std::initializer_list<double> numbers, double allowed = tolerance) {
    double worst = 0;
    std::string where;
    Probe received;
    for (const double frequency : {100., 300., 1000., 3000.})
        for (const int around : {32, 256, 2048})
            for (const double number : numbers) {
                Encounter met{frequency, number, around, 0.3};
                if (length > 0) met.range = length * length / (met.wavelength() * number);
                const Target target = shape(met);
                const double error = targetError(met, target, targetSonar(met, target, samples));
                if (!(std::abs(error) <= worst)) {
                    worst = std::abs(error);
                    where = fmt::format("{:.2f} dB at {} kHz, {} facets around, {:.0f} m", error, frequency, around,
                                        met.range);
                }
            }
    received.ping.bins = {1};
    return within(allowed, worst, "at most " + where, received);
}

Outcome far(const Shape& shape, double length) { return errorOf(shape, length, {0.05, 0.1}); }
Outcome near(const Shape& shape, double length) { return errorOf(shape, length, {8, 20}); }

Target cylinder(const Encounter& met, double tilt_deg) {
    return cylinderTarget(met, 0.1, 0.5, types::radians(tilt_deg));
}

}  // namespace

std::vector<StabilityCase> targetCases() {
    const std::string expected = "to 0.5 dB with 32 to 2048 facets around, 100 kHz to 3 MHz";
    const auto sphere = [](const Encounter& met) { return ellipsoidTarget(met, 0.1, 0.1, 0.1); };
    const auto egg = [](const Encounter& met) { return ellipsoidTarget(met, 1, 0.6, 0.4); };
    const auto plate = [](const Encounter& met) { return plateTarget(met, 0.5, 0.3); };
    const auto pipe = [](const Encounter& met) { return cylinder(met, 0); };
    const auto cone = [](const Encounter& met) { return coneTarget(met, 0.15, 0.5); };
    const auto hull = [](const Encounter& met) { return hullTarget(met, 0.1, 1); };
    std::vector<StabilityCase> cases = {
        {61, "Sphere", expected,
         [=] {
             return errorOf(sphere, 0, {5, 100});
         }},
        {61, "Ellipsoid", expected,
         [=] {
             return errorOf(egg, 0, {5, 100});
         }},
        {61, "Plate, far", expected, [=] { return far(plate, 0.5); }},
        {61, "Plate, near", expected, [=] { return near(plate, 0.3); }},
        {61, "Cylinder broadside, far", expected, [=] { return far(pipe, 0.5); }},
        {61, "Cylinder broadside, near", expected, [=] { return near(pipe, 0.5); }},
        {61, "Cone square to its side, far", expected, [=] { return far(cone, std::hypot(0.15, 0.5)); }},
        {61, "Cone square to its side, near", expected, [=] { return near(cone, std::hypot(0.15, 0.5)); }},
        {61, "Hull of a torpedo broadside, far", expected, [=] { return far(hull, 1); }},
        {61, "Hull of a torpedo broadside, near", expected, [=] { return near(hull, 1); }}};
    for (const double tilt : {1., 3., 10.})
        cases.push_back({61, fmt::format("Cylinder {:.0f} deg off broadside", tilt),
                         "to 1 dB with 32 to 2048 facets around, 100 kHz to 3 MHz; means of sidelobes", [=] {
                             return errorOf([=](const Encounter& met) { return cylinder(met, tilt); }, 0, {50, 200},
                                            tilted_tolerance);
                         }});
    return cases;
}

}  // namespace insonify::study
