// Range images compared with closed forms: a wall and a sphere, beam by beam.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

using test::makeScene;

constexpr double cloud_bin = 0.03;  // 20 us at 1500 m/s [m]

struct Sonar3dTaskTest : test::TaskBench<Sonar3dTask, types::SnapshotPtr, types::DepthMapPtr> {
    Sonar3dTaskTest() : TaskBench(&Sonar3dTask::snapshot, &Sonar3dTask::range_image) {}
    static Sonar3dConfig grid() {
        Sonar3dConfig config;
        config.sonar.range = 15;
        config.sonar.bin_count = 500;
        config.horizontal = {60, 90};
        config.vertical = {20, 40};
        config.sonar.beam_height_deg = 2;
        config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 8;
        return config;
    }
    types::DepthMapPtr makeMap(types::Snapshot snapshot) {
        return answerTo(std::make_shared<types::Snapshot>(std::move(snapshot)));
    }
    /** A pattern reaches far beyond its beam: few rows in its main lobe would show a plate in neighbouring beams alone.
     */
    void expectPlateInItsOwnBeams(acoustics::Weighting weighting) {
        constexpr double azimuth = types::radians(12), elevation = types::radians(3), half = 0.15;
        const glm::dvec3 ahead(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                               std::sin(elevation));
        const glm::dvec3 across(-std::sin(azimuth), std::cos(azimuth), 0), up = glm::cross(ahead, across);
        Sonar3dConfig config = grid();
        config.horizontal = {80, 40};
        config.vertical = {8, 16};
        config.sonar.frequency_khz = 1200;
        config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 4;
        config.sonar.beam_pattern.emplace();
        acoustics::BeamLaw& receive = config.sonar.beam_pattern->receive.azimuth.emplace();
        receive.weighting = weighting;
        receive.width_deg = 0.6;
        startWith(config);
        const auto plate = test::quad(8.0 * ahead - half * (across + up), 2 * half * across, 2 * half * up);
        const auto map = makeMap(test::makeSnapshot(makeScene({plate})));
        ASSERT_TRUE(map) << task_.lastError();
        const auto strongest = std::ranges::max_element(map->remissions) - map->remissions.begin();
        const auto offDeg = [&](size_t cell) { return types::degrees(map->horizontal_interval[cell % 80]) - 12; };
        EXPECT_NEAR(offDeg(static_cast<size_t>(strongest)), 0, 1.4);
        for (size_t cell = 0; cell < map->remissions.size(); ++cell)
            if (std::abs(offDeg(cell)) > 4) {
                EXPECT_LT(map->remissions[cell], 0.006 * map->remissions[static_cast<size_t>(strongest)])
                    << "sidelobes are 25 dB weaker, " << offDeg(cell) << " deg off";
            }
    }
};

/** D / (cos e cos a). This is symmetric in azimuth and elevation, so the wall is also rotated. */
TEST_F(Sonar3dTaskTest, AWallIsAtTheRangeOfEachDirection) {
    constexpr double distance = 6;
    startWith(grid());
    for (const double yaw : {0.0, 20.0}) {
        const auto map = makeMap(test::makeSnapshot(makeScene({test::wall(distance)}), {}, types::radians(yaw)));
        ASSERT_TRUE(map) << task_.lastError();
        ASSERT_EQ(map->distances.size(), 1200u);
        double worst = 0;
        for (size_t row = 0; row < 20; ++row)
            for (size_t column = 0; column < 60; ++column) {
                const double e = -map->vertical_interval[row],
                             a = map->horizontal_interval[column] + types::radians(yaw);
                const double expected = distance / (std::cos(e) * std::cos(a));
                if (expected > 14) continue;  // the range cuts off a part of what such beams see
                worst = std::max(worst, std::abs(map->distances[row * 60 + column] - expected));
            }
        std::cout << "wall, yaw " << yaw << ": ranges at most " << worst << " m off, bins of " << cloud_bin << " m\n";
        EXPECT_LT(worst, 0.55 * cloud_bin);
    }
}

