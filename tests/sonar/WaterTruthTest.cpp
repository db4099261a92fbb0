// The label of the water in the truth of a ping: closed forms (ACOUSTICS.md 3.9), and random scenes, in which the
// water's energy in a bin is the difference of two pings.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/sonar/ShellScenes.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr uint8_t by_water = types::SonarTruth::water;

struct WaterLabels {
    types::Sonar ping;
    types::SonarTruth truth;

    size_t at(size_t beam, size_t bin) const { return beam * ping.bin_count + bin; }
    bool isWater(size_t at) const { return truth.path[at] == by_water; }
    double energy(size_t at) const { return ping.bins[at]; }
    /** Energy of the object, or the water, of the label of a bin. */
    double labelled(size_t at) const { return energy(at) * double{truth.share[at]}; }
};

WaterLabels getLabels(const SonarConfig& config, const types::Snapshot& snapshot, int threads = 0) {
    SonarRenderer renderer(config, snapshot.geometry, {.threads = threads});
    WaterLabels labels;
    renderer.setTruth(labels.ping, &labels.truth);
    renderer.render(snapshot, labels.ping);
    return labels;
}

/** 8 beams of 10 deg, 40 deg high, 300 bins of 0.1 m from 1 m on. */
SonarConfig inWater(std::optional<double> strength_db, int rows = 512) {
    SonarConfig config =
        test::getSonar({.beams = 8, .width_deg = 80, .height_deg = 40, .bins = 300, .rows = rows, .columns = 4});
    config.range_min = 1;
    if (strength_db) config.volume = {{{}, {}, *strength_db}};
    return config;
}

constexpr double up = types::radians(20), of_beam = types::radians(10);

/** Energy of water of 1/m in the part of a beam that is `sines` high. */
test::Form waterEnergy(const std::function<double(double)>& sines) {
    return [=](double r1, double r2) {
        return of_beam * test::integral(r1, r2, [=](double r) { return sines(r) / (r * r); });
    };
}

/** Expects the label of each bin in which water and one object have the energies of two forms. */
void expectShares(const WaterLabels& labels, const test::Form& water, const test::Form& surface, size_t first,
                  size_t last) {
    for (size_t beam = 0; beam < labels.ping.beam_count; ++beam)
        for (size_t bin = first; bin < last; ++bin) {
            const double r1 = 0.1 * static_cast<double>(bin), r2 = r1 + 0.1;
            const double of_water = water(r1, r2), of_surface = surface(r1, r2);
            const double share = std::max(of_water, of_surface) / (of_water + of_surface);
            const size_t at = labels.at(beam, bin);
            if (share > 0.51) {
                EXPECT_EQ(labels.isWater(at), of_water > of_surface) << bin;
            }
            EXPECT_EQ(labels.truth.object[at], labels.isWater(at) ? -1 : 0) << bin;
            EXPECT_NEAR(labels.truth.share[at] / share, 1, 0.01) << bin;
            EXPECT_EQ(std::isnan(labels.truth.elevation[at]), labels.isWater(at)) << bin;
            EXPECT_EQ(std::isnan(labels.truth.grazing[at]), labels.isWater(at)) << bin;
            EXPECT_EQ(labels.truth.hits[at] > 0, of_surface > 0) << bin;
        }
}

TEST(WaterTruthTest, OpenWaterIsTheLabelOfEveryBinWithAnEcho) {
    std::vector<SonarConfig> all(5, inWater(-70));
    all[1].volume = {{{}, 1.0, -70}, {1.0, {}, -90}};
    all[2].beam_geometry = BeamGeometry::Conical;
    acoustics::BeamLaw law;
    law.width_deg = 12;
    all[3].beam_pattern.emplace().receive.azimuth = law;
    all[3].pulse.emplace().bandwidth_khz = 2;
    all[4].range_min = 0;
    for (const SonarConfig& config : all)
        for (const SonarConfig& way : test::everyRenderer(config)) {
            const WaterLabels labels = getLabels(way, test::makeSnapshot(test::openWater()));
            for (size_t at = 0; at < labels.ping.bins.size(); ++at) {
                const bool blanked = at % 300 < 10 && way.range_min > 0;
                ASSERT_EQ(labels.isWater(at), !blanked) << at;
                ASSERT_EQ(labels.truth.share[at], blanked ? 0 : 1) << at;
                ASSERT_TRUE(std::isnan(labels.truth.elevation[at]) && std::isnan(labels.truth.grazing[at]));
            }
            EXPECT_THAT(labels.truth.object, testing::Each(-1));
            EXPECT_THAT(labels.truth.hits, testing::Each(0));
            EXPECT_THAT(labels.truth.shadow, testing::Each(0));
        }
}

