// A plate between two fluids (ACOUSTICS.md 3.10).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>
#include <numeric>
#include <random>

#include "components/acoustics/Plate.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

constexpr Fluid water{1025, 1500}, air{1.21, 343};

Plate steel(double thickness) { return {thickness, 7850, 5900, 3230, 0}; }
double transmittedPower(const Plate& plate, const Fluid& fluid, double frequency, double cosine) {
    return std::norm(plateResponse(plate, fluid, fluid, frequency, cosine).transmitted);
}

/** A plate of half a wavelength between equal fluids is transparent, one of a quarter reflects most; without losses the
 *  shares are all of the energy, also between two fluids. */
TEST(PlateTest, AHalfWavePlateIsTransparentAndAllEnergyIsShared) {
    const Plate pvc{0.4e-3, 1380, 2400, 1060, 0.01};
    EXPECT_NEAR(countHalfWaves(pvc, 3e6), 1, 1e-12);
    EXPECT_TRUE(isNearResonance(pvc, 3e6) && isNearResonance(pvc, 2.75e6) && isNearResonance(pvc, 5.8e6));
    EXPECT_FALSE(isNearResonance(pvc, 2.6e6) || isNearResonance(pvc, 1.5e6) || isNearResonance(pvc, 1e4));
    const PlateShares half = computeShares(pvc, water, water, 3e6, 1);
    const PlateShares quarter = computeShares(pvc, water, water, 1.5e6, 1);
    EXPECT_LT(half.reflected, 1e-3);
    EXPECT_GT(half.passed, 0.9);
    EXPECT_GT(quarter.reflected, 0.3);
    for (const Fluid& behind : {water, Fluid{1900, 1650}, air})
        for (const double cosine : {1.0, 0.9, 0.7, 0.3}) {
            const PlateShares shares = computeShares(steel(2e-3), water, behind, 7e5, cosine);
            EXPECT_NEAR(shares.reflected + shares.passed, 1, 1e-6) << behind.density << " " << cosine;
        }
}

/** Draws random plates and waves. */
class Draw {
public:
    double between(double low, double high) {
        return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random_));
    }
    double uniform() { return std::uniform_real_distribution(0.0, 1.0)(random_); }

private:
    std::mt19937 random_{3};
};

TEST(PlateTest, ReflectionAndTransmissionSumToOneWithoutLoss) {
    Draw draw;
    for (int i = 0; i < 2000; ++i) {
        Plate plate{draw.between(1e-4, 0.1), draw.between(500, 9000), draw.between(1000, 7000), 0, 0};
        if (i % 2) plate.shear_speed = plate.sound_speed * (0.3 + 0.3 * draw.uniform());
        const Fluid before{draw.between(800, 2000), draw.between(1000, 2000)};
        const Fluid behind{draw.between(800, 2000), draw.between(1000, 2000)};
        const double cosine = draw.uniform(), frequency = draw.between(1e4, 3e6);
        const double sine = std::sqrt(1 - cosine * cosine) * behind.sound_speed / before.sound_speed;
        if (sine > 0.999) continue;  // totally reflected
        const PlateResponse response = plateResponse(plate, before, behind, frequency, cosine);
        const double one = before.density * before.sound_speed / cosine,
                     other = behind.density * behind.sound_speed / std::sqrt(1 - sine * sine);
        EXPECT_NEAR(std::norm(response.reflected) + std::norm(response.transmitted) * one / other, 1, 1e-4)
            << plate.thickness << " m, " << frequency << " Hz, cosine " << cosine;
    }
}

TEST(PlateTest, TransmissionIsTheSameInBothDirections) {
    Draw draw;
    for (int i = 0; i < 500; ++i) {
        const Plate plate{draw.between(1e-3, 0.05), 1200, 2700, 1340, 0.01};
        const Fluid one{1000, 1500}, other{900, 1400};
        const double frequency = draw.between(1e4, 2e6), cosine = 0.1 + 0.9 * draw.uniform();
        const double sine = std::sqrt(1 - cosine * cosine) * other.sound_speed / one.sound_speed;
        const double there = std::sqrt(1 - sine * sine);
        const double z_one = one.density * one.sound_speed / cosine,
                     z_other = other.density * other.sound_speed / there;
        const auto out = plateResponse(plate, one, other, frequency, cosine).transmitted;
        const auto back = plateResponse(plate, other, one, frequency, there).transmitted;
        EXPECT_LT(std::abs(out / z_other - back / z_one) * z_one, 1e-6 * std::abs(out)) << frequency;
    }
}

/** Kinsler et al. 2000, 6.3: a fluid layer at normal incidence. */
TEST(PlateTest, AFluidLayerAtTheNormalIsThatOfTextbooks) {
    Draw draw;
    for (int i = 0; i < 500; ++i) {
        const Plate layer{draw.between(1e-4, 0.1), draw.between(500, 9000), draw.between(1000, 7000), 0, 0};
        const double frequency = draw.between(1e4, 3e6),
                     phase = 2 * pi * frequency * layer.thickness / layer.sound_speed;
        const double ratio = layer.density * layer.sound_speed / (water.density * water.sound_speed);
        const double power = 1 / (1 + std::pow((ratio - 1 / ratio) / 2 * std::sin(phase), 2));
        EXPECT_NEAR(transmittedPower(layer, water, frequency, 1), power, 1e-5);
    }
}

