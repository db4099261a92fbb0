#include <gtest/gtest.h>

#include "components/sonar/multipath/OtherSonars.hpp"
#include "types/samples/Transmission.hpp"

namespace insonify::sonar {
namespace {

/** A radiation for pulses that are never rendered. */
struct NoPower : types::Radiation {
    double towards(const glm::dvec3&) const override { return 0; }
};

types::TransmissionPtr pulseAt(double seconds) {
    static const auto radiation = std::make_shared<const NoPower>();
    auto sent = std::make_shared<types::Transmission>();
    sent->radiation = radiation;
    sent->time = types::Time::fromSeconds(seconds);
    return sent;
}

TEST(OthersReceivedTest, ASonarThatDoesNotPingKeepsFewPulses) {
    OthersReceived others;
    size_t most = 0;
    for (int i = 0; i < 200'000; ++i) {  // 100 Hz, for half an hour
        others.add(pulseAt(0.01 * i));
        most = std::max(most, others.size());
    }
    const double kept = OthersReceived::memory + OthersReceived::longest_ping;
    EXPECT_LE(static_cast<double>(most), 2 * 100 * kept + 200);
}

TEST(OthersReceivedTest, ALatePingGetsThePulsesOfItsTime) {
    OthersReceived others;
    for (int i = 0; i < 20'000; ++i) others.add(pulseAt(0.01 * i));  // to 200 s
    types::Snapshot scene;
    scene.time = types::Time::fromSeconds(100);
    others.give(scene, 20, 1500);
    ASSERT_FALSE(scene.transmissions.empty());
    for (const auto& sent : scene.transmissions) EXPECT_NEAR(sent->time.seconds(), 100, 20 * 2 / 1500.0 + 1e-9);
}

TEST(OthersReceivedTest, PulsesFromBeforeAClockWasSetBackAreForgotten) {
    OthersReceived others;
    for (int i = 0; i < 1000; ++i) others.add(pulseAt(1e6 + 0.01 * i));
    for (int i = 0; i < 3000; ++i) others.add(pulseAt(0.01 * i));
    EXPECT_LE(others.size(), 3000u);
    types::Snapshot scene;
    scene.time = types::Time::fromSeconds(30);
    others.give(scene, 20, 1500);
    EXPECT_LE(others.size(), 1001u);
}

}  // namespace
}  // namespace insonify::sonar