TEST(WaterTruthTest, WaterWithoutScatteringIsNoLabel) {
    for (const SonarConfig& way : test::everyRenderer(inWater(-200))) {
        const WaterLabels labels = getLabels(way, test::makeSnapshot(test::openWater()));
        EXPECT_THAT(labels.truth.path, testing::Each(0));
        EXPECT_THAT(labels.truth.share, testing::Each(0));
    }
}

/** A plate fills the lower half of one beam straight ahead; the upper half is open up to a far wall. */
TEST(WaterTruthTest, APlateAndTheWaterShareTheBinsOfThePlate) {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    int surfaces = 0, waters = 0;
    for (int i = 0; i < 8; ++i) {
        const double distance = between(6, 14), strength_db = between(-55, -35), mu_db = strength_db + between(-2, 8);
        const auto plate = test::quad({static_cast<float>(distance), -100, -100}, {0, 200, 0}, {0, 0, 100});
        const auto far_wall = test::quad({25, -100, 0}, {0, 200, 0}, {0, 0, 100});
        const auto snapshot = test::makeSnapshot(test::makeScene({plate, far_wall}, static_cast<float>(mu_db)));
        const auto lower = [&](double r) {
            return distance < r ? std::max(0.0, std::sin(up) - std::sin(std::acos(distance / r))) : std::sin(up);
        };
        const double water = std::pow(10, strength_db / 10), mu = std::pow(10, mu_db / 10);
        SonarConfig config = inWater(strength_db, 1024);
        config.beam_count = 1;
        config.field_of_view_deg = 1;  // thin, as the beam of the form; the shares do not depend on its width
        if (i % 2) {                   // formed of cells, of which the truth has the middle
            acoustics::BeamLaw law;
            law.width_deg = 1;
            config.beam_pattern.emplace().receive.azimuth = law;
        }
        for (const SonarConfig& way : test::everyRenderer(config)) {
            const WaterLabels labels = getLabels(way, snapshot);
            const auto first = static_cast<size_t>(distance / 0.1),
                       last = static_cast<size_t>(distance / std::cos(up) / 0.1);
            expectShares(labels, test::times(water, waterEnergy([&](double r) { return std::sin(up) + lower(r); })),
                         test::times(mu / 2, test::thinBeamOnWall(distance, up, of_beam)), first + 1, last);
            for (size_t bin = first + 1; bin < last; ++bin) (labels.isWater(bin) ? waters : surfaces) += 1;
            for (size_t bin = last + 1; bin < 249; ++bin) {
                EXPECT_TRUE(labels.isWater(bin)) << bin;
                EXPECT_EQ(labels.truth.share[bin], 1) << bin;
                EXPECT_EQ(labels.truth.shadow[bin], 1) << "water does not fill a shadow, bin " << bin;
            }
            for (size_t bin = 270; bin < 300; ++bin) EXPECT_EQ(labels.truth.shadow[bin], 0) << "nothing beyond";
        }
    }
    EXPECT_GT(surfaces, 10);
    EXPECT_GT(waters, 10);
}

TEST(WaterTruthTest, WaterBehindAWallThatFillsTheBeamIsNoLabelWhereItHasNoEcho) {
    for (const SonarConfig& way : test::everyRenderer(inWater(-70))) {
        const WaterLabels labels = getLabels(way, test::makeSnapshot(test::makeScene({test::wall(0.5)})));
        size_t silent = 0;
        for (size_t at = 0; at < labels.ping.bins.size(); ++at) {
            EXPECT_EQ(labels.isWater(at), labels.ping.bins[at] > 0) << at;
            EXPECT_LT(labels.ping.bins[at], 1e-14f);
            silent += !labels.isWater(at);
        }
        EXPECT_GE(silent, 8u * 10);
        EXPECT_THAT(labels.truth.shadow, testing::Each(0));
    }
}

