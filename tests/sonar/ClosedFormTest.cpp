// Pings of scenes whose echo is known in closed form (ACOUSTICS.md 9), rasterised by OpenGL. Each form has a
// deliberately wrong variant, which must fail by the same measure.
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "components/sonar/renderer/Metrics.hpp"
#include "components/sonar/surfaces/FacetLobes.hpp"
#include "components/study/StudyScene.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using test::expectForm;
using test::makePing;
using types::radians;

/** Bins of whole microseconds at 1000 m/s: 0.1 m is 100 us. */
SonarConfig getSonar(double fov_deg, double height_deg, int beams, double bin, int bins) {
    const int columns = std::max(2, 512 / beams);
    return test::getSonar({.beams = beams,
                           .width_deg = fov_deg,
                           .height_deg = height_deg,
                           .bins = bins,
                           .bin = bin,
                           .rows = 512,
                           .columns = columns});
}

SonarConfig published(SonarConfig config) {
    config.model = Model::Cerqueira2017;
    return config;
}

}  // namespace

TEST(ClosedFormTest, FlatBottomUnderALevelFanIsTheSameInAllBeams) {
    const double height = 5, fov = 130, elevation = radians(20);
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-5)}));
    for (int beams : {64, 256}) {
        const double delta = radians(fov / beams);
        expectForm(makePing(getSonar(fov, 40, beams, 0.1, 500), snapshot), test::flatBottom(height, elevation, delta),
                   test::flatBottomWithoutCosine(height, elevation, delta));
    }
}

TEST(ClosedFormTest, AnyPlaneFacingDiscShowsOmegaOverRToTheFifth) {
    const double distance = 10, edge = 10.4, radius = std::sqrt(edge * edge - distance * distance);
    const auto snapshot = test::makeSnapshot(test::makeScene({test::disc(distance, radius)}, -10));
    expectForm(makePing(getSonar(40, 40, 1, 0.1, 120), snapshot), test::planeDisc(distance, edge, 0.1),
               test::planeDisc(distance, edge, 0.105));
}

TEST(ClosedFormTest, RolledPlaneHasTheSameEnergyPerRangeAsALevelOneInAConeOfAllBearings) {
    // A plane ahead, rotated about the line of sight, is the facing disc again: no bin may depend on roll.
    const double distance = 10, edge = 10.4, radius = std::sqrt(edge * edge - distance * distance);
    const auto geometry = test::makeScene({test::disc(distance, radius)});
    const auto config = getSonar(40, 40, 1, 0.1, 120);
    const test::Form straight = test::getForm(makePing(config, test::makeSnapshot(geometry)));
    expectForm(makePing(config, test::makeSnapshot(geometry, {}, 0, 0, 0.3)), straight, test::times(1.02, straight));
}

TEST(ClosedFormTest, PitchedPlaneFollowsTheThinBeamForm) {
    const double height = 5, pitch = radians(30), half = radians(20), delta = radians(1);
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-5)}), {}, 0, pitch);
    expectForm(makePing(getSonar(1, 40, 1, 0.1, 300), snapshot), test::pitchedBottom(height, pitch, half, delta, pitch),
               test::pitchedBottom(height, pitch, half, delta, 0));
}

TEST(ClosedFormTest, SphereFollowsItsRangeDensity) {
    const auto snapshot = test::makeSnapshot(test::makeScene({test::sphere(1, 256)}, 0, {{10, 0, 0}}));
    // Bins of 0.2 m: at the limb one pixel spans 0.1 m of range, so that narrower bins would test the silhouette.
    expectForm(makePing(getSonar(12, 12, 1, 0.2, 60), snapshot), test::sphereEcho(1, 10),
               test::times(1.03, test::sphereEcho(1, 10)));
}

