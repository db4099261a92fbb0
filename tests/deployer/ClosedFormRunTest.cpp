// The closed forms of ACOUSTICS.md 9 for users: `insonify run` renders a glTF scene and a deployment, and the tests
// check the numbers of `insonify log export`. Each form is compared with a deliberately wrong one, which must fail by
// the same measure. Bins are whole microseconds at 1000 m/s: 0.1 m is 100 us.
#include "tests/deployer/SceneRun.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/Scenes.hpp"
#include "types/geometry/Angle.hpp"

using namespace insonify::deployer;
using namespace insonify::test;
using insonify::types::GeometryPtr;
using insonify::types::radians;
using insonify::types::Sonar;

namespace {

GeometryPtr bottom() { return makeScene({ground(-5)}); }

GeometryPtr ball(double radius, int rings, double distance) {
    return makeScene({sphere(static_cast<float>(radius), rings)}, 0, {{distance, 0, 0}});
}

}  // namespace

TEST(ClosedFormRunTest, Form1APlaneOffTheAxisShowsOmegaOverRToTheFifthAndAbsorption) {
    const double distance = 10, edge = 10.4, beta = 2 * 0.5 * std::log(10) / 10;
    const GeometryPtr scene = makeScene({disc(distance, std::sqrt(edge * edge - distance * distance))}, -10);
    const Sonar ping = loggedPing(*scene, R"({speed_of_sound: 1000, range: 12, bin_count: 120, beam_count: 1,
        field_of_view_deg: 55, beam_height_deg: 50, absorption: {db_per_m: 0.5},
        quality: {rows: 512, columns_per_beam: 256}})",
                                  "{yaw_deg: 8, pitch_deg: 5, roll_deg: 20}");
    expectForm(ping, planeDisc(distance, edge, 0.1, beta), planeDisc(distance, edge, 0.1, beta / 2));
}

class FlatBottomTest : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(FlatBottomTest, Form2IsTheSameInAllBeamsOfALevelFan) {
    const auto [beams, columns] = GetParam();
    const Sonar ping =
        loggedPing(*bottom(), "{speed_of_sound: 1000, range: 50, bin_count: 500, beam_count: " + std::to_string(beams) +
                                  ", field_of_view_deg: 130, beam_height_deg: 40, quality: {rows: 512, "
                                  "columns_per_beam: " +
                                  std::to_string(columns) + "}}");
    const double delta = radians(130.0 / beams);
    ASSERT_EQ(ping.beam_count, static_cast<uint32_t>(beams));
    expectForm(ping, flatBottom(5, radians(20), delta), flatBottomWithoutCosine(5, radians(20), delta));
}

INSTANTIATE_TEST_SUITE_P(ClosedFormRun, FlatBottomTest, testing::Values(std::pair(64, 8), std::pair(256, 2)),
                         [](const auto& tested) { return std::to_string(tested.param.first) + "Beams"; });

TEST(ClosedFormRunTest, Form3ABottomUnderAPitchedBeam) {
    const Sonar ping = loggedPing(*bottom(), R"({speed_of_sound: 1000, range: 30, bin_count: 300, beam_count: 1,
        field_of_view_deg: 1, beam_height_deg: 40, quality: {rows: 512, columns_per_beam: 64}})",
                                  "{pitch_deg: 30}");
    expectForm(ping, pitchedBottom(5, radians(30), radians(20), radians(1), radians(30)),
               pitchedBottom(5, radians(30), radians(20), radians(1), 0));
}

TEST(ClosedFormRunTest, Form4ASphere) {
    // Bins of 0.2 m: at the limb one pixel spans 0.1 m of range, so that smaller bins would test the silhouette.
    const Sonar ping = loggedPing(*ball(1, 256, 10), R"({speed_of_sound: 1000, range: 12, bin_count: 60, beam_count: 1,
        field_of_view_deg: 12, beam_height_deg: 12, quality: {rows: 512, columns_per_beam: 256}})");
    expectForm(ping, sphereEcho(1, 10), times(1.03, sphereEcho(1, 10)));
}

