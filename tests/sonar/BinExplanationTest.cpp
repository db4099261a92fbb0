// What explainBin() says of bins, compared with the pings of random sonars and with closed forms.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "components/sonar/plan/Effect.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/renderer/BinExplanation.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/EveryRenderer.hpp"
#include "tests/support/RandomSonars.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Waiting.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using test::Draw;
using test::RandomSonar;
using testing::HasSubstr;
using types::radians;

double computeSum(const BinExplanation& explained) {
    return std::accumulate(explained.parts.begin(), explained.parts.end(), 0.0,
                           [](double sum, const BinPart& part) { return sum + part.intensity; });
}

const BinPart* getPart(const BinExplanation& explained, const std::string& name) {
    const auto found = std::ranges::find(explained.parts, name, &BinPart::name);
    return found == explained.parts.end() ? nullptr : &*found;
}

/** The strongest bin of a ping, a drawn one with an echo, and any. */
std::vector<size_t> someBins(const types::Sonar& ping, Draw& draw) {
    std::vector<size_t> with_echo;
    for (size_t at = 0; at < ping.bins.size(); ++at)
        if (ping.bins[at] > 0) with_echo.push_back(at);
    std::vector<size_t> bins{static_cast<size_t>(std::ranges::max_element(ping.bins) - ping.bins.begin()),
                             static_cast<size_t>(draw.upTo(static_cast<int>(ping.bins.size())))};
    if (!with_echo.empty())
        bins.push_back(with_echo[static_cast<size_t>(draw.upTo(static_cast<int>(with_echo.size())))]);
    return bins;
}

void expectSum(const PingTask& task, const types::Sonar& ping, size_t at, bool is_coherent) {
    const PingTask::RenderedBeam beam = task.renderedBeam(at / ping.bin_count);
    const BinExplanation explained = explainBin(beam.config, beam.scene, beam.beam, at % ping.bin_count);
    SCOPED_TRACE(fmt::format("beam {}, bin {}\n{}", at / ping.bin_count, at % ping.bin_count, text(explained)));
    EXPECT_EQ(explained.is_mean, is_coherent);
    EXPECT_NEAR(explained.intensity, ping.bins[at], is_coherent ? 1e30 : 1e-5 * ping.bins[at]);
    EXPECT_NEAR(computeSum(explained), explained.intensity, 1e-4 * explained.intensity);
    const bool has_surface = std::ranges::any_of(
        explained.parts, [](const BinPart& part) { return part.of_surface && part.of_surface->is_in_beam; });
    EXPECT_NE(has_surface, !explained.why_no_surface.empty());
    for (const BinPart& part : explained.parts) {
        EXPECT_NE(part.name, "");
        if (!part.of_surface) continue;
        double shares = 0;
        for (const auto& [triangle, share] : part.of_surface->triangles) shares += share;
        EXPECT_NEAR(shares, part.of_surface->triangles.empty() ? 0 : 1, 1e-9);
    }
}

TEST(BinExplanationTest, ThePartsOfABinSumUpToItForEverySonar) {
    test::forEachSonar(18, [](const RandomSonar& drawn, Draw& draw) {
        for (const RandomSonar& one : {drawn, withPaths(drawn, draw)}) {
            test::SonarBench bench(one);
            const types::Sonar ping = bench.getPings(one.scene()).back();
            for (const size_t at : someBins(ping, draw)) expectSum(bench.task(), ping, at, one.is_coherent);
        }
    });
}

std::string getExplanation(PingTask& task, double bearing_deg, double range) {
    std::string found;
    EXPECT_TRUE(test::becomesTrue([&] { return !(found = task.explain(bearing_deg, range)).empty(); }));
    return found;
}

