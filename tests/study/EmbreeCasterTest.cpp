// Rays and the rasteriser are two programs for one estimate: they agree far better than either with the truth.
#include <gtest/gtest.h>

#include <algorithm>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "components/study/EmbreeCaster.hpp"
#include "components/study/Metrics.hpp"
#include "components/study/StudyScene.hpp"

namespace insonify::study {
namespace {

StudyScene sceneNamed(const std::string& name) {
    for (StudyScene& scene : closedFormScenes())
        if (scene.name == name) return scene;
    throw std::invalid_argument(name);
}

struct Pair {
    std::vector<float> rays, drawn;
    double difference;
    double kappa;
};

Pair both(const StudyScene& scene, int rows, int columns) {
    sonar::SonarConfig config = scene.config;
    config.quality.rows = rows;
    config.quality.columns_per_beam = columns;
    Pair pair;
    EmbreeCaster caster(scene.snapshot);
    caster.render(scene.snapshot.sonar, config, pair.rays);
    pair.kappa = caster.kappaMax();
    sonar::SonarRenderer renderer(config, scene.snapshot.geometry);
    types::Sonar ping;
    renderer.render(scene.snapshot, ping);
    pair.drawn = ping.bins;
    const std::vector<double> reference(pair.rays.begin(), pair.rays.end());
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    pair.difference = compare(pair.drawn, reference, {config.beam_count, grid.bin_count, grid.bin_width, 0}).rel_l2;
    return pair;
}

TEST(EmbreeCasterTest, PlanesAreTheSameToRounding) {
    EXPECT_LT(both(sceneNamed("flat_bottom_edge"), 128, 2).difference, 1e-5);
    EXPECT_LT(both(sceneNamed("tilted_plane"), 128, 2).difference, 1e-4);  // no bound by the plane's own distance
}

TEST(EmbreeCasterTest, SilhouettesDifferInFewPixels) {
    EXPECT_LT(both(sceneNamed("sphere"), 128, 128).difference, 1e-3);
    EXPECT_LT(both(sceneNamed("shadow_screen"), 128, 4).difference, 1e-2);
}

TEST(EmbreeCasterTest, AMovedObjectIsWhereItWasMovedTo) {
    StudyScene scene = sceneNamed("sphere");
    glm::dmat4 place(1);
    place[3] = glm::dvec4(11.05, 0, 0, 1);
    scene.snapshot.moved = {{0, place}};
    scene.config.range = 15;
    scene.config.bin_count = 150;
    const Pair moved = both(scene, 128, 128);
    EXPECT_LT(moved.difference, 1e-3);
    const auto first = std::ranges::find_if(moved.rays, [](float e) { return e > 0; }) - moved.rays.begin();
    EXPECT_EQ(first, 100);  // 10.05 m
}

TEST(EmbreeCasterTest, TheLongestCellIsToldInBins) {
    const double coarse = both(sceneNamed("wall"), 32, 2).kappa, fine = both(sceneNamed("wall"), 128, 8).kappa;
    EXPECT_GT(coarse, 1);
    EXPECT_NEAR(coarse / fine, 4, 1);
}

TEST(EmbreeCasterTest, AnEmptySceneIsSilent) {
    StudyScene scene = sceneNamed("wall");
    scene.snapshot.geometry = std::make_shared<types::Geometry>();
    std::vector<float> energies;
    EmbreeCaster caster(scene.snapshot);
    caster.render(scene.snapshot.sonar, scene.config, energies);
    EXPECT_EQ(std::ranges::count(energies, 0.0f), static_cast<std::ptrdiff_t>(energies.size()));
}

}  // namespace
}  // namespace insonify::study
