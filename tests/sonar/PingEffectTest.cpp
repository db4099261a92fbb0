// An effect that follows the rays of pings gets every ray once and every cell once, for any number of parts and
// threads.
#include <gmock/gmock.h>

#include <atomic>
#include <random>

#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {
namespace {

constexpr float added = 1e3f;  ///< Intensity that the effect adds to each bin of a cell.

/** Counts of the last ping. */
struct Seen {
    std::vector<std::atomic<int>> rays, cells;
    int truths = 0;
    bool truth_began = false;
} seen;

class Follower final : public PingEffect {
public:
    Follower(const RenderPlan& plan, bool hides) : plan_(plan), hides_(hides) {}
    void begin(const PingStart& start) override {
        const size_t columns = plan_.cells.size() * static_cast<size_t>(plan_.config.columnsPerBeam());
        seen.rays = std::vector<std::atomic<int>>(columns * static_cast<size_t>(plan_.config.rows()));
        seen.cells = std::vector<std::atomic<int>>(plan_.cells.size());
        seen.truths = 0;
        seen.truth_began = start.truth;
    }
    bool followsRays() const override { return true; }
    void followRays(const TracedPing& ping, std::span<const TracedTile> tiles) override {
        for (const TracedTile& tile : tiles)
            for (int i = 0; i < tile_samples; ++i) {
                const TileShape::Extent at = ping.view.shape.at[i];
                const int column = tile.first_column + at.columns, row = tile.first_row + at.rows;
                if (column >= tile.end_column || row >= ping.view.cells.rows) continue;
                ++seen.rays.at(static_cast<size_t>(column * ping.view.cells.rows + row));
                if (hides_) tile.hits->command[i] = TileHits::nothing;
            }
    }
    bool addEnergies(const TracedPing&, size_t cell, std::span<float> bins) override {
        ++seen.cells.at(cell);
        for (float& bin : bins) bin += added;
        return true;
    }
    void addToTruth(const TracedPing&, types::SonarTruth&) override { ++seen.truths; }

private:
    const RenderPlan& plan_;
    bool hides_;
};

struct FollowerEffect final : Effect {
    std::string key() const override { return "follower"; }
    std::vector<types::Field> numbers() const override {
        return {{"hides", "1", "1: takes away what rays have met", 0, 1}};
    }
    bool plan(const types::Geometry&, RenderPlan& plan) const override {
        return plan.config.effects.contains("follower");
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry&) const override {
        return std::make_unique<Follower>(plan, plan.config.effects.at("follower").at("hides") > 0);
    }
};

TEST(PingEffectTest, RaysAndCellsAreVisitedOnceInEveryPing) {
    addEffect(std::make_unique<FollowerEffect>());
    const types::Snapshot snapshot =
        test::snapshotOf(test::sceneOf({test::ground(-3), test::sphere(1, 24)}, 0, {{}, {8, 0, -1}}));
    std::mt19937 random(7);
    const auto upTo = [&](int max) { return std::uniform_int_distribution(1, max)(random); };
    for (int i = 0; i < 30; ++i) {
        SonarConfig config = test::sonarOf({.beams = upTo(20),
                                            .width_deg = 60,
                                            .height_deg = 40,
                                            .bins = 100,
                                            .rows = upTo(1500),
                                            .columns = upTo(7)});
        config.visibility = Visibility::Cpu;
        const types::Sonar plain = test::pingOf(config, snapshot);
        const bool hides = i % 2, records = i % 3 == 0;
        config.effects["follower"]["hides"] = hides;
        SonarRenderer renderer(config, snapshot.geometry, {.threads = upTo(4)});
        types::Sonar ping;
        types::SonarTruth truth;
        if (records) renderer.setTruth(ping, &truth);
        renderer.render(snapshot, ping);
        EXPECT_THAT(seen.rays, testing::Each(testing::Eq(1))) << i;
        EXPECT_THAT(seen.cells, testing::Each(testing::Eq(1))) << i;
        EXPECT_EQ(seen.truths, records) << i;
        EXPECT_EQ(seen.truth_began, records) << i;
        EXPECT_TRUE(renderer.hasEchoes());
        for (size_t k = 0; k < ping.bins.size(); ++k)
            ASSERT_EQ(ping.bins[k], hides ? added : plain.bins[k] + added) << i << ", bin " << k;
    }
}

/** An effect that does nothing, with its own key. */
struct NamedEffect : Effect {
    explicit NamedEffect(std::string name) : name(std::move(name)) {}
    std::string key() const override { return name; }
    bool plan(const types::Geometry&, RenderPlan&) const override { return false; }
    std::string name;
};

TEST(PingEffectTest, EffectsAreAddedWhileOthersUseTheList) {
    std::atomic<bool> ended{false};
    std::thread reader([&] {
        while (!ended)
            for (const Effect* effect : effects()) EXPECT_NE(effect, nullptr);
    });
    const size_t before = effects().size();
    for (int i = 0; i < 100; ++i) addEffect(std::make_unique<NamedEffect>("named_" + std::to_string(i % 50)));
    ended = true;
    reader.join();
    EXPECT_EQ(effects().size(), before + 50) << "each key once";
}

}  // namespace
}  // namespace insonify::sonar
