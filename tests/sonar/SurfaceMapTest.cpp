// Maps of strengths and of materials on surfaces: levels of painted regions, means over the areas of samples, and no
// other changes (ACOUSTICS.md 3.13).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <random>

#include "components/sonar/rays/SurfaceMapping.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using types::SurfaceMap;

float linear(double decibels) { return static_cast<float>(std::pow(10, decibels / 10)); }

/** Returns a map with or without strengths; other members are set later. */
SurfaceMap makeMap(int width, int height, std::vector<float> strengths = {}, bool repeats = true) {
    return {width, height, std::move(strengths), {}, {}, repeats, repeats};
}

SpeckleConfig coherent() {
    SpeckleConfig config;
    config.coherent = true;
    return config;
}

/** Ground of `size` x `size` metres at z = -5 about the origin; its map's u runs along x, v along y. */
types::Mesh mappedGround(double size) {
    types::Mesh mesh = test::ground(-5, static_cast<float>(size));
    for (const glm::vec3& at : mesh.positions) mesh.map_uvs.emplace_back(at.x / size + 0.5, at.y / size + 0.5);
    return mesh;
}

std::shared_ptr<types::Geometry> groundWith(const SurfaceMap& map, double size = 80) {
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({mappedGround(size)}, -15));
    geometry->meshes[0].maps = {{0, std::make_shared<const SurfaceMap>(map)}};
    geometry->materials[0].max_map_strength = map.strengths.empty() ? 1 : *std::ranges::max_element(map.strengths);
    return geometry;
}

types::GeometryPtr plainGround(float lambert_db = -15) { return test::makeScene({mappedGround(80)}, lambert_db); }

/** Adds a material for the classes of the map. */
int addMaterial(types::Geometry& geometry, float lambert_db) {
    geometry.materials.push_back(geometry.materials[0]);
    geometry.materials.back().lambert_db = lambert_db;
    geometry.materials.back().max_map_strength = 0;
    return static_cast<int>(geometry.materials.size()) - 1;
}

SonarConfig fanOver(int beams = 16) {
    SonarConfig config = test::getSonar({.beams = beams, .width_deg = 90, .height_deg = 60, .rows = 128, .columns = 4});
    config.visibility = Visibility::Cpu;
    return config;
}

std::vector<float> getBins(const types::GeometryPtr& geometry, const SonarConfig& config = fanOver()) {
    return test::makePing(config, test::makeSnapshot(geometry, {0, 0, 0}, 0, types::radians(25))).bins;
}

double sum(const std::vector<float>& bins) { return std::accumulate(bins.begin(), bins.end(), 0.0); }

}  // namespace

TEST(SurfaceMapTest, ANeutralMapChangesNoBin) {
    std::vector<SonarConfig> configs(3, fanOver());
    configs[1].frequency_khz = 400;
    configs[1].speckle = coherent();
    configs[2].motion_in_ping = true;
    for (size_t i = 0; i < configs.size(); ++i)
        EXPECT_EQ(getBins(groundWith(makeMap(3, 5, std::vector<float>(15, 1))), configs[i]),
                  getBins(plainGround(), configs[i]))
            << i;
}

TEST(SurfaceMapTest, EachPaintedRegionHasTheLevelOfItsValue) {
    // A map of 64 x 64 with eight stripes along y, at x from -40 to 40 m.
    const double decibels[8] = {0, 0, 0, 0, -3, -20, 6, -40};
    SurfaceMap map = makeMap(64, 64, {}, false);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) map.strengths.push_back(linear(decibels[x / 8]));
    SonarConfig config = fanOver(1);
    config.field_of_view_deg = 2;
    const std::vector<float> painted = getBins(groundWith(map), config), plain = getBins(plainGround(), config);
    int compared = 0;
    double worst = 0;
    for (size_t k = 0; k < plain.size(); ++k) {
        const double range = (static_cast<double>(k) + 0.5) * 0.1, along = std::sqrt(std::max(range * range - 25, 0.0));
        const double in_stripe = std::fmod(along, 10);
        if (plain[k] == 0 || along < 4 || in_stripe < 2 || in_stripe > 8) continue;  // two texels from a border
        const double expected = std::pow(10, decibels[4 + static_cast<size_t>(along / 10)] / 10);
        worst = std::max(worst, std::abs(painted[k] / plain[k] / expected - 1));
        ++compared;
    }
    std::cout << compared << " bins of painted stripes at most " << worst << " off\n";
    EXPECT_GT(compared, 100);
    EXPECT_LT(worst, 0.01);
}

