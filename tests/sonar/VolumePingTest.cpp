// Pings in water that scatters sound back, compared with closed forms (ACOUSTICS.md 3.9). Each form has a deliberately
// wrong variant, which must fail by the same measure.
#include <gmock/gmock.h>

#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "tests/support/ClosedForms.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using test::everyRenderer;
using test::expectForm;
using test::makePing;
using types::radians;

constexpr double half = radians(20), strength = 1e-7;

VolumeLayer layer(double strength_db, std::optional<double> top = {}, std::optional<double> bottom = {}) {
    return {top, bottom, strength_db};
}

SonarConfig clearSonar() {
    SonarConfig config =
        test::getSonar({.beams = 8, .width_deg = 80, .height_deg = 40, .bins = 300, .rows = 512, .columns = 4});
    config.range_min = 1;
    return config;
}

SonarConfig sonarIn(std::vector<VolumeLayer> volume) {
    SonarConfig config = clearSonar();
    config.volume = std::move(volume);
    return config;
}

/** Intensity of a beam: the water's strength times the solid angle of the beam at a range, over the range squared. */
test::Form getWater(const std::function<double(double)>& solid_angle) {
    return test::between(1, 1e9, [=](double near, double far) {
        return test::integral(near, far, [=](double r) { return strength * solid_angle(r) / (r * r); });
    });
}

/** Ground without an echo that hides the water. */
types::Snapshot overSilentGround(double height) {
    return test::makeSnapshot(test::makeScene({test::ground(static_cast<float>(-height))}, -200));
}

TEST(VolumePingTest, ABottomHidesTheWaterBelowIt) {
    const double height = 3, delta = radians(10);
    const auto right =
        getWater([=](double r) { return delta * (std::sin(half) + std::min(std::sin(half), height / r)); });
    const auto open = getWater([=](double) { return 2 * delta * std::sin(half); });
    for (const SonarConfig& way : everyRenderer(sonarIn({layer(-70)})))
        expectForm(makePing(way, overSilentGround(height)), right, open);
}

TEST(VolumePingTest, OpenWaterEchoesByThePatternInElevation) {
    SonarConfig config = sonarIn({layer(-70)});
    acoustics::BeamLaw law;
    law.weighting = acoustics::Weighting::Gaussian;
    law.width_deg = 10;
    config.beam_pattern.emplace().transmit.elevation = law;
    const acoustics::BeamPattern pattern(law);
    const double received =
        test::integral(-1.5, 1.5, [&](double angle) { return pattern.power(angle) * std::cos(angle); });
    const auto right = getWater([=](double) { return radians(10) * received; });
    const auto box = getWater([=](double) { return 2 * radians(10) * std::sin(half); });
    const auto far = test::makeSnapshot(test::makeScene({test::wall(90)}));
    for (const SonarConfig& way : everyRenderer(config)) expectForm(makePing(way, far), right, box);
}

TEST(VolumePingTest, ALayerEchoesAtItsRanges) {
    // Between 1 and 2 m below a level sonar that is 4 m below the surface, over ground at 3 m below it.
    const double delta = radians(10), top = 1, bottom = 2;
    auto snapshot = overSilentGround(3);
    snapshot.water_surface = 4;
    const auto right =
        getWater([=](double r) { return delta * std::max(0.0, std::min(bottom / r, std::sin(half)) - top / r); });
    const auto deeper =
        getWater([=](double r) { return delta * std::max(0.0, std::min(bottom / r, std::sin(half)) - 1.2 * top / r); });
    SonarConfig config = sonarIn({layer(-70, 5, 6), layer(-200, 6, 7)});
    config.quality.rows = 1024;
    for (const SonarConfig& way : everyRenderer(config)) expectForm(makePing(way, snapshot), right, deeper);
}

TEST(VolumePingTest, LayersThatTogetherCoverAllDepthsEqualOneLayer) {
    const auto snapshot = overSilentGround(3);
    for (const SonarConfig& way : everyRenderer(sonarIn({layer(-70)}))) {
        SonarConfig split = way;
        split.volume = {layer(-70, {}, 1), layer(-70, 1, {})};
        const types::Sonar whole = makePing(way, snapshot), both = makePing(split, snapshot);
        const test::Deviation off = test::deviation(both, test::getForm(whole));
        EXPECT_LT(off.worst_db, 0.1) << off;
    }
}

