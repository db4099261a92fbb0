// What the stages of a ping count, in closed form and on any number of threads.
#include <gmock/gmock.h>

#include "components/sonar/base/Counters.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/RandomSonars.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {
namespace {

using test::Draw;
using test::RandomSonar;

/** What this thread counts while `work` runs. */
Counts getCounts(const auto& work) {
    const Counts before = thread_counts;
    work();
    Counts counts = thread_counts;
    for (size_t i = 0; i < counter_count; ++i) counts[i] -= before[i];
    return counts;
}
uint64_t in(const Counts& counts, Counter what) { return counts[static_cast<size_t>(what)]; }

Counts getCounts(const SonarConfig& config, const types::Snapshot& scene) {
    return getCounts([&] { test::makePing(config, scene); });
}

}  // namespace

/** The samples of a view that is no whole number of tiles are padded to tiles; the padding is not traced. */
TEST(CountersTest, TheRaysBeforeAnEndlessWallAreRowsTimesColumnsTimesBeams) {
    const types::Snapshot scene = test::makeSnapshot(test::makeScene({test::wall(10)}));
    Draw draw(1);
    for (int i = 0; i < 20; ++i) {
        const int beams = 1 + draw.upTo(40), rows = 1 + draw.upTo(70), columns = 1 + draw.upTo(9);
        SonarConfig config =
            test::getSonar({.beams = beams, .width_deg = 60, .height_deg = 20, .rows = rows, .columns = columns});
        config.visibility = Visibility::Cpu;
        const Counts counts = getCounts(config, scene);
        EXPECT_EQ(in(counts, Counter::Rays), static_cast<uint64_t>(rows * columns * beams));
        EXPECT_EQ(in(counts, Counter::Cells) + in(counts, Counter::SamplesMerged), in(counts, Counter::Rays));
        EXPECT_EQ(in(counts, Counter::Bins), static_cast<uint64_t>(beams * config.bin_count));
        for (const Counter other : {Counter::ObjectsCulled, Counter::Pixels, Counter::OnwardRays,
                                    Counter::OcclusionRays, Counter::WallsPassed, Counter::MirrorPaths})
            EXPECT_EQ(in(counts, other), 0u) << counter_meanings[static_cast<size_t>(other)].name;
    }
}

TEST(CountersTest, FineSamplesOfOneTriangleShareCells) {
    SonarConfig config =
        test::getSonar({.beams = 8, .width_deg = 2, .height_deg = 2, .bins = 10, .bin = 2, .rows = 512, .columns = 8});
    config.visibility = Visibility::Cpu;
    const Counts counts = getCounts(config, test::makeSnapshot(test::makeScene({test::wall(10)})));
    EXPECT_EQ(in(counts, Counter::Cells) + in(counts, Counter::SamplesMerged), 8u * 512 * 8);
    EXPECT_GT(in(counts, Counter::SamplesMerged), 4u * 512 * 8);
}

TEST(CountersTest, AnObjectOutOfViewIsCulledFromEachImage) {
    const auto behind = test::makeScene({test::wall(10), test::quad({-20, -1, -1}, {0, 2, 0}, {0, 0, 2})});
    const auto ahead = test::makeScene({test::wall(10), test::quad({5, -1, -1}, {0, 2, 0}, {0, 0, 2})});
    for (const SonarConfig& config : test::everyRenderer(
             test::getSonar({.beams = 8, .width_deg = 40, .height_deg = 20, .rows = 32, .columns = 4}))) {
        if (config.visibility == Visibility::Cpu) continue;
        const Counts hidden = getCounts(config, test::makeSnapshot(behind));
        EXPECT_EQ(in(hidden, Counter::ObjectsCulled), 1u);
        EXPECT_EQ(in(getCounts(config, test::makeSnapshot(ahead)), Counter::ObjectsCulled), 0u);
        EXPECT_GE(in(hidden, Counter::Pixels), 8u * 32 * 4);
        EXPECT_EQ(in(hidden, Counter::Rays), 0u);
    }
}

TEST(CountersTest, AMovingObjectOutOfViewIsCulledFromEachTile) {
    SonarConfig config = test::getSonar({.beams = 16, .width_deg = 60, .height_deg = 20, .rows = 64, .columns = 4});
    config.visibility = Visibility::Cpu;
    types::Snapshot scene =
        test::makeSnapshot(test::makeScene({test::wall(10), test::quad({0, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
    const auto culledAt = [&](double x) {
        glm::dmat4 place(1);
        place[3].x = x;
        scene.moved = {{1, place}};
        return in(getCounts(config, scene), Counter::ObjectsCulled);
    };
    EXPECT_EQ(culledAt(-20), 64u * 4 * 16 / 16);  // 16 rays in a tile, and none is padded
    EXPECT_EQ(culledAt(0.5), 0u);                 // so near that it fills the view
}

TEST(CountersTest, CountsDoNotDependOnTheNumberOfThreads) {
    Counts all{};
    test::forEachSonar(12, [&](const RandomSonar& drawn, Draw& draw) {
        for (const RandomSonar& one : {drawn, withPaths(drawn, draw)}) {
            const auto with = [&](int threads) {
                test::SonarBench bench(one, threads);
                bench.getPings(one.scene());
                return bench.counts();
            };
            const Counts alone = with(1);
            EXPECT_EQ(with(2), alone);
            EXPECT_EQ(with(5), alone);
            for (size_t i = 0; i < counter_count; ++i) all[i] += alone[i];
        }
    });
    for (const Counter what : {Counter::Rays, Counter::OnwardRays, Counter::OcclusionRays, Counter::Cells,
                               Counter::WallsPassed, Counter::MirrorPaths, Counter::Bins, Counter::Targets})
        EXPECT_GT(in(all, what), 0u) << counter_meanings[static_cast<size_t>(what)].name;
}

}  // namespace insonify::sonar
