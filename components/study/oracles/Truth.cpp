#include "components/study/oracles/Truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace insonify::study {
namespace {

/** Gauss-Legendre nodes and weights of order 8 on [-1, 1], the positive half. */
constexpr std::array<std::array<double, 2>, 4> gauss = {{{0.1834346424956498, 0.3626837833783620},
                                                         {0.5255324099163290, 0.3137066458778873},
                                                         {0.7966664774136267, 0.2223810344533745},
                                                         {0.9602898564975363, 0.1012285362903763}}};

template <class F>
double integral(double from, double to, const F& f) {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double total = 0;
    for (const auto& [node, weight] : gauss) total += weight * (f(middle - half * node) + f(middle + half * node));
    return half * total;
}

/** Integrates; halves the interval until that changes nothing, because apertures cut corners into the integrand. */
double adaptive(double from, double to, const auto& f, double whole, int depth) {
    constexpr double tolerance = 1e-8;
    constexpr int min_depth = 2, max_depth = 24;
    const double middle = 0.5 * (from + to), low = integral(from, middle, f), high = integral(middle, to, f);
    const bool settled = std::abs(low + high - whole) <= tolerance * std::abs(low + high);
    if (depth >= max_depth || (settled && depth >= min_depth)) return low + high;
    return adaptive(from, middle, f, low, depth + 1) + adaptive(middle, to, f, high, depth + 1);
}

/** The plane at one azimuth: 1/r = slope * cos(elevation - steepest). */
struct Profile {
    double slope, steepest;
    Profile(glm::dvec3 normal, double distance, double azimuth) {
        const double level = normal.x * std::cos(azimuth) + normal.y * std::sin(azimuth);
        slope = std::hypot(level, normal.z) / distance;
        steepest = std::atan2(normal.z, level);
    }
    /** Returns the distance from the steepest elevation at which the range is r; the min range is 1 / slope. */
    double away(double r) const { return std::acos(std::min(1.0, 1 / (slope * r))); }
    /** Integral of cos(theta) r^-2 over solid angle, per azimuth, with cos(theta) = distance / r. */
    double echo(double low, double high, double distance, const Pattern& pattern) const {
        if (!(high > low)) return 0;
        return integral(low, high, [&](double elevation) {
            const double inverse = slope * std::cos(elevation - steepest);
            const double received = pattern ? pattern(elevation) : 1;
            return received * std::cos(elevation) * distance * inverse * inverse * inverse;
        });
    }
};

double profileEcho(const Profile& profile, double distance, const Pattern& pattern, Elevations seen, double r1,
                   double r2) {
    if (r2 * profile.slope <= 1) return 0;
    const double near = profile.away(r1), far = profile.away(r2), at = profile.steepest;
    return profile.echo(std::max(at + near, seen.low), std::min(at + far, seen.high), distance, pattern) +
           profile.echo(std::max(at - far, seen.low), std::min(at - near, seen.high), distance, pattern);
}

Elevations both(Elevations a, Elevations b) { return {std::max(a.low, b.low), std::min(a.high, b.high)}; }

}  // namespace

Truth planeTruth(glm::dvec3 normal, double distance, Window window, Pattern pattern) {
    return [=](const BeamLimits& beam, double r1, double r2) {
        const auto per_azimuth = [&](double azimuth) {
            Elevations seen{-beam.half_height, beam.half_height};
            if (window) seen = both(seen, window(azimuth));
            return profileEcho(Profile(normal, distance, azimuth), distance, pattern, seen, r1, r2);
        };
        return adaptive(beam.azimuth_low, beam.azimuth_high, per_azimuth,
                        integral(beam.azimuth_low, beam.azimuth_high, per_azimuth), 0);
    };
}

Truth sphereTruth(double radius, double centre) {
    return [=](const BeamLimits&, double r1, double r2) {
        const double q = centre * centre - radius * radius;
        const auto antiderivative = [&](double r) { return -q * q / (4 * std::pow(r, 4)) + q / (r * r) + std::log(r); };
        const double from = std::max(r1, centre - radius), to = std::min(r2, std::sqrt(q));
        if (!(to > from)) return 0.0;
        return std::numbers::pi / (2 * radius * centre) * (antiderivative(to) - antiderivative(from));
    };
}

Truth sphereTruth(double radius, double centre, const std::function<double(double)>& section) {
    return [=](const BeamLimits&, double r1, double r2) {
        const double q = centre * centre - radius * radius;
        const double from = std::max(r1, centre - radius), to = std::min(r2, std::sqrt(q));
        if (!(to > from)) return 0.0;
        const auto density = [&](double r) {
            const double cosine = std::clamp((q - r * r) / (2 * radius * r), 0.0, 1.0);
            return section(cosine) * 2 * std::numbers::pi * radius / centre * std::pow(r, -3);
        };
        return adaptive(from, to, density, integral(from, to, density), 0);
    };
}

Truth waterTruth(double strength, double height) {
    return [=](const BeamLimits& beam, double r1, double r2) {
        const double up = std::sin(beam.half_height), met = height / up;  // from there on the bottom hides water
        const auto before = [&](double from, double to) { return 2 * up * (1 / from - 1 / to); };
        const auto behind = [&](double from, double to) {
            return up * (1 / from - 1 / to) + height / 2 * (1 / (from * from) - 1 / (to * to));
        };
        const double middle = std::clamp(met, r1, r2);
        return strength * (beam.azimuth_high - beam.azimuth_low) * (before(r1, middle) + behind(middle, r2));
    };
}

Truth discTruth(double distance, double radius) {
    return [=](const BeamLimits&, double r1, double r2) {
        const double from = std::max(r1, distance), to = std::min(r2, std::hypot(distance, radius));
        if (!(to > from)) return 0.0;
        return std::numbers::pi * distance * distance / 2 * (std::pow(from, -4) - std::pow(to, -4));
    };
}

Truth sum(std::vector<Truth> parts) {
    return [parts = std::move(parts)](const BeamLimits& beam, double r1, double r2) {
        double total = 0;
        for (const Truth& part : parts) total += part(beam, r1, r2);
        return total;
    };
}

}  // namespace insonify::study