TEST(BinExplanationTest, ARunningSonarExplainsItsLastPingWhileItGoesOn) {
    test::forEachSonar(12, [](const RandomSonar& one, Draw& draw) {
        test::SonarBench bench(one);
        PingTask& task = bench.task();
        EXPECT_THROW(task.explain(0, 5), std::runtime_error) << "before the first ping";
        const types::Sonar ping = bench.getPings(one.scene()).back();
        for (const size_t at : someBins(ping, draw)) {
            const size_t beam = at / ping.bin_count, bin = at % ping.bin_count;
            const double bearing = ping.bearings[beam].deg(),
                         range = (static_cast<double>(bin) + 0.5) * ping.binWidth();
            const PingTask::RenderedBeam rendered = task.renderedBeam(beam);
            EXPECT_EQ(task.explain(bearing, range), "") << "it has just begun";
            EXPECT_EQ(task.explain(bearing, range / 2), "") << "another place waits";
            EXPECT_THAT(getExplanation(task, bearing, range),
                        testing::AllOf(
                            testing::StartsWith("ping at "), HasSubstr(fmt::format(" bin {} at ", bin)),
                            testing::EndsWith(text(explainBin(rendered.config, rendered.scene, rendered.beam, bin)))));
            EXPECT_THAT(getExplanation(task, bearing, range / 2), testing::StartsWith("ping at "));
        }
        EXPECT_EQ(task.explain(ping.bearings[0].deg(), 1), "");
        bench.getPings(one.scene());  // meanwhile
        for (const double wrong : {-1.0, 1e6, std::nan("")})
            EXPECT_THROW(getExplanation(task, ping.bearings[0].deg(), wrong), std::runtime_error) << wrong;
    });
}

TEST(BinExplanationTest, ASonarHasNoBinBesideItsFan) {
    RandomSonar one = test::randomSonar(6);  // a fan of at most 140 deg
    test::SonarBench bench(one);
    bench.getPings(one.scene());
    EXPECT_THROW(bench.task().explain(180, 5), std::runtime_error);
    EXPECT_THROW(bench.task().explain(std::nan(""), 5), std::runtime_error);
}

/** 16 beams of 5 deg, 200 bins of 0.1 m, 60 deg high. */
SonarConfig explainedFan() {
    return test::getSonar({.beams = 16, .width_deg = 80, .height_deg = 60, .bins = 200, .rows = 512, .columns = 4});
}

/** Ground 3 m below the sonar, and on it a plate, 5 m ahead and 2 m high. */
types::Snapshot plateOnGround() {
    auto scene = std::make_shared<types::Geometry>(
        *test::makeScene({test::ground(-3), test::quad({5, -20, -3}, {0, 40, 0}, {0, 0, 2})}, -12));
    scene->materials[0].name = "gravel";
    types::Material steel = scene->materials[0];
    steel.name = "steel";
    steel.lambert_db = -7;
    scene->materials.push_back(steel);
    scene->meshes[1].clusters[0].material = 1;
    scene->objects[0].name = "floor";
    scene->objects[1].name = "plate";
    return test::makeSnapshot(scene);
}

class BinExplanationOfAPlate : public testing::TestWithParam<int> {
protected:
    BinExplanation at(double range, size_t beam = 8) const {
        return explainBin(config, plateOnGround(), beam, static_cast<size_t>(range / 0.1));
    }
    SonarConfig config = test::everyRenderer(explainedFan())[static_cast<size_t>(GetParam())];
};

/** At slant range r the plate is seen at the elevation -acos(5 / r). Its diagonal is there at z = -2, at 5.39 m. */
TEST_P(BinExplanationOfAPlate, NamesTheTriangleTheMaterialAndTheLaw) {
    for (const auto& [range, triangle] : {std::pair(5.25, 1u), std::pair(5.55, 0u)}) {
        const BinExplanation explained = at(range);
        ASSERT_EQ(explained.parts.size(), 1u) << text(explained);
        EXPECT_EQ(explained.parts[0].name, "plate");
        const SurfaceEcho& echo = explained.parts[0].of_surface.value();
        EXPECT_EQ(echo.path, "direct");
        EXPECT_EQ(echo.material, "steel");
        EXPECT_EQ(echo.law, "Lambert's law, -7.0 dB");
        ASSERT_FALSE(echo.triangles.empty());
        EXPECT_EQ(echo.triangles[0].first, triangle);
        EXPECT_GT(echo.triangles[0].second, 0.9);
        const double grazing = std::asin(5 / range * std::cos(radians(2.5)));
        EXPECT_NEAR(echo.grazing, grazing, 0.02);
        EXPECT_NEAR(echo.elevation, -std::acos(5 / (range * std::cos(radians(2.5)))), 0.03);
        EXPECT_NEAR(echo.strength_db, -7 + 20 * std::log10(std::sin(grazing)), 0.1);
        EXPECT_EQ(explained.why_no_surface, "");
    }
}

