// Rays on the processor: they meet the rasterised triangles, and their pings match the closed forms.
#include <gmock/gmock.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/raster/Culler.hpp"
#include "components/sonar/raster/SurfacePass.hpp"
#include "components/sonar/rays/RayVisibility.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using types::radians;

SonarConfig seenFan(Visibility visibility) {
    SonarConfig config =
        test::getSonar({.beams = 50, .width_deg = 100, .height_deg = 50, .bins = 400, .rows = 256, .columns = 8});
    config.visibility = visibility;
    if (visibility == Visibility::Gl) config.device = "software";
    return config;
}

/** An object and one of its triangles; no object for a miss. */
using SeenPart = std::pair<uint32_t, uint32_t>;
constexpr SeenPart nothing{0xffffffff, 0};

/** Returns the rasterised triangle in each pixel of the frusta. */
std::vector<SeenPart> seenIn(const types::Snapshot& snapshot, const std::vector<ViewFrustum>& frusta) {
    gpu::EglContext context("software");
    Culler culler(*snapshot.geometry, {.range_min = 0, .reach = {1e4}, .draw_all = true});
    ThreadPool threads(1);
    const MaterialLaws laws = makeMaterialLaws({}, *snapshot.geometry);
    SurfacePass surface(context, {*snapshot.geometry, laws, frusta, {}, 1e-3, true}, culler, threads);
    culler.place(snapshot);
    surface.cull();
    surface.draw();
    std::vector<SeenPart> seen;
    for (size_t i = 0; i < frusta.size(); ++i) {
        const size_t count = 2 * static_cast<size_t>(frusta[i].columns * frusta[i].rows);
        gpu::ReadBack read(surface.picture(i).bytes());
        surface.picture(i).read(read);
        const std::span words(static_cast<const uint32_t*>(read.wait()), count);
        const auto commands = surface.lists().commands(i);
        for (size_t pixel = 0; pixel < words.size(); pixel += 2)
            seen.push_back(words[pixel] == 0 ? nothing : SeenPart{commands[words[pixel] - 1].object, words[pixel + 1]});
    }
    return seen;
}

/** Returns the triangles that rays through the centres of the same pixels meet. */
std::vector<SeenPart> met(const types::Snapshot& snapshot, const std::vector<ViewFrustum>& frusta) {
    RayVisibility visibility(*snapshot.geometry);
    visibility.place(snapshot);
    std::vector<SeenPart> seen;
    for (const ViewFrustum& frustum : frusta)
        for (int first = 0; first < frustum.rows * frustum.columns; first += tile_samples) {
            TileRays rays;
            TileHits hits;
            for (int i = 0; i < tile_samples; ++i) {
                const double u = frustum.u((first + i) % frustum.columns + 0.5),
                             v = frustum.v((first + i) / frustum.columns + 0.5);
                const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth);
                rays.x[i] = static_cast<float>(cosine - sine * u);
                rays.y[i] = static_cast<float>(sine + cosine * u);
                rays.z[i] = static_cast<float>(v);
            }
            visibility.trace({&rays, 1}, {&hits, 1});
            for (int i = 0; i < tile_samples && first + i < frustum.rows * frustum.columns; ++i)
                seen.push_back(hits.command[i] == TileHits::nothing
                                   ? nothing
                                   : SeenPart{visibility.commands()[hits.command[i]].object, hits.triangle[i]});
        }
    return seen;
}

/** Returns the scene without normal maps, which the two paths look up differently, and with a thick plate. The echo of
 *  a thin plate edge-on in one or two pixels would depend on the places of samples. */
std::shared_ptr<types::Geometry> plainSurfaces() {
    auto geometry = test::surfaces();
    geometry->materials[1].normal_map = -1;
    geometry->objects[3].world_from_object = glm::scale(geometry->objects[3].world_from_object, {1.0, 50.0, 1.0});
    return geometry;
}

types::Snapshot movedScene() {
    types::Snapshot snapshot = test::makeSnapshot(plainSurfaces(), {0, 0, 0}, 0.1, 0.15, 0.05);
    snapshot.moved = {{1, glm::translate(glm::dmat4(1), {8, -2, -1})},
                      {2, glm::scale(glm::rotate(glm::translate(glm::dmat4(1), {10, 4, 0}), 1.0, glm::dvec3(1, 1, 0)),
                                     {1.0, -2.0, 0.5})}};
    return snapshot;
}