/** Two layers over a bottom 3 m below a level sonar, which is 4 m below the surface: the layers share one label. */
TEST(WaterTruthTest, LayersTogetherAreOneLabel) {
    auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-3)}, -45));
    snapshot.water_surface = 4;
    const auto inLayer = [](double top, double bottom, double r) {
        return std::max(0.0, std::min(bottom / r, std::sin(up)) - std::min(top / r, std::sin(up)));
    };
    const auto water =
        waterEnergy([&](double r) { return 1e-4 * inLayer(0.5, 1, r) + std::pow(10, -4.6) * inLayer(1, 2, r); });
    const auto bottom = test::times(std::pow(10, -4.5), test::flatBottom(3, up, of_beam));
    SonarConfig config = inWater({}, 1024);
    config.volume = {{4.5, 5.0, -40}, {5.0, 6.0, -46}};
    for (const SonarConfig& way : test::everyRenderer(config)) {
        const WaterLabels labels = getLabels(way, snapshot);
        expectShares(labels, water, bottom, 92, 300);
        EXPECT_TRUE(labels.isWater(labels.at(3, 60))) << "before the bottom";
        EXPECT_EQ(labels.truth.shadow[labels.at(3, 60)], 1) << "and before the first echo of a surface";
        EXPECT_FALSE(labels.isWater(labels.at(3, 12))) << "where no ray has reached a layer";
    }
}

TEST(WaterTruthTest, ATargetThatIsLouderThanTheWaterEndsItsLabel) {
    auto snapshot = test::makeSnapshot(test::openWater());
    for (const double target_db : {-30.0, -90.0}) {
        snapshot.targets = {{{10.05 * std::cos(of_beam / 2), 10.05 * std::sin(of_beam / 2), 0}, target_db}};
        const WaterLabels labels = getLabels(inWater(-70), snapshot);
        EXPECT_EQ(labels.isWater(labels.at(4, 100)), target_db < -60);
        EXPECT_EQ(labels.truth.share[labels.at(4, 100)], target_db < -60 ? 1 : 0);
        EXPECT_TRUE(labels.isWater(labels.at(4, 99)));
    }
}

types::Snapshot ballsOverGround(std::mt19937& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    std::vector<types::Mesh> meshes = {test::ground(static_cast<float>(between(-6, -2))),
                                       test::quad({24, -100, -100}, {0, 200, 0}, {0, 0, 102})};
    std::vector<glm::dvec3> places(2);
    for (int i = 0; i < 12; ++i) {
        meshes.push_back(test::sphere(static_cast<float>(between(0.3, 1)), 16));
        places.emplace_back(between(3, 20), between(-8, 8), between(-2, 1));
    }
    auto snapshot = test::makeSnapshot(test::makeScene(std::move(meshes), -25, places), {0, 0, between(-1, 1)},
                                       between(-0.3, 0.3), between(-0.2, 0.2), between(-0.2, 0.2));
    snapshot.water_surface = 8;
    return snapshot;
}

std::vector<VolumeLayer> randomWater(std::mt19937& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double loud = between(-60, -35), middle = between(6, 11);
    if (random() % 2) return {{{}, {}, loud}};
    return {{{}, middle, loud}, {middle - between(0, 2), {}, loud - between(0, 15)}};
}

/** Numbers of bins. */
struct LabelCounts {
    size_t waters = 0, surfaces = 0, mixed = 0, behind_walls = 0;
};