/** The ground appears again behind the shadow, at 15.3 m. */
TEST_P(BinExplanationOfAPlate, SaysWhyABinIsEmpty) {
    EXPECT_EQ(at(3.05).why_no_surface, "it is before the first surface of the beam, plate at 5.05 m");
    EXPECT_THAT(at(10.05).why_no_surface, testing::MatchesRegex("it is between the echoes of plate at 5\\..* m and of "
                                                                "floor at 15\\..* m: in a shadow, or in open water"));
    EXPECT_EQ(at(17.05).parts.at(0).name, "floor");
    EXPECT_EQ(at(17.05).parts.at(0).of_surface->material, "gravel");
    config.range_min = 4;
    EXPECT_EQ(at(3.05).why_no_surface, "it is nearer than range_min, 4.000 m");
}

TEST_P(BinExplanationOfAPlate, NamesADeadBeam) {
    config.imperfections.emplace().dead_beams = {8};
    EXPECT_EQ(at(5.25).why_no_surface, "the beam is dead");
    EXPECT_TRUE(at(5.25).parts.empty());
    EXPECT_EQ(at(5.25, 7).parts.at(0).name, "plate");
}

TEST_P(BinExplanationOfAPlate, NamesWhatIsNoSurface) {
    config.volume = {{{}, {}, -60}};
    config.pulse.emplace().bandwidth_khz = 20;
    config.pulse->ring_down.emplace();
    config.pulse->ring_down->level_db = -20;
    config.pulse->ring_down->decay_db_per_m = 40;
    const BinExplanation near = at(0.25), middle = at(3.05), plate = at(5.25);
    ASSERT_NE(getPart(near, "transmit ring-down"), nullptr) << text(near);
    EXPECT_EQ(near.parts[0].name, "transmit ring-down");
    EXPECT_EQ(getPart(middle, "transmit ring-down"), nullptr) << text(middle);
    EXPECT_THAT(middle.parts[0].name, HasSubstr("reverberation"));
    EXPECT_THAT(middle.why_no_surface, HasSubstr("before the first surface"));
    EXPECT_EQ(plate.parts.at(0).name, "plate");
    EXPECT_NEAR(computeSum(plate), plate.intensity, 1e-5 * plate.intensity);
}

/** A beam with a pattern receives the plate through its sidelobes as well. */
TEST_P(BinExplanationOfAPlate, SaysThatAnEchoCameThroughSidelobes) {
    acoustics::BeamLaw law;
    law.width_deg = 3;
    config.beam_pattern.emplace().receive.azimuth = law;
    auto scene = std::make_shared<types::Geometry>(*test::makeScene({test::sphere(0.3f, 16)}, 0, {{6, 3, 0}}));
    const BinExplanation explained = explainBin(config, test::makeSnapshot(scene), 3, 66);  // the sphere is at 26.6 deg
    ASSERT_EQ(explained.parts.size(), 1u) << text(explained);
    const SurfaceEcho& echo = explained.parts[0].of_surface.value();
    EXPECT_FALSE(echo.is_in_beam);
    EXPECT_NEAR(types::degrees(echo.bearing), 26.6, 3);
    EXPECT_NEAR(echo.range, 6.5, 0.3);
    EXPECT_THAT(text(explained), HasSubstr("through a sidelobe; its strongest echo is at 2"));
}

/** Beams that are eight times as wide as their spacing: an echo in the main lobe came through no sidelobe. */
TEST_P(BinExplanationOfAPlate, AnEchoInTheMainLobeCameThroughNoSidelobe) {
    acoustics::BeamLaw law;
    law.width_deg = 8 * config.fieldOfViewDeg() / config.beam_count;
    config.beam_pattern.emplace().receive.azimuth = law;
    for (size_t beam = 7; beam < 10; ++beam) {
        const BinExplanation explained = at(5.25, beam);
        ASSERT_FALSE(explained.parts.empty()) << beam;
        EXPECT_TRUE(explained.parts[0].of_surface->is_in_beam) << text(explained);
        EXPECT_EQ(explained.why_no_surface, "");
    }
}