TEST(VolumePingTest, ObjectsNearerThanTheBlankingHideTheWaterBehind) {
    const auto plate = test::makeSnapshot(test::makeScene({test::wall(0.5)}));
    for (const SonarConfig& way : everyRenderer(sonarIn({layer(-70)})))
        EXPECT_THAT(makePing(way, plate).bins, testing::Each(testing::Lt(1e-14f)));
}

TEST(VolumePingTest, WaterFarBeyondTheSceneEchoesWithNothingInView) {
    const auto behind = test::makeSnapshot(test::makeScene({test::wall(-5)}));
    const auto right = getWater([=](double) { return 2 * radians(10) * std::sin(half); });
    for (const SonarConfig& way : everyRenderer(sonarIn({layer(-70)})))
        expectForm(makePing(way, behind), right, test::times(1.02, right));
    for (const SonarConfig& way : everyRenderer(sonarIn({layer(-70, -1000, 1000)})))
        expectForm(makePing(way, behind), right, test::times(1.02, right));
}

TEST(VolumePingTest, WaterWithoutScatteringChangesNoBin) {
    const auto snapshot = test::makeSnapshot(test::makeScene({test::ground(-3)}));
    for (const SonarConfig& way : everyRenderer(clearSonar())) {
        SonarConfig silent = way, layered = way;
        silent.volume = {layer(-200)};
        layered.volume = {layer(-200, 0, 10)};
        EXPECT_EQ(makePing(silent, snapshot).bins, makePing(way, snapshot).bins);
        EXPECT_EQ(makePing(layered, snapshot).bins, makePing(way, snapshot).bins);
    }
}

/** Returns the sums of all beams, after tiles without any hit are deposited for the first `beams` beams. */
std::vector<uint64_t> sumsOfMisses(const RenderPlan& plan, const types::Geometry& geometry, int beams) {
    const PingEffects effects(plan, geometry);
    const EchoRules rules = makeEchoRules(plan, effects);
    TracedView view{makeAngularView(plan), {}};
    view.shape = TileShape(view.cells, rules.bins, beams);
    TileHits misses{};
    std::ranges::fill(misses.command, TileHits::nothing);
    std::vector<TracedTile> tiles;
    const int end = beams * view.cells.beam_columns;
    for (int column = 0; column < end; column += view.shape.all.columns)
        for (int row = 0; row < view.cells.rows; row += view.shape.all.rows)
            tiles.push_back({column, row, end, &misses});
    std::vector<uint64_t> sums(plan.cells.size() * rules.sumCount());
    const NormalMapping normal_maps(geometry);
    depositTiles(rules, view, {{}, {}, {}, normal_maps, waterView({})}, tiles, {0, sums.data()});
    return sums;
}

TEST(VolumePingTest, LayersAddNothingToBeamsBeyondTheTiles) {
    const types::GeometryPtr geometry = test::openWater();
    for (int columns = 1; columns <= 7; ++columns)
        for (int beams = 1; beams <= 3; ++beams) {
            SonarConfig config = sonarIn({layer(-70, {}, 3), layer(-60, 3)});
            config.quality.columns_per_beam = columns;
            const auto sums = sumsOfMisses(makeRenderPlan(config, *geometry), *geometry, beams);
            const size_t of_beam = sums.size() / static_cast<size_t>(config.beam_count);
            for (size_t beam = 0; beam < static_cast<size_t>(config.beam_count); ++beam) {
                const auto own = std::span(sums).subspan(beam * of_beam, of_beam);
                EXPECT_EQ(std::ranges::any_of(own, [](uint64_t sum) { return sum != 0; }),
                          beam < static_cast<size_t>(beams))
                    << columns << " columns, beam " << beam << " of " << beams;
            }
        }
}

}  // namespace
}  // namespace insonify::sonar