/** Expects that the labels follow from those of the same ping without water: the pings differ by the water. */
void expectDifference(const WaterLabels& labels, const WaterLabels& clear, LabelCounts& counts) {
    EXPECT_EQ(labels.truth.hits, clear.truth.hits);
    EXPECT_EQ(labels.truth.shadow, clear.truth.shadow);
    for (size_t at = 0; at < labels.ping.bins.size(); ++at) {
        const double all = labels.energy(at), water = all - clear.energy(at), surface = clear.labelled(at);
        if (!(all > 0)) continue;
        const double share = std::max(water, surface) / all;
        const bool is_water = water > surface;
        ASSERT_NEAR(labels.truth.share[at], share, 1e-5) << at;
        if (std::abs(water - surface) < 1e-4 * all) continue;
        ASSERT_EQ(labels.truth.path[at], is_water ? by_water : clear.truth.path[at]) << at;
        ASSERT_EQ(labels.truth.object[at], is_water ? -1 : clear.truth.object[at]) << at;
        (is_water ? counts.waters : counts.surfaces) += 1;
        counts.mixed += surface > 0 && share < 0.95;
        counts.behind_walls += labels.truth.path[at] == types::SonarTruth::through_wall;
    }
}

TEST(WaterTruthTest, SharesAreThoseOfPingsWithAndWithoutWater) {
    std::mt19937 random(5);
    LabelCounts counts;
    for (int i = 0; i < 8; ++i) {
        const types::Snapshot snapshot = ballsOverGround(random);
        SonarConfig clear = inWater({}, 256), filled = clear;
        clear.beam_geometry = filled.beam_geometry = i % 3 ? BeamGeometry::Planar : BeamGeometry::Conical;
        filled.volume = randomWater(random);
        const auto with = test::everyRenderer(filled), without = test::everyRenderer(clear);
        for (size_t way = 0; way < with.size(); ++way) {
            SCOPED_TRACE(std::to_string(i) + " " + std::to_string(way));
            const WaterLabels labels = getLabels(with[way], snapshot);
            EXPECT_EQ(test::makePing(with[way], snapshot).bins, labels.ping.bins) << "truth changes no bin";
            expectDifference(labels, getLabels(without[way], snapshot), counts);
        }
    }
    EXPECT_GT(counts.waters, 1000u);
    EXPECT_GT(counts.surfaces, 1000u);
    EXPECT_GT(counts.mixed, 1000u);
}

TEST(WaterTruthTest, WaterBeforeThinWallsSharesBinsWithWhatIsBehindThem) {
    std::mt19937 random(12);
    LabelCounts counts;
    for (int i = 0; i < 6; ++i) {
        types::Snapshot snapshot = ballsOverGround(random);
        auto geometry = std::make_shared<types::Geometry>(*snapshot.geometry);
        geometry->materials.push_back(geometry->materials[0]);
        geometry->materials[1].shell = acrylic;
        for (size_t ball = 2; ball < geometry->meshes.size(); ++ball)
            for (types::Cluster& cluster : geometry->meshes[ball].clusters) cluster.material = 1;
        snapshot.geometry = geometry;
        SonarConfig clear = inWater({}, 256);
        clear.visibility = Visibility::Cpu;
        clear.frequency_khz = shell_khz;
        SonarConfig filled = clear;
        filled.volume = randomWater(random);
        expectDifference(getLabels(filled, snapshot), getLabels(clear, snapshot), counts);
    }
    EXPECT_GT(counts.waters, 500u);
    EXPECT_GT(counts.mixed, 500u);
    EXPECT_GT(counts.behind_walls, 100u);
}

/** Returns the numbers of the water's labels; NaN equals NaN. */
std::vector<double> getNumbers(const types::SonarTruth& truth) {
    std::vector<double> all;
    types::SonarTruth::forEachArray(truth, [&](const char*, const auto& numbers, auto) {
        for (const auto number : numbers) all.push_back(std::isnan(double(number)) ? -9 : double(number));
    });
    return all;
}

TEST(WaterTruthTest, LabelsAreTheSameOnAnyNumberOfThreads) {
    std::mt19937 random(6);
    std::vector<SonarConfig> all(4, inWater(-45));
    acoustics::BeamLaw law;
    law.width_deg = 12;
    all[1].beam_pattern.emplace().receive.azimuth = law;
    all[1].pulse.emplace().bandwidth_khz = 2;
    all[2].beam_count = 1;  // several threads share a beam
    all[2].quality.rows = 2048;
    all[2].quality.columns_per_beam = 32;
    all[3].multipath.emplace().surface.emplace();
    for (const SonarConfig& config : all) {
        const types::Snapshot snapshot = ballsOverGround(random);
        for (SonarConfig& way : test::everyRenderer(config)) {
            if (config.multipath && way.visibility != Visibility::Cpu) continue;
            const auto one = getNumbers(getLabels(way, snapshot, 1).truth);
            for (const int threads : {2, 5}) EXPECT_EQ(one, getNumbers(getLabels(way, snapshot, threads).truth));
        }
    }
}

