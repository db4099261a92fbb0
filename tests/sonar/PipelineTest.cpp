// Pings that are under way together, whatever culls and sums them: bit for bit those that are rendered one by one.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sonar/ClusteredHarbour.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

using CullOn = RenderOptions::CullOn;
using SumIn = RenderOptions::SumIn;

/** A sonar that turns about the harbour while its ball moves. */
std::vector<types::SnapshotPtr> passage(const types::GeometryPtr& geometry, int count) {
    std::vector<types::SnapshotPtr> snapshots;
    for (int i = 0; i < count; ++i) {
        types::Snapshot snapshot = test::snapshotOf(geometry, {i - 2.0, 0.5 * i, 0.0}, 0.7 * i, 0.15, 0.1 * i);
        snapshot.time = types::Time::fromSeconds(1 + 0.1 * i);
        snapshot.moved = {{1, glm::translate(glm::dmat4(1), {9.0 - i, 4.0 - 0.5 * i, -3.0})}};
        snapshots.push_back(std::make_shared<types::Snapshot>(snapshot));
    }
    return snapshots;
}

types::Sonar rendered(SonarRenderer& renderer, const types::Snapshot& snapshot) {
    types::Sonar ping;
    renderer.render(snapshot, ping);
    return ping;
}

/** The pings of all snapshots, with as many under way as there may be. */
std::vector<types::Sonar> pipelined(SonarRenderer& renderer, const std::vector<types::SnapshotPtr>& snapshots) {
    std::vector<types::Sonar> pings;
    for (size_t i = 0; i < snapshots.size(); ++i) {
        if (i >= renderer.ringSize()) renderer.collect(pings.emplace_back());
        renderer.submit(snapshots[i]);
    }
    while (pings.size() < snapshots.size()) renderer.collect(pings.emplace_back());
    return pings;
}

struct Way {
    Deposit deposit;
    CullOn cull_on;
};

class PipelineTest : public testing::TestWithParam<Way> {
protected:
    SonarConfig config() const {
        SonarConfig config = fan(100);
        config.deposit = GetParam().deposit;
        return config;
    }
    RenderOptions options(size_t ring) const { return {.ring = ring, .cull_on = GetParam().cull_on}; }
};

/** Objects, triangles and frusta that were left out, and of how many. */
std::vector<std::tuple<std::string_view, double, double>> leftOut(const SonarRenderer& renderer) {
    std::vector<std::tuple<std::string_view, double, double>> all;
    for (const LeftOut& what : renderer.leftOut())
        if (what.effect != "point targets") all.emplace_back(what.effect, what.value, what.bound);
    return all;
}

/** Whether two ways to draw give the same bins of each snapshot, and leave the same out. */
void expectSame(const SonarConfig& config, const std::vector<types::SnapshotPtr>& snapshots, RenderOptions one,
                RenderOptions other) {
    const auto run = [&](const RenderOptions& options, const auto& use) {
        SonarRenderer renderer(config, snapshots.front()->geometry, options);
        for (const types::SnapshotPtr& snapshot : snapshots) use(rendered(renderer, *snapshot), leftOut(renderer));
    };
    std::vector<std::vector<float>> bins;
    std::vector<std::vector<std::tuple<std::string_view, double, double>>> left_out;
    run(one, [&](const types::Sonar& ping, const auto& left) {
        bins.push_back(ping.bins);
        left_out.push_back(left);
    });
    size_t at = 0;
    run(other, [&](const types::Sonar& ping, const auto& left) {
        EXPECT_EQ(ping.bins, bins[at]) << at;
        EXPECT_EQ(left, left_out[at]) << at;
        ++at;
    });
    EXPECT_GT(*std::ranges::max_element(bins.front()), 0);
}

}  // namespace

