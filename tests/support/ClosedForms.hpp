#pragma once
// Echoes with a closed form (ACOUSTICS.md 9, with S0 = 1), and the deviation of a ping from a form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <vector>

#include "types/samples/Sonar.hpp"

namespace insonify::test {

/** Energy between slant ranges [r1, r2] in one beam, or the mean of S there. */
using Form = std::function<double(double r1, double r2)>;

/** The deviation of a ping from a form that applies to all of its beams. */
struct Deviation {
    double relative_l2;  ///< Over all bins of all beams [1].
    double worst_db;     ///< Over the bins above -40 dB of the form's maximum [dB].
    double ripple;       ///< rms over the beams of energy / energy of the form - 1 [1].
    bool small() const { return relative_l2 < 0.01 && worst_db < 0.2 && ripple < 0.01; }
};

inline Deviation deviation(const types::Sonar& ping, const Form& form) {
    std::vector<double> expected(ping.bin_count);
    for (uint32_t k = 0; k < ping.bin_count; ++k) expected[k] = form(ping.binStart(k), ping.binStart(k + 1));
    const double floor = *std::max_element(expected.begin(), expected.end()) * 1e-4;
    double error = 0, norm = 0, worst = 0, ripple = 0;
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
        double sum = 0, truth = 0;
        for (uint32_t k = 0; k < ping.bin_count; ++k) {
            const double got = ping.bins[beam * ping.bin_count + k], e = expected[k];
            error += (got - e) * (got - e);
            norm += e * e;
            sum += got;
            truth += e;
            if (e > floor) worst = std::max(worst, got > 0 ? std::abs(10 * std::log10(got / e)) : 999);
        }
        ripple += (sum / truth - 1) * (sum / truth - 1) / ping.beam_count;
    }
    return {std::sqrt(error / norm), worst, std::sqrt(ripple)};
}

inline std::ostream& operator<<(std::ostream& out, const Deviation& d) {
    return out << "relative L2 " << d.relative_l2 << ", worst " << d.worst_db << " dB, ripple " << d.ripple;
}

/** Expects that the ping follows `right`, and that the same measure detects that it does not follow `wrong`. */
inline void expectForm(const types::Sonar& ping, const Form& right, const Form& wrong) {
    const Deviation d = deviation(ping, right);
    EXPECT_TRUE(d.small()) << d;
    EXPECT_FALSE(deviation(ping, wrong).small()) << "a wrong form passed: " << deviation(ping, wrong);
    testing::Test::RecordProperty("relative_l2", std::to_string(d.relative_l2));
}

inline Form times(double factor, Form form) {
    return [=](double r1, double r2) { return factor * form(r1, r2); };
}

/** The bins of a ping of one beam. */
inline Form getForm(const types::Sonar& ping) {
    return [=](double r1, double) { return ping.bins[static_cast<size_t>(r1 / ping.binStart(1) + 0.5)]; };
}

/** The part of `form` between two ranges; nothing elsewhere. */
inline Form between(double first, double last, Form form) {
    return [=](double r1, double r2) {
        const double from = std::max(r1, first), to = std::min(r2, last);
        return to <= from ? 0.0 : form(from, to);
    };
}

/** Midpoint rule. */
inline double integral(double from, double to, const std::function<double(double)>& f) {
    constexpr int steps = 200;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += f(from + (to - from) * (i + 0.5) / steps);
    return sum * (to - from) / steps;
}

/** Integral of r^-5. */
inline double inverseFourth(double r1, double r2) { return 0.25 * (std::pow(r1, -4) - std::pow(r2, -4)); }

/** Form 1: a plane at perpendicular distance D, visible in a disc around the foot of the perpendicular out to slant
 *  range `edge`; beta is the two-way absorption [1/m]. */
inline Form planeDisc(double distance, double edge, double mu, double beta = 0) {
    return between(distance, edge, [=](double r1, double r2) {
        const auto density = [=](double r) { return std::pow(r, -5) * std::exp(-beta * r); };
        return mu * distance * distance * 2 * std::numbers::pi * integral(r1, r2, density);
    });
}

