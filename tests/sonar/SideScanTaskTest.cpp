// Lines of a side-scan, compared with closed forms (ACOUSTICS.md 9.11).
#include <gmock/gmock.h>

#include <cmath>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

using test::Form;
using test::ground;
using test::makeScene;

constexpr double height = 8;  // above the bottom [m]

struct SideScanTaskTest : test::TaskBench<SideScanTask, types::SnapshotPtr, types::SonarPtr> {
    SideScanTaskTest() : TaskBench(&SideScanTask::snapshot, &SideScanTask::ping) {}
    /** Beams from straight down to 10 deg below the horizontal. */
    static SideScanConfig sideScan() {
        SideScanConfig config;
        config.sonar.range = 40.5;
        config.sonar.bin_count = 900;
        config.sonar.beam_height_deg = 80;
        config.depression_deg = 50;
        return config;
    }
    types::SonarPtr makeLine(types::Snapshot snapshot) {
        return answerTo(std::make_shared<types::Snapshot>(std::move(snapshot)));
    }
    static types::Sonar side(const types::Sonar& line, uint32_t beam) {
        types::Sonar one = line;
        one.beam_count = 1;
        one.bearings = {line.bearings[beam]};
        one.bins.assign(line.bins.begin() + beam * line.bin_count, line.bins.begin() + (beam + 1) * line.bin_count);
        return one;
    }
    /** Energy of a flat bottom between slant ranges: delta mu / D^2 [sin a - sin^3 a / 3], a = acos(D / r). */
    static Form bottom(double mu, double along_rad, int power = 3) {
        const auto antiderivative = [power](double r) {
            const double a = std::acos(std::min(1.0, height / r));
            return power == 3 ? std::sin(a) - std::pow(std::sin(a), 3) / 3 : std::sin(a);  // of cos^3, of cos
        };
        const double farthest = height / std::cos(types::radians(80));
        return test::between(height, farthest, [=](double r1, double r2) {
            return along_rad * mu / (height * height) * (antiderivative(r2) - antiderivative(r1));
        });
    }
};

TEST_F(SideScanTaskTest, AFlatBottomFollowsLambertAlongTheGroundOnBothSides) {
    startWith(sideScan());
    const auto line = makeLine(test::makeSnapshot(makeScene({ground(0)}, -10), {3, 4, height}, types::radians(70)));
    ASSERT_TRUE(line) << task_.lastError();
    ASSERT_EQ(line->beam_count, 2u);
    const double along = types::radians(0.5);
    for (const uint32_t beam : {0u, 1u}) {
        test::expectForm(side(*line, beam), bottom(0.1, along), bottom(0.1, along, 1));
        std::cout << "side " << beam << ": " << test::deviation(side(*line, beam), bottom(0.1, along)) << "\n";
    }
}

TEST_F(SideScanTaskTest, TheFirstReturnIsAtTheHeightAndTheLastWhereTheUpperEdgeMeetsTheBottom) {
    SideScanConfig config = sideScan();
    startWith(config);
    const auto line = makeLine(test::makeSnapshot(makeScene({ground(0)}), {0, 0, height}));
    ASSERT_TRUE(line) << task_.lastError();
    for (const uint32_t beam : {0u, 1u}) {
        const types::Sonar one = side(*line, beam);
        uint32_t first = 0;
        while (first < one.bin_count && !(one.bins[first] > 0)) ++first;
        EXPECT_NEAR(one.binStart(first), height, one.binStart(1));
    }
    config.depression_deg = 40;
    config.sonar.beam_height_deg = 30;  // from 25 to 55 deg below the horizontal
    task_.stop();
    task_.cleanup();
    startWith(config);
    const auto narrow = makeLine(test::makeSnapshot(makeScene({ground(0)}), {0, 0, height}));
    ASSERT_TRUE(narrow) << task_.lastError();
    const types::Sonar one = side(*narrow, 1);
    const double bin = one.binStart(1);
    uint32_t first = 0, last = one.bin_count - 1;
    while (first < one.bin_count && !(one.bins[first] > 0)) ++first;
    while (last > 0 && !(one.bins[last] > 0)) --last;
    EXPECT_NEAR(one.binStart(first), height / std::sin(types::radians(55)), bin);
    EXPECT_NEAR(one.binStart(last), height / std::sin(types::radians(25)), bin);
}

