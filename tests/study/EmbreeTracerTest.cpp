// The independent ray tracer: correct to second order as well, and as fast as rays can be.
#include <gmock/gmock.h>

#include <algorithm>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/renderer/Metrics.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StudyScene.hpp"
#include "components/study/oracles/EmbreeTracer.hpp"
#include "tests/support/Allocations.hpp"

namespace insonify::study {
namespace {

using sonar::compare, sonar::Layout, sonar::Metrics;

StudyScene sceneNamed(const std::string& name) {
    for (const SceneMaker& scene : closedFormScenes())
        if (scene.name == name) return scene.make();
    throw std::invalid_argument(name);
}

struct Received {
    std::vector<float> energies;
    double kappa;
};

Received trace(StudyScene scene, int rows, int columns) {
    setSamples(scene.config, rows, columns);
    EmbreeTracer tracer(scene.snapshot);
    tracer.prepare(scene.config);
    Received received;
    tracer.render(scene.snapshot.sonar, received.energies);
    received.kappa = tracer.kappaMax();
    return received;
}

double computeError(const StudyScene& scene, int rows, int columns) {
    const sonar::BinGrid grid = sonar::makeBinGrid(scene.config);
    return compare(trace(scene, rows, columns).energies, trueEnergies(scene),
                   {scene.config.beam_count, grid.bin_count, grid.bin_width, scene.range_from})
        .rel_l2;
}

TEST(EmbreeTracerTest, PlanesConvergeLikeFootprints) {
    for (const char* name : {"flat_bottom_pitched", "tilted_plane", "wall"}) {
        const double coarse = computeError(sceneNamed(name), 64, 1), fine = computeError(sceneNamed(name), 256, 4);
        EXPECT_LT(coarse, 0.02) << name;
        EXPECT_LT(fine, coarse / 10) << name << ": second order in the cell's size would be 16";
    }
    EXPECT_LT(computeError(sceneNamed("flat_bottom_edge"), 64, 1), 1e-5)
        << "cells between equal elevations are exact here";
}

TEST(EmbreeTracerTest, SilhouettesAreCorrectToTheirPixels) {
    EXPECT_LT(computeError(sceneNamed("sphere"), 256, 256), 0.005);
    EXPECT_LT(computeError(sceneNamed("shadow_screen"), 256, 4), 0.02);
}

TEST(EmbreeTracerTest, AMovedObjectIsAtItsNewPlace) {
    StudyScene scene = sceneNamed("sphere");
    glm::dmat4 place(1);
    place[3] = glm::dvec4(11.05, 0, 0, 1);
    scene.snapshot.moved = {{0, place}};
    scene.config.range = 15;
    scene.config.bin_count = 150;
    const std::vector<float> moved = trace(scene, 128, 128).energies;
    const auto first = std::ranges::find_if(moved, [](float e) { return e > 0; }) - moved.begin();
    EXPECT_EQ(first, 100);  // 10.05 m
}

TEST(EmbreeTracerTest, BlankedSurfacesStillHide) {
    StudyScene scene{"", "", fan(60, 20, 7, 15), lookingAt(makeScene({facingWall(10), facingWall(0.5f)})), {}};
    scene.config.range_min = 0.6;
    const std::vector<float> received = trace(scene, 64, 2).energies;
    for (int bin = 7; bin < scene.config.bin_count; ++bin) EXPECT_EQ(received[static_cast<size_t>(bin)], 0) << bin;
}

TEST(EmbreeTracerTest, ReportsTheLongestCellInBins) {
    const double coarse = trace(sceneNamed("wall"), 32, 2).kappa, fine = trace(sceneNamed("wall"), 128, 8).kappa;
    EXPECT_GT(coarse, 1);
    EXPECT_NEAR(coarse / fine, 4, 1);
}

TEST(EmbreeTracerTest, ItsSumsDoNotDependOnTheOrderOfThreads) {
    StudyScene many = sceneNamed("tilted_plane"), one = sceneNamed("two_spheres");
    for (const StudyScene& scene : {many, one}) {
        const std::vector<float> first = trace(scene, 128, 8).energies;
        for (int i = 0; i < 3; ++i) EXPECT_EQ(trace(scene, 128, 8).energies, first) << scene.name;
    }
}

TEST(EmbreeTracerTest, TracesRaysWithoutEnergies) {
    StudyScene scene = sceneNamed("flat_bottom");
    setSamples(scene.config, 66, 3);  // not a multiple of tiles
    scene.config.beam_count = 33;
    EmbreeTracer tracer(scene.snapshot);
    tracer.prepare(scene.config);
    EXPECT_EQ(tracer.traceOnly(scene.snapshot.sonar), 32u * 33 * 3) << "33 rows look down, one beyond the ground's end";
}

TEST(EmbreeTracerTest, APingAllocatesNothing) {
    const StudyScene scene = sceneNamed("tilted_plane");
    EmbreeTracer tracer(scene.snapshot);
    tracer.prepare(scene.config);
    std::vector<float> energies;
    tracer.render(scene.snapshot.sonar, energies);
    test::takeCounted();
    test::countHere(true);
    tracer.render(scene.snapshot.sonar, energies);
    test::countHere(false);
    EXPECT_THAT(test::takeCounted(), testing::IsEmpty());
}

TEST(EmbreeTracerTest, AnEmptySceneIsSilent) {
    StudyScene scene = sceneNamed("wall");
    scene.snapshot.geometry = std::make_shared<types::Geometry>();
    const std::vector<float> energies = trace(scene, 64, 2).energies;
    EXPECT_EQ(std::ranges::count(energies, 0.0f), static_cast<std::ptrdiff_t>(energies.size()));
}

}  // namespace
}  // namespace insonify::study
