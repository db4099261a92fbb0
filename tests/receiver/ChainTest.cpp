// Noise before the receiver grows with the gain; noise after the receiver is an error.
#include <gmock/gmock.h>

#include <cmath>

#include "components/framework/Deployment.hpp"
#include "components/noise/Noise.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/receiver/Receiver.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::receiver {
namespace {

constexpr double level_db = -90;  ///< Level of the noise of the sea.
constexpr uint32_t bins = 400;

ReceiverConfig amplifying() {
    ReceiverConfig config;
    config.tvg = TvgConfig{.log_coefficient = 50, .db_per_m = 0.21, .max_db = 60};
    return config;
}

noise::NoiseConfig sea() {
    noise::NoiseConfig config;
    config.speckle.emplace();
    config.ambient.emplace().level_db = level_db;
    return config;
}

/** Returns the max difference between the mean level of the noise in 20 adjacent bins of all beams, and the level of
 *  the sea plus the gain of these bins [dB]. */
double offTheLaw(const types::Sonar& ping) {
    double worst = 0;
    for (uint32_t from = 20; from + 20 <= bins; from += 20) {
        double relative = 0;
        for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
            for (uint32_t k = from; k < from + 20; ++k)
                relative += ping.bins[beam * bins + k] /
                            std::pow(10, tvgDb(*amplifying().tvg, ping.binStart(k + 0.5)) / 10) /
                            (20 * ping.beam_count);
        worst = std::max(worst, std::abs(10 * std::log10(relative) - level_db));
    }
    return worst;
}

TEST(ChainTest, NoiseGrowsWithTheGainAsTheGainDoes) {
    types::Sonar noisy, ping;
    noise::Noise(sea()).add(test::makePing(256, bins, 0), noisy);
    Receiver(amplifying()).receive(noisy, ping);
    EXPECT_LT(offTheLaw(ping), 0.3) << "of 5120 exponential variates a mean is off by 0.06 dB";
}

TEST(ChainTest, NoiseAfterTheGainDoesNotGrow) {
    types::Sonar amplified, ping;
    Receiver(amplifying()).receive(test::makePing(256, bins, 0), amplified);
    noise::Noise(sea()).add(amplified, ping);
    EXPECT_GT(offTheLaw(ping), 50);
}

TEST(ChainTest, AReceiverBeforeTheNoiseIsAnErrorOfTheDeployment) {
    framework::Registry registry;
    noise::registerTasks(registry);
    receiver::registerTasks(registry);
    const char* yaml = R"(
tasks:
  receiver: {type: receiver::ReceiverTask}
  noise: {type: noise::NoiseTask}
connections:
  - {from: receiver.ping, to: noise.clean}
)";
    EXPECT_THAT(
        test::refused([&] { framework::Deployment(framework::DeploymentSpec::parse(yaml, "a.yml"), registry); }),
        testing::Contains(testing::HasSubstr("a.yml:6:5: connections[0]: receiver.ping gives what a receiver has "
                                             "amplified, noise.clean takes intensities that reach a receiver")));
}

}  // namespace
}  // namespace insonify::receiver