TEST(ClosedFormTest, BinsAtTheLimbOfASphereAreRightToTheirPixels) {
    // The last pixel before the limb is 4 mm wide and spans sqrt(2 * 1 m * 4 mm), 0.09 m of range, on a sphere of 1 m:
    // there a bin of 0.025 m depends on single pixels, each rasterised as the plane of its triangle.
    const double limb = std::sqrt(99.0), pixel = 0.09;
    const auto snapshot = test::makeSnapshot(test::makeScene({test::sphere(1, 512)}, 0, {{10, 0, 0}}));
    const types::Sonar ping = makePing(getSonar(12, 12, 1, 0.025, 480), snapshot);
    const test::Form form = test::sphereEcho(1, 10);
    double at_limb = 0, right_at_limb = 0, beyond = 0, all = 0;
    for (uint32_t k = 364; k < ping.bin_count; ++k) {  // from 9.1 m on: nearer, facets of the ball fill single bins
        const double near = ping.binStart(k), far = ping.binStart(k + 1), got = ping.bins[k], right = form(near, far);
        all += right;
        if (far < limb - pixel) {
            EXPECT_NEAR(got, right, 0.01 * right) << near;
            continue;
        }
        at_limb += got, right_at_limb += right;
        if (near > limb) beyond += got;
        if (far < limb) {
            EXPECT_NEAR(got, right, 0.25 * right) << near;
        }
    }
    EXPECT_NEAR(at_limb, right_at_limb, 0.03 * right_at_limb) << "what single bins lack, their neighbours have";
    EXPECT_LT(beyond, 1e-4 * all) << "planes of triangles go on beyond the limb";
    EXPECT_GT(std::abs(at_limb - form(limb - 1.15 * pixel, limb)), 0.03 * right_at_limb) << "a wrong limb would show";
}

/** A sphere in a fan of 64 beams, somewhere ahead and turned somehow. */
struct RandomSphere {
    RandomSphere(std::mt19937& random, int rings, int rows, int columns) {
        std::uniform_real_distribution<double> u(0, 1);
        radius = 0.2 * std::pow(10, u(random));
        distance = radius * (4 + 20 * u(random));
        bin = radius / (4 + 16 * u(random));
        mesh = test::sphere(radius, rings);
        const double azimuth = 0.02 * (u(random) - 0.5), elevation = 0.02 * (u(random) - 0.5);
        const glm::dvec4 axis(u(random) - 0.5, u(random) - 0.5, u(random) - 0.5, u(random) - 0.5);
        place = glm::mat4_cast(glm::normalize(glm::dquat(axis.w, axis.x, axis.y, axis.z)));
        place[3] = glm::dvec4(distance * std::cos(elevation) * std::cos(azimuth),
                              distance * std::cos(elevation) * std::sin(azimuth), distance * std::sin(elevation), 1);
        config = test::getSonar({.beams = 64,
                                 .width_deg = 32,
                                 .height_deg = 32,
                                 .bins = static_cast<int>((distance + 2 * radius) / bin),
                                 .bin = bin,
                                 .rows = rows,
                                 .columns = columns});
        config.visibility = Visibility::Cpu;
    }
    /** Energies of all beams together by bin. */
    std::vector<double> receive(types::Sonar& ping) const {
        auto geometry = std::make_shared<types::Geometry>(*test::makeScene({mesh}));
        geometry->objects[0].world_from_object = place;
        ping = makePing(config, test::makeSnapshot(geometry));
        std::vector<double> sums(ping.bin_count);
        for (size_t i = 0; i < ping.bins.size(); ++i) sums[i % ping.bin_count] += static_cast<double>(ping.bins[i]);
        return sums;
    }
    /** The farthest corner of a facet that faces the sonar, which is the limb of the mesh [m]. */
    double meshLimb() const {
        double limb = 0;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            glm::dvec3 corners[3];
            for (size_t k = 0; k < 3; ++k)
                corners[k] = glm::dvec3(place * glm::dvec4(mesh.positions[mesh.indices[i + k]], 1));
            const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (glm::dot(normal, corners[0]) < 0)
                for (const glm::dvec3& corner : corners) limb = std::max(limb, glm::length(corner));
        }
        return limb;
    }

    double radius, distance, bin;
    types::Mesh mesh;
    glm::dmat4 place;
    SonarConfig config;
};

TEST(ClosedFormTest, NoEchoIsBeforeASphereOrBehindItsLimb) {
    std::mt19937 random(11);
    double behind_planes = 0;
    for (const int rings : {64, 256, 512})
        for (const auto& [rows, columns] : {std::pair{64, 2}, {128, 2}, {256, 4}, {512, 8}}) {
            RandomSphere sphere(random, rings, rows, columns);
            types::Sonar ping;
            const std::vector<double> sums = sphere.receive(ping);
            const test::Form form = test::sphereEcho(sphere.radius, sphere.distance);
            const double limb = std::sqrt(std::pow(sphere.distance, 2) - std::pow(sphere.radius, 2));
            const double end = std::max(sphere.meshLimb(), limb), peak = *std::ranges::max_element(sums);
            double last = 0, right = 0;
            for (uint32_t k = 0; k < ping.bin_count; ++k) {
                const double near = ping.binStart(k), far = ping.binStart(k + 1);
                if (far <= sphere.distance - sphere.radius || near >= end) {
                    EXPECT_LT(sums[k], 1e-5 * peak) << near << " of a sphere of " << rings << " rings at " << rows;
                }
                if (far > limb - 3 * (far - near)) last += sums[k], right += form(near, far);
            }
            if (rings > 64 && rows == 512) {
                EXPECT_NEAR(last, right, 0.02 * right);
            }
            sphere.mesh.indices.resize(sphere.mesh.indices.size() - 3);  // open, and so of planes
            sphere.mesh = study::getMesh(sphere.mesh.positions, sphere.mesh.indices);
            const std::vector<double> planes = sphere.receive(ping);
            for (uint32_t k = 0; k < ping.bin_count; ++k)
                if (ping.binStart(k) >= end) behind_planes = std::max(behind_planes, planes[k] / peak);
        }
    EXPECT_GT(behind_planes, 1e-3) << "planes reach behind the limb";
}

