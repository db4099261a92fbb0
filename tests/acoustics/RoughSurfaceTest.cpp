// Backscatter of rough solids, compared with closed forms, limits and the conservation of energy (ACOUSTICS.md 3.11).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/RoughSurface.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

const HalfSpace steel_space{7850.0 / 1025, 5900.0 / 1500, 1e-4};

/** Returns the integral over K of f(K) 2 pi K, in logarithmic steps. */
double overWaves(double low, double high, const auto& f) {
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double k = low * std::pow(high / low, (i + 0.5) / steps);
        sum += f(k) * 2 * pi * k * k * std::log(high / low) / steps;
    }
    return sum;
}

/** Returns the share of a wave's energy at an angle of incidence that a surface returns: that of its lobe and, by
 *  reciprocity, the scattering into each direction as the root of the cross sections of both directions. */
double energyBack(const RoughSurface& surface, double incidence) {
    constexpr int steps = 2000;
    double scattered = 0;
    for (int i = 0; i < steps; ++i) {
        const double out = (i + 0.5) / steps * pi / 2;
        scattered += std::sqrt(surface.diffuse(pi / 2 - incidence) * surface.diffuse(pi / 2 - out)) * std::sin(out);
    }
    scattered *= 2 * pi * (pi / 2 / steps) / std::cos(incidence);
    return scattered + std::pow(surface.reflection(), 2) * surface.lobeShare();
}

TEST(RoughSurfaceTest, HeightsAndSlopesAreIntegralsOfTheSpectrum) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-1, 1);
    for (int i = 0; i < 10; ++i) {
        const Relief relief{1e-4 * std::pow(10, exponent(random)), 1e-3 * std::pow(10, exponent(random))};
        const double cut = std::pow(10, exponent(random)) / relief.length, low = 1e-5 / relief.length;
        const double above = overWaves(cut, 1e7 / relief.length, [&](double k) { return relief.spectrum(k); });
        const double below = overWaves(low, cut, [&](double k) { return relief.spectrum(k); });
        const double slope = overWaves(low, cut, [&](double k) { return k * k * relief.spectrum(k); });
        EXPECT_NEAR(relief.squareHeightAbove(cut) / above, 1, 1e-4);
        EXPECT_NEAR(relief.squareHeightBelow(cut) / below, 1, 1e-4);
        EXPECT_NEAR(relief.squareSlopeBelow(cut) / slope, 1, 1e-4);
        EXPECT_NEAR(relief.squareHeightAbove(cut) + relief.squareHeightBelow(cut), relief.height * relief.height,
                    1e-12 * relief.height * relief.height);
    }
}

TEST(RoughSurfaceTest, TheReflectionIsThatOfTheImpedanceInTheWater) {
    const RoughSurface surface(steel_space, {1e-5, 1e-4}, 3770);
    EXPECT_NEAR(surface.reflection(), (46.315 - 1.5375) / (46.315 + 1.5375), 1e-6);
    EXPECT_NEAR(surface.reflection(), halfSpaceReflection({7850.0 / 1025, 5900.0 / 1500, 0}, pi / 2).real(), 1e-12);
    EXPECT_NEAR(RoughSurface({1, 1, 0}, {1e-5, 1e-4}, 3770).reflection(), 0, 1e-15) << "water in water";
}

TEST(RoughSurfaceTest, ASurfaceWithoutHeightIsAMirror) {
    double last_share = 0, last_slope = 1, last_diffuse = 1;
    for (const double height : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
        const RoughSurface surface(steel_space, {height, 1e-3}, 3770);
        EXPECT_GE(surface.lobeShare(), last_share);
        EXPECT_LT(surface.squareSlope(), last_slope);
        EXPECT_LT(surface.diffuse(pi / 4), last_diffuse);
        last_share = surface.lobeShare(), last_slope = surface.squareSlope(), last_diffuse = surface.diffuse(pi / 4);
    }
    EXPECT_NEAR(last_share, 1, 1e-6);
    EXPECT_LT(last_slope, 1e-12);
    EXPECT_LT(last_diffuse, 1e-7);
    const RoughSurface mirror(steel_space, {0, 1e-3}, 3770);
    EXPECT_EQ(mirror.lobeShare(), 1);
    EXPECT_EQ(mirror.squareSlope(), 0);
    EXPECT_EQ(mirror.diffuse(1), 0);
    EXPECT_TRUE(std::isfinite(solidSection(mirror, pi / 2)));
}

TEST(RoughSurfaceTest, GreatHeightsFollowLambertsLawOfAllThatIsReflected) {
    const RoughSurface surface(steel_space, {0.02, 0.02}, 3770);
    EXPECT_LT(surface.lobeShare(), 1e-12);
    const double mu = std::pow(surface.reflection(), 2) / pi;
    for (const double grazing_deg : {20.0, 45.0, 70.0, 90.0}) {
        const double sine = std::sin(grazing_deg * pi / 180);
        EXPECT_NEAR(solidSection(surface, grazing_deg * pi / 180), mu * sine * sine, 1e-9) << grazing_deg;
    }
}