TEST(SurfaceMapTest, ClassesHaveTheLevelsOfTheirMaterials) {
    SurfaceMap map = makeMap(2, 64, {}, false);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 2; ++x) map.classes.push_back(y < 32 ? 0 : SurfaceMap::no_class);
    auto geometry = groundWith(map);
    map.materials = {addMaterial(*geometry, -25)};
    geometry->materials.back().reflection = 0.5;  // a separate law with a lobe
    geometry->materials.back().roughness_slope = 0.3f;
    geometry->meshes[0].maps[0].map = std::make_shared<const SurfaceMap>(map);
    auto other = std::make_shared<types::Geometry>(*plainGround());
    other->materials[0] = geometry->materials.back();
    const SonarConfig config = fanOver(18);
    const std::vector<float> mapped = getBins(geometry, config), of_class = getBins(other, config),
                             own = getBins(plainGround(), config);
    double worst = 0, border = 0, border_expected = 0;
    for (size_t beam = 0; beam < 18; ++beam)
        for (size_t k = 0; k < 300; ++k) {
            const size_t at = beam * 300 + k;
            if (beam == 8 || beam == 9) {
                border += mapped[at];
                border_expected += (of_class[at] + own[at]) / 2;
                continue;
            }
            const float expected = beam < 8 ? of_class[at] : own[at];  // beam 0 is at starboard, where y is negative
            if (k < 100 || expected == 0) continue;                    // near nadir even these beams see the border
            worst = std::max(worst, std::abs(mapped[at] / static_cast<double>(expected) - 1));
        }
    EXPECT_LT(worst, 1e-6);
    EXPECT_NEAR(border / border_expected, 1, 0.1) << "half of either, but for the two texels between them";
}

TEST(SurfaceMapTest, DetailFinerThanASampleCountsByItsMean) {
    SurfaceMap strengths = makeMap(1024, 1024), classes = makeMap(1024, 1024);
    for (int y = 0; y < 1024; ++y)
        for (int x = 0; x < 1024; ++x) {
            strengths.strengths.push_back((x + y) % 2 == 0 ? 1.6f : 0);
            classes.classes.push_back((x + y) % 2 == 0 ? 0 : 1);
        }
    SonarConfig config = fanOver(8);
    config.quality.rows = 32;
    config.quality.columns_per_beam = 1;
    auto of_classes = groundWith(classes);
    classes.materials = {addMaterial(*of_classes, -12), addMaterial(*of_classes, -30)};
    of_classes->meshes[0].maps[0].map = std::make_shared<const SurfaceMap>(classes);
    const double plain = sum(getBins(plainGround(), config));
    EXPECT_NEAR(sum(getBins(groundWith(strengths), config)) / plain, 0.8, 0.008);
    const double mean = (sum(getBins(plainGround(-12), config)) + sum(getBins(plainGround(-30), config))) / 2;
    EXPECT_NEAR(sum(getBins(of_classes, config)) / mean, 1, 0.01);
}