TEST(ClosedFormTest, FacetsBendAsTheSmoothClosedBodyDoes) {
    const double radius = 0.7;
    for (const int rings : {16, 64, 256}) {
        types::Mesh ball = test::sphere(radius, rings);
        const auto curves = facetCurves(ball, glm::dmat3(1)), twice = facetCurves(ball, glm::dmat3(2));
        ASSERT_EQ(curves.size(), ball.indices.size() / 3);
        const vec4 bend = curves[curves.size() / 2].bend, wide = twice[twice.size() / 2].bend;
        const double minimum = static_cast<double>(bend.w), more = glm::dot(glm::dvec3(bend), glm::dvec3(bend));
        EXPECT_NEAR(minimum, 1 / radius, 0.05 / radius) << rings;
        EXPECT_NEAR(minimum + more, 1 / radius, 0.05 / radius) << rings;
        EXPECT_NEAR(static_cast<double>(wide.w), minimum / 2, 0.01 * minimum) << rings;
        for (size_t i = 0; i < ball.indices.size(); i += 3) std::swap(ball.indices[i], ball.indices[i + 1]);
        EXPECT_NEAR(static_cast<double>(facetCurves(ball, glm::dmat3(1))[curves.size() / 2].bend.w), minimum,
                    0.01 * minimum)
            << "wound the other way round";
        types::Mesh doubled = ball;
        doubled.indices.insert(doubled.indices.end(), ball.indices.rbegin(), ball.indices.rend());
        const auto once = facetCurves(ball, glm::dmat3(1)), both = facetCurves(doubled, glm::dmat3(1));
        ASSERT_EQ(both.size(), 2 * once.size());
        for (size_t i = 0; i < once.size(); ++i) {
            EXPECT_EQ(both[i].bend, once[i].bend) << "doubled facets";
            EXPECT_EQ(both[both.size() - 1 - i].bend, once[i].bend) << "doubled facets";
        }
        ball.indices.resize(ball.indices.size() - 3);
        EXPECT_TRUE(facetCurves(ball, glm::dmat3(1)).empty()) << "open";
    }
    EXPECT_TRUE(facetCurves(test::ground(-5), glm::dmat3(1)).empty());
    EXPECT_TRUE(facetCurves(study::makeTiles(study::FractalFloor{}, 8).front(), glm::dmat3(1)).empty());
}

TEST(ClosedFormTest, WallAheadFollowsTheThinVerticalBeamForm) {
    const double distance = 10, half = radians(20), delta = radians(1);
    expectForm(makePing(getSonar(1, 40, 1, 0.1, 150), test::makeSnapshot(test::makeScene({test::wall(10)}))),
               test::thinBeamOnWall(distance, half, delta), test::thinBeamOnFadingWall(distance, half, delta));
}

TEST(ClosedFormTest, TwoObjectsAtOneRangeDoubleTheEnergyButNotThePublishedMean) {
    const types::Mesh ball = test::sphere(0.3f, 64);
    const double up = radians(6);
    const glm::dvec3 high(10 * std::cos(up), 0, 10 * std::sin(up)), low(10 * std::cos(up), 0, -10 * std::sin(up));
    const auto one = test::makeSnapshot(test::makeScene({ball}, 0, {high}));
    const auto two = test::makeSnapshot(test::makeScene({ball, ball}, 0, {high, low}));
    const auto config = getSonar(10, 20, 1, 0.1, 120);
    const test::Form single = test::getForm(makePing(config, one));
    expectForm(makePing(config, two), test::times(2, single), single);
    const test::Form mean = test::getForm(makePing(published(config), one));
    expectForm(makePing(published(config), two), mean, test::times(2, mean));
}