TEST(RoughSurfaceTest, SmallHeightsFollowSmallPerturbations) {
    const Relief relief{2e-6, 1e-3};
    const double k = 3770;
    // A rigid surface scatters 4 k^4 (1 + sin^2)^2 W(2 k sin) by the angle of incidence, a soft surface 4 k^4 cos^4 W.
    const RoughSurface rigid({1e6, 1e3, 0}, relief, k), soft({1e-6, 0.2, 0}, relief, k);
    for (const double incidence_deg : {35.0, 45.0, 55.0}) {
        const double incidence = incidence_deg * pi / 180, sine = std::sin(incidence), cosine = std::cos(incidence);
        const double scale = 4 * std::pow(k, 4) * relief.spectrum(2 * k * sine);
        EXPECT_NEAR(rigid.perturbation(pi / 2 - incidence) / (scale * std::pow(1 + sine * sine, 2)), 1, 1e-3);
        EXPECT_NEAR(soft.perturbation(pi / 2 - incidence) / (scale * std::pow(cosine, 4)), 1, 1e-3);
        EXPECT_EQ(soft.diffuse(pi / 2 - incidence), soft.perturbation(pi / 2 - incidence));
    }
    // Twice the height scatters four times the energy.
    const RoughSurface twice({1e-6, 0.2, 0}, {4e-6, 1e-3}, k);
    EXPECT_NEAR(twice.diffuse(pi / 4) / soft.diffuse(pi / 4), 4, 1e-9);
}

TEST(RoughSurfaceTest, NoEnergyIsCreated) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> u(0, 1);
    const auto between = [&](double low, double high) { return low * std::pow(high / low, u(random)); };
    for (int i = 0; i < 300; ++i) {
        const HalfSpace solid{between(1e-3, 20), between(0.1, 5), between(1e-9, 0.1)};
        const Relief relief{between(1e-8, 0.1), between(1e-6, 1)};
        const RoughSurface surface(solid, relief, 2 * pi * between(1e4, 3e6) / 1500);
        const double reflected = std::pow(surface.reflection(), 2);
        for (const double incidence : {0.0, 0.5, 1.0, 1.4})
            EXPECT_LE(energyBack(surface, incidence), reflected * (1 + 1e-5) + 1e-15) << i;
    }
    // The cap limits the energy: small perturbations alone would scatter more energy than arrives.
    EXPECT_GT(RoughSurface(steel_space, {0.02, 0.02}, 3770).perturbation(1), 1);
}

TEST(RoughSurfaceTest, AllMatterIsFiniteFrom10KilohertzTo3Megahertz) {
    for (size_t i = 0; i < matterCount(); ++i) {
        const MatterProperties& matter = getProperties(static_cast<Matter>(i));
        if (!matter.hasRoughness()) continue;
        for (const double khz : {10.0, 33.0, 100.0, 450.0, 900.0, 3000.0}) {
            const RoughSurface surface = makeRoughSurface(matter, khz, 1025, 1500);
            EXPECT_NEAR(surface.reflection(), matter.reflection, 0.06) << getName(matter.matter);
            for (const double grazing_deg : {0.0, 1e-9, 1.0, 45.0, 89.999, 90.0}) {
                const double section = solidSection(surface, grazing_deg * pi / 180);
                EXPECT_TRUE(std::isfinite(section) && section >= 0) << getName(matter.matter) << " " << khz;
            }
            EXPECT_LE(energyBack(surface, 0), 1) << getName(matter.matter) << " " << khz;
        }
    }
}

TEST(RoughSurfaceTest, SmoothMetalsShineAndRockAndConcreteDoNotAt900Kilohertz) {
    const auto getSurface = [](Matter matter) { return makeRoughSurface(getProperties(matter), 900, 1025, 1500); };
    for (const Matter smooth : {Matter::Steel, Matter::Aluminium, Matter::Glass, Matter::Acrylic, Matter::Pvc}) {
        EXPECT_GT(getSurface(smooth).lobeShare(), 0.95) << getName(smooth);
        EXPECT_LT(std::sqrt(getSurface(smooth).squareSlope()), 0.01) << getName(smooth);
    }
    for (const Matter rough : {Matter::Rock, Matter::Granite, Matter::Fouling})
        EXPECT_LT(getSurface(rough).lobeShare(), 0.05) << getName(rough);
    EXPECT_LT(getSurface(Matter::Concrete).lobeShare(), 0.5);
    // At 30 kHz concrete is smooth.
    EXPECT_GT(makeRoughSurface(getProperties(Matter::Concrete), 30, 1025, 1500).lobeShare(), 0.95);
}

}  // namespace
}  // namespace insonify::acoustics