/** 1 cm is 6.67 us one way, which a ping states as 7. */
TEST_F(Sonar3dTaskTest, RangesAreExactForBinsOfFractionalMicroseconds) {
    Sonar3dConfig config = grid();
    config.sonar.range = 8;
    config.sonar.bin_count = 800;
    config.sonar.range_rounding = RangeRounding::Exact;
    startWith(config);
    const auto map = makeMap(test::makeSnapshot(makeScene({test::wall(5)})));
    ASSERT_TRUE(map) << task_.lastError();
    double worst = 0;
    for (size_t cell = 0; cell < map->distances.size(); ++cell)
        if (std::isfinite(map->distances[cell]))
            worst = std::max(worst, std::abs(map->distances[cell] * map->direction(cell / 60, cell % 60).x - 5));
    EXPECT_LT(worst, 0.006);
}

/** L . d - sqrt((L . d)^2 - L^2 + b^2) in the directions d that meet the sphere; no range next to it. */
TEST_F(Sonar3dTaskTest, ASphereIsAtTheRangeOfEachDirectionAndNothingNextToIt) {
    constexpr double radius = 2;
    const glm::dvec3 centre(7, 1, 0.5);
    Sonar3dConfig config = grid();
    config.horizontal = {180, 90};
    config.vertical = {80, 40};
    config.sonar.beam_height_deg = 0.5;
    startWith(config);
    const auto map = makeMap(test::makeSnapshot(makeScene({test::sphere(radius)}, 0, {centre})));
    ASSERT_TRUE(map) << task_.lastError();
    double worst = 0;
    int met = 0, weak = 0;
    for (size_t row = 0; row < 80; ++row)
        for (size_t column = 0; column < 180; ++column) {
            const float got = map->distances[row * 180 + column];
            const glm::dvec3 direction = map->direction(row, column);
            const double along = glm::dot(centre, direction), off = glm::length(centre - along * direction);
            if (off > radius + 0.1) {
                EXPECT_EQ(got, types::DepthMap::too_far) << row << " " << column;
                ++weak;
            } else if (off < 0.9 * radius) {
                worst = std::max(worst, std::abs(got - (along - std::sqrt(radius * radius - off * off))));
                ++met;
            }
        }
    std::cout << "sphere: " << met << " ranges at most " << worst << " m off, bins of " << cloud_bin << " m\n";
    EXPECT_GT(met, 1000);
    EXPECT_GT(weak, 8000);
    EXPECT_LT(worst, 0.6 * cloud_bin);
}

TEST_F(Sonar3dTaskTest, AGaussianPatternShowsAPlateInItsOwnBeams) {
    expectPlateInItsOwnBeams(acoustics::Weighting::Gaussian);
}

TEST_F(Sonar3dTaskTest, ATaylorPatternShowsAPlateInItsOwnBeams) {
    expectPlateInItsOwnBeams(acoustics::Weighting::Taylor);
}

TEST_F(Sonar3dTaskTest, RowsRunDownAndColumnsFromPortToStarboard) {
    startWith(grid());
    const auto plate = test::quad({5, 1.5, 0.5}, {0, 1, 0}, {0, 0, 1});  // ahead, to port, above
    const auto map = makeMap(test::makeSnapshot(makeScene({plate})));
    ASSERT_TRUE(map) << task_.lastError();
    EXPECT_LT(map->vertical_interval.front(), map->vertical_interval.back());
    EXPECT_GT(map->horizontal_interval.front(), map->horizontal_interval.back());
    int seen = 0;
    for (size_t cell = 0; cell < map->distances.size(); ++cell) {
        if (!std::isfinite(map->distances[cell])) continue;
        ++seen;
        EXPECT_LT(cell / 60, 10u) << "the upper half";
        EXPECT_LT(cell % 60, 30u) << "the port half";
        EXPECT_GT(map->remissions[cell], 0);
    }
    EXPECT_GT(seen, 20);
}

