// Brute force, the reference of scenes without a closed form, compared with scenes that have a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/renderer/Metrics.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StudyScene.hpp"
#include "components/study/oracles/PointTracer.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using sonar::compare, sonar::Layout, sonar::Metrics;

using types::radians;

struct Errors {
    double true_error, estimated;
};

/** Returns the errors of the mean of two halves: from the truth, and estimated from the halves. */
Errors errors(const StudyScene& scene, int up, int across) {
    PointTracer tracer(scene.snapshot);
    std::vector<double> mean = tracer.render(scene.snapshot.sonar, scene.config, up, across, 1);
    const std::vector<double> second = tracer.render(scene.snapshot.sonar, scene.config, up, across, 2);
    const std::vector<float> half(mean.begin(), mean.end());
    for (size_t i = 0; i < mean.size(); ++i) mean[i] = (mean[i] + second[i]) / 2;
    const sonar::BinGrid grid = sonar::makeBinGrid(scene.config);
    const Layout layout{scene.config.beam_count, grid.bin_count, grid.bin_width, scene.range_from};
    return {compare(std::vector<float>(mean.begin(), mean.end()), trueEnergies(scene), layout).rel_l2,
            compare(half, mean, layout).rel_l2};
}

StudyScene studyNamed(const std::string& name) {
    for (const SceneMaker& scene : closedFormScenes())
        if (scene.name == name) return scene.make();
    throw std::invalid_argument(name);
}

class PointTracerTest : public testing::TestWithParam<const char*> {};

TEST_P(PointTracerTest, ItsErrorIsThatEstimatedFromItsHalvesAndFallsWithRays) {
    const StudyScene scene = studyNamed(GetParam());
    const int across = std::max(1, 8 / scene.config.beam_count);
    const Errors coarse = errors(scene, 8, across), fine = errors(scene, 32, 4 * across);
    EXPECT_LT(fine.estimated, coarse.estimated / 3) << "16 times the tiles: 8 with independent tiles, 4 without";
    const double facets = 1.5e-3;  // of the ball, which approximates a sphere
    EXPECT_LT(fine.true_error, 1.3 * fine.estimated + facets);
    EXPECT_GT(fine.true_error, 0.7 * fine.estimated);
    EXPECT_LT(fine.true_error, 0.01);
    RecordProperty("estimated", std::to_string(fine.estimated));
    RecordProperty("true_error", std::to_string(fine.true_error));
}

INSTANTIATE_TEST_SUITE_P(Scenes, PointTracerTest,
                         testing::Values("flat_bottom_edge", "tilted_plane", "wall", "sphere", "shadow_screen"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(PointTracerTest, EqualSeedsGiveEqualSumsAndOtherSeedsOthers) {
    const StudyScene scene = studyNamed("shadow_screen");
    const auto sums = [&](uint64_t seed) {
        return PointTracer(scene.snapshot).render(scene.snapshot.sonar, scene.config, 50, 3, seed);
    };
    EXPECT_EQ(sums(1), sums(1));
    EXPECT_NE(sums(1), sums(2));
}

/** Returns a wall 10 m ahead whose map tilts its normal everywhere. */
types::GeometryPtr leaningWall(glm::ivec3 rgb) {
    const auto geometry = makeCopy(makeScene({facingWall(10, 20)}));
    types::Mesh& mesh = geometry->meshes[0];
    mesh.normals.assign(4, {-1, 0, 0});
    mesh.tangents.assign(4, {0, -1, 0, 1});  // so that the bitangent is up
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    geometry->normal_maps.push_back(
        {1, 1, {static_cast<uint8_t>(rgb.r), static_cast<uint8_t>(rgb.g), static_cast<uint8_t>(rgb.b)}});
    geometry->materials[0].normal_map = 0;
    return geometry;
}

TEST(PointTracerTest, ANormalMapChangesOnlyTheCosine) {
    const glm::ivec3 rgb(190, 160, 230);
    sonar::SonarConfig config = fan(20, 20, 1, 15);
    setSamples(config, 256, 256);
    const types::Snapshot scene = lookingAt(leaningWall(rgb));
    const std::vector<double> sums = PointTracer(scene).render(scene.sonar, config, 64, 64, 1);
    const glm::dvec3 reported = glm::dvec3(rgb) * (2.0 / 255) - 1.0;
    const glm::dvec3 bent = glm::normalize(glm::dvec3(-reported.z, -reported.x, reported.y));
    double expected = 0;
    for (int i = 0; i < 400; ++i)
        for (int j = 0; j < 400; ++j) {
            const double azimuth = radians(20) * ((i + 0.5) / 400 - 0.5), up = radians(20) * ((j + 0.5) / 400 - 0.5);
            const glm::dvec3 d(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
            expected += -glm::dot(bent, d) * d.x * d.x / 100 * std::cos(up) * std::pow(radians(20) / 400, 2);
        }
    EXPECT_NEAR(std::accumulate(sums.begin(), sums.end(), 0.0), expected, 1e-3 * expected);
    const Probe rasterised = probe(config, scene);
    EXPECT_NEAR(rasterised.energy(), expected, 1e-3 * expected) << "and it is rendered like this";
}

}  // namespace
}  // namespace insonify::study