TEST_P(PipelineTest, PingsUnderWayTogetherAreThoseOfOneAfterAnother) {
    const auto snapshots = passage(clusteredHarbour(), 8);
    std::vector<types::Sonar> expected;
    SonarRenderer one_by_one(config(), snapshots.front()->geometry);
    for (const types::SnapshotPtr& snapshot : snapshots) expected.push_back(rendered(one_by_one, *snapshot));
    for (size_t ring : {1, 2, 3}) {
        SonarRenderer renderer(config(), snapshots.front()->geometry, options(ring));
        ASSERT_EQ(renderer.ringSize(), ring);
        const std::vector<types::Sonar> pings = pipelined(renderer, snapshots);
        for (size_t i = 0; i < pings.size(); ++i) {
            EXPECT_EQ(pings[i].bins, expected[i].bins) << "ring of " << ring << ", ping " << i;
            EXPECT_EQ(pings[i].time, snapshots[i]->time);
        }
    }
    EXPECT_NE(expected[0].bins, expected[1].bins);
}

TEST_P(PipelineTest, WhatIsToldIsOfThePingThatWasCollectedLast) {
    const types::GeometryPtr ball = test::sceneOf({test::sphere(1, 8)}, 0, {{10, 0, 0}});
    const auto ahead = std::make_shared<types::Snapshot>(test::snapshotOf(ball));
    const auto aside = std::make_shared<types::Snapshot>(test::snapshotOf(ball, {}, 2));
    SonarRenderer renderer(config(), ball, options(2));
    types::Sonar ping;
    EXPECT_TRUE(leftOut(renderer).empty()) << "nothing was drawn yet";
    EXPECT_FALSE(renderer.hasEchoes());
    renderer.submit(ahead);
    renderer.submit(aside);
    renderer.collect(ping);
    EXPECT_TRUE(renderer.hasEchoes());
    const auto of_ahead = leftOut(renderer);
    renderer.collect(ping);
    EXPECT_FALSE(renderer.hasEchoes());
    EXPECT_NE(leftOut(renderer), of_ahead);
    EXPECT_EQ(leftOut(renderer).front(), (std::tuple{"objects", 1.0, 1.0}));
}

INSTANTIATE_TEST_SUITE_P(Ways, PipelineTest,
                         testing::Values(Way{Deposit::Cpu, CullOn::Processor}, Way{Deposit::Gpu, CullOn::Processor},
                                         Way{Deposit::Cpu, CullOn::Device}, Way{Deposit::Gpu, CullOn::Device}),
                         [](const auto& way) {
                             return std::string(way.param.deposit == Deposit::Cpu ? "Cpu" : "Gpu") +
                                    (way.param.cull_on == CullOn::Device ? "CulledByDevice" : "CulledByProcessor");
                         });

TEST(PipelineOrderTest, APingThatHasNoPlaceOrWasNotSubmittedIsRefused) {
    const auto snapshots = passage(clusteredHarbour(), 1);
    SonarRenderer renderer(fan(60), snapshots[0]->geometry, {.ring = 2});
    types::Sonar ping;
    EXPECT_THROW(renderer.collect(ping), std::logic_error);
    renderer.submit(snapshots[0]);
    EXPECT_THROW(renderer.render(*snapshots[0], ping), std::logic_error);
    EXPECT_THROW(renderer.setQuality(64, 1), std::logic_error);
    renderer.submit(snapshots[0]);
    EXPECT_THROW(renderer.submit(snapshots[0]), std::logic_error);
    renderer.collect(ping);
    const types::Sonar first = ping;
    renderer.collect(ping);
    EXPECT_EQ(ping.bins, first.bins);
    EXPECT_THROW(renderer.collect(ping), std::logic_error);
    renderer.setQuality(64, 1);
    EXPECT_EQ(rendered(renderer, *snapshots[0]).bins.size(), first.bins.size());
}