TEST(ClosedFormTest, ShadowBehindAScreenEndsWhereTheTopRayMeetsTheBottom) {
    // A screen of height h is on the bottom at horizontal distance R; the sonar is at height H.
    const double height = 5, screen = 2, ground_range = 15;
    const auto geometry = test::makeScene({test::ground(-5), test::quad({15, -50, -5}, {0, 100, 0}, {0, 0, 2})});
    const auto ping = makePing(getSonar(1, 60, 1, 0.1, 400), test::makeSnapshot(geometry));
    const auto first_dark = static_cast<size_t>(std::hypot(ground_range, height) / 0.1) + 2;
    size_t end = first_dark;
    while (end < 400 && ping.bins[end] == 0) ++end;
    EXPECT_NEAR(end * 0.1, test::shadowEnd(height, screen, ground_range), 0.1) << "shadow [m]";
    EXPECT_GT(std::abs(end * 0.1 - ground_range * height / (height - screen)), 0.1) << "ground range is wrong";
}

TEST(ClosedFormTest, AMeshEchoesAsItsTilesDo) {
    study::StudyScene scene = study::roughFloor();
    scene.config.visibility = Visibility::Cpu;
    std::vector<types::Mesh> tiles = study::makeTiles(study::FractalFloor{}, 8);  // of 64 x 64 squares
    std::vector<glm::dvec3> a_millimetre_apart;
    for (size_t i = 0; i < tiles.size(); ++i)
        a_millimetre_apart.push_back(1e-3 *
                                     glm::dvec3(static_cast<double>(i / 8) - 4, static_cast<double>(i % 8) - 4, 0));
    types::Snapshot cut = scene.snapshot, apart = scene.snapshot;
    cut.geometry = study::makeScene(tiles);
    apart.geometry = study::makeScene(std::move(tiles), std::move(a_millimetre_apart));
    scene.config.quality.columns_per_beam = 2;
    for (const int rows : {128, 256}) {
        scene.config.quality.rows = rows;
        const types::Sonar whole = makePing(scene.config, scene.snapshot);
        const auto off = [&](const types::Snapshot& snapshot) {
            const std::vector<double> reference(whole.bins.begin(), whole.bins.end());
            return sonar::compare(makePing(scene.config, snapshot).bins, reference,
                                  {static_cast<int>(whole.beam_count), static_cast<int>(whole.bin_count),
                                   whole.binStart(1) - whole.binStart(0), 0})
                .rel_l2_tvg;
        };
        const double joined = off(cut);
        EXPECT_LT(joined, 0.002) << rows << " rows";
        EXPECT_GT(off(apart), 0.002) << rows << " rows, each tile ends at its own ranges";
        RecordProperty("joined_" + std::to_string(rows), std::to_string(joined));
    }
}

TEST(CerqueiraLimitTest, EveryPlaneIsTheSigmoidOfDistanceOverRange) {
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-5)}));
    expectForm(makePing(published(getSonar(130, 80, 64, 0.1, 300)), snapshot), test::publishedBottom(5, radians(40)),
               test::publishedBottom(5.05, radians(40)));
}

TEST(CerqueiraLimitTest, ThePlanesLimitDoesNotDependOnPitch) {
    auto config = published(getSonar(130, 40, 64, 0.1, 300));
    const auto ping = makePing(config, test::makeSnapshot(test::makeScene({test::ground(-5)}), {}, 0, radians(15)));
    for (uint32_t beam = 16; beam < 48; ++beam)  // beams that see all of 10 to 25 m
        for (uint32_t k = 100; k < 250; ++k) {
            const double right = test::sigmoid(5 / ping.binStart(k + 0.5));
            EXPECT_NEAR(ping.bins[beam * ping.bin_count + k], right, 0.01 * right + 1e-5) << beam << " " << k;
        }
    const double wrong = test::sigmoid(1.05 * 5 / ping.binStart(110.5));
    EXPECT_GT(std::abs(ping.bins[32 * 300 + 110] - wrong), 0.01 * wrong);
}

TEST(CerqueiraLimitTest, SphereIsTheSigmoidOfItsIncidence) {
    // The first and last range of the sphere are inside bins. A mean has no weight, so a bin that only a rounding
    // touches shows the sphere in full.
    const auto snapshot = test::makeSnapshot(test::makeScene({test::sphere(1, 256)}, 0, {{10.03, 0, 0}}));
    expectForm(makePing(published(getSonar(14, 14, 1, 0.1, 120)), snapshot), test::publishedSphere(1, 10.03),
               test::publishedSphere(1.02, 10.05));
}

}  // namespace insonify::sonar
