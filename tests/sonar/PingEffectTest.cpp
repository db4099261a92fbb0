// An effect that follows the rays of pings gets every ray once and every cell once, for any number of parts and
// threads. What an effect does wrong is found by the checks at the seams.
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <random>

#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/bins/EchoField.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/Check.hpp"

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
        test::makeSnapshot(test::makeScene({test::ground(-3), test::sphere(1, 24)}, 0, {{}, {8, 0, -1}}));
    std::mt19937 random(7);
    const auto upTo = [&](int max) { return std::uniform_int_distribution(1, max)(random); };
    for (int i = 0; i < 30; ++i) {
        SonarConfig config = test::getSonar({.beams = upTo(20),
                                             .width_deg = 60,
                                             .height_deg = 40,
                                             .bins = 100,
                                             .rows = upTo(1500),
                                             .columns = upTo(7)});
        config.visibility = Visibility::Cpu;
        const types::Sonar plain = test::makePing(config, snapshot);
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

/** What an effect of a library may do wrong. */
enum class Wrong {
    NotANumber,    ///< In a bin of a ping.
    Negative,      ///< In a bin of a cell, by threads of the pool.
    FewerBins,     ///< In a ping.
    BinBeyond,     ///< Reports a bin behind the last.
    BeamBeyond,    ///< Adds an echo to a beam behind the last.
    NowhereEcho,   ///< Adds an echo at no range.
    CellBeyond,    ///< Adds energies to a cell behind the last.
    ThreadBeyond,  ///< Uses the buffer of a thread that does not exist.
    Throws,
};

class BreaksPings final : public PingEffect {
public:
    explicit BreaksPings(Wrong wrong) : wrong_(wrong) {}
    bool followsRays() const override { return wrong_ == Wrong::Negative; }
    bool addEnergies(const TracedPing&, size_t, std::span<float> bins) override {
        bins.back() = -1;
        return true;
    }
    void addEchoes(PingInMaking& made) override {
        if (wrong_ == Wrong::BinBeyond) made.report(made.ping.bins.size(), false);
        if (wrong_ == Wrong::BeamBeyond) made.field->add(made.ping.beam_count, 3, 1);
        if (wrong_ == Wrong::NowhereEcho) made.field->add(0, std::nan(""), 1);
        if (wrong_ == Wrong::CellBeyond) made.field->addEnergies(1 << 20, 0);
        if (wrong_ == Wrong::ThreadBeyond) made.field->energies(0, 2);
    }
    void addToBins(types::Sonar& ping) override {
        if (wrong_ == Wrong::NotANumber) ping.bins[7] = std::numeric_limits<float>::quiet_NaN();
        if (wrong_ == Wrong::FewerBins) ping.bins.pop_back();
        if (wrong_ == Wrong::Throws) throw std::runtime_error("out of order");
    }

private:
    Wrong wrong_;
};

struct BreakerEffect final : Effect {
    std::string key() const override { return "breaker"; }
    std::vector<types::Field> numbers() const override { return {{"wrong", "1", "what it does wrong", 0, 100}}; }
    bool plan(const types::Geometry&, RenderPlan& plan) const override {
        return plan.config.effects.contains("breaker");
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry&) const override {
        return std::make_unique<BreaksPings>(static_cast<Wrong>(plan.config.effects.at("breaker").at("wrong")));
    }
};

SonarConfig smallSonar(bool coherent) {
    SonarConfig config =
        test::getSonar({.beams = 4, .width_deg = 20, .height_deg = 20, .bins = 40, .rows = 40, .columns = 2});
    config.visibility = Visibility::Cpu;
    if (coherent) {
        config.frequency_khz = 500;
        config.speckle.emplace().coherent = true;
    }
    return config;
}

/** Returns what a ping of an effect that is wrong fails with. */
std::string failure(Wrong wrong, bool coherent) {
    addEffect(std::make_unique<BreakerEffect>());
    SonarConfig config = smallSonar(coherent);
    config.effects["breaker"]["wrong"] = static_cast<double>(wrong);
    const types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::wall(3)}));
    SonarRenderer renderer(config, snapshot.geometry, {.threads = 2});
    types::Sonar ping;
    return test::computeError<std::exception>([&] { renderer.render(snapshot, ping); });
}

