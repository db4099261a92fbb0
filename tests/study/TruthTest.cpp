// The study's exact echoes compared with the closed forms of ACOUSTICS.md 9.
#include <gtest/gtest.h>

#include "components/study/StudyScene.hpp"
#include "tests/support/ClosedForms.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

void expectForm(const Truth& truth, const BeamLimits& beam, const test::Form& form, double from, double to) {
    for (double r = from; r < to; r += 0.1) {
        const double expected = form(r, r + 0.1);
        EXPECT_NEAR(truth(beam, r, r + 0.1), expected, 1e-7 * expected + 1e-12) << r;
    }
}

TEST(TruthTest, ABottomUnderALevelFanIsTheSameInAllBeams) {
    const double half = radians(20), delta = radians(2);
    for (const double azimuth : {0.0, 0.5, 1.1})
        expectForm(planeTruth({0, 0, -1}, 5), {azimuth - delta / 2, azimuth + delta / 2, half},
                   test::flatBottom(5, half, delta), 5, 50);
}

TEST(TruthTest, APitchedBottomFollowsTheThinBeamForm) {
    const double pitch = radians(30), half = radians(20), delta = 1e-4;
    const glm::dvec3 down(std::sin(pitch), 0, -std::cos(pitch));
    const Truth truth = planeTruth(down, 5);
    const test::Form form = test::pitchedBottom(5, pitch, half, delta, pitch);
    for (double r = 5; r < 40; r += 0.1)
        EXPECT_NEAR(truth({-delta / 2, delta / 2, half}, r, r + 0.1), form(r, r + 0.1), 1e-5 * form(r, r + 0.1) + 1e-12)
            << r;
}

TEST(TruthTest, APatternInElevationWeightsThePitchedThinBeamForm) {
    const double pitch = radians(30), half = radians(20), delta = 1e-4;
    const glm::dvec3 down(std::sin(pitch), 0, -std::cos(pitch));
    const Pattern pattern = [](double elevation) { return std::exp(-20 * elevation * elevation - elevation); };
    const Truth truth = planeTruth(down, 5, {}, pattern);
    for (double r = 5 / std::sin(pitch + half) + 0.1; r < 20; r += 0.1) {
        const double expected = test::integral(r, r + 0.1, [&](double at) {
            const double p = std::asin(5 / at);
            return delta * 25 * std::pow(at, -5) * std::cos(pitch - p) / std::cos(p) * pattern(pitch - p);
        });
        EXPECT_NEAR(truth({-delta / 2, delta / 2, half}, r, r + 0.1), expected, 1e-4 * expected) << r;
    }
}

TEST(TruthTest, AWallFollowsTheThinBeamForm) {
    const double half = radians(20), delta = 1e-4;
    const test::Form form = test::thinBeamOnWall(10, half, delta);
    for (double r = 10; r < 12; r += 0.1)
        EXPECT_NEAR(planeTruth({1, 0, 0}, 10)({-delta / 2, delta / 2, half}, r, r + 0.1), form(r, r + 0.1),
                    1e-5 * form(r, r + 0.1) + 1e-12)
            << r;
}

TEST(TruthTest, DiscAndSphereFollowThePublishedForms) {
    const BeamLimits wide{-1, 1, 1};
    expectForm(sphereTruth(1, 10), wide, test::sphereEcho(1, 10), 8.5, 11);
    const double edge = std::hypot(10, 2.9);
    for (double r = 9.5; r < 11; r += 0.1)
        EXPECT_NEAR(discTruth(10, 2.9)(wide, r, r + 0.1), test::planeDisc(10, edge, 1)(r, r + 0.1), 1e-8) << r;
}

TEST(TruthTest, AWindowRemovesHiddenParts) {
    const Window none = [](double) { return Elevations{0.1, 0.2}; };  // above the horizon, where there is no bottom
    EXPECT_EQ(planeTruth({0, 0, -1}, 5, none)({-0.1, 0.1, 0.5}, 10, 20), 0);
    const Window lower = [](double) { return Elevations{-1, -0.3}; };
    const double seen = planeTruth({0, 0, -1}, 5, lower)({-0.1, 0.1, 0.5}, 5, 50);
    EXPECT_NEAR(seen, test::flatBottom(5, 0.5, 0.2)(5, 5 / std::sin(0.3)), 1e-9);
}

}  // namespace
}  // namespace insonify::study