TEST_F(SideScanTaskTest, PortAndStarboardAreCorrectAndTheLineHasTheWidthOfTheBeam) {
    startWith(sideScan());
    const auto getEchoes = [&](glm::dvec3 target, double yaw) {
        const auto line = makeLine(
            test::makeSnapshot(makeScene({test::sphere(0.3)}, 0, {target}), {0, 0, height}, types::radians(yaw)));
        EXPECT_TRUE(line) << task_.lastError();
        EXPECT_NEAR(line->bearings[0].deg(), -90, 1e-9);
        EXPECT_NEAR(line->bearings[1].deg(), 90, 1e-9);
        EXPECT_NEAR(line->beam_width.deg(), 0.5, 1e-6);
        EXPECT_NEAR(line->beam_height.deg(), 80, 1e-6);
        return std::pair{std::ranges::any_of(side(*line, 0).bins, [](float bin) { return bin > 0; }),
                         std::ranges::any_of(side(*line, 1).bins, [](float bin) { return bin > 0; })};
    };
    EXPECT_EQ(getEchoes({0, 12, 1}, 0), std::pair(false, true)) << "west of a vehicle that looks north: port";
    EXPECT_EQ(getEchoes({0, -12, 1}, 0), std::pair(true, false));
    EXPECT_EQ(getEchoes({0, -12, 1}, 180), std::pair(false, true)) << "turned round";
    EXPECT_EQ(getEchoes({2, 12, 1}, 0), std::pair(false, false)) << "ahead of the line";
}

/** The two-way weight of a beam's law in the bins of one side, at the ranges where the bottom is at an angle. */
TEST_F(SideScanTaskTest, TheLawAcrossTheTrackIsAboutTheAxisOfEachBeam) {
    SideScanConfig config = sideScan();
    config.sonar.beam_height_deg = 40;
    config.sonar.beam_pattern.emplace();
    config.sonar.beam_pattern->receive.elevation.emplace();
    config.sonar.beam_pattern->receive.elevation->weighting = acoustics::Weighting::Gaussian;
    config.sonar.beam_pattern->receive.elevation->width_deg = 40;
    startWith(config);
    const auto line = makeLine(test::makeSnapshot(makeScene({ground(0)}), {0, 0, height}));
    ASSERT_TRUE(line) << task_.lastError();
    const Form flat = bottom(1, types::radians(0.5));
    for (const uint32_t beam : {0u, 1u}) {
        const types::Sonar one = side(*line, beam);
        for (const double below : {70.0, 60.0, 50.0, 40.0, 30.0}) {  // the horizontal [deg]
            const auto bin = static_cast<uint32_t>(height / std::sin(types::radians(below)) / one.binStart(1));
            const double weight = one.bins[bin] / flat(one.binStart(bin), one.binStart(bin + 1));
            EXPECT_NEAR(10 * std::log10(weight), -3.0103 * std::pow((below - 50) / 20, 2), 0.2) << below;
        }
    }
}

/** Elevations in the truth are above the vehicle's x-y plane, as with other sonars. For a flat bottom at slant range r
 *  the sine is -D / r; a vehicle that rolls to starboard changes the elevations by its roll. */
TEST_F(SideScanTaskTest, TheTruthsElevationsAreAboveTheVehiclesPlane) {
    test::Reader<types::SonarTruthPtr> reported{"told"};
    task_.truth.connectTo(reported.port, framework::ConnPolicy::data());
    startWith(sideScan());
    for (const double roll : {0.0, 6.0}) {
        types::Snapshot snapshot = test::makeSnapshot(makeScene({ground(0)}, -10), {3, 4, height}, types::radians(70));
        snapshot.sonar.orientation *= glm::angleAxis(types::radians(roll), glm::dvec3(1, 0, 0));
        const auto line = makeLine(snapshot);
        types::SonarTruthPtr truth;
        ASSERT_TRUE(line && reported.port.readNewest(truth) == framework::FlowStatus::NewData) << task_.lastError();
        size_t compared = 0;
        for (uint32_t beam = 0; beam < 2; ++beam)
            for (uint32_t bin = 0; bin < line->bin_count; ++bin) {
                const size_t at = size_t{beam} * line->bin_count + bin;
                const double near = line->binStart(bin), far = line->binStart(bin + 1);
                if (truth->object[at] < 0 || near <= 1.02 * height) continue;
                const double turn = types::radians(beam == 0 ? roll : -roll);
                const double high = turn - std::asin(height / far), low = turn - std::asin(height / near);
                const double slack = 2e-3;  // a sample's extent in range
                ASSERT_GT(truth->elevation[at], low - slack) << beam << " " << bin;
                ASSERT_LT(truth->elevation[at], high + slack) << beam << " " << bin;
                ++compared;
            }
        EXPECT_GT(compared, 1000u);
    }
}

}  // namespace
}  // namespace insonify::sonar
