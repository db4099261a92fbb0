// Edges compared with independent solutions: Keller's and Ufimtsev's formulas for the half-plane, and exact fields of
// strips and square cylinders by integral equations (ACOUSTICS.md 3.12).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>
#include <random>
#include <vector>

#include "components/acoustics/Wedge.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr Complex i{0, 1};

/** A point of the plane, or a vector. */
struct Vec {
    double x, y;
    Vec operator+(Vec o) const { return {x + o.x, y + o.y}; }
    Vec operator-(Vec o) const { return {x - o.x, y - o.y}; }
    Vec operator*(double f) const { return {x * f, y * f}; }
};
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
double length(Vec a) { return std::sqrt(dot(a, a)); }

Complex hankel0(double x) { return {std::cyl_bessel_j(0, x), std::cyl_neumann(0, x)}; }
Complex hankel1(double x) { return {std::cyl_bessel_j(1, x), std::cyl_neumann(1, x)}; }

/** Solves a dense system by elimination with pivots, for several right sides, which become the solutions. */
void solve(std::vector<std::vector<Complex>> a, std::vector<std::vector<Complex>>& sides) {
    const size_t n = a.size();
    for (size_t k = 0; k < n; ++k) {
        size_t pivot = k;
        for (size_t r = k + 1; r < n; ++r)
            if (std::abs(a[r][k]) > std::abs(a[pivot][k])) pivot = r;
        std::swap(a[k], a[pivot]);
        for (auto& side : sides) std::swap(side[k], side[pivot]);
        for (size_t r = k + 1; r < n; ++r) {
            const Complex factor = a[r][k] / a[k][k];
            for (size_t c = k; c < n; ++c) a[r][c] -= factor * a[k][c];
            for (auto& side : sides) side[r] -= factor * side[k];
        }
    }
    for (auto& side : sides)
        for (size_t k = n; k-- > 0;) {
            for (size_t c = k + 1; c < n; ++c) side[k] -= a[k][c] * side[c];
            side[k] /= a[k][k];
        }
}

/** A piece of a contour, with its normal into the water. */
struct Piece {
    Vec middle, normal;
    double size;
};

std::vector<Piece> makeLine(Vec from, Vec to, int count) {
    std::vector<Piece> pieces;
    const Vec way = (to - from) * (1.0 / count);
    // Smaller pieces at the ends, where fields grow.
    const auto at = [&](int k) { return from + (to - from) * ((1 - std::cos(pi * k / count)) / 2); };
    const double size = length(way);
    for (int k = 0; k < count; ++k)
        pieces.push_back({(at(k) + at(k + 1)) * 0.5, {way.y / size, -way.x / size}, length(at(k + 1) - at(k))});
    return pieces;
}

/** Far fields D of backscatter, u_s = D exp(i (k r + pi / 4)) / sqrt(2 pi k r), for directions of incidence. */
using Fields = std::vector<Complex>;

/** Field of a soft strip: the single layer on it vanishes with the incident wave, i/4 int H0 q = -u_i. */
Fields softStrip(double k, double width, const std::vector<double>& from) {
    const std::vector<Piece> pieces = makeLine({-width / 2, 0}, {width / 2, 0}, static_cast<int>(k * width * 2.5) + 40);
    const size_t n = pieces.size();
    constexpr double gamma = 1.781072417990198;
    std::vector<std::vector<Complex>> matrix(n, std::vector<Complex>(n)), sides;
    for (size_t r = 0; r < n; ++r)
        for (size_t c = 0; c < n; ++c) {
            const double size = pieces[c].size;
            if (r == c) {
                matrix[r][c] = i / 4.0 * size * (1.0 + 2.0 * i / pi * (std::log(gamma * k * size / 4) - 1));
                continue;
            }
            Complex sum = 0;  // by three points of Gauss
            for (const auto& [at, weight] :
                 {std::pair{-std::sqrt(0.6), 5.0 / 18}, {0.0, 8.0 / 18}, {std::sqrt(0.6), 5.0 / 18}})
                sum += weight * hankel0(k * std::abs(pieces[r].middle.x - pieces[c].middle.x - at * size / 2));
            matrix[r][c] = i / 4.0 * size * sum;
        }
    const auto wave = [&](double angle, Vec at) {
        return std::exp(-i * k * dot({std::cos(angle), std::sin(angle)}, at));
    };
    for (const double angle : from) {
        sides.emplace_back();
        for (const Piece& piece : pieces) sides.back().push_back(-wave(angle, piece.middle));
    }
    solve(matrix, sides);
    Fields fields;
    for (size_t a = 0; a < from.size(); ++a) {
        Complex sum = 0;
        for (size_t c = 0; c < n; ++c) sum += sides[a][c] * pieces[c].size * wave(from[a], pieces[c].middle);
        fields.push_back(sum / 2.0);  // i/4 H0(kr) = exp(i (kr + pi/4)) / (2 sqrt(2 pi k r))
    }
    return fields;
}