/** Form 2: a flat bottom `height` under a level fan that looks down by `elevation`; beams `delta` wide [rad]. */
inline Form flatBottom(double height, double elevation, double delta) {
    return between(height / std::sin(elevation), 1e9,
                   [=](double r1, double r2) { return height * height * delta * inverseFourth(r1, r2); });
}

/** Form 2 without cos(theta): wrong. */
inline Form flatBottomWithoutCosine(double height, double elevation, double delta) {
    return between(height / std::sin(elevation), 1e9,
                   [=](double r1, double r2) { return height * delta * (std::pow(r1, -3) - std::pow(r2, -3)) / 3; });
}

/** Form 3: a flat bottom under a thin beam pitched down, of half aperture `half`. `tilt` is the pitch; any other value
 *  is wrong [rad]. */
inline Form pitchedBottom(double height, double pitch, double half, double delta, double tilt) {
    const auto f4 = [](double p) { return 3 * p / 8 - std::sin(2 * p) / 4 + std::sin(4 * p) / 32; };
    return between(height / std::sin(pitch + half), height / std::sin(pitch - half), [=](double r1, double r2) {
        return delta * (std::cos(tilt) * height * height * inverseFourth(r1, r2) +
                        std::sin(tilt) / (height * height) * (f4(std::asin(height / r1)) - f4(std::asin(height / r2))));
    });
}

/** Form 4: a sphere of radius a. */
inline Form sphereEcho(double a, double centre) {
    const double q = centre * centre - a * a;
    const auto antiderivative = [=](double r) { return -q * q / (4 * std::pow(r, 4)) + q / (r * r) + std::log(r); };
    return between(centre - a, std::sqrt(q), [=](double r1, double r2) {
        return std::numbers::pi / (2 * a * centre) * (antiderivative(r2) - antiderivative(r1));
    });
}

/** Form 5: a wall ahead of a thin vertical beam of half aperture `half` and width `delta` [rad]. */
inline Form thinBeamOnWall(double distance, double half, double delta) {
    const auto g4 = [=](double r) {
        const double p = std::acos(distance / r);
        return 3 * p / 8 + std::sin(2 * p) / 4 + std::sin(4 * p) / 32;
    };
    return between(distance, distance / std::cos(half),
                   [=](double r1, double r2) { return 2 * delta / (distance * distance) * (g4(r2) - g4(r1)); });
}

/** Form 5 as if the wall fell off at 0.2 /m: wrong. */
inline Form thinBeamOnFadingWall(double distance, double half, double delta) {
    const Form form = thinBeamOnWall(distance, half, delta);
    return [=](double r1, double r2) { return form(r1, r2) * std::exp(-0.2 * (std::max(r1, distance) - distance)); };
}

/** S of cerqueira2017. */
inline double sigmoid(double x) { return 0.5 + 0.5 * std::tanh(9 * (x - 2.0 / 3)); }

/** Mean of S(cosine(r)) over a bin, each range weighted by the solid angle that it takes. */
inline Form publishedMean(const std::function<double(double)>& cosine, const std::function<double(double)>& weight) {
    return [=](double r1, double r2) {
        const auto weighted = [=](double r) { return weight(r) * sigmoid(cosine(r)); };
        return integral(r1, r2, weighted) / integral(r1, r2, weight);
    };
}

/** cerqueira2017 over a flat bottom, seen as in form 2: S(D/r). */
inline Form publishedBottom(double height, double elevation) {
    return between(height / std::sin(elevation), 1e9,
                   publishedMean([=](double r) { return height / r; }, [](double r) { return 1 / (r * r); }));
}

/** cerqueira2017 on a sphere of radius a: S((centre^2 - a^2 - r^2) / (2 a r)). */
inline Form publishedSphere(double a, double centre) {
    const double q = centre * centre - a * a;
    return between(centre - a, std::sqrt(q),
                   publishedMean([=](double r) { return (q - r * r) / (2 * a * r); },
                                 [=](double r) { return (q - r * r) / (r * r); }));
}

/** Form 8: slant range at the end of the shadow of an object of height h on the bottom, under a sonar of height H;
 *  `ground_range` is the object's horizontal distance [m]. */
inline double shadowEnd(double sonar_height, double object_height, double ground_range) {
    const double above = sonar_height - object_height;
    return std::hypot(ground_range, above) * sonar_height / above;
}

}  // namespace insonify::test