/** Beams are formed of cells. Rays and pictures sample the edges of balls differently. */
TEST(WaterTruthTest, RaysAndPicturesHaveTheSameLabels) {
    std::mt19937 random(7);
    SonarConfig config = inWater(-45);
    config.quality.columns_per_beam = 16;
    acoustics::BeamLaw law;
    law.width_deg = 12;
    config.beam_pattern.emplace().receive.azimuth = law;
    const types::Snapshot snapshot = ballsOverGround(random);
    const auto ways = test::everyRenderer(config);
    const WaterLabels rays = getLabels(ways[0], snapshot);
    for (const size_t way : {1, 2}) {
        const WaterLabels pictures = getLabels(ways[way], snapshot);
        double same = 0, waters = 0, all = 0;
        for (size_t at = 0; at < rays.ping.bins.size(); ++at) {
            all += rays.energy(at);
            if (rays.truth.path[at] != pictures.truth.path[at]) continue;
            if (std::abs(rays.truth.share[at] - pictures.truth.share[at]) > 0.03f) continue;
            same += rays.energy(at);
            if (rays.isWater(at)) waters += rays.energy(at);
        }
        std::cout << 100 * same / all << " % of the energy with the same labels, " << 100 * waters / all
                  << " % of the water\n";
        EXPECT_GT(same, 0.97 * all);
        EXPECT_GT(waters, 0.1 * all);
    }
}

/** Echoes by the water surface, direct echoes and the water: each ping without one of them gives its energy. */
TEST(WaterTruthTest, WaterMirrorsAndDirectEchoesShareABin) {
    std::mt19937 random(8);
    size_t of_path[7] = {};
    for (int i = 0; i < 4; ++i) {
        types::Snapshot snapshot = ballsOverGround(random);
        snapshot.water_surface = 3;
        SonarConfig config = inWater(std::uniform_real_distribution(-60.0, -45.0)(random), 256);
        config.beam_height_deg = 80;
        config.visibility = Visibility::Cpu;
        config.multipath.emplace().surface.emplace().wind_m_s = 0;
        SonarConfig clear = config, direct = config;
        clear.volume.clear();
        direct.volume.clear();
        direct.multipath->surface.reset();
        direct.multipath->bounces = 0;
        const WaterLabels labels = getLabels(config, snapshot), alone = getLabels(clear, snapshot),
                          plain = getLabels(direct, snapshot);
        EXPECT_EQ(labels.truth.shadow, alone.truth.shadow);
        EXPECT_EQ(test::makePing(config, snapshot).bins, labels.ping.bins);
        for (size_t at = 0; at < labels.ping.bins.size(); ++at) {
            const double all = labels.energy(at), water = all - alone.energy(at);
            if (!(all > 0)) continue;
            ++of_path[labels.truth.path[at]];
            ASSERT_GT(labels.truth.share[at], 0) << at;
            if (water > 0.501 * all) {
                ASSERT_EQ(labels.truth.path[at], by_water) << at;
            }
            // A label by mirrors counts two ways, of which the stronger has at least half.
            if (water < (alone.truth.path[at] == 0 ? 0.999 : 0.499) * alone.labelled(at)) {
                ASSERT_EQ(labels.truth.path[at], alone.truth.path[at]) << at;
            }
            const double expected = labels.isWater(at)                              ? water
                                    : labels.truth.path[at] == 0                    ? plain.labelled(at)
                                    : labels.truth.path[at] == alone.truth.path[at] ? alone.labelled(at)
                                                                                    : labels.labelled(at);
            ASSERT_NEAR(labels.truth.share[at], expected / all, 1e-4)
                << i << " " << at << " path " << int{labels.truth.path[at]};
        }
    }
    for (const int path : {0, 1, 2, 6}) EXPECT_GT(of_path[path], 200u) << path;
}