TEST_F(Sonar3dTaskTest, SoundingsAreTheSameInTheWorld) {
    test::Reader<types::PointCloudPtr> clouds;
    task_.soundings.connectTo(clouds.port, framework::ConnPolicy::buffer(2));
    startWith(grid());
    ASSERT_TRUE(
        makeMap(test::makeSnapshot(makeScene({test::ground(0)}), {3, -2, 4}, types::radians(50), types::radians(35))))
        << task_.lastError();
    types::PointCloudPtr cloud;
    ASSERT_TRUE(clouds.port.readNew(cloud));
    EXPECT_GT(cloud->points.size(), 500u);
    for (const glm::dvec3& p : cloud->points) {
        if (glm::distance(p, {3, -2, 4}) > 12) continue;  // beams that the range cuts off
        EXPECT_NEAR(p.z, 0, 0.55 * cloud_bin);
    }
}

TEST_F(Sonar3dTaskTest, DetectionsAreTheRangeImageByTravelTimes) {
    test::Reader<types::SonarDetectionsPtr> reader;
    task_.detections.connectTo(reader.port, framework::ConnPolicy::buffer(2));
    startWith(grid());
    const auto plate = test::quad({5, 1.5, 0.5}, {0, 1, 0}, {0, 0, 1});  // ahead, to port, above
    const auto map = makeMap(test::makeSnapshot(makeScene({plate})));
    types::SonarDetectionsPtr found;
    ASSERT_TRUE(map && reader.port.readNew(found)) << task_.lastError();
    ASSERT_EQ(found->travel_times.size(), map->distances.size());
    EXPECT_NEAR(found->beam_height.deg(), grid().sonar.beam_height_deg, 1e-9) << "of one beam";
    size_t seen = 0;
    for (size_t cell = 0; cell < map->distances.size(); ++cell) {
        const glm::dvec3 direction = map->direction(cell / 60, cell % 60);
        const double bearing = found->bearings[cell].rad, elevation = static_cast<double>(found->elevations[cell]);
        EXPECT_NEAR(std::cos(elevation) * std::cos(bearing), direction.x, 1e-6);
        EXPECT_NEAR(std::cos(elevation) * std::sin(bearing), direction.y, 1e-6);
        EXPECT_NEAR(std::sin(elevation), direction.z, 1e-6);
        EXPECT_EQ(found->intensities[cell], map->remissions[cell]);
        const float range = found->travel_times[cell] * found->speed_of_sound / 2;
        if (!std::isfinite(map->distances[cell])) {
            EXPECT_TRUE(std::isnan(range));
            continue;
        }
        EXPECT_NEAR(range, map->distances[cell], 1e-5);
        EXPECT_GT(bearing, 0) << "to port";
        EXPECT_GT(elevation, 0) << "up";
        ++seen;
    }
    EXPECT_GT(seen, 20u);
}

/** The energy of a fan of the whole height in each azimuth. */
TEST_F(Sonar3dTaskTest, ThePingIsTheSumOverAllElevations) {
    test::Reader<types::SonarPtr> pings;
    task_.ping.connectTo(pings.port, framework::ConnPolicy::buffer(2));
    Sonar3dConfig config = grid();
    config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 16;
    startWith(config);
    const types::Snapshot scene = test::makeSnapshot(makeScene({test::wall(6)}));
    ASSERT_TRUE(makeMap(scene)) << task_.lastError();
    types::SonarPtr ping;
    ASSERT_TRUE(pings.port.readNew(ping));
    SonarConfig whole = config.sonar;
    whole.beam_count = 60;
    whole.field_of_view_deg = 90;
    whole.beam_width_deg.reset();
    whole.beam_height_deg = 40;
    whole.quality.rows = 320;
    types::Sonar fan;
    SonarRenderer(whole, scene.geometry).render(scene, fan);
    ASSERT_EQ(ping->bins.size(), fan.bins.size());
    for (size_t beam = 0; beam < 60; ++beam) {
        EXPECT_NEAR(ping->bearings[beam].rad, fan.bearings[beam].rad, 1e-9);
        const auto energy = [&](const types::Sonar& of) {
            return std::accumulate(of.bins.begin() + beam * 500, of.bins.begin() + (beam + 1) * 500, 0.0);
        };
        // Beams are bands about a vertical plane, wider in azimuth by 1 / cos(elevation) than those of a fan.
        EXPECT_NEAR(energy(*ping) / energy(fan), 1, 0.03) << beam;
    }
}