/** Field of a rigid square cylinder about the origin: u / 2 - int u dG/dn = u_i on it. */
Fields rigidSquare(double k, double width, const std::vector<double>& from) {
    const double h = width / 2;
    std::vector<Piece> pieces;
    const Vec corners[] = {{-h, -h}, {h, -h}, {h, h}, {-h, h}};
    for (int side = 0; side < 4; ++side)
        for (const Piece& piece :
             makeLine(corners[side], corners[(side + 1) % 4], static_cast<int>(k * width * 1.6) + 24))
            pieces.push_back(piece);
    const size_t n = pieces.size();
    std::vector<std::vector<Complex>> matrix(n, std::vector<Complex>(n)), sides;
    for (size_t r = 0; r < n; ++r)
        for (size_t c = 0; c < n; ++c) {
            if (r == c) {
                matrix[r][c] = 0.5;
                continue;
            }
            const Vec along{-pieces[c].normal.y, pieces[c].normal.x};
            Complex sum = 0;
            for (const auto& [at, weight] :
                 {std::pair{-std::sqrt(0.6), 5.0 / 18}, {0.0, 8.0 / 18}, {std::sqrt(0.6), 5.0 / 18}}) {
                const Vec way = pieces[r].middle - pieces[c].middle - along * (at * pieces[c].size / 2);
                const double distance = length(way);
                sum += weight * i * k / 4.0 * hankel1(k * distance) * dot(way, pieces[c].normal) / distance;
            }
            matrix[r][c] = -sum * pieces[c].size;
        }
    const auto wave = [&](double angle, Vec at) {
        return std::exp(-i * k * dot({std::cos(angle), std::sin(angle)}, at));
    };
    for (const double angle : from) {
        sides.emplace_back();
        for (const Piece& piece : pieces) sides.back().push_back(wave(angle, piece.middle));
    }
    solve(matrix, sides);
    Fields fields;
    for (size_t a = 0; a < from.size(); ++a) {
        Complex sum = 0;
        const Vec to{std::cos(from[a]), std::sin(from[a])};
        for (size_t c = 0; c < n; ++c)
            sum += sides[a][c] * pieces[c].size * dot(to, pieces[c].normal) * wave(from[a], pieces[c].middle);
        fields.push_back(-i * k * sum / 2.0);
    }
    return fields;
}

/** Physical optics of a lit face of a width about a place, in the units of D; positive for a rigid face. */
Complex computeOptics(double k, double width, Vec middle, Vec normal, double angle) {
    const Vec to{std::cos(angle), std::sin(angle)};
    const double cosine = dot(to, normal);
    if (cosine <= 0) return 0;
    const double phase = k * width * std::sqrt(1 - std::min(cosine * cosine, 1.0));
    const double sinc = phase > 1e-9 ? std::sin(phase) / phase : 1;
    return -i * k * cosine * width * sinc * std::exp(-2.0 * i * k * dot(to, middle));
}