/** The truth of fields is that of energies, whose bins are wider than those of the fields. */
TEST(WaterTruthTest, CoherentSpeckleHasTheLabelsOfEnergies) {
    std::mt19937 random(9);
    for (const bool mirrors : {false, true}) {
        const types::Snapshot snapshot = ballsOverGround(random);
        SonarConfig energies = inWater(-45);
        energies.visibility = Visibility::Cpu;
        energies.frequency_khz = 300;
        if (mirrors) energies.multipath.emplace().surface.emplace();
        SonarConfig fields = energies;
        fields.speckle.emplace().coherent = true;
        const WaterLabels sums = getLabels(energies, snapshot), coherent = getLabels(fields, snapshot);
        EXPECT_EQ(test::makePing(fields, snapshot).bins, coherent.ping.bins);
        size_t same = 0, count = 0, waters = 0;
        for (size_t at = 0; at < sums.ping.bins.size(); ++at) {
            if (sums.truth.path[at] % by_water != 0) continue;  // whether a mirror is stronger is unknown with fields
            ++count;
            waters += sums.isWater(at);
            same += sums.truth.path[at] == coherent.truth.path[at] &&
                    std::abs(sums.truth.share[at] - coherent.truth.share[at]) < 0.03;
        }
        std::cout << same << " of " << count << " labels, " << waters << " of the water\n";
        EXPECT_GT(waters, 400u);
        EXPECT_GT(static_cast<double>(same), 0.97 * static_cast<double>(count));
    }
}

/** A 3-D sonar's azimuths are sums over its beams; the truth of a fan of the whole height is that of the same bins. */
TEST(WaterTruthTest, AGridOfBeamsHasTheWaterToo) {
    Sonar3dTask task("sonar");
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarTruthPtr> truths{"truths"}, of_returns{"returns"};
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
    task.truth.connectTo(truths.port, framework::ConnPolicy::data());
    task.range_truth.connectTo(of_returns.port, framework::ConnPolicy::data());
    Sonar3dConfig config;
    config.sonar = inWater(-45);
    config.horizontal = {8, 80};
    config.vertical = {20, 40};
    config.sonar.field_of_view_deg.reset();
    config.sonar.beam_height_deg = 2;
    config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 16;
    task.config.set(config);
    ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    std::mt19937 random(10);
    types::Snapshot snapshot = ballsOverGround(random);
    in.port.write(std::make_shared<types::Snapshot>(snapshot));
    task.update();
    types::SonarTruthPtr truth, returns;
    ASSERT_TRUE(truths.port.readNew(truth) && of_returns.port.readNew(returns)) << task.lastError();
    const WaterLabels fan = getLabels(inWater(-45), snapshot);
    ASSERT_EQ(truth->path.size(), fan.truth.path.size());
    size_t strong = 0, same = 0, waters = 0;
    for (size_t at = 0; at < truth->path.size(); ++at) {
        EXPECT_EQ(truth->path[at] == by_water, std::isnan(truth->elevation[at]) && truth->share[at] > 0) << at;
        if (fan.truth.share[at] < 0.7f) continue;
        ++strong;
        waters += fan.isWater(at);
        same += truth->path[at] == fan.truth.path[at] && truth->object[at] == fan.truth.object[at];
    }
    std::cout << same << " of " << strong << " labels the same, " << waters << " of the water\n";
    EXPECT_GT(waters, 300u);
    EXPECT_GT(static_cast<double>(same), 0.97 * static_cast<double>(strong));
    snapshot.geometry = test::openWater();
    in.port.write(std::make_shared<types::Snapshot>(snapshot));
    task.update();
    ASSERT_TRUE(of_returns.port.readNew(returns)) << task.lastError();
    EXPECT_THAT(returns->hits, testing::Each(0u)) << "the water's own echo is no return";
    EXPECT_THAT(returns->object, testing::Each(-1));
    EXPECT_THAT(returns->elevation, testing::Each(testing::IsNan()));
}

}  // namespace
}  // namespace insonify::sonar