TEST(SeamCheckTest, WhatAnEffectDoesWrongIsFoundAtTheSeam) {
    using testing::EndsWith;
    using testing::HasSubstr;
    EXPECT_THAT(failure(Wrong::NotANumber, false), EndsWith("effects.breaker: leaves a bin of nan; must be finite and "
                                                            "not negative"));
    EXPECT_THAT(failure(Wrong::Negative, false), HasSubstr("effects.breaker: leaves a bin of -1; "));
    EXPECT_EQ(failure(Wrong::Throws, false), "effects.breaker: out of order");
    EXPECT_THAT(failure(Wrong::FewerBins, false), AllOf(HasSubstr("SonarRenderer.cpp:"), EndsWith(": 159, 4, 40")));
    EXPECT_THAT(failure(Wrong::BinBeyond, false),
                AllOf(HasSubstr("Effects.cpp:"), EndsWith("bin < ping.bins.size() does not hold; bin, "
                                                          "ping.bins.size(): 160, 160")));
    EXPECT_THAT(failure(Wrong::BeamBeyond, true), AllOf(HasSubstr("EchoField.cpp:"), HasSubstr("; beam, ")));
    EXPECT_THAT(failure(Wrong::NowhereEcho, true), AllOf(HasSubstr("EchoField.cpp:"), EndsWith(": nan, 1, 0")));
    EXPECT_THAT(failure(Wrong::CellBeyond, true), AllOf(HasSubstr("EchoField.cpp:"), HasSubstr(": 1048576, ")));
    EXPECT_THAT(failure(Wrong::ThreadBeyond, true), AllOf(HasSubstr("EchoField.cpp:"), EndsWith(": 2, 2")));
}

TEST(SeamCheckTest, APoseThatIsNoneIsFoundWhateverDrawsTheScene) {
    for (const Visibility visibility : {Visibility::Cpu, Visibility::Gl})
        for (const bool turned : {true, false}) {
            SonarConfig config = smallSonar(false);
            config.visibility = visibility;
            types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::wall(3)}));
            SonarRenderer renderer(config, snapshot.geometry);
            (turned ? snapshot.sonar.orientation.x : snapshot.sonar.position.y) = std::nan("");
            types::Sonar ping;
            EXPECT_THAT(test::computeError<types::CheckFailure>([&] { renderer.render(snapshot, ping); }),
                        testing::EndsWith(turned ? ": nan" : ", nan, 0)"));
        }
}

TEST(SeamCheckTest, SumsThatOverflowAndSizesThatDifferAreFound) {
    const types::GeometryPtr scene = test::makeScene({test::wall(3)});
    const RenderPlan plan = makeRenderPlan(smallSonar(false), *scene);
    const EchoRules rules = makeEchoRules(plan, PingEffects(plan, *scene));
    const BinLevels levels(plan.config, plan.grid);
    const std::vector<uint64_t> sums(100), full(100, uint64_t{1} << 63);
    std::vector<float> bins(40), more(41);
    EXPECT_FALSE(levels.fill(rules, sums.data(), 0.01, bins));
    const auto failure = [&](const std::vector<uint64_t>& of, double angle, std::span<float> to) {
        return test::computeError<types::CheckFailure>([&] { levels.fill(rules, of.data(), angle, to); });
    };
    EXPECT_THAT(failure(sums, 0.01, more), testing::EndsWith(": 41, 40"));
    EXPECT_THAT(failure(sums, 0, bins), testing::EndsWith("solid_angle: 0"));
    EXPECT_THAT(failure(full, 0.01, bins), testing::EndsWith("any: 9223372036854775808"));
    TruthTable table(2, 40);
    types::SonarTruth truth;
    truth.object.resize(80);
    EXPECT_THAT(test::computeError<types::CheckFailure>([&] { table.report(2, 0, truth, {}); }),
                testing::EndsWith("beam, bins_, used_.size(): 2, 40, 80"));
    EXPECT_THAT(test::computeError<types::CheckFailure>([&] { table.report(1, 2, truth, {}); }),
                testing::EndsWith(": 2, 40, 80"));
    EXPECT_THAT(test::computeError<types::CheckFailure>([&] { table.merge(0, TruthTable(2, 41), 0); }),
                testing::EndsWith(": 41, 40"));
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