TEST_P(BinExplanationOfAPlate, RefusesABeamOrABinThatIsNotThere) {
    EXPECT_THROW(at(5.25, 16), std::out_of_range);
    EXPECT_THROW(at(20.05), std::out_of_range);
}

std::string nameRenderer(const testing::TestParamInfo<int>& info) {
    return std::vector{"Rays", "Drawn", "DrawnAndDepositedOnTheDevice"}[static_cast<size_t>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Ways, BinExplanationOfAPlate, testing::Range(0, 3), nameRenderer);

/** The image of a plate in the water surface: out directly and back by it, in a bin behind the plate's own. */
TEST(BinExplanationTest, NamesTheKindOfPath) {
    SonarConfig config = explainedFan();
    config.visibility = Visibility::Cpu;
    config.multipath.emplace().surface.emplace().wind_m_s = 0;
    types::Snapshot scene = test::makeSnapshot(test::makeScene({test::quad({10, -2, -1}, {0, 4, 0}, {0, 0, 1})}));
    scene.water_surface = 2;
    std::set<std::string> paths;
    for (size_t bin = 95; bin < 125; ++bin)
        for (const BinPart& part : explainBin(config, scene, 8, bin).parts)
            if (part.of_surface) paths.insert(part.of_surface->path);
    EXPECT_THAT(paths, testing::UnorderedElementsAre("direct", "one way by the water surface",
                                                     "both ways by the water surface"));
}

TEST(BinExplanationTest, NamesAWallThatSoundHasPassed) {
    auto geometry = std::make_shared<types::Geometry>(*test::makeScene({test::wall(5), test::wall(8)}));
    geometry->materials.push_back(geometry->materials[0]);
    geometry->materials[1].shell = {.thickness = 0.002, .density = 1100, .sound_speed = 1700};
    geometry->meshes[0].clusters[0].material = 1;
    SonarConfig config = explainedFan();
    config.visibility = Visibility::Cpu;
    config.frequency_khz = 100;
    const BinExplanation explained = explainBin(config, test::makeSnapshot(geometry), 8, 80);
    ASSERT_FALSE(explained.parts.empty());
    EXPECT_EQ(explained.parts[0].name, "object_1");
    EXPECT_EQ(explained.parts[0].of_surface->path, "through a wall");
}

/** Nothing is selected in a ping without a selection: truth or not, its bits are the same. */
TEST(BinExplanationTest, ExplainingChangesNoPing) {
    SonarConfig config = explainedFan();
    config.visibility = Visibility::Cpu;
    SonarRenderer renderer(config, plateOnGround().geometry);
    types::Sonar before, after;
    renderer.render(plateOnGround(), before);
    explainBin(config, plateOnGround(), 8, 52);
    renderer.render(plateOnGround(), after);
    EXPECT_EQ(before.bins, after.bins);
}

/** Adds a number that grows from ping to ping. */
struct GrowingEffect final : Effect {
    struct Growing final : PingEffect {
        void addToBins(types::Sonar& ping) override {
            for (float& bin : ping.bins) bin += static_cast<float>(pings);
            ++pings;
        }
        int pings = 0;
    };
    std::string key() const override { return "growing"; }
    bool plan(const types::Geometry&, RenderPlan& plan) const override {
        return plan.config.effects.contains("growing");
    }
    std::unique_ptr<PingEffect> make(const RenderPlan&, const types::Geometry&) const override {
        return std::make_unique<Growing>();
    }
};

TEST(BinExplanationTest, APingThatDependsOnEarlierOnesHasNoParts) {
    addEffect(std::make_unique<GrowingEffect>());
    const types::Snapshot scene = test::makeSnapshot(test::makeScene({test::wall(3)}));
    SonarConfig config =
        test::getSonar({.beams = 4, .width_deg = 20, .height_deg = 20, .bins = 40, .rows = 40, .columns = 2});
    config.visibility = Visibility::Cpu;
    EXPECT_FALSE(explainBin(config, scene, 1, 15).depends_on_past);
    config.effects["growing"];
    const BinExplanation explained = explainBin(config, scene, 1, 15);
    EXPECT_TRUE(explained.depends_on_past);
    EXPECT_TRUE(explained.parts.empty());
    EXPECT_THAT(text(explained), testing::HasSubstr("an effect remembers earlier pings"));
}

}  // namespace
}  // namespace insonify::sonar
