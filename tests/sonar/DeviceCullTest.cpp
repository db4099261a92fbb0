// With `deposit: gpu` a compute shader culls clusters: the same clusters as the processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "tests/sonar/ClusteredHarbour.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

/** A sonar that turns about the harbour while its ball moves. */
std::vector<types::Snapshot> passage(const types::GeometryPtr& geometry, int count) {
    std::vector<types::Snapshot> snapshots;
    for (int i = 0; i < count; ++i) {
        types::Snapshot snapshot = test::makeSnapshot(geometry, {i - 2.0, 0.5 * i, 0.0}, 0.7 * i, 0.15, 0.1 * i);
        snapshot.moved = {{1, glm::translate(glm::dmat4(1), {9.0 - i, 4.0 - 0.5 * i, -3.0})}};
        snapshots.push_back(snapshot);
    }
    return snapshots;
}

SonarConfig fanWith(Deposit deposit, double field_of_view_deg) {
    SonarConfig config = fan(field_of_view_deg);
    config.deposit = deposit;
    return config;
}

/** Bins of a ping, and the numbers of culled and of all objects, triangles and frusta. */
struct Result {
    std::vector<float> bins;
    std::vector<std::tuple<std::string_view, double, double>> culled;
};

std::vector<Result> rendered(const SonarConfig& config, const std::vector<types::Snapshot>& snapshots) {
    SonarRenderer renderer(config, snapshots.front().geometry);
    EXPECT_TRUE(renderer.omissions().empty()) << "no ping yet";
    std::vector<Result> results;
    for (const types::Snapshot& snapshot : snapshots) {
        types::Sonar ping;
        renderer.render(snapshot, ping);
        Result& result = results.emplace_back(Result{ping.bins, {}});
        for (const Omitted& what : renderer.omissions())
            if (what.reason == Reason::OutOfView) result.culled.emplace_back(what.effect, what.value, what.bound);
        EXPECT_EQ(renderer.hasEchoes(), *std::ranges::max_element(ping.bins) > 0);
    }
    return results;
}

/** Expects processor and device to cull the same in each ping; `config.deposit` is ignored. */
void expectSameCulling(SonarConfig config, const std::vector<types::Snapshot>& snapshots) {
    config.deposit = Deposit::Cpu;
    const std::vector<Result> processor = rendered(config, snapshots);
    config.deposit = Deposit::Gpu;
    const std::vector<Result> device = rendered(config, snapshots);
    for (size_t i = 0; i < snapshots.size(); ++i) EXPECT_EQ(device[i].culled, processor[i].culled) << i;
    const auto nothing = [](const Result& result) { return result.culled.empty(); };
    EXPECT_FALSE(config.fieldOfViewDeg() < 100 && std::ranges::all_of(device, nothing));
}

TEST(DeviceCullTest, TheDeviceCullsTheSameAsTheProcessor) {
    const auto open = clusteredHarbour(), both_sides = clusteredHarbour();
    both_sides->materials[0].double_sided = true;
    for (const types::GeometryPtr& scene : {types::GeometryPtr(open), types::GeometryPtr(both_sides)})
        for (const double degrees : {60.0, 130.0, 360.0})
            expectSameCulling(fanWith(Deposit::Auto, degrees), passage(scene, 5));
}

TEST(DeviceCullTest, TheDeviceCullsTheSameWithNormalMapsAndSeveralMaterials) {
    for (const double degrees : {10.0, 60.0, 360.0})
        expectSameCulling(fanWith(Deposit::Auto, degrees), passage(test::surfaces(), 4));
}

TEST(DeviceCullTest, NoBinChangesWithoutCulling) {
    SonarConfig config = fanWith(Deposit::Gpu, 100);
    config.range = 120;  // contains the whole scene
    const std::vector<types::Snapshot> snapshots = passage(clusteredHarbour(), 5);
    const std::vector<Result> culled = rendered(config, snapshots);
    config.draw_all = true;
    const std::vector<Result> whole = rendered(config, snapshots);
    for (size_t i = 0; i < snapshots.size(); ++i) {
        EXPECT_EQ(culled[i].bins, whole[i].bins) << i;
        EXPECT_FALSE(culled[i].culled.empty());
        EXPECT_TRUE(whole[i].culled.empty());
    }
    EXPECT_NE(whole[0].bins, whole[1].bins);
}

TEST(DeviceCullTest, ClustersOfAnObjectInViewAreCulled) {
    const Result result = rendered(fanWith(Deposit::Gpu, 60), passage(clusteredHarbour(), 1)).front();
    const auto triangles =
        std::ranges::find(result.culled, "triangles", [](const auto& what) { return std::get<0>(what); });
    ASSERT_NE(triangles, result.culled.end());
    EXPECT_GT(std::get<1>(*triangles), 0.5 * std::get<2>(*triangles)) << "most of the floor is not ahead";
}

TEST(DeviceCullTest, NoEchoIsReceivedWithNothingInView) {
    const auto ball = test::makeScene({test::sphere(1, 8)}, 0, {{10, 0, 0}});
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        const auto results =
            rendered(fanWith(deposit, 60), {test::makeSnapshot(ball), test::makeSnapshot(ball, {}, 2)});
        EXPECT_GT(*std::ranges::max_element(results[0].bins), 0);
        EXPECT_EQ(*std::ranges::max_element(results[1].bins), 0);
        EXPECT_EQ(results[1].culled.front(), (std::tuple{std::string_view("objects"), 1.0, 1.0}));
    }
}

}  // namespace
}  // namespace insonify::sonar
