// Cases of ACOUSTICS.md 11.2.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::Ge;
using ::testing::HasSubstr;

SonarConfig stiffFan(double field_of_view_deg = 60, int beams = 16, int bins = 200) {
    return test::getSonar({.beams = beams, .width_deg = field_of_view_deg, .height_deg = 40, .bins = bins});
}

std::vector<float> stiffBins(const SonarConfig& config, const types::GeometryPtr& geometry,
                             const RenderOptions& options = {}) {
    return test::makePing(config, test::makeSnapshot(geometry), options).bins;
}

std::vector<types::Mesh> wallAndBall() { return {test::wall(12), test::sphere(1.5, 48)}; }

/** Returns the wall and ball after `change`. */
std::vector<float> receivedWith(const auto& change) {
    std::vector<types::Mesh> meshes = wallAndBall();
    for (types::Mesh& mesh : meshes) change(mesh);
    return stiffBins(stiffFan(), test::makeScene(std::move(meshes), 0, {{0, 0, 0}, {9, 1, -0.5}}));
}

}  // namespace

TEST(StiffCasesTest, DegenerateTrianglesNormalsAndWindingChangeNoEcho) {
    const std::vector<float> plain = receivedWith([](types::Mesh&) {});
    EXPECT_THAT(plain, Contains(testing::Gt(0)));
    EXPECT_EQ(receivedWith([](types::Mesh& mesh) {
                  mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2});
                  mesh.positions.push_back(0.5f * (mesh.positions[0] + mesh.positions[2]));
                  mesh.indices.insert(mesh.indices.end(), {0, static_cast<uint32_t>(mesh.positions.size() - 1), 2});
                  mesh.clusters[0].index_count = static_cast<uint32_t>(mesh.indices.size());
              }),
              plain)
        << "repeated corners, and three in a line";
    EXPECT_EQ(receivedWith([](types::Mesh& mesh) { mesh.normals.assign(mesh.positions.size(), glm::vec3(0)); }), plain);
    EXPECT_EQ(receivedWith([](types::Mesh& mesh) {
                  for (size_t i = 0; i < mesh.indices.size(); i += 3)
                      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
              }),
              plain)
        << "wound the other way";
}

/** A plate at each of 399 edges that are exact in binary. */
TEST(StiffCasesTest, ASurfaceOnTheEdgeOfABinIsInTheBinThatBeginsThere) {
    SonarConfig config = stiffFan(10, 1, 400);
    config.range = 50;
    config.speed_of_sound = 1250;  // 0.125 m a bin
    config.range_min = 0.05;
    config.beam_height_deg = 10;
    config.quality.rows = 16;
    config.quality.columns_per_beam = 2;
    const auto geometry = test::makeScene({test::wall(0)});
    SonarRenderer renderer(config, geometry);
    for (int bin = 1; bin < 400; ++bin) {
        types::Sonar ping;
        renderer.render(test::makeSnapshot(geometry, {-0.125 * bin, 0, 0}), ping);
        const auto first = std::ranges::find_if(ping.bins, [](float echo) { return echo > 0; });
        EXPECT_EQ(first - ping.bins.begin(), bin);
    }
}

TEST(StiffCasesTest, ReportsFrequenciesOutsideTheLawsAndKeepsEchoesFinite) {
    for (const double khz : {0.0, 1e4})
        for (const auto law : {acoustics::AbsorptionLaw::FrancoisGarrison, acoustics::AbsorptionLaw::AinslieMccolm}) {
            SonarConfig config = stiffFan();
            config.water.emplace();
            config.absorption.emplace().frequency_khz = khz;
            config.absorption->law = law;
            EXPECT_THAT(configNotices(config), Contains(HasSubstr("outside its law's validity"))) << khz;
            const std::vector<float> bins = stiffBins(config, test::makeScene({test::ground(-1)}));
            EXPECT_THAT(bins, Each(testing::AllOf(Ge(0), testing::Lt(INFINITY)))) << khz;
            EXPECT_GT(bins[35], 0) << khz;
        }
}

TEST(StiffCasesTest, TheNumberOfThreadsThatSumARasterisedPingChangesNoBit) {
    for (const Model model : {Model::Physical, Model::Cerqueira2017}) {
        SonarConfig config = stiffFan(130, 61, 300);
        config.model = model;
        config.device = "software";
        config.deposit = Deposit::Cpu;
        const auto scene = test::surfaces();
        const std::vector<float> alone = stiffBins(config, scene, {.threads = 1});
        EXPECT_THAT(alone, Contains(testing::Gt(0)));
        for (const int threads : {2, 3, 5, 8, 16})
            EXPECT_EQ(stiffBins(config, scene, {.threads = threads}), alone) << threads << " threads";
    }
}

TEST(StiffCasesTest, AReusedSampleKeepsNothingOfItsOldPing) {
    const auto scene = test::surfaces();
    const SonarConfig small = stiffFan(40, 5, 120), large = stiffFan(130, 61, 300);
    types::Sonar ping;
    for (const SonarConfig& config : {large, small, large, small}) {
        SonarRenderer(config, scene).render(test::makeSnapshot(scene), ping);
        EXPECT_EQ(ping.bins, stiffBins(config, scene));
    }
    SonarRenderer renderer(large, scene);
    renderer.render(test::makeSnapshot(scene), ping);
    renderer.render(test::makeSnapshot(scene, {0, 0, 1000}), ping);
    EXPECT_THAT(ping.bins, Each(0)) << "far above all";
}

/** Within a cell such a plane extends from the sonar to infinity; its plate does not. */
TEST(StiffCasesTest, APlateBeyondTheRangeHasNoEchoWhereItsPlanePassesTheSonar) {
    std::mt19937 random(3);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    int received = 0;
    for (int i = 0; i < 60; ++i) {
        SonarConfig config = stiffFan(130, 64);
        config.frequency_khz = 700;
        config.beam_pattern.emplace().receive.azimuth.emplace().weighting = acoustics::Weighting::Taylor;
        config.beam_pattern->receive.azimuth->width_deg = 3;
        const double bearing = uniform(-1, 1), distance = uniform(3, 6), length = 3 * distance, height = uniform(1, 2);
        const glm::dvec3 along(std::cos(bearing), std::sin(bearing), 0), aside(-along.y, along.x, 0);
        const glm::dvec3 corner = distance * along + uniform(0.05, 0.3) * aside - glm::dvec3(0, 0, height / 2);
        const auto scene = test::makeScene({test::quad(corner, length * along, {0, 0, height})});
        for (const double range : {0.5, 0.7, 0.9}) {
            config.range = range * distance;
            EXPECT_THAT(stiffBins(config, scene), Each(0)) << i << ", range " << config.range;
        }
        config.range = 4 * distance;
        received += std::ranges::max(stiffBins(config, scene)) > 0;
    }
    EXPECT_GT(received, 50) << "of 60: a plate may be between the samples";
}

TEST(StiffCasesTest, RejectsATooLargePictureWithAMessage) {
    SonarConfig config = stiffFan(120, 4096);
    config.quality.rows = 16384;
    config.quality.columns_per_beam = 256;
    config.visibility = Visibility::Gl;
    EXPECT_THAT(test::computeError<std::exception>([&] { stiffBins(config, test::makeScene({test::wall(10)})); }),
                HasSubstr("cannot render"));
}

}  // namespace insonify::sonar