TEST(PlateTest, AHalfWavePlateIsTransparentAndAQuarterWavePlateReflectsMost) {
    const double frequency = 500e3, wave = 5900 / frequency;
    EXPECT_NEAR(transmittedPower(steel(wave / 2), water, frequency, 1), 1, 1e-5);
    const double quarter = transmittedPower(steel(wave / 4), water, frequency, 1), ratio = 7850. * 5900 / (1025 * 1500);
    EXPECT_NEAR(quarter, 4 / std::pow(ratio + 1 / ratio, 2), 1e-6);
}

/** Fahy and Gardonio 2007, 5.2: 1 / (1 + (omega m cos / (2 rho c))^2). */
TEST(PlateTest, AThinPlateFollowsTheLawOfMassBelowCoincidence) {
    for (const double cosine : {1.0, 0.8, 0.5})
        for (const double frequency : {100., 1000., 3000.}) {
            const double mass = 7850 * 1e-3, load = 2 * pi * frequency * mass * cosine / (2 * 1.21 * 343);
            const double power = transmittedPower(steel(1e-3), air, frequency, cosine);
            EXPECT_NEAR(power * (1 + load * load), 1, 0.2) << cosine << ", " << frequency << " Hz";
        }
}

/** Fahy and Gardonio 2007, table 5.1: critical frequency times thickness of steel in air, 12.4 m/s. Just above it, a
 *  plate without loss transmits everything at the angle where the trace speed matches its flexural waves. */
TEST(PlateTest, SteelInAirIsClearAtTheAngleOfCoincidence) {
    const double thickness = 1e-3, critical = 12.4 / thickness;
    for (const double over : {1.2, 2.0, 4.0}) {
        double best = 0, at = 0;
        for (double sine = 0.2; sine < 1; sine += 1e-5) {
            const double power = transmittedPower(steel(thickness), air, over * critical, std::sqrt(1 - sine * sine));
            if (power > best) best = power, at = sine;
        }
        EXPECT_GT(best, 0.5) << over;
        EXPECT_NEAR(at * std::sqrt(over), 1, 0.02) << over;
        EXPECT_LT(transmittedPower(steel(thickness), air, over * critical, 1), 1e-3);
    }
}

TEST(PlateTest, AirBehindReflectsAllAndAnAbsorberTransmitsNothing) {
    const PlateResponse backed = plateResponse(steel(0.003), water, air, 200e3, 0.9);
    EXPECT_NEAR(std::abs(backed.reflected), 1, 1e-2);
    const Plate rubber{0.1, 1100, 1550, 0, 0.2};
    const PlateResponse lost = plateResponse(rubber, water, water, 3e6, 1);
    EXPECT_LT(std::abs(lost.transmitted), 1e-30);
    EXPECT_NEAR(std::abs(lost.reflected), std::abs(1100. * 1550 - 1025. * 1500) / (1100. * 1550 + 1025. * 1500), 0.1);
}

/** Parseval: the sum of the energies of a series of pulses is the mean of the spectrum's energy over a period. */
TEST(PlateTest, TheReturnsOfAShortPulseAreTheMeanOverAResonance) {
    Draw draw;
    double worst = 0;
    for (int i = 0; i < 100; ++i) {
        const Plate plate{draw.between(1e-3, 0.1), draw.between(900, 9000), draw.between(1000, 7000), 0, 0};
        const Fluid before{draw.between(800, 2000), draw.between(1000, 2000)};
        const Fluid behind{draw.between(800, 2000), draw.between(1000, 2000)};
        const double frequency = draw.between(1e5, 3e6), width = plate.sound_speed / (2 * plate.thickness);
        constexpr int steps = 2000;
        const double impedances = before.density * before.sound_speed / (behind.density * behind.sound_speed);
        double reflected = 0, passed = 0, once = 0;
        for (int k = 0; k < steps; ++k) {
            const double at = frequency + width * (k + 0.5) / steps;
            reflected += std::norm(plateResponse(plate, before, behind, at, 1).reflected) / steps;
            passed += std::norm(plateResponse(plate, before, behind, at, 1).transmitted *
                                plateResponse(plate, behind, before, at, 1).transmitted) /
                      steps;
            once += std::norm(plateResponse(plate, before, behind, at, 1).transmitted) * impedances / steps;
        }
        const PlateReturns returns = plateReturns(plate, before, behind, frequency, 32);
        const double all = std::accumulate(returns.reflected.begin(), returns.reflected.end(), 0.0),
                     through = std::accumulate(returns.passed.begin(), returns.passed.end(), 0.0);
        EXPECT_NEAR(all, reflected, 1e-5) << i;
        EXPECT_NEAR(through, passed, 1e-5) << i;
        EXPECT_NEAR(std::accumulate(returns.passed_once.begin(), returns.passed_once.end(), 0.0), once, 1e-5) << i;
        EXPECT_LE(all + through, 1 + 1e-9);
        worst = std::max({worst, std::abs(all - reflected), std::abs(through - passed)});
    }
    std::cout << "worst difference from the mean over a resonance: " << worst << "\n";
}