/** Returns the scene far from the origin of the world, as in UTM coordinates. */
types::Snapshot farScene() {
    const glm::dvec3 away(463'000, 5'937'000, 0);
    auto geometry = plainSurfaces();
    for (types::Object& object : geometry->objects) object.world_from_object[3] += glm::dvec4(away, 0);
    return test::makeSnapshot(geometry, away, 0.1, 0.15, 0.05);
}

struct Scene {
    const char* name;
    types::Snapshot snapshot;
};
std::vector<Scene> seenScenes() {
    return {{"open, closed, mirrored, scaled, several of one mesh",
             test::makeSnapshot(plainSurfaces(), {0, 0, 0}, 0.1, 0.15, 0.05)},
            {"behind", test::makeSnapshot(plainSurfaces(), {0, 0, 0}, 2.3, 0.05, 0)},
            {"moved", movedScene()},
            {"far", farScene()}};
}

}  // namespace

TEST(VisibilityTest, RaysMeetTheRasterisedTriangles) {
    const SonarConfig config = seenFan(Visibility::Gl);
    const std::vector<ViewFrustum> frusta = makeFrusta(config, makeBeams(config));
    for (const Scene& scene : seenScenes()) {
        const std::vector<SeenPart> pixels = seenIn(scene.snapshot, frusta), rays = met(scene.snapshot, frusta);
        ASSERT_EQ(pixels.size(), rays.size());
        size_t differ = 0, something = 0;
        for (size_t i = 0; i < pixels.size(); ++i) {
            differ += pixels[i] != rays[i];
            something += pixels[i] != nothing;
        }
        EXPECT_GT(something, pixels.size() / 10) << scene.name;
        EXPECT_LE(static_cast<double>(differ), 0.001 * static_cast<double>(pixels.size())) << scene.name;
    }
}

TEST(VisibilityTest, RayTracedPingsMatchRasterisedPingsUpToTheSampling) {
    for (const Scene& scene : seenScenes())
        for (Model model : {Model::Physical, Model::Cerqueira2017})
            for (BeamGeometry beams : {BeamGeometry::Planar, BeamGeometry::Conical}) {
                SonarConfig gl = seenFan(Visibility::Gl), cpu = seenFan(Visibility::Cpu);
                gl.quality.rows = cpu.quality.rows = 512;
                gl.model = cpu.model = model;
                gl.beam_geometry = cpu.beam_geometry = beams;
                // In a mean, bins with few samples count like other bins.
                EXPECT_LT(test::relativeL2(makePing(cpu, scene.snapshot), makePing(gl, scene.snapshot)),
                          model == Model::Physical ? 0.03 : 0.16)
                    << scene.name << (model == Model::Physical ? ", physical" : ", cerqueira2017")
                    << (beams == BeamGeometry::Planar ? ", planar" : ", conical");
            }
    SonarConfig other = seenFan(Visibility::Cpu);
    other.beam_height_deg = 40;
    EXPECT_GT(test::relativeL2(makePing(other, seenScenes()[0].snapshot),
                               makePing(seenFan(Visibility::Gl), seenScenes()[0].snapshot)),
              0.03);
}

TEST(VisibilityTest, NormalMapsHaveTheSameEffectInBoth) {
    const auto snapshot = test::makeSnapshot(test::surfaces(), {10, 0, -2});
    SonarConfig gl = seenFan(Visibility::Gl), cpu = seenFan(Visibility::Cpu);
    const types::Sonar raster_ping = makePing(gl, snapshot), traced_ping = makePing(cpu, snapshot);
    const types::Sonar flat = makePing(cpu, test::makeSnapshot(plainSurfaces(), {10, 0, -2}));
    EXPECT_LT(test::relativeL2(traced_ping, raster_ping), 0.03);
    EXPECT_GT(test::relativeL2(flat, raster_ping), 0.06);
}

TEST(VisibilityTest, PingsHaveTheSameBytesForAnyNumberOfThreads) {
    for (int columns : {1, 2, 3, 8, 512}) {  // the last: beams that several threads share
        SonarConfig config = seenFan(Visibility::Cpu);
        config.quality.columns_per_beam = columns;
        config.beam_count = columns == 512 ? 2 : 50;
        const std::vector<float> alone = makePing(config, movedScene(), {.threads = 1}).bins;
        EXPECT_GT(std::accumulate(alone.begin(), alone.end(), 0.0), 0);
        for (int threads : {2, 5})
            EXPECT_EQ(makePing(config, movedScene(), {.threads = threads}).bins, alone)
                << threads << " threads, " << columns << " columns";
    }
}