TEST(WedgeTest, AHalfPlaneHasKellersCoefficients) {
    for (double angle = 0.01; angle < 2 * pi; angle += 0.0137) {
        const double rigid = wedgeEcho(WedgeFaces::Rigid, 2 * pi, angle).total();
        const double soft = wedgeEcho(WedgeFaces::Soft, 2 * pi, angle).total();
        const double secant = 1 / std::cos(angle);
        EXPECT_NEAR(rigid, -(1 + secant) / 2, 1e-9 * std::abs(1 + secant)) << angle;
        EXPECT_NEAR(soft, -(1 - secant) / 2, 1e-9 * std::abs(1 - secant)) << angle;
    }
}

TEST(WedgeTest, AnyWedgeHasKellersCoefficients) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        const double exterior = std::uniform_real_distribution(pi, 2 * pi)(random), n = exterior / pi;
        const double angle = std::uniform_real_distribution(0.0, exterior)(random);
        const double scale = std::sin(pi / n) / n, direct = scale / (std::cos(pi / n) - 1);
        const double reflected = scale / (std::cos(pi / n) - std::cos(2 * angle / n));
        const double rounding = 1e-9 * (1 + std::pow(reflected, 2));
        EXPECT_NEAR(wedgeEcho(WedgeFaces::Rigid, exterior, angle).total(), direct + reflected, rounding);
        EXPECT_NEAR(wedgeEcho(WedgeFaces::Soft, exterior, angle).total(), direct - reflected, rounding);
    }
}

TEST(WedgeTest, APlaneHasNoEdge) {
    for (const WedgeFaces faces : {WedgeFaces::Rigid, WedgeFaces::Soft})
        for (double angle = 0; angle <= pi; angle += 0.01) {
            const WedgeEcho echo = wedgeEcho(faces, pi, angle);
            EXPECT_NEAR(echo.fringe, 0, 1e-9) << angle;
            if (std::abs(angle - pi / 2) > 0.02) {
                EXPECT_NEAR(echo.total(), 0, 1e-9) << angle;
            }
        }
}

TEST(WedgeTest, TheFringeIsFiniteAndContinuousEverywhere) {
    std::mt19937 random(6);
    double maximum = 0, step = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const double exterior = std::uniform_real_distribution(pi, 2 * pi)(random);
        const double special[] = {0, pi / 2, pi, exterior - pi / 2, exterior - pi, exterior};
        double angle = special[trial % 6];
        if (trial % 12 > 5) angle = std::uniform_real_distribution(0.0, exterior)(random);
        for (const WedgeFaces faces : {WedgeFaces::Rigid, WedgeFaces::Soft}) {
            const double at = wedgeEcho(faces, exterior, std::clamp(angle, 0.0, exterior)).fringe;
            ASSERT_TRUE(std::isfinite(at)) << exterior << ", " << angle;
            for (const double way : {-1.0, 1.0}) {
                const double nearby = std::clamp(angle + way * 1e-7, 0.0, exterior);
                step = std::max(step, std::abs(wedgeEcho(faces, exterior, nearby).fringe - at));
            }
            maximum = std::max(maximum, std::abs(at));
        }
    }
    EXPECT_LT(maximum, 1.01);
    EXPECT_LT(step, 1e-6) << "within 1e-7 rad";
    std::cout << "largest fringe " << maximum << ", largest step " << step << "\n";
}

TEST(WedgeTest, FacesMayBeCountedFromEitherSide) {
    for (double angle = 0; angle <= 1.5 * pi; angle += 0.01) {
        const WedgeEcho one = wedgeEcho(WedgeFaces::Rigid, 1.5 * pi, angle);
        const WedgeEcho other = wedgeEcho(WedgeFaces::Rigid, 1.5 * pi, 1.5 * pi - angle);
        EXPECT_NEAR(one.fringe, other.fringe, 1e-9);
    }
}

