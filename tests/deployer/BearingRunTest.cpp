// Objects are in the log at their places in the scene: positive bearings are to port, and every target is in the beam
// and the bin of its own bearing and slant range.
#include <numeric>

#include "tests/deployer/SceneRun.hpp"
#include "tests/support/Scenes.hpp"
#include "types/geometry/Angle.hpp"

using namespace insonify::deployer;
using namespace insonify::test;
using insonify::types::GeometryPtr;
using insonify::types::radians;
using insonify::types::Sonar;

namespace {

/** Returns the bin of target k of n: all bins differ, neighbours are far apart, and the nearest is at 5 m. */
size_t findBin(size_t k, size_t n) { return 50 + 37 * k % n; }

/** A ball of 7 cm at each of these bearings, at three elevations, whose echo is within one bin of 0.1 m. */
GeometryPtr targetsAt(const std::vector<double>& bearings_deg) {
    std::vector<glm::dvec3> positions;
    for (size_t k = 0; k < bearings_deg.size(); ++k) {
        const double bearing = radians(bearings_deg[k]), elevation = radians(4.0 * static_cast<double>(k % 3) - 4);
        const double range = 0.1 * (static_cast<double>(findBin(k, bearings_deg.size())) + 0.9);
        positions.push_back(range * glm::dvec3(std::cos(elevation) * std::cos(bearing),
                                               std::cos(elevation) * std::sin(bearing), std::sin(elevation)));
    }
    return makeScene(std::vector(positions.size(), sphere(0.07f, 16)), 0, positions);
}

std::vector<double> bearingsFrom(double first_deg, double step_deg, size_t count) {
    std::vector<double> bearings;
    for (size_t k = 0; k < count; ++k) bearings.push_back(first_deg + step_deg * static_cast<double>(k));
    return bearings;
}

void expectTarget(const Sonar& ping, size_t beam, double bearing_deg, size_t bin) {
    const double difference = std::remainder(ping.bearings[beam].rad - radians(bearing_deg), radians(360));
    EXPECT_NEAR(difference, 0, 1e-6) << "the beam at " << bearing_deg << " deg";
    const auto first = ping.bins.begin() + static_cast<std::ptrdiff_t>(beam * ping.bin_count);
    const auto last = first + ping.bin_count;
    EXPECT_EQ(std::max_element(first, last) - first, static_cast<std::ptrdiff_t>(bin)) << bearing_deg << " deg";
    EXPECT_GT(first[static_cast<std::ptrdiff_t>(bin)], 0.6f * std::accumulate(first, last, 0.f)) << bearing_deg;
}

void expectTargetInEachBeam(const std::string& fan, const std::vector<double>& bearings_deg) {
    const Sonar ping = loggedPing(*targetsAt(bearings_deg),
                                  "{speed_of_sound: 1000, range: 20, bin_count: 200, quality: {rows: 512, "
                                  "columns_per_beam: 8}, " +
                                      fan + "}");
    ASSERT_EQ(ping.beam_count, bearings_deg.size());
    for (size_t k = 0; k < bearings_deg.size(); ++k)
        expectTarget(ping, k, bearings_deg[k], findBin(k, bearings_deg.size()));
}

}  // namespace

TEST(BearingRunTest, AWallSeenToPortIsLoggedToPort) {
    // Along the x axis from 4 to 12 m, at y = 6 m: to port. glTF is y-up, so that its z is -6.
    const WallFolder folder(replaced(wall_deployment, "field_of_view_deg: 60", "field_of_view_deg: 140"),
                            makeGltf({4, -1, -6, 12, -1, -6, 12, 1, -6, 4, 1, -6}, {0, 1, 2, 0, 2, 3}));
    ASSERT_EQ(folder.run({"--pings", "1"}).code, 0);
    const Sonar ping = exportedPings(folder, "out/wall.0.log", "sonar.ping").at(0);
    const double half_beam = radians(140.0 / 16 / 2), near_end = std::atan2(6, 4), far_end = std::atan2(6, 12);
    int seen = 0;
    for (size_t beam = 0; beam < 16; ++beam) {
        const double bearing = ping.bearings[beam].rad;
        const auto first = ping.bins.begin() + static_cast<std::ptrdiff_t>(beam * ping.bin_count);
        const auto echo = std::find_if(first, first + ping.bin_count, [](float energy) { return energy > 0; }) - first;
        const bool sees = bearing + half_beam > far_end && bearing - half_beam < near_end;
        EXPECT_EQ(echo < ping.bin_count, sees) << "the beam at " << bearing << " rad";
        if (!sees) continue;
        ++seen;
        const double range = 6 / std::sin(std::min(bearing + half_beam, near_end));  // of the nearest wall in the beam
        EXPECT_NEAR(ping.binStart(static_cast<double>(echo)), range, 2 * ping.binStart(1)) << bearing;
    }
    EXPECT_EQ(seen, 4);
}

TEST(BearingRunTest, ATargetAtEveryBearingOfAFanIsInItsBeamAndBin) {
    expectTargetInEachBeam("field_of_view_deg: 120, beam_count: 64", bearingsFrom(-60 + 120.0 / 128, 120.0 / 64, 64));
}

TEST(BearingRunTest, ATargetAtEveryBearingAllAroundIsInItsBeamAndBin) {
    expectTargetInEachBeam("field_of_view_deg: 360, beam_count: 120", bearingsFrom(-178.5, 3, 120));
}

TEST(BearingRunTest, ATargetAtEveryBearingOfATableIsInItsBeamAndBin) {
    expectTargetInEachBeam("bearings_deg: [7.2, -9, -4.5, 0, 3, 5, -7, -2], beam_width_deg: 2",
                           {7.2, -9, -4.5, 0, 3, 5, -7, -2});
}

TEST(BearingRunTest, ATargetAtEveryBearingOfATurningHeadIsInItsPingAndBin) {
    const std::vector<double> bearings = bearingsFrom(180, -3, 120);
    const std::vector<Sonar> pings =
        loggedPings(*targetsAt(bearings), "sonar::ScanningSonarTask",
                    R"({speed_of_sound: 1000, range: 20, bin_count: 200, head: {step_deg: 3},
        quality: {rows: 512, columns_per_beam: 16}})",
                    "{yaw_deg: 0}", 120);
    ASSERT_EQ(pings.size(), 120u);
    for (size_t k = 0; k < pings.size(); ++k) expectTarget(pings[k], 0, bearings[k], findBin(k, 120));
}

TEST(BearingRunTest, AMountTurnedToPortMovesTargetsToStarboard) {
    const Sonar ping = loggedPing(*targetsAt({30}), R"({speed_of_sound: 1000, range: 20, bin_count: 200,
        field_of_view_deg: 120, beam_count: 60, quality: {rows: 512, columns_per_beam: 8}})",
                                  "{yaw_deg: 43}");
    expectTarget(ping, 23, -13, findBin(0, 1));
}