TEST(VisibilityTest, APingDoesNotDependOnEarlierPlacesOfTheSonar) {
    const types::GeometryPtr geometry = plainSurfaces();
    const types::Snapshot last = test::makeSnapshot(geometry, {0.3, 0.2, 0.1}, 0.1, 0.15, 0.05);
    SonarRenderer renderer(seenFan(Visibility::Cpu), geometry);
    types::Sonar ping;
    for (const glm::dvec3& place : {glm::dvec3(-7.123, 3.21, 0.4), glm::dvec3(400, 1, 0)})
        renderer.render(test::makeSnapshot(geometry, place, 0.1, 0.15, 0.05), ping);
    renderer.render(last, ping);
    EXPECT_GT(std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0), 0);
    EXPECT_EQ(ping.bins, makePing(seenFan(Visibility::Cpu), last).bins);
}

TEST(VisibilityTest, AnObjectMovesFromPingToPing) {
    const types::Snapshot still = test::makeSnapshot(plainSurfaces(), {0, 0, 0}, 0.1, 0.15, 0.05), moved = movedScene();
    SonarRenderer renderer(seenFan(Visibility::Cpu), still.geometry);
    types::Snapshot later = moved;
    later.geometry = still.geometry;
    types::Sonar before, after, again;
    renderer.render(still, before);
    renderer.render(later, after);
    renderer.render(still, again);
    EXPECT_EQ(after.bins, makePing(seenFan(Visibility::Cpu), moved).bins);
    EXPECT_LT(test::relativeL2(again, before), 1e-6) << "at its place again, by a tree of its own";
    EXPECT_GT(test::relativeL2(after, before), 0.05);
}

TEST(VisibilityTest, APingDoesNotDependOnEarlierPings) {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.resize(1);
    geometry->meshes = {test::sphere(0.4f, 40)};
    for (const double x : {8, 264, 708})
        geometry->objects.push_back({"ball", 0, glm::translate(glm::dmat4(1), {x, 1, -0.5})});
    const SonarConfig config = seenFan(Visibility::Cpu);
    SonarRenderer renderer(config, geometry);
    // Places on both sides of a change of the tree's origin, back and forth.
    for (const double x : {0.3, 255.9, 256.1, 255.95, 256.2, 700.0, 0.3}) {
        const types::Snapshot snapshot = test::makeSnapshot(geometry, {x, 0, 0}, 0.1, 0.15);
        types::Sonar ping;
        renderer.render(snapshot, ping);
        EXPECT_GT(*std::ranges::max_element(ping.bins), 0) << x;
        EXPECT_EQ(ping.bins, makePing(config, snapshot).bins) << x;
    }
}

TEST(VisibilityTest, InstancesOfLargeMeshesEchoTheSame) {
    // 70 balls of 65,000 triangles are too many to be copied.
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.resize(1);
    geometry->meshes = {test::sphere(0.4f, 180), test::ground(-3)};
    for (int i = 0; i < 70; ++i)
        geometry->objects.push_back({"ball " + std::to_string(i), 0,
                                     glm::translate(glm::dmat4(1), {6 + 2.0 * (i % 7), 1.5 * (i / 7) - 7, -1})});
    geometry->objects.push_back({"ground", 1, glm::dmat4(1)});
    ASSERT_GT(geometry->triangleCount(), 4'000'000u);
    const auto snapshot = test::makeSnapshot(geometry, {0, 0, 0}, 0, 0.15);
    EXPECT_LT(
        test::relativeL2(makePing(seenFan(Visibility::Cpu), snapshot), makePing(seenFan(Visibility::Gl), snapshot)),
        0.03);
}

TEST(VisibilityTest, AnApertureOf120And170DegOfElevationFollowsTheClosedForm) {
    // One wide beam straight down on a flat bottom, as of an altimeter: a plane that faces the sonar.
    for (double height_deg : {120.0, 170.0, 180.0}) {
        SonarConfig config = seenFan(Visibility::Cpu);
        config.beam_count = 1;
        config.field_of_view_deg = 1;
        config.beam_height_deg = height_deg;
        config.quality.rows = 1024;
        config.quality.columns_per_beam = 8;
        config.range = 30;
        config.bin_count = 300;
        const auto down = test::makeSnapshot(test::makeScene({test::ground(-5)}), {}, 0, radians(90));
        const double half = radians(height_deg / 2), delta = radians(1);
        test::expectForm(makePing(config, down), test::thinBeamOnWall(5, half, delta),
                         test::thinBeamOnFadingWall(5, half, delta));
    }
}

TEST(VisibilityTest, RejectsATallImageThatRaysAccept) {
    SonarConfig config = seenFan(Visibility::Gl);
    config.beam_height_deg = 170;
    EXPECT_THAT(test::countRefusals(config), testing::ElementsAre(testing::HasSubstr("rays (visibility: cpu) 180")));
    config.visibility = Visibility::Cpu;
    config.device.clear();
    EXPECT_THAT(test::countRefusals(config), testing::IsEmpty());
}

}  // namespace insonify::sonar