TEST(ClosedFormRunTest, Form5AWallInAThinVerticalBeam) {
    const Sonar ping = loggedPing(*makeScene({wall(10)}), R"({speed_of_sound: 1000, range: 15, bin_count: 150,
        beam_count: 1, field_of_view_deg: 1, beam_height_deg: 40, quality: {rows: 512, columns_per_beam: 64}})");
    expectForm(ping, thinBeamOnWall(10, radians(20), radians(1)), thinBeamOnFadingWall(10, radians(20), radians(1)));
}

TEST(ClosedFormRunTest, Form7TwoObjectsAtOneRangeDoubleTheEnergyButNotThePublishedMean) {
    const double up = radians(6);
    const glm::dvec3 high(10 * std::cos(up), 0, 10 * std::sin(up)), low(high.x, 0, -high.z);
    const auto mesh = sphere(0.3f, 64);
    const GeometryPtr one = makeScene({mesh}, 0, {high}), two = makeScene({mesh, mesh}, 0, {high, low});
    const std::string sonar = R"({speed_of_sound: 1000, range: 12, bin_count: 120, beam_count: 1, field_of_view_deg: 10,
        beam_height_deg: 20, quality: {rows: 512, columns_per_beam: 256})";
    const Form single = getForm(loggedPing(*one, sonar + "}"));
    expectForm(loggedPing(*two, sonar + "}"), times(2, single), single);
    const Form mean = getForm(loggedPing(*one, sonar + ", model: cerqueira2017}"));
    expectForm(loggedPing(*two, sonar + ", model: cerqueira2017}"), mean, times(2, mean));
}

TEST(ClosedFormRunTest, Form8AShadowEndsWhereTheRayOverTheTopMeetsTheBottom) {
    // A screen 2 m high is on the bottom, 5 m below the sonar, at a horizontal distance of 15 m.
    const GeometryPtr scene = makeScene({ground(-5), quad({15, -50, -5}, {0, 100, 0}, {0, 0, 2})});
    const Sonar ping = loggedPing(*scene, R"({speed_of_sound: 1000, range: 40, bin_count: 400, beam_count: 1,
        field_of_view_deg: 1, beam_height_deg: 60, quality: {rows: 512, columns_per_beam: 64}})");
    size_t end = static_cast<size_t>(std::hypot(15, 5) / 0.1) + 2;
    while (end < 400 && ping.bins[end] == 0) ++end;
    EXPECT_NEAR(end * 0.1, shadowEnd(5, 2, 15), 0.1);
    EXPECT_GT(std::abs(end * 0.1 - 15.0 * 5 / (5 - 2)), 0.1) << "ground range instead of slant range is wrong";
    Sonar lit = ping;  // beyond the shadow the bottom is that of form 2
    std::fill(lit.bins.begin(), lit.bins.begin() + static_cast<std::ptrdiff_t>(end) + 1, 0.f);
    const double from = lit.binStart(static_cast<double>(end) + 1);
    expectForm(lit, between(from, 40, flatBottom(5, radians(30), radians(1))),
               between(from, 40, flatBottomWithoutCosine(5, radians(30), radians(1))));
}

TEST(CerqueiraLimitRunTest, APlaneIsTheSigmoidOfDistanceOverRange) {
    const Sonar ping = loggedPing(*bottom(), R"({model: cerqueira2017, speed_of_sound: 1000, range: 30, bin_count: 300,
        beam_count: 64, field_of_view_deg: 130, beam_height_deg: 80, quality: {rows: 512, columns_per_beam: 8}})");
    expectForm(ping, publishedBottom(5, radians(40)), publishedBottom(5.05, radians(40)));
}

TEST(CerqueiraLimitRunTest, ASphereIsTheSigmoidOfItsIncidence) {
    const Sonar ping = loggedPing(*ball(1, 256, 10.03), R"({model: cerqueira2017, speed_of_sound: 1000, range: 12,
        bin_count: 120, beam_count: 1, field_of_view_deg: 14, beam_height_deg: 14,
        quality: {rows: 512, columns_per_beam: 256}})");
    expectForm(ping, publishedSphere(1, 10.03), publishedSphere(1.02, 10.05));
}