TEST_F(Sonar3dTaskTest, AWeakEchoInThePingIsNoReturn) {
    Sonar3dConfig config = grid();
    config.detection.threshold_db = -5;
    startWith(config);
    auto geometry = std::make_shared<types::Geometry>(
        *makeScene({test::quad({5, 1, -1}, {0, 2, 0}, {0, 0, 2}), test::quad({5, -3, -1}, {0, 2, 0}, {0, 0, 2})}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[1].lambert_db = -20;
    for (types::Cluster& cluster : geometry->meshes[1].clusters) cluster.material = 1;
    const auto map = makeMap(test::makeSnapshot(geometry));
    ASSERT_TRUE(map) << task_.lastError();
    size_t port = 0, starboard = 0;
    for (size_t cell = 0; cell < map->distances.size(); ++cell)
        if (std::isfinite(map->distances[cell])) ++(cell % 60 < 30 ? port : starboard);
    EXPECT_GT(port, 50u);
    EXPECT_EQ(starboard, 0u);
}

/** A ball before a wall. */
types::Snapshot ballBeforeWall() {
    return test::makeSnapshot(makeScene({test::sphere(1.5f), test::wall(12)}, 0, {{6, 1, 0.5}, {}}));
}

TEST_F(Sonar3dTaskTest, EachCellOfTheMapNamesItsObject) {
    test::Reader<types::SonarTruthPtr> truths{"truths"};
    task_.range_truth.connectTo(truths.port, framework::ConnPolicy::buffer(2));
    startWith(grid());
    const auto map = makeMap(ballBeforeWall());
    ASSERT_TRUE(map) << task_.lastError();
    types::SonarTruthPtr truth;
    ASSERT_TRUE(truths.port.readNew(truth));
    ASSERT_EQ(truth->diagnostic(), nullptr);
    ASSERT_EQ(truth->beam_count, 1200u);
    ASSERT_EQ(truth->bin_count, 1u);
    ASSERT_EQ(truth->objects.size(), 2u);
    const glm::dvec3 centre(6, 1, 0.5);
    int balls = 0, walls = 0;
    for (size_t cell = 0; cell < 1200; ++cell) {
        EXPECT_EQ(std::isfinite(map->distances[cell]), truth->object[cell] >= 0) << cell;
        const glm::dvec3 direction = map->direction(cell / 60, cell % 60);
        EXPECT_NEAR(truth->bearings[cell].rad, map->horizontal_interval[cell % 60], 1e-9);
        if (truth->object[cell] < 0) continue;
        EXPECT_NEAR(truth->elevation[cell], -map->vertical_interval[cell / 60], 1e-6);
        const double along = glm::dot(centre, direction), off = glm::length(centre - along * direction);
        if (std::abs(off - 1.5) < 0.25) continue;  // beams that see both
        EXPECT_EQ(truth->object[cell], off < 1.5 ? 0 : 1) << cell;
        EXPECT_FLOAT_EQ(truth->share[cell], 1) << cell;
        EXPECT_GT(truth->hits[cell], 0u);
        ++(off < 1.5 ? balls : walls);
        if (off < 1.4)
            EXPECT_NEAR(std::sin(truth->grazing[cell]), std::sqrt(1 - off * off / 2.25), 0.15) << cell;
        else
            EXPECT_NEAR(std::sin(truth->grazing[cell]), direction.x, 0.03) << cell;
    }
    EXPECT_GT(balls, 100);
    EXPECT_GT(walls, 300);
}

/** The truth of a fan of the whole height, which sums all elevations of an azimuth in one rendering. */
TEST_F(Sonar3dTaskTest, ThePingsTruthIsThatOfAFanOfTheWholeHeight) {
    test::Reader<types::SonarTruthPtr> truths{"truths"};
    task_.truth.connectTo(truths.port, framework::ConnPolicy::buffer(2));
    Sonar3dConfig config = grid();
    config.horizontal = {40, 40};
    config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 16;
    startWith(config);
    auto geometry = makeScene({test::sphere(1.5f), test::wall(12), test::ground(-2.5f)}, 0, {{6, 1, 0.5}, {}, {}});
    const types::Snapshot scene = test::makeSnapshot(geometry);
    ASSERT_TRUE(makeMap(scene)) << task_.lastError();
    types::SonarTruthPtr truth;
    ASSERT_TRUE(truths.port.readNew(truth));
    ASSERT_EQ(truth->diagnostic(), nullptr);
    SonarConfig whole = config.sonar;
    whole.beam_count = 40;
    whole.field_of_view_deg = 40;
    whole.beam_height_deg = 40;
    whole.quality.rows = 640;
    SonarRenderer renderer(whole, scene.geometry);
    types::Sonar fan;
    types::SonarTruth expected;
    renderer.setTruth(fan, &expected);
    renderer.render(scene, fan);
    ASSERT_EQ(truth->object.size(), expected.object.size());
    size_t received = 0, same = 0, near = 0, shadows = 0, same_shadows = 0;
    for (size_t at = 0; at < expected.object.size(); ++at) {
        shadows += expected.shadow[at];
        same_shadows += expected.shadow[at] & truth->shadow[at];
        if (expected.object[at] < 0 || expected.share[at] < 0.8f) continue;
        ++received;
        if (truth->object[at] != expected.object[at]) continue;
        ++same;
        // The nearest bins of wall and ball contain directions above and below the axis, and their mean.
        near += std::abs(truth->elevation[at] - expected.elevation[at]) < types::radians(2.1);
        EXPECT_NEAR(truth->share[at], expected.share[at], 0.2) << at;
    }
    std::cout << same << " of " << received << " labels and " << same_shadows << " of " << shadows
              << " shadows the same\n";
    EXPECT_GT(received, 5000u);
    EXPECT_GT(static_cast<double>(same), 0.99 * static_cast<double>(received));
    EXPECT_GT(static_cast<double>(near), 0.99 * static_cast<double>(same));
    EXPECT_GT(shadows, 1000u);
    EXPECT_GT(static_cast<double>(same_shadows), 0.97 * static_cast<double>(shadows));
}

TEST_F(Sonar3dTaskTest, ReadingTheTruthChangesNoBin) {
    startWith(grid());
    const auto before = makeMap(ballBeforeWall());
    ASSERT_TRUE(before) << task_.lastError();
    test::Reader<types::SonarTruthPtr> truths{"truths"};
    task_.range_truth.connectTo(truths.port, framework::ConnPolicy::buffer(2));
    types::Snapshot later = ballBeforeWall();
    later.time = types::Time::fromSeconds(5);
    const auto after = makeMap(later);
    ASSERT_TRUE(after) << task_.lastError();
    EXPECT_EQ(before->distances, after->distances);
    EXPECT_EQ(before->remissions, after->remissions);
}

TEST_F(Sonar3dTaskTest, AnEchoTooWeakForAReturnHasNoObject) {
    test::Reader<types::SonarTruthPtr> truths{"truths"};
    task_.range_truth.connectTo(truths.port, framework::ConnPolicy::buffer(2));
    Sonar3dConfig config = grid();
    config.detection.threshold_db = -5;
    startWith(config);
    const auto map = makeMap(ballBeforeWall());
    ASSERT_TRUE(map) << task_.lastError();
    types::SonarTruthPtr truth;
    ASSERT_TRUE(truths.port.readNew(truth));
    size_t none = 0;
    for (size_t cell = 0; cell < 1200; ++cell) {
        EXPECT_EQ(std::isfinite(map->distances[cell]), truth->object[cell] >= 0) << cell;
        none += truth->object[cell] < 0;
    }
    EXPECT_GT(none, 100u);
    EXPECT_LT(none, 1200u);
}

TEST_F(Sonar3dTaskTest, ASilentSonarReportsItsDirections) {
    std::string reported;
    auto environment = std::make_shared<framework::Environment>(task_.environment());
    environment->warn = [&](const std::string& text) { reported += text; };
    task_.setEnvironment(environment);
    startWith(grid());
    const auto map = makeMap(test::makeSnapshot(makeScene({test::wall(60)})));
    ASSERT_TRUE(map) << task_.lastError();
    EXPECT_TRUE(std::ranges::none_of(map->distances, [](float distance) { return std::isfinite(distance); }));
    EXPECT_THAT(reported, testing::HasSubstr("beyond the range of 15 m"));
}

/** The sonar rings once, whatever the number of its rows: 10^(L/10) exp(-K r) (1 - exp(-K dR)) / (K dR). */
TEST_F(Sonar3dTaskTest, TheRingDownOfThePingIsThatOfTheSonarForAnyNumberOfRows) {
    test::Reader<types::SonarPtr> pings;
    task_.ping.connectTo(pings.port, framework::ConnPolicy::buffer(4));
    Sonar3dConfig config = grid();
    config.horizontal = {2, 20};
    config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 2;
    config.sonar.pulse.emplace().bandwidth_khz = 5;
    config.sonar.pulse->ring_down = acoustics::RingDownConfig{-40, 10};
    for (const int rows : {1, 4, 16}) {
        config.vertical = {rows, 2.0 * rows};
        for (const bool imperfect : {false, true}) {
            config.sonar.imperfections.reset();
            if (imperfect) config.sonar.imperfections.emplace().clock_jitter_us = 0;
            startWith(config);
            ASSERT_TRUE(makeMap(test::makeSnapshot(test::openWater()))) << task_.lastError();
            types::SonarPtr ping;
            ASSERT_TRUE(pings.port.readNew(ping));
            const double width = ping->binStart(1), rate = std::log(10);
            for (size_t k = 0; k < 40; ++k) {
                const double r = width * static_cast<double>(k);
                const double right = 1e-4 * std::exp(-rate * r) * (1 - std::exp(-rate * width)) / (rate * width);
                EXPECT_NEAR(double{ping->bins[k]} / right, 1, 1e-5) << rows << " rows, bin " << k;
            }
            task_.stop();
            task_.cleanup();
        }
    }
}

/** All numbers that a 3-D sonar writes of eight pings. Meanwhile it moves and turns past a ball, which begins to move
 * and rests again; its range changes, and then its scene. */
std::vector<float> getNumbers(const Sonar3dConfig& config, int threads) {
    Sonar3dTask task{"task"};
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> pings{"pings"};
    test::Reader<types::DepthMapPtr> maps{"maps"};
    test::Reader<types::SonarTruthPtr> truths{"truths"}, returned{"returned"};
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(1));
    task.ping.connectTo(pings.port, framework::ConnPolicy::buffer(1));
    task.range_image.connectTo(maps.port, framework::ConnPolicy::buffer(1));
    task.truth.connectTo(truths.port, framework::ConnPolicy::buffer(1));
    task.range_truth.connectTo(returned.port, framework::ConnPolicy::buffer(1));
    task.config.set(config);
    task.useThreads(threads);
    if (!task.configure() || !task.start()) throw std::runtime_error(task.lastError());
    const auto scene = makeScene({test::sphere(1.5f), test::wall(12)}, 0, {{6, 1, 0.5}, {}});
    const auto other = makeScene({test::sphere(1), test::wall(10), test::ground(-2)}, 0, {{5, -1, 0}, {}, {}});
    std::vector<float> all;
    for (int k = 0; k < 8; ++k) {
        types::Snapshot now = test::makeSnapshot(k < 6 ? scene : other, {0.7 * k, 0.2 * k, 0.1 * k}, 0.1 * k);
        now.water_surface = 20 + 0.5 * k;
        now.time = types::Time::fromSeconds(0.2 * k);
        if (k == 2 || k == 3) now.moved.push_back({0, glm::translate(glm::dmat4(1), glm::dvec3(6, 1 - 0.5 * k, 0.5))});
        if (k == 5) task.properties().front()->setAll({{"range", "14"}});
        in.port.write(std::make_shared<types::Snapshot>(now));
        task.update();
        types::SonarPtr ping;
        types::DepthMapPtr map;
        types::SonarTruthPtr truth, of_returns;
        if (!pings.port.readNew(ping) || !maps.port.readNew(map) || !truths.port.readNew(truth) ||
            !returned.port.readNew(of_returns))
            throw std::runtime_error("no ping: " + task.lastError());
        for (const std::vector<float>* numbers : {&ping->bins, &map->distances, &map->remissions})
            all.insert(all.end(), numbers->begin(), numbers->end());
        for (const types::SonarTruthPtr& shown : {truth, of_returns})
            for (const uint32_t bits : test::getBits(*shown)) all.push_back(static_cast<float>(bits));
    }
    return all;
}

TEST_F(Sonar3dTaskTest, ThreadsChangeNoBitOfSuccessivePings) {
    Sonar3dConfig still = grid();
    still.horizontal = {11, 60};
    still.vertical = {6, 24};
    Sonar3dConfig moving = still, bent = still;
    moving.sonar.motion_in_ping = true;
    const std::string profile = testing::TempDir() + "steep_profile.csv";
    std::ofstream(profile) << "depth_m,sound_speed_m_s\n0,1400\n100,1700\n";
    bent.sonar.water.emplace().profile = profile;
    for (const auto& [name, config] :
         {std::pair("still", still), std::pair("moving", moving), std::pair("bent", bent)}) {
        const std::vector<float> one = getNumbers(config, 1);
        EXPECT_GT(std::ranges::count_if(one, [](float number) { return number > 0; }), 1000) << name;
        for (const int threads : {2, 5}) EXPECT_TRUE(getNumbers(config, threads) == one) << name << " " << threads;
    }
    EXPECT_FALSE(getNumbers(moving, 1) == getNumbers(still, 1)) << "the motion is there";
    EXPECT_FALSE(getNumbers(bent, 1) == getNumbers(still, 1)) << "the rays are bent";
}

/** A turn that the pose has is the turn from ping to ping; it is about an axis of the vehicle, not of a fan. */
TEST_F(Sonar3dTaskTest, TheTurnOfThePoseIsThatOfTheSonarInEachAzimuth) {
    test::Reader<types::SonarPtr> pings;
    task_.ping.connectTo(pings.port, framework::ConnPolicy::buffer(4));
    Sonar3dConfig config = grid();
    config.horizontal = {15, 60};
    config.vertical = {4, 16};
    const auto plate = test::quad({8, -1, -1}, {0, 2, 0}, {0, 0, 2});
    constexpr double rate = 4;  // [rad/s]
    std::vector<std::vector<float>> bins;
    for (const auto& [moves, known] : {std::pair(true, false), std::pair(true, true), std::pair(false, true)}) {
        config.sonar.motion_in_ping = moves;
        startWith(config);
        for (int k = 0; k < 2; ++k) {
            types::Snapshot now = test::makeSnapshot(makeScene({plate}), {}, 0.1 * rate * (k - 1));
            now.time = types::Time::fromSeconds(1 + 0.1 * k);
            if (known) now.sonar.velocity = {}, now.sonar.angular_velocity = {0, 0, rate};
            ASSERT_TRUE(makeMap(now)) << task_.lastError();
        }
        types::SonarPtr ping;
        while (pings.port.readNew(ping)) continue;
        bins.push_back(ping->bins);
        task_.stop();
        task_.cleanup();
    }
    EXPECT_LT(test::relativeL2(bins[1], bins[0]), 1e-3);
    EXPECT_GT(test::relativeL2(bins[2], bins[0]), 0.02) << "the turn shows";
}

}  // namespace
}  // namespace insonify::sonar