TEST(PipelineOrderTest, RaysAreCastWhenTheyAreCollected) {
    const auto snapshots = passage(clusteredHarbour(), 3);
    SonarConfig config = fan(60);
    config.device.clear();
    config.visibility = Visibility::Cpu;
    if (!makeRenderPlan(config, *snapshots[0]->geometry).casts_rays) GTEST_SKIP() << "built without Embree";
    SonarRenderer renderer(config, snapshots[0]->geometry), other(config, snapshots[0]->geometry);
    ASSERT_EQ(renderer.ringSize(), 1u);
    const auto pings = pipelined(renderer, snapshots);
    for (size_t i = 0; i < pings.size(); ++i) EXPECT_EQ(pings[i].bins, rendered(other, *snapshots[i]).bins);
}

TEST(DeviceCullTest, TheDeviceCullsWhatTheProcessorCulls) {
    const auto open = clusteredHarbour(), both_sides = clusteredHarbour();
    both_sides->materials[0].double_sided = true;
    for (const types::GeometryPtr& scene : {types::GeometryPtr(open), types::GeometryPtr(both_sides)})
        for (Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
            SonarConfig config = fan(130);
            config.deposit = deposit;
            expectSame(config, passage(scene, 5), {.cull_on = CullOn::Processor}, {.cull_on = CullOn::Device});
        }
}

TEST(DeviceCullTest, SoItDoesAllAroundWithNormalMapsAndSeveralMaterials) {
    for (double degrees : {60.0, 360.0}) {
        SonarConfig config = fan(degrees);
        config.deposit = Deposit::Gpu;
        expectSame(config, passage(test::surfaces(), 4), {.cull_on = CullOn::Processor}, {.cull_on = CullOn::Device});
    }
}

TEST(DeviceCullTest, ClustersOfAnObjectInViewAreCulledAndNoneWhereAllAreDrawn) {
    const auto snapshots = passage(clusteredHarbour(), 1);
    SonarConfig config = fan(60);
    config.deposit = Deposit::Gpu;
    const auto triangles = [&] {
        SonarRenderer renderer(config, snapshots[0]->geometry, {.cull_on = CullOn::Device});
        rendered(renderer, *snapshots[0]);
        const auto all = renderer.leftOut();
        const auto found = std::ranges::find(all, "triangles", &LeftOut::effect);
        return found == all.end() ? 0 : found->value / found->bound;
    };
    EXPECT_GT(triangles(), 0.5) << "most of the floor is not ahead";
    config.draw_all = true;
    EXPECT_EQ(triangles(), 0);
}

TEST(DeviceCullTest, WhereNothingIsInViewNothingIsHeard) {
    SonarConfig config = fan(60);
    config.deposit = Deposit::Gpu;
    const auto behind = test::snapshotOf(test::sceneOf({test::sphere(1, 8)}, 0, {{-10, 0, 0}}));
    SonarRenderer renderer(config, behind.geometry, {.cull_on = CullOn::Device});
    const types::Sonar ping = rendered(renderer, behind);
    EXPECT_EQ(*std::ranges::max_element(ping.bins), 0);
    EXPECT_FALSE(renderer.hasEchoes());
}

TEST(GroupSumsTest, SumsOfWorkGroupsAreThoseOfMemory) {
    for (Model model : {Model::Physical, Model::Cerqueira2017})
        for (BeamGeometry beams : {BeamGeometry::Planar, BeamGeometry::Conical})
            for (int bins : {30, 300, 6000}) {  // of the last, a group spans more than it has memory for
                SonarConfig config = fan(130);
                config.deposit = Deposit::Gpu;
                config.model = model;
                config.beam_geometry = beams;
                config.bin_count = bins;
                expectSame(config, passage(clusteredHarbour(), 2), {.sum_in = SumIn::Memory},
                           {.sum_in = SumIn::Groups});
            }
}

TEST(GroupSumsTest, AlsoInThePublishedModelWhereMissesCount) {
    SonarConfig config = fan(60);
    config.deposit = Deposit::Gpu;
    config.model = Model::Cerqueira2017;
    config.published = true;
    expectSame(config, passage(clusteredHarbour(), 2), {.sum_in = SumIn::Memory}, {.sum_in = SumIn::Groups});
}

}  // namespace insonify::sonar