/** Angles over a quarter of a turn. */
std::vector<double> quarter(double from, double to, double step) {
    std::vector<double> all;
    for (double angle = from; angle <= to + 1e-9; angle += step) all.push_back(angle * pi / 180);
    return all;
}

TEST(WedgeTest, ASoftStripIsItsTwoEdges) {
    const double k = 2 * pi, width = 5;  // in wavelengths
    const std::vector<double> angles = quarter(2, 90, 2);
    const Fields exact = softStrip(k, width, angles);
    double optics_error = 0, error = 0, norm = 0;
    for (size_t a = 0; a < angles.size(); ++a) {
        const Vec to{std::cos(angles[a]), std::sin(angles[a])};
        const Complex optics = -computeOptics(k, width, {0, 0}, {0, 1}, angles[a]);
        Complex sum = optics;
        for (const double side : {-1.0, 1.0}) {  // the face of the right edge is to its left
            const double from_face = side < 0 ? angles[a] : pi - angles[a];
            sum += wedgeEcho(WedgeFaces::Soft, 2 * pi, from_face).fringe *
                   std::exp(-2.0 * i * k * dot(to, {side * width / 2, 0}));
        }
        error += std::norm(sum - exact[a]);
        optics_error += std::norm(optics - exact[a]);
        if (angles[a] < 1.4) norm += std::norm(exact[a]);
    }
    std::cout << "soft strip: relative error " << std::sqrt(error / norm) << ", of physical optics alone "
              << std::sqrt(optics_error / norm) << " (L2, off the main lobe)\n";
    EXPECT_LT(std::sqrt(error / norm), 0.02);
    EXPECT_GT(std::sqrt(optics_error / norm), 0.4);
}

TEST(WedgeTest, ARigidSquareIsItsFacesAndEdges) {
    const double k = 2 * pi, width = 4.4;  // far from the resonances of a soft box, width = sqrt(m^2 + n^2) / 2
    const std::vector<double> angles = quarter(1, 45, 1);
    const Fields exact = rigidSquare(k, width, angles);
    double optics_error = 0, error = 0, unshaded = 0, norm = 0;
    for (size_t a = 0; a < angles.size(); ++a) {
        const double angle = angles[a], h = width / 2;
        const Vec to{std::cos(angle), std::sin(angle)};
        const auto edge = [&](Vec at, double coefficient) {
            return coefficient * std::exp(-2.0 * i * k * dot(to, at));
        };
        const auto wedge = [&](double from_face) { return wedgeEcho(WedgeFaces::Rigid, 1.5 * pi, from_face); };
        const Complex optics =
            computeOptics(k, width, {h, 0}, {1, 0}, angle) + computeOptics(k, width, {0, h}, {0, 1}, angle);
        const Complex keller = optics + edge({h, h}, wedge(pi / 2 + angle).fringe) +
                               edge({h, -h}, wedge(pi / 2 - angle).fringe) + edge({-h, h}, wedge(angle).fringe);
        const double share = grazingShare(false, k * width, angle);  // along the face y = h
        const Complex sum = keller + edge({-h, h}, (share * share - 1) * wedge(angle).total());
        if (angle < 0.12) unshaded = std::max(unshaded, std::abs(keller - exact[a]) / std::abs(sum - exact[a]));
        if (angle < 0.24) continue;  // the main lobe of a face
        error += std::norm(sum - exact[a]);
        optics_error += std::norm(optics - exact[a]);
        norm += std::norm(exact[a]);
    }
    std::cout << "rigid square: relative error " << std::sqrt(error / norm) << ", of physical optics alone "
              << std::sqrt(optics_error / norm) << " (L2, off the main lobe); near grazing up to " << unshaded
              << " times less than without the share that passes\n";
    EXPECT_LT(std::sqrt(error / norm), 0.25) << "what two edges scatter to one another is missing";
    EXPECT_GT(std::sqrt(optics_error / norm), 0.35);
    EXPECT_GT(unshaded, 1.5);
}

}  // namespace
}  // namespace insonify::acoustics
