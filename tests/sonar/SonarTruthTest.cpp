// The truth of a ping, compared with closed forms. It changes no bin.
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/samples/SonarReturns.hpp"

namespace insonify::sonar {
namespace {

/** A ping and its truth. */
struct Truths {
    types::Sonar ping;
    types::SonarTruth truth;

    size_t at(double range, size_t beam) const {
        return beam * ping.bin_count + static_cast<size_t>(range / ping.binStart(1));
    }
};

Truths getTruths(const SonarConfig& config, const types::Snapshot& snapshot, int threads = 0) {
    SonarRenderer renderer(config, snapshot.geometry, {.threads = threads});
    Truths labelled;
    renderer.setTruth(labelled.ping, &labelled.truth);
    renderer.render(snapshot, labelled.ping);
    return labelled;
}

/** 16 beams of 5 deg, 200 bins of 0.1 m, 60 deg high. */
SonarConfig truthFan() {
    return test::getSonar({.beams = 16, .width_deg = 80, .height_deg = 60, .bins = 200, .rows = 512, .columns = 4});
}

struct Way {
    const char* name;
    Visibility visibility;
    Deposit deposit;

    SonarConfig of(SonarConfig config) const {
        config.visibility = visibility;
        config.deposit = deposit;
        config.device = visibility == Visibility::Gl ? "software" : "";
        return config;
    }
};
constexpr Way ways[] = {{"Rays", Visibility::Cpu, Deposit::Auto},
                        {"Drawn", Visibility::Gl, Deposit::Cpu},
                        {"DrawnAndDepositedOnTheDevice", Visibility::Gl, Deposit::Gpu}};

using test::getBits;

class SonarTruthTest : public testing::TestWithParam<Way> {};

/** A bottom 3 m below a level sonar: at slant range r it is at the depression asin(3 / r), which is also its grazing
 *  angle. With bins of 0.1 m and samples of 0.1 deg the mean is within 3 mrad. */
TEST_P(SonarTruthTest, ABottomHasTheElevationAndTheGrazingAngleOfItsDepth) {
    const Truths labelled =
        getTruths(GetParam().of(truthFan()), test::makeSnapshot(test::makeScene({test::ground(-3)})));
    double maximum = 0;
    for (size_t beam = 0; beam < 16; ++beam)
        for (double r = 6.55; r < 19.9; r += 0.1) {  // below 6 m the aperture ends
            const size_t at = labelled.at(r, beam);
            ASSERT_EQ(labelled.truth.object[at], 0) << beam << " " << r;
            EXPECT_EQ(labelled.truth.share[at], 1);
            EXPECT_GE(labelled.truth.hits[at], 1u);
            const double angle = std::asin(3 / r);
            EXPECT_NEAR(labelled.truth.grazing[at], angle, 0.003) << r;
            EXPECT_NEAR(labelled.truth.elevation[at], -angle, 0.003) << r;
            maximum = std::max(maximum, std::abs(static_cast<double>(labelled.truth.grazing[at]) - angle));
        }
    RecordProperty("largest_rad", std::to_string(maximum));
    EXPECT_THAT(labelled.truth.path, testing::Each(0));
}

/** A plate on the bottom, 5 m ahead and 2 m high, hides the bottom from 5.83 m (its foot, straight ahead) to where the
 *  ray over its upper edge meets the bottom: 15 m ahead, at a slant range of 15.30 m. */
TEST_P(SonarTruthTest, APlateCastsItsShadowOnTheBottomBehindIt) {
    const auto scene = test::makeScene({test::ground(-3), test::quad({5, -20, -3}, {0, 40, 0}, {0, 0, 2})});
    const Truths labelled = getTruths(GetParam().of(truthFan()), test::makeSnapshot(scene));
    for (const size_t beam : {size_t{7}, size_t{8}}) {
        for (double r = 6.15; r < 15.1; r += 0.1) {
            EXPECT_EQ(labelled.truth.shadow[labelled.at(r, beam)], 1) << r;
            EXPECT_EQ(labelled.truth.object[labelled.at(r, beam)], -1) << r;
        }
        for (double r = 15.55; r < 19.9; r += 0.1) {
            EXPECT_EQ(labelled.truth.shadow[labelled.at(r, beam)], 0) << r;
            EXPECT_EQ(labelled.truth.object[labelled.at(r, beam)], 0) << r;
        }
        EXPECT_EQ(labelled.truth.object[labelled.at(5.25, beam)], 1);
        EXPECT_EQ(labelled.truth.shadow[labelled.at(5.25, beam)], 0);
        EXPECT_EQ(labelled.truth.shadow[labelled.at(2.05, beam)], 1) << "water before the first echo is silent as well";
    }
}

std::vector<SonarConfig> manyKinds() {
    std::vector<SonarConfig> all(5, truthFan());
    all[1].beam_geometry = BeamGeometry::Conical;
    all[2].model = Model::Cerqueira2017;
    acoustics::BeamLaw law;
    law.width_deg = 8;
    all[3].beam_pattern.emplace().receive.azimuth = law;
    law.width_deg = 30;
    all[3].beam_pattern->transmit.elevation = law;
    all[3].pulse.emplace().bandwidth_khz = 2;
    all[4].beam_count = 1;
    all[4].quality.rows = 2048;
    all[4].quality.columns_per_beam = 32;
    return all;
}

types::Snapshot scatteredBalls() {
    std::vector<types::Mesh> meshes = {test::ground(-3), test::wall(14)};
    std::vector<glm::dvec3> places(2);
    for (int i = 0; i < 8; ++i) {
        meshes.push_back(test::sphere(0.6f, 16));
        places.emplace_back(5 + i, i % 2 ? 2.0 * i - 8 : 8 - 2.0 * i, -0.3 * i);
    }
    return test::makeSnapshot(test::makeScene(std::move(meshes), -10, places));
}

TEST_P(SonarTruthTest, TruthChangesNoBin) {
    const types::Snapshot snapshot = scatteredBalls();
    for (const SonarConfig& config : manyKinds()) {
        SonarRenderer renderer(GetParam().of(config), snapshot.geometry);
        types::Sonar alone, labelled, again;
        types::SonarTruth truth;
        renderer.render(snapshot, alone);
        renderer.setTruth(labelled, &truth);
        renderer.render(snapshot, labelled);
        renderer.render(snapshot, again);
        EXPECT_EQ(alone.bins, labelled.bins);
        EXPECT_EQ(alone.bins, again.bins);
        EXPECT_THAT(truth.object, testing::Contains(5));
    }
}

TEST_P(SonarTruthTest, TruthIsTheSameOnAnyNumberOfThreads) {
    const types::Snapshot snapshot = scatteredBalls();
    for (const SonarConfig& config : manyKinds()) {
        const std::vector<uint32_t> one = getBits(getTruths(GetParam().of(config), snapshot, 1).truth);
        for (const int threads : {2, 5})
            EXPECT_EQ(one, getBits(getTruths(GetParam().of(config), snapshot, threads).truth)) << threads;
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, SonarTruthTest, testing::ValuesIn(ways),
                         [](const auto& way) { return std::string(way.param.name); });

/** The published model counts pixels without an echo in its first bin, which has no object. */
TEST(PublishedTruthTest, MissesAreNoObjects) {
    SonarConfig config = ways[1].of(truthFan());
    config.model = Model::Cerqueira2017;
    config.published = true;
    const types::Snapshot snapshot =
        test::makeSnapshot(test::makeScene({test::quad({8, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
    const Truths labelled = getTruths(config, snapshot);
    SonarRenderer renderer(config, snapshot.geometry);
    types::Sonar alone;
    renderer.render(snapshot, alone);
    EXPECT_EQ(alone.bins, labelled.ping.bins);
    EXPECT_GT(labelled.ping.bins[0], 0);
    EXPECT_EQ(labelled.truth.object[0], -1);
    EXPECT_EQ(labelled.truth.object[labelled.at(8.05, 8)], 0);
}

/** A ball in one beam echoes in the sidelobes of all other beams, but only its own beam has it in the truth. */
TEST(PatternedTruthTest, EchoesInSidelobesHaveNoTruth) {
    SonarConfig config = ways[0].of(truthFan());
    acoustics::BeamLaw law;
    law.width_deg = 5;
    config.beam_pattern.emplace().receive.azimuth = law;
    const double bearing = types::radians(2.5);  // the middle of beam 8
    const glm::dvec3 place(10 * std::cos(bearing), 10 * std::sin(bearing), 0);
    const Truths labelled =
        getTruths(config, test::makeSnapshot(test::makeScene({test::sphere(0.2f, 32)}, 0, {place})));
    for (size_t beam = 0; beam < 16; ++beam) {
        const size_t at = labelled.at(9.85, beam);
        EXPECT_GT(labelled.ping.bins[at], 0) << beam;
        EXPECT_EQ(labelled.truth.object[at], beam == 8 ? 0 : -1) << beam;
    }
}

/** Pings of a task with its connections, and their truth. */
struct Bench {
    SonarTask task{"sonar"};
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> pings;
    test::Reader<types::SonarTruthPtr> truths{"truths"};
    test::Reader<types::SonarReturnsPtr> returns{"returns"};

    explicit Bench(const SonarConfig& config) {
        in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(4));
        task.ping.connectTo(pings.port, framework::ConnPolicy::data());
        task.config.set(config);
    }
    types::SonarPtr makePing(const types::Snapshot& snapshot) {
        if (!task.isRunning() && !(task.configure() && task.start())) return nullptr;
        in.port.write(std::make_shared<types::Snapshot>(snapshot));
        task.update();
        types::SonarPtr ping;
        pings.port.readNew(ping);
        return ping;
    }
};

TEST(SonarTaskTruthTest, WritesNoTruthWithoutAConnectionAndChoosesTheSameQuality) {
    SonarConfig config = ways[0].of(truthFan());
    config.quality = {};  // chosen by the task, and monitored with coarser pings
    Bench alone(config), labelled(config);
    labelled.task.truth.connectTo(labelled.truths.port, framework::ConnPolicy::data());
    types::Snapshot snapshot = scatteredBalls();
    for (int i = 0; i < 12; ++i) {
        snapshot.time = snapshot.time + types::Time{100'000};
        snapshot.sonar.position.x = 0.05 * i;
        const auto ping = alone.makePing(snapshot), same = labelled.makePing(snapshot);
        ASSERT_TRUE(ping && same);
        EXPECT_EQ(ping->bins, same->bins) << i;
        types::SonarTruthPtr truth;
        ASSERT_TRUE(labelled.truths.port.readNew(truth));
        EXPECT_EQ(truth->time, same->time);
        EXPECT_EQ(truth->diagnostic(), nullptr);
        EXPECT_THAT(truth->objects, testing::SizeIs(10));
        EXPECT_EQ(truth->objects[4], "object_4");
        for (size_t at = 0; at < ping->bins.size(); ++at)
            ASSERT_EQ(ping->bins[at] > 0, truth->object[at] >= 0) << "the truth of other samples, ping " << i;
    }
    EXPECT_EQ(alone.task.truth.written(), 0u);
    EXPECT_EQ(labelled.task.returns.written(), 0u);
}

TEST(SonarTaskTruthTest, ThePlanOmitsTheTruthWithoutAConnection) {
    for (const Way& way : ways) {
        Bench alone(way.of(truthFan())), to_truth(way.of(truthFan())), to_returns(way.of(truthFan()));
        to_truth.task.truth.connectTo(to_truth.truths.port, framework::ConnPolicy::data());
        to_returns.task.returns.connectTo(to_returns.returns.port, framework::ConnPolicy::data());
        for (Bench* bench : {&alone, &to_truth, &to_returns}) {
            ASSERT_TRUE(bench->makePing(scatteredBalls()));
            std::vector<std::string> omitted;
            for (const types::Omission& omission : bench->task.plan()->omitted)
                if (omission.name == "truth") omitted.push_back(omission.reason);
            if (bench == &alone)
                EXPECT_THAT(omitted, testing::ElementsAre(testing::HasSubstr("nobody is connected")));
            else
                EXPECT_THAT(omitted, testing::IsEmpty());
        }
    }
}

/** A plate at normal incidence 9 m ahead, and a bottom below: the bottom is nearer, the plate is stronger. */
TEST(SonarTaskTruthTest, ReturnsAreTheFirstAndTheStrongestOfEachBeam) {
    Bench bench(ways[0].of(truthFan()));
    bench.task.returns.connectTo(bench.returns.port, framework::ConnPolicy::data());
    const auto scene = test::makeScene({test::ground(-3), test::quad({9, -10, -0.5}, {0, 20, 0}, {0, 0, 1})});
    const auto ping = bench.makePing(test::makeSnapshot(scene));
    types::SonarReturnsPtr returns;
    ASSERT_TRUE(ping && bench.returns.port.readNew(returns));
    EXPECT_EQ(returns->diagnostic(), nullptr);
    EXPECT_EQ(bench.task.truth.written(), 0u);
    constexpr size_t beam = 8;
    EXPECT_NEAR(returns->first_range[beam], 3 / std::sin(types::radians(30)), 0.1) << "where the aperture ends";
    EXPECT_NEAR(returns->first_elevation[beam], -types::radians(30), 0.02);
    EXPECT_NEAR(returns->strongest_range[beam], 9.05, 0.051);
    EXPECT_NEAR(returns->strongest_elevation[beam], 0, 0.03);
    const size_t at = beam * 200 + static_cast<size_t>(returns->strongest_range[beam] / 0.1f);
    EXPECT_FLOAT_EQ(returns->strongest_level[beam], 10 * std::log10(ping->bins[at]));
    const auto silent = bench.makePing(test::makeSnapshot(scene, {0, 0, 500}));
    ASSERT_TRUE(silent && bench.returns.port.readNew(returns));
    EXPECT_TRUE(std::isnan(returns->first_range[beam]) && std::isnan(returns->strongest_level[beam]));
}

/** Random balls, boxes and tilted plates: no bin beyond an object's farthest point, or before its nearest, has its
 *  label. */
TEST(ObjectTruthTest, LabelsAreWithinTheRangesOfTheirObjects) {
    std::mt19937 random(21);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    SonarConfig config = test::getSonar(
        {.beams = 12, .width_deg = 60, .height_deg = 40, .bins = 400, .bin = 0.05, .rows = 64, .columns = 4});
    config.visibility = Visibility::Cpu;
    for (int trial = 0; trial < 12; ++trial) {
        const auto scene = std::make_shared<types::Geometry>(*test::makeScene(
            {test::ground(-4), trial % 2 ? test::sphere(static_cast<float>(between(0.3, 1.5)), trial % 4 == 1 ? 6 : 12)
                                         : test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})},
            0, {{}, {between(6, 14), between(-3, 3), between(-3, 2)}}));
        const glm::dquat turn =
            glm::normalize(glm::dquat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)));
        scene->objects[1].world_from_object = scene->objects[1].world_from_object * glm::mat4_cast(turn);
        double near = 1e9, far = 0;
        for (const glm::vec3& corner : scene->meshes[1].positions) {
            const double range = glm::length(glm::dvec3(scene->objects[1].world_from_object * glm::dvec4(corner, 1)));
            near = std::min(near, range), far = std::max(far, range);
        }
        const Truths all = getTruths(config, test::makeSnapshot(scene));
        size_t labelled = 0;
        for (size_t i = 0; i < all.ping.bins.size(); ++i) {
            if (all.truth.object[i] != 1) continue;
            ++labelled;
            const double start = all.ping.binStart(static_cast<double>(i % 400));
            EXPECT_LT(start, far + 1e-3) << trial;
            EXPECT_GT(start + 0.05, near - 0.6) << trial;  // within a facet
        }
        EXPECT_GT(labelled, 0u) << trial;
    }
}

}  // namespace
}  // namespace insonify::sonar