/** A board of random place, size, rotation and mirroring, painted in blocks, compared with a board per block. */
TEST(SurfaceMapTest, APaintedBoardEchoesAsBoardsOfItsBlocks) {
    std::mt19937 random(11);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    for (int trial = 0; trial < 20; ++trial) {
        constexpr int blocks = 4, texels = 256;
        SurfaceMap map = makeMap(texels, texels, {}, false);
        std::array<double, blocks * blocks> db{};
        for (double& each : db) each = uniform(-25, 10);
        for (int y = 0; y < texels; ++y)
            for (int x = 0; x < texels; ++x)
                map.strengths.push_back(
                    linear(db[static_cast<size_t>(y / (texels / blocks) * blocks + x / (texels / blocks))]));
        const glm::dvec3 size(1, uniform(2, 9) * (trial % 3 == 0 ? -1 : 1), uniform(2, 9));
        const glm::dmat4 place = glm::scale(
            glm::rotate(glm::rotate(glm::translate(glm::dmat4(1), {uniform(10, 20), uniform(-3, 3), uniform(-2, 2)}),
                                    uniform(-1, 1), glm::dvec3(0, 0, 1)),
                        uniform(-0.8, 0.8), glm::dvec3(0, 1, 0)),
            size);
        const auto whole = std::make_shared<types::Geometry>(*test::makeScene({test::mappedWall()}, -10));
        types::Mesh board = test::mappedWall();
        board.map_uvs = board.uvs;
        board.maps = {{0, std::make_shared<const SurfaceMap>(map)}};
        whole->meshes = {board};
        whole->objects[0].world_from_object = place;
        whole->materials[0].max_map_strength = 10;
        const auto apart = std::make_shared<types::Geometry>();
        for (size_t i = 0; i < db.size(); ++i) {
            const auto row = static_cast<float>(i / blocks), column = static_cast<float>(i % blocks),
                       step = 2.0f / blocks;
            // The map's rows run down, as v of the wall does.
            apart->meshes.push_back(
                test::quad({0, -1 + column * step, 1 - (row + 1) * step}, {0, step, 0}, {0, 0, step}));
            apart->meshes[i].clusters[0].material = static_cast<int>(i);
            apart->objects.push_back({"block_" + std::to_string(i), static_cast<int>(i), place});
            apart->materials.emplace_back().lambert_db = static_cast<float>(-10 + db[i]);
        }
        SonarConfig config =
            test::getSonar({.beams = 24, .width_deg = 100, .height_deg = 90, .rows = 1024, .columns = 32});
        config.visibility = Visibility::Cpu;
        const auto echo = [&](const types::GeometryPtr& geometry) {
            return test::makePing(config, test::makeSnapshot(geometry)).bins;
        };
        const std::vector<float> painted = echo(whole), expected = echo(apart);
        ASSERT_GT(sum(expected), 0) << trial;
        double apart_sum = 0;
        for (size_t k = 0; k < painted.size(); ++k) apart_sum += std::abs(painted[k] - expected[k]);
        std::cout << trial << ": bins " << apart_sum / sum(expected) << " apart, all "
                  << sum(painted) / sum(expected) - 1 << '\n';
        EXPECT_LT(apart_sum / sum(expected), 0.03) << trial;
        EXPECT_NEAR(sum(painted) / sum(expected), 1, 0.01) << trial;
    }
}

TEST(SurfaceMapTest, FieldsOfScatterersAreWeakerByTheSameFactor) {
    SonarConfig config = fanOver(8);
    config.frequency_khz = 400;
    config.speckle = coherent();
    const std::vector<float> plain = getBins(plainGround(), config),
                             weak = getBins(groundWith(makeMap(1, 1, {0.01f})), config);
    for (size_t k = 0; k < plain.size(); ++k) EXPECT_NEAR(weak[k], 0.01 * plain[k], 1e-4 * plain[k] + 1e-12) << k;
    SurfaceMap classes = makeMap(512, 512);
    for (int i = 0; i < 512 * 512; ++i) classes.classes.push_back((i + i / 512) % 2 == 0 ? 0 : 1);
    auto geometry = groundWith(classes);
    classes.materials = {addMaterial(*geometry, -12), addMaterial(*geometry, -30)};
    geometry->meshes[0].maps[0].map = std::make_shared<const SurfaceMap>(classes);
    const double mean = (sum(getBins(plainGround(-12), config)) + sum(getBins(plainGround(-30), config))) / 2;
    EXPECT_NEAR(sum(getBins(geometry, config)) / mean, 1, 0.1);
}

TEST(SurfaceMapTest, ASilentFloorDoesNotChangeTheWaterBeforeIt) {
    SonarConfig config = fanOver(8);
    config.volume = {{{}, {}, -50}};
    SurfaceMap half = makeMap(2, 1, {}, false);
    half.classes = {0, 1};
    auto geometry = groundWith(half);
    half.materials = {addMaterial(*geometry, -200), addMaterial(*geometry, -200)};
    geometry->materials[0].lambert_db = -200;
    geometry->meshes[0].maps[0].map = std::make_shared<const SurfaceMap>(half);
    const std::vector<float> mapped = getBins(geometry, config), plain = getBins(plainGround(-200), config);
    ASSERT_GT(sum(plain), 0);
    for (size_t k = 0; k < plain.size(); ++k) EXPECT_NEAR(mapped[k], plain[k], 1e-5 * plain[k]) << k;
}

