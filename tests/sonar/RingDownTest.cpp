// The transmitter in the first bins (ACOUSTICS.md 5.15).
#include <gmock/gmock.h>

#include <numbers>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {
namespace {

SonarConfig ringingSonar() {
    SonarConfig config = test::getSonar({.beams = 4, .bins = 200, .rows = 32});
    config.visibility = Visibility::Cpu;
    config.pulse.emplace().bandwidth_khz = 4;
    return config;
}

types::Sonar ringingPing(const SonarConfig& config, const types::GeometryPtr& geometry) {
    return test::makePing(config, test::makeSnapshot(geometry));
}

TEST(RingDownTest, EveryBeamHasTheMeanOfItsDecayOverEachBin) {
    SonarConfig config = ringingSonar();
    config.pulse->ring_down = acoustics::RingDownConfig{-30, 12};
    const types::Sonar ping = ringingPing(config, test::openWater());
    const auto at = [](double r) { return std::pow(10, (-30 - 12 * r) / 10); };
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        for (size_t k = 0; k < ping.bin_count; ++k) {
            const double r = 0.1 * static_cast<double>(k), rate = 1.2 * std::numbers::ln10;
            const double right = (at(r) - at(r + 0.1)) / rate / 0.1, middle = at(r + 0.05);
            const float received = ping.bins[beam * ping.bin_count + k];
            EXPECT_NEAR(received, right, 1e-6 * right) << k;
            EXPECT_GT(std::abs(received - middle), 1e-3 * middle) << "the level of the bin's middle differs";
        }
}

TEST(RingDownTest, IsAddedToTheEchoesAndIsNoEcho) {
    const auto geometry = test::makeScene({test::wall(10)});
    const types::Sonar plain = ringingPing(ringingSonar(), geometry);
    SonarConfig config = ringingSonar();
    config.pulse->ring_down = acoustics::RingDownConfig{-3000, 25};
    EXPECT_EQ(ringingPing(config, geometry).bins, plain.bins) << "of nothing";
    config.pulse->ring_down->level_db = 0;
    const types::Sonar received = ringingPing(config, geometry);
    EXPECT_GT(received.bins[0], 0.7f);
    EXPECT_NEAR(received.bins[100], plain.bins[100], 1e-6f * plain.bins[100]);
    const auto behind = test::makeScene({test::wall(-10)});
    SonarRenderer deaf(config, behind);
    types::Sonar ping;
    deaf.render(test::makeSnapshot(behind), ping);
    EXPECT_FALSE(deaf.hasEchoes());
}

TEST(RingDownTest, ThePlanStatesWhetherItIsAdded) {
    const auto geometry = test::makeScene({test::wall(10)});
    SonarConfig config = ringingSonar();
    EXPECT_EQ(makeRenderPlan(config, *geometry).findOmitted("transmit ring-down")->reason, Reason::NotConfigured);
    config.pulse->ring_down = acoustics::RingDownConfig{0, 25};
    EXPECT_TRUE(makeRenderPlan(config, *geometry).has(Pass::RingDown));
    EXPECT_FALSE(makeRenderPlan(config, *geometry).findOmitted("transmit ring-down"));
}

}  // namespace
}  // namespace insonify::sonar
