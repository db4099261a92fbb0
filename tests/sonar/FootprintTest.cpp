// A cell's echo in its bins, compared with the same cell cut into many points, each of which counts once:
// ACOUSTICS.md 4.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "components/sonar/bins/Estimators.hpp"

namespace insonify::sonar {
namespace {

#include "shaders/picture.glsl"
#include "shaders/plane.glsl"

constexpr double infinity = std::numeric_limits<double>::infinity();

/** 600 bins of 0.1 m, filled by the deposit's shared code. */
struct PointBins {
    static constexpr uint bin_count = 600;
    static constexpr double bin_width = 0.1;
    std::vector<double> sums = std::vector<double>(bin_count);

    double binEdge(uint k) const { return k == 0 ? 1e3 : 1 / (k * bin_width); }
    uint findBin(double place) const { return min(uint(1.0 / (place * bin_width)), bin_count - 1u); }
    void addToBin(uint, uint bin, double amount, double) { sums[bin] += amount; }
    /** A point of solid angle `share` at range r on a plane of unit Lambert parameter, `distance` away. */
    void addPoint(double r, double distance, double share) {
        const auto bin = static_cast<uint>(r / bin_width);
        const double relative = (bin + 0.5) * bin_width / r;
        if (bin < bin_count) sums[bin] += distance / r * share * relative * relative;
    }
    double energy() const {
        double sum = 0;
        for (const double e : sums) sum += e;
        return sum;
    }
    int occupied() const {
        return static_cast<int>(std::ranges::count_if(sums, [](double e) { return e > 0; }));
    }
#define HAVE_PHYSICAL
#include "shaders/deposit.glsl"
#undef HAVE_PHYSICAL
};

double relativeL2(const PointBins& got, const PointBins& expected) {
    double error = 0, norm = 0;
    for (uint k = 0; k < PointBins::bin_count; ++k) {
        error += (got.sums[k] - expected.sums[k]) * (got.sums[k] - expected.sums[k]);
        norm += expected.sums[k] * expected.sums[k];
    }
    return sqrt(error / norm);
}

/** Plane n.p = distance, n of unit length. */
struct Plane {
    std::array<double, 3> n;
    double distance;

    Plane(double azimuth, double elevation, double d)
        : n{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)},
          distance(d) {}
    double inverseRange(double x, double y, double z) const {
        return (n[0] * x + n[1] * y + n[2] * z) / (distance * sqrt(x * x + y * y + z * z));
    }
    /** Returns the footprint of a cell of an extent [rad] and a solid angle [1] about an azimuth and an elevation. */
    PlaneFootprint seen(double azimuth, double elevation, double width, double height, double size,
                        double far_edge = 0) const {
        return planeFootprint(n[0], n[1], n[2], distance, std::cos(azimuth), std::sin(azimuth), std::cos(elevation),
                              std::sin(elevation), width, height, 0, size, infinity, 0, 1e3, far_edge);
    }
};

const Plane bottom(0, -std::numbers::pi / 2, 3), slope(0.4, -1.2, 3), wall(0.3, 0.2, 10);

constexpr int parts = 1000;  ///< Points of a cell along each axis.

/** Middles of `parts` equal parts of [from, to]. */
double part(double from, double to, int i) { return from + (to - from) * (i + 0.5) / parts; }

/** A cell of the picture: the middle of its pixel, of which it is the columns [from, to], and the aperture's edge. */
struct ShareOfPixel {
    double u, v, from, to, size, limit = infinity;
    bool upright = false;  ///< Not sheared, the wrong variant.

    void deposit(const Plane& plane, PointBins& bins) const {
        const double middle = (from + to) / 2, shear = upright ? 0 : u / (1 + u * u);
        const PictureRow row = pictureRow(v + v * shear * (middle - u), size, -limit, limit);
        const PictureCell cell = pictureCell(middle, row.middle, to - from, row.rise, 1 / (size * size));
        const PlaneFootprint seen = plane.seen(std::atan(middle), std::atan(row.middle / std::hypot(1, middle)),
                                               cell.width, cell.height, cell.size, bins.binEdge(PointBins::bin_count));
        bins.depositCell(seen.footprint, 0, seen.perpendicular);
    }
    /** Adds the points between curves of constant elevation. */
    void cut(const Plane& plane, PointBins& bins) const {
        for (int i = 0; i < parts; ++i)
            for (int j = 0; j < parts; ++j) {
                const double at = part(from, to, i), lean = sqrt((1 + at * at) / (1 + u * u));
                const double height = part(v - size / 2, v + size / 2, j) * lean, q2 = 1 + at * at + height * height;
                const double share = (to - from) * lean / (size * parts * parts * q2 * sqrt(q2));
                if (abs(height) > limit) continue;
                bins.addPoint(1 / plane.inverseRange(1, at, height), plane.distance, share);
            }
    }
};

/** A cell da x de about (a, e), its solid angle relative to a cell at elevation 0. */
struct AngularCell {
    double a, e, da, de;