TEST(SurfaceMapTest, LabelsAreThoseOfTheObject) {
    SurfaceMap map = makeMap(8, 8);
    for (int i = 0; i < 64; ++i) map.classes.push_back(static_cast<uint8_t>(i % 3));
    auto geometry = groundWith(map);
    map.materials = {addMaterial(*geometry, -12), addMaterial(*geometry, -20), addMaterial(*geometry, -16)};
    geometry->meshes[0].maps[0].map = std::make_shared<const SurfaceMap>(map);
    types::Sonar ping;
    const auto getTruth = [&](const types::GeometryPtr& of) {
        SonarRenderer renderer(fanOver(), of);
        types::SonarTruth truth;
        renderer.setTruth(ping, &truth);
        renderer.render(test::makeSnapshot(of, {0, 0, 0}, 0, types::radians(25)), ping);
        return truth;
    };
    const types::SonarTruth plain = getTruth(plainGround()), mapped = getTruth(geometry);
    for (size_t k = 0; k < ping.bins.size(); ++k) EXPECT_EQ(ping.bins[k] > 0, mapped.object[k] == 0) << k;
    EXPECT_EQ(mapped.object, plain.object);
    EXPECT_EQ(mapped.path, plain.path);
    EXPECT_EQ(mapped.shadow, plain.shadow);
    for (size_t k = 0; k < plain.elevation.size(); ++k)
        EXPECT_NEAR(plain.object[k] < 0 ? 0 : mapped.elevation[k] - plain.elevation[k], 0, 0.02) << k;
}

TEST(SurfaceMapTest, MapsApplyToPathsByMirrorsToo) {
    SonarConfig config = fanOver(8);
    config.multipath.emplace().surface.emplace();
    const auto ghosts = [&](const types::GeometryPtr& geometry) {
        types::Snapshot snapshot = test::makeSnapshot(geometry, {0, 0, 0});
        snapshot.water_surface = 3;
        SonarConfig direct = config;
        direct.multipath.reset();
        return sum(test::makePing(config, snapshot).bins) - sum(test::makePing(direct, snapshot).bins);
    };
    const double plain = ghosts(plainGround());
    ASSERT_GT(plain, 0);
    EXPECT_NEAR(ghosts(groundWith(makeMap(1, 1, {0.1f}))) / plain, 0.1, 1e-4);
    SurfaceMap map = makeMap(1, 1);
    map.classes = {0};
    auto geometry = groundWith(map);
    map.materials = {addMaterial(*geometry, -25)};
    geometry->meshes[0].maps[0].map = std::make_shared<const SurfaceMap>(map);
    EXPECT_NEAR(ghosts(geometry) / plain, 0.1, 1e-4);
}

TEST(SurfaceMapTest, ExtremeCoordinatesAndValuesHaveFiniteEchoes) {
    for (const float uv : {NAN, INFINITY, 1e30f, -1e30f, 1e7f})
        for (const float strength : {0.0f, 1e-20f, 1e4f}) {
            auto geometry = groundWith(makeMap(2, 2, std::vector<float>(4, strength)));
            geometry->meshes[0].map_uvs[1] = {uv, uv};
            for (const float bin : getBins(geometry)) {
                ASSERT_TRUE(std::isfinite(bin)) << uv << " " << strength;
                ASSERT_GE(bin, 0);
            }
        }
}

TEST(SurfaceMapTest, TheRasterisedPathOmitsMapsWithANotice) {
    SonarConfig config = fanOver();
    config.visibility = Visibility::Gl;
    config.device = "software";
    const auto geometry = groundWith(makeMap(1, 1, {0.1f}));
    const RenderPlan plan = makeRenderPlan(config, *geometry);
    const Omitted* const omitted = plan.findOmitted("surface maps");
    ASSERT_NE(omitted, nullptr);
    EXPECT_EQ(omitted->reason, Reason::Lacking);
    EXPECT_EQ(getBins(geometry, config), getBins(plainGround(), config));
    const RenderPlan without = makeRenderPlan(fanOver(), *plainGround());
    ASSERT_NE(without.findOmitted("surface maps"), nullptr);
    EXPECT_EQ(without.findOmitted("surface maps")->reason, Reason::NoneInScene);
}

TEST(SurfaceMapTest, LevelsOfAMapKeepItsMeanAtAnySize) {
    std::mt19937 random(3);
    for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {3, 7}, {64, 64}, {100, 1}, {37, 53}}) {
        SurfaceMap map = makeMap(width, height);
        double mean = 0;
        for (int i = 0; i < width * height; ++i) {
            map.strengths.push_back(std::uniform_real_distribution(0.0f, 2.0f)(random));
            mean += map.strengths.back() / (width * height);
        }
        const MapLevels levels(map);
        const MapLevels::Look all = levels.look({{0.5f, 0.5f}, {0, 100}, {100, 0}});
        EXPECT_NEAR(all.strength, mean, 1e-4 * mean) << width << " x " << height;
        EXPECT_FLOAT_EQ(
            levels.look({{0.5f / static_cast<float>(width), 0.5f / static_cast<float>(height)}, {}, {}}).strength,
            map.strengths[0]);
    }
}

}  // namespace insonify::sonar