/** A train of pulses by the coefficients of the faces. With its delays it equals the response at every frequency. */
TEST(PlateTest, EachReturnMatchesItsPath) {
    const Plate plate{0.01, 1190, 2700, 0, 0};
    const Fluid oil{870, 1440};
    const double own = 1190. * 2700, one = water.density * water.sound_speed, other = oil.density * oil.sound_speed;
    const double front = (own - one) / (own + one), back = (other - own) / (other + own);
    const PlateReturns returns = plateReturns(plate, water, oil, 500e3, 32);
    EXPECT_NEAR(returns.reflected[0], front * front, 1e-12);
    EXPECT_NEAR(returns.reflected[1], std::pow((1 - front * front) * back, 2), 1e-12);
    EXPECT_NEAR(returns.reflected[2], std::pow((1 - front * front) * back * front * back, 2), 1e-3);
    for (const double frequency : {480e3, 500e3, 555e3}) {
        std::complex<double> sum = front;
        const std::complex<double> across = std::exp(std::complex(0.0, 4 * pi * frequency * 0.01 / 2700));
        for (int n = 1; n < 60; ++n)
            sum += (1 - front * front) * back * std::pow(-front * back, n - 1) * std::pow(across, n);
        EXPECT_LT(std::abs(sum - plateResponse(plate, water, oil, frequency, 1).reflected), 1e-6) << frequency;
    }
}

TEST(PlateTest, APlateOfNoThicknessIsTheBoundaryOfItsFluids) {
    Draw draw;
    for (int i = 0; i < 1000; ++i) {
        const Fluid behind{draw.between(1, 9000), draw.between(200, 6000)};
        const double cosine = 1e-3 + 0.999 * draw.uniform(), frequency = draw.between(1e3, 3e6);
        const double sine = std::sqrt(1 - cosine * cosine) * behind.sound_speed / water.sound_speed;
        const std::complex<double> other =
            behind.density * behind.sound_speed / std::sqrt(std::complex<double>(1 - sine * sine, 0));
        const double one = water.density * water.sound_speed / cosine;
        const std::complex<double> reflected = (other - one) / (other + one), passed = 2.0 * other / (other + one);
        for (const double thickness : {0., 1e-200, 1e-15, 1e-10}) {  // the last one is computed as a plate
            Plate plate{thickness, draw.between(500, 9000), draw.between(300, 7000), 0, i % 3 ? draw.uniform() : 0};
            if (i % 2) plate.shear_speed = 0.5 * plate.sound_speed;
            const PlateResponse response = plateResponse(plate, water, behind, frequency, cosine);
            const double tolerance = thickness < 1e-12 ? 1e-9 : 0.02 * (1 + std::abs(passed));
            EXPECT_LT(std::abs(response.reflected - reflected), tolerance) << i << ", " << thickness;
            EXPECT_LT(std::abs(response.transmitted - passed), tolerance) << i << ", " << thickness;
        }
    }
}

TEST(PlateTest, ReturnsOfExtremePlatesAreFiniteAndBounded) {
    Draw draw;
    for (int i = 0; i < 3000; ++i) {
        const Plate plate{i % 7 ? draw.between(1e-9, 10) : 0, draw.between(1, 30000), draw.between(100, 20000), 0,
                          i % 3 ? draw.uniform() : 0};
        const Fluid behind = i % 5 ? Fluid{draw.between(1, 3000), draw.between(100, 4000)} : air;
        const PlateReturns returns = plateReturns(plate, water, behind, draw.between(1, 1e8), 32);
        double reflected = 0, passed = 0;
        for (const double share : returns.reflected) EXPECT_GE(share, 0), reflected += share;
        for (const double share : returns.passed) EXPECT_GE(share, 0), passed += share;
        EXPECT_TRUE(std::isfinite(reflected) && std::isfinite(passed)) << i;
        EXPECT_LE(reflected, 1 + 1e-9) << i;
        EXPECT_LE(passed, 1 + 1e-9) << i;
        EXPECT_LE(returns.reflected.size(), 32u);
    }
}

TEST(PlateTest, ExtremePlatesAreFinite) {
    for (const double thickness : {1e-9, 1e-3, 10.})
        for (const double frequency : {1., 1e5, 1e8})
            for (const double cosine : {0., 1e-12, 0.5, 1.})
                for (const double shear : {0., 3230.}) {
                    const Plate plate{thickness, 7850, 5900, shear, 0};
                    const PlateResponse r = plateResponse(plate, water, water, frequency, cosine);
                    EXPECT_TRUE(std::isfinite(std::norm(r.reflected)) && std::isfinite(std::norm(r.transmitted)));
                    EXPECT_LE(std::norm(r.reflected) + std::norm(r.transmitted), 1 + 1e-3) << thickness << frequency;
                }
}

}  // namespace
}  // namespace insonify::acoustics