    void deposit(const Plane& plane, PointBins& bins) const {
        const double size = (std::sin(e + de / 2) - std::sin(e - de / 2)) / de;
        const PlaneFootprint seen = plane.seen(a, e, da, de, size, bins.binEdge(PointBins::bin_count));
        bins.depositCell(seen.footprint, 0, seen.perpendicular);
    }
    void cut(const Plane& plane, PointBins& bins) const {
        for (int i = 0; i < parts; ++i)
            for (int j = 0; j < parts; ++j) {
                const double at = part(a - da / 2, a + da / 2, i), up = part(e - de / 2, e + de / 2, j);
                const double level = std::cos(up);
                const double g = plane.inverseRange(level * std::cos(at), level * std::sin(at), std::sin(up));
                bins.addPoint(1 / g, plane.distance, level / (parts * parts));
            }
    }
};

/** Expects the deposit to follow the cut: bins to `in_bins` (relative L2), their sum to `in_all`. */
void expectFollows(const auto& cell, const Plane& plane, double in_bins, double in_all) {
    PointBins got, expected;
    cell.deposit(plane, got);
    cell.cut(plane, expected);
    EXPECT_GT(expected.occupied(), 0);
    EXPECT_LT(relativeL2(got, expected), in_bins) << expected.occupied() << " bins";
    EXPECT_NEAR(got.energy() / expected.energy(), 1, in_all);
}

TEST(FootprintTest, ACellIsAsDeepAsTheInverseRangeChangesOverIt) {
    constexpr double step = 1e-6;
    for (const Plane& plane : {bottom, slope, wall})
        for (const auto& [azimuth, elevation] : {std::pair{0.0, -0.15}, {0.5, -0.3}, {-0.4, -0.5}}) {
            const auto inverse = [&](double a, double e) {
                return plane.inverseRange(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
            };
            const double width = 0.001, height = 0.002;
            const PlaneFootprint seen = plane.seen(azimuth, elevation, width, height, 1);
            EXPECT_NEAR(seen.footprint.pixel, inverse(azimuth, elevation), 1e-12);
            EXPECT_NEAR(seen.perpendicular, plane.distance, 1e-12);
            EXPECT_NEAR(seen.footprint.nearest, 1 / plane.distance, 1e-12);
            const double across =
                             abs(inverse(azimuth + step, elevation) - inverse(azimuth - step, elevation)) / (2 * step),
                         along =
                             abs(inverse(azimuth, elevation + step) - inverse(azimuth, elevation - step)) / (2 * step);
            EXPECT_NEAR(seen.footprint.wide, max(across * width, along * height), 1e-11);
            EXPECT_NEAR(seen.footprint.narrow, min(across * width, along * height), 1e-11);
        }
    EXPECT_EQ(bottom.seen(0, 0.1, 0.01, 0.01, 1).footprint.pixel, 0) << "behind";
    EXPECT_EQ(bottom.seen(0, -0.99e-4, 0.01, 0.01, 1).footprint.pixel, 0) << "edge-on";
}

TEST(FootprintTest, ACellOfThePictureCoversTheBinsThatItsPointsDo) {
    expectFollows(ShareOfPixel{0.3, -0.12, 0.298, 0.302, 0.004}, bottom, 0.005, 5e-4);
    expectFollows(ShareOfPixel{0.3, -0.12, 0.298, 0.302, 0.004}, slope, 0.005, 5e-4);
    expectFollows(ShareOfPixel{0.3, -0.12, 0.301, 0.302, 0.004}, slope, 0.005, 5e-4);
    expectFollows(ShareOfPixel{0.5, 0.5, 0.48, 0.52, 0.04}, wall, 0.05, 3e-3);
    ShareOfPixel wide{0.3, -0.12, 0.25, 0.35, 0.004};
    expectFollows(wide, bottom, 0.01, 2e-3);
    ShareOfPixel aside{0.3, -0.12, 0.325, 0.35, 0.004};
    const auto off = [&] {
        PointBins got, expected;
        aside.deposit(bottom, got);
        aside.cut(bottom, expected);
        return relativeL2(got, expected);
    };
    const double leaning = off();
    EXPECT_LT(leaning, 0.1) << "its height is the pixel's; over both halves of the pixel that cancels";
    aside.upright = true;
    EXPECT_GT(off(), 3 * leaning) << "an upright cell covers others";
}

TEST(FootprintTest, ACellIsClippedAtTheAperture) {
    ShareOfPixel cell{0.3, -0.12, 0.298, 0.302, 0.004};
    PointBins whole, clipped;
    cell.deposit(bottom, whole);
    cell.limit = 0.119;
    cell.deposit(bottom, clipped);
    EXPECT_NEAR(clipped.energy() / whole.energy(), 0.25, 0.01) << "a quarter is above v = -0.119";
    expectFollows(cell, bottom, 0.02, 1e-2);
}

TEST(FootprintTest, ACellOfAzimuthAndElevationCoversTheBinsThatItsPointsDo) {
    expectFollows(AngularCell{0.3, -0.12, 0.004, 0.004}, bottom, 0.005, 5e-4);
    expectFollows(AngularCell{0.3, -0.12, 0.004, 0.004}, slope, 0.005, 5e-4);
    expectFollows(AngularCell{-0.2, -0.4, 0.02, 0.005}, slope, 0.01, 5e-4);
    expectFollows(AngularCell{0.5, 0.5, 0.04, 0.04}, wall, 0.05, 5e-4);
    expectFollows(AngularCell{0.3, -1.5, 0.04, 0.01}, bottom, 0.01, 5e-4);  // nearly straight down
}

/** A cell da x de about (a, e) of a sphere of `radius` about (distance, 0, 0). */
struct CellOfSphere {
    double radius, distance, a, e, da, de;

    /** Returns the range of the sphere in a direction, and the cosine of incidence. */
    std::pair<double, double> at(double azimuth, double elevation) const {
        const double ahead = distance * std::cos(elevation) * std::cos(azimuth);
        const double limb_square = distance * distance - radius * radius;
        const double range = ahead - sqrt(ahead * ahead - limb_square);
        return {range, (limb_square - range * range) / (2 * radius * range)};
    }
    void deposit(double curvature, PointBins& bins) const {
        const double range = at(a, e).first, level = std::cos(e);
        const std::array<double, 3> n = {(distance - range * level * std::cos(a)) / radius,
                                         -range * level * std::sin(a) / radius, -range * std::sin(e) / radius};
        const double perpendicular = range * (level * (n[0] * std::cos(a) + n[1] * std::sin(a)) + n[2] * std::sin(e));
        const double size = (std::sin(e + de / 2) - std::sin(e - de / 2)) / de;
        const double far_edge = bins.binEdge(PointBins::bin_count);
        const PlaneFootprint seen = planeFootprint(n[0], n[1], n[2], perpendicular, std::cos(a), std::sin(a), level,
                                                   std::sin(e), da, de, 0, size, infinity, 0, 1e3, far_edge);
        Footprint cell = seen.footprint;
        double length = seen.perpendicular;
        EXPECT_NEAR(1 / cell.pixel, range, 1e-9);
        if (curvature > 0) {
            length = bend(
                cell, {curvature, perpendicular, da, de, level, cell.pixel - cell.centre, infinity, 0, 1e3, far_edge});
            EXPECT_NEAR(1 / cell.limb, sqrt(distance * distance - radius * radius), 1e-9);
            EXPECT_NEAR(1 / cell.nearest, distance - radius, 1e-9);
        }
        bins.depositCell(cell, 0, length);
    }
    void cut(PointBins& bins) const {
        for (int i = 0; i < parts; ++i)
            for (int j = 0; j < parts; ++j) {
                const double up = part(e - de / 2, e + de / 2, j);
                const auto [range, cosine] = at(part(a - da / 2, a + da / 2, i), up);
                bins.addPoint(range, cosine * range, std::cos(up) / (parts * parts));
            }
    }
};

TEST(FootprintTest, ACellOfASphereCoversTheBinsThatItsPointsDo) {
    for (const CellOfSphere& cell :
         {CellOfSphere{4, 10, 0.1, 0.05, 0.02, 0.03}, CellOfSphere{4, 10, -0.05, 0.3, 0.01, 0.05},
          CellOfSphere{8, 20, 0.25, -0.2, 0.04, 0.02}, CellOfSphere{4, 10, 0, 0.39, 0.001, 0.03}}) {
        PointBins got, flat, expected;
        cell.deposit(1 / cell.radius, got);
        cell.deposit(0, flat);
        cell.cut(expected);
        EXPECT_LT(relativeL2(got, expected), 0.04) << cell.e;
        EXPECT_NEAR(got.energy() / expected.energy(), 1, 0.01) << cell.e;
        EXPECT_GT(relativeL2(flat, expected), 2 * relativeL2(got, expected)) << "a plane has other bins";
    }
}

}  // namespace
}  // namespace insonify::sonar
