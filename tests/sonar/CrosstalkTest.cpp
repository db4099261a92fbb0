// The pulses of other sonars compared with the one-way sonar equation, and their echoes compared with an integral over
// the sea floor, both computed independently here (ACOUSTICS.md 5.29).
#include <gmock/gmock.h>

#include <complex>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <numeric>
#include <random>

#include "components/acoustics/BeamPattern.hpp"
#include "components/acoustics/Pulse.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/multipath/OtherSonars.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;
using test::makePing;
using test::openWater;

/** Power that is sent in each direction. */
class Beacon final : public types::Radiation {
public:
    explicit Beacon(std::function<double(const glm::dvec3&)> power) : power_(std::move(power)) {}
    double towards(const glm::dvec3& direction) const override { return power_(direction); }

private:
    std::function<double(const glm::dvec3&)> power_;
};

types::TransmissionPtr sentFrom(
    glm::dvec3 place, double delay_s, std::function<double(const glm::dvec3&)> power = [](auto&) { return 1.0; }) {
    auto sent = std::make_shared<types::Transmission>();
    sent->time = types::Time{1'000'000 + static_cast<int64_t>(std::llround(delay_s * 1e6))};
    sent->sonar.position = place;
    sent->radiation = std::make_shared<Beacon>(std::move(power));
    return sent;
}

SonarConfig receiving(SonarConfig config, bool echoes = false) {
    config.visibility = Visibility::Cpu;
    config.crosstalk.emplace().echoes = echoes;
    return config;
}

acoustics::BeamLaw getLaw(double width_deg) {
    acoustics::BeamLaw law;
    law.width_deg = width_deg;
    return law;
}

double decibels(double ratio) { return 10 * std::log10(ratio); }

types::Snapshot openWaterWith(types::TransmissionPtr sent) {
    types::Snapshot snapshot = test::makeSnapshot(openWater());
    snapshot.transmissions = {std::move(sent)};
    return snapshot;
}

/** A patterned sonar with a random fan: regular or a table of bearings in any order, planar or conical. */
SonarConfig randomFan(std::mt19937& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    SonarConfig config =
        receiving(test::getSonar({.beams = 16, .width_deg = 90, .height_deg = 30, .bins = 400, .rows = 8}));
    if (between(0, 1) < 0.5) {
        config.field_of_view_deg.reset();
        config.beam_width_deg = 5;
        for (int i = 0; i < 16; ++i) config.bearings_deg.push_back(-45 + 6 * i + between(-2, 2));
        std::ranges::shuffle(config.bearings_deg, random);
    }
    if (between(0, 1) < 0.5) config.beam_geometry = BeamGeometry::Conical;
    config.absorption.emplace().db_per_m = between(0, 0.3);
    config.crosstalk->source_level_db = between(180, 220);
    config.beam_pattern.emplace();
    config.beam_pattern->receive.azimuth = getLaw(between(3, 12));
    config.beam_pattern->transmit.elevation = getLaw(between(10, 30));
    return config;
}

/** Random fans, places, delays, levels, absorption and patterns: every beam that receives a pulse has it in the right
 *  bin, at the level of the one-way sonar equation. */
TEST(CrosstalkTest, ADirectPulseFollowsTheOneWaySonarEquation) {
    std::mt19937 random(5);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    int received = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const SonarConfig config = randomFan(random);
        const double azimuth = between(-0.7, 0.7), elevation = between(-0.2, 0.2), distance = between(3, 60);
        const glm::dvec3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                   std::sin(elevation));
        const double delay = between(-0.5, 0.5) * distance / 1000;
        auto sent = std::make_shared<types::Transmission>(*sentFrom(distance * direction, delay, [&](const auto& to) {
            EXPECT_NEAR(glm::distance(to, -direction), 0, 1e-9);
            return 0.25;
        }));
        sent->source_level_db = between(180, 220);
        const auto ping = makePing(config, openWaterWith(sent));
        const double range = 500 * (sent->time - types::Time{1'000'000}).seconds() + distance / 2;
        const auto bin = static_cast<size_t>(range / 0.1);
        const acoustics::BeamPattern receive(*config.beam_pattern->receive.azimuth);
        const bool conical = config.beam_geometry == BeamGeometry::Conical;
        for (uint32_t beam = 0; beam < ping.beam_count; ++beam) {
            const double bearing = ping.bearings[beam].rad;
            const double power =
                conical ? receive.power(std::asin(direction.y), bearing) : receive.power(azimuth - bearing, 0);
            if (bin >= ping.bin_count || power < 1e-4) continue;
            const double expected = sent->source_level_db - *config.crosstalk->source_level_db + decibels(0.25) +
                                    decibels(power) - 20 * std::log10(distance) -
                                    *config.absorption->db_per_m * distance;
            EXPECT_NEAR(decibels(double{ping.bins[beam * ping.bin_count + bin]}), expected, 0.01) << trial;
            ++received;
        }
        for (size_t i = 0; i < ping.bins.size(); ++i)  // in that bin alone
            ASSERT_TRUE(i % ping.bin_count == bin || ping.bins[i] == 0) << trial << " " << i;
    }
    EXPECT_GT(received, 200);
}

TEST(CrosstalkTest, APulseOfTheSameKindHasTheShapeOfAnEcho) {
    SonarConfig config = receiving(test::getSonar({.bins = 300, .rows = 8}));
    config.frequency_khz = 700;
    config.pulse.emplace().bandwidth_khz = 2;
    config.pulse->window = acoustics::PulseWindow::Hann;
    const auto ping = makePing(config, openWaterWith(sentFrom({20, 0, 0}, 0.003)));
    const acoustics::Pulse pulse(*config.pulse, 1000);
    for (size_t k = 80; k < 160; ++k) {
        const double low = 0.1 * static_cast<double>(k) - 11.5;
        EXPECT_NEAR(double{ping.bins[k]} * 400, pulse.mean(low, low + 0.1), 2e-3) << k;
    }
}

TEST(CrosstalkTest, NoPulseArrivesBehindAWallTooEarlyTooLateOrOutsideOfFanAndAperture) {
    const SonarConfig config = receiving(test::getSonar({.width_deg = 60, .bins = 300, .rows = 8}));
    const auto receivedFrom = [&](glm::dvec3 place, double delay, types::GeometryPtr scene = openWater()) {
        types::Snapshot snapshot = test::makeSnapshot(scene);
        const double alone = test::computeSum(makePing(config, snapshot));
        snapshot.transmissions = {sentFrom(place, delay)};
        return test::computeSum(makePing(config, snapshot)) - alone;
    };
    EXPECT_NEAR(receivedFrom({20, 0, 0}, 0), 1.0 / 400, 1e-6);
    EXPECT_EQ(receivedFrom({20, 0, 0}, 0, test::makeScene({test::wall(10)})), 0);
    EXPECT_NEAR(receivedFrom({20, 0, 0}, 0, test::makeScene({test::wall(25)})), 1.0 / 400, 1e-6);
    EXPECT_EQ(receivedFrom({20, 0, 0}, -0.021), 0);  // it has passed
    EXPECT_EQ(receivedFrom({20, 0, 0}, 0.041), 0);   // the sonar no longer listens
    EXPECT_GT(receivedFrom({20, 0, 0}, 0.039), 0);
    EXPECT_EQ(receivedFrom({-20, 0, 0}, 0), 0);
    EXPECT_EQ(receivedFrom({0, 20, 0}, 0), 0);
    EXPECT_EQ(receivedFrom({20, 0, 8}, 0), 0);
}

/** The surface's image of the sender, 6 m above it. */
TEST(CrosstalkTest, ThePulseArrivesByTheSurfaceToo) {
    SonarConfig config = test::getSonar({.width_deg = 60, .height_deg = 120, .bins = 300, .rows = 64});
    config = receiving(config);
    config.multipath.emplace().surface.emplace();
    types::Snapshot snapshot = openWaterWith(sentFrom({16, 0, 0}, 0.01, [](const glm::dvec3& to) {
        return to.z > 0.1 ? 0.5 : 1.0;  // weaker towards the surface
    }));
    snapshot.water_surface = 6;
    const auto ping = makePing(config, snapshot);
    const double straight = 16, reflected = 20;
    EXPECT_NEAR(double{ping.bins[static_cast<size_t>((5 + straight / 2) / 0.1)]} * straight * straight, 1, 1e-5);
    EXPECT_NEAR(double{ping.bins[static_cast<size_t>((5 + reflected / 2) / 0.1)]} * reflected * reflected, 0.5, 1e-5);
}

/** A matched filter on sampled chirps: the energy that passes, relative to the filter's own pulse of the same level. */
double filteredEnergy(const Waveform& own, const Waveform& sent) {
    constexpr double rate = 2e6;
    const auto chirp = [&](const Waveform& form) {
        std::vector<std::complex<double>> all(static_cast<size_t>(form.duration * rate));
        for (size_t i = 0; i < all.size(); ++i) {
            const double t = static_cast<double>(i) / rate - form.duration / 2;
            const double offset = 1e3 * (form.frequency_khz - own.frequency_khz);
            all[i] = std::polar(1.0, 2 * pi * (offset * t + 0.5e3 * form.bandwidth_khz / form.duration * t * t));
        }
        return all;
    };
    const auto filter = chirp(own), pulse = chirp(sent);
    double energy = 0;
    for (auto shift = -static_cast<std::ptrdiff_t>(filter.size()); shift < std::ssize(pulse); ++shift) {
        std::complex<double> sum = 0;
        const auto from = std::max<std::ptrdiff_t>(0, -shift);
        const auto to = std::min(std::ssize(filter), std::ssize(pulse) - shift);
        for (auto i = from; i < to; ++i)
            sum += std::conj(filter[static_cast<size_t>(i)]) * pulse[static_cast<size_t>(i + shift)];
        energy += std::norm(sum) / std::norm(static_cast<double>(filter.size()));
    }
    return energy / rate;  // [s], of a peak of 1
}

TEST(CrosstalkTest, AMatchedFilterPassesTheShareOfAnotherChirpByMismatchOf) {
    const Waveform own{700, 40, 1.5e-3};
    for (const Waveform& sent : {Waveform{700, 40, 2.5e-3}, Waveform{720, 40, 1.5e-3}, Waveform{715, 60, 1e-3},
                                 Waveform{700, 30, 3e-3}, Waveform{690, 25, 2e-3}}) {
        const double cell = 0.5 * 1500 * filteredEnergy(own, own);  // of the own pulse, in slant range
        const Mismatch mismatch = computeMismatch(own, sent, cell, 300, 1500);
        const double passed = 0.5 * 1500 * filteredEnergy(own, sent);
        EXPECT_NEAR(decibels(mismatch.intensity * mismatch.length / passed), 0, 0.5)
            << sent.frequency_khz << " " << sent.bandwidth_khz;
    }
    EXPECT_EQ(computeMismatch(own, own, 0.02, 40, 1500).length, 0);
    const Mismatch far = computeMismatch(own, {900, 40, 1.5e-3}, 0.02, 40, 1500);
    EXPECT_NEAR(decibels(far.intensity), -40 + decibels(0.02 / far.length), 1e-9);
}

TEST(CrosstalkTest, AnotherSonarsPulseFillsTheBinsOfItsDuration) {
    SonarConfig config = receiving(test::getSonar({.bins = 300, .rows = 8}));
    config.frequency_khz = 700;
    config.pulse.emplace().bandwidth_khz = 50;  // without chirp_us it lasts 1 ms
    auto sent = std::make_shared<types::Transmission>(*sentFrom({20, 0, 0}, 0));
    sent->frequency_khz = 725, sent->bandwidth_khz = 50, sent->duration = 2e-3;
    const auto ping = makePing(config, openWaterWith(sent));
    std::vector<size_t> received;
    for (size_t k = 0; k < ping.bin_count; ++k)
        if (ping.bins[k] > 0) received.push_back(k);
    ASSERT_EQ(received.size(), 16u);  // c (1 + 2 ms) / 2 = 1.5 m, about 10 m
    EXPECT_EQ(received.front(), 92u);
    // Half of the pulse's band passes, with twice the energy, as a box of 1.5 m instead of a pulse of c / 2 B.
    EXPECT_NEAR(double{ping.bins[100]} * 400 / (0.5 * 2 * acoustics::Pulse(*config.pulse, 1000).cellLength() / 1.5), 1,
                1e-4);
}

/** A twin at the place of a sonar doubles the echoes of the sonar's own pulse. Fields of coherent speckle add with
 *  independent phases, so with coherent speckle the sum over the ping doubles. */
TEST(CrosstalkTest, ATwinAtTheSonarsPlaceDoublesEveryEcho) {
    for (const bool patterned : {false, true}) {
        SonarConfig config =
            test::getSonar({.beams = 8, .width_deg = 80, .height_deg = 60, .bins = 300, .rows = 512, .columns = 8});
        config.visibility = Visibility::Cpu;
        config.frequency_khz = 300;
        config.absorption.emplace().db_per_m = 0.1;
        config.crosstalk.emplace();
        if (patterned) {
            config.beam_pattern.emplace();
            config.beam_pattern->receive.azimuth = getLaw(6);
            config.beam_pattern->receive.elevation = getLaw(30);
            config.pulse.emplace().bandwidth_khz = 2;
        }
        types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-5, 200)}, -10));
        const auto own = makePing(config, snapshot);
        types::Snapshot with_twin = snapshot;
        with_twin.transmissions = {sentFrom({-0.003, 0, 0}, 0)};  // not at a distance of 0, and behind the sonar
        const auto both = makePing(config, with_twin);
        for (uint32_t beam = 1; beam < 7; ++beam)
            for (size_t k = 110; k < 280; k += 5) {
                const auto five = [&](const types::Sonar& ping) {
                    const float* bins = &ping.bins[beam * ping.bin_count + k];
                    return std::accumulate(bins, bins + 5, 0.0);
                };
                EXPECT_NEAR(five(both) / five(own), 2, 0.03) << patterned << beam << " " << k;
            }
        config.speckle.emplace().coherent = true;
        const auto evened = [](const types::Sonar& ping) {
            double sum = 0;
            for (size_t i = 0; i < ping.bins.size(); ++i)
                sum += double{ping.bins[i]} * std::pow(static_cast<double>(i % ping.bin_count), 5);
            return sum;
        };
        EXPECT_NEAR(evened(makePing(config, with_twin)) / evened(makePing(config, snapshot)), 2, 0.25) << patterned;
    }
}

/** Level ground of Lambert's law, by an integral over its points. */
TEST(CrosstalkTest, EchoesOfAnotherSonarsPulseAreTheBistaticIntegralOverTheGround) {
    SonarConfig config = receiving(
        test::getSonar({.beams = 1, .width_deg = 60, .height_deg = 120, .bins = 300, .rows = 2048, .columns = 64}),
        true);
    const auto scene = test::makeScene({test::ground(-4, 400)}, -20);
    types::Snapshot snapshot = test::makeSnapshot(scene);
    const auto own = makePing(config, snapshot);
    const glm::dvec3 sender(-3, 2.5, 3);
    const double delay = 0.012;
    const auto power = [](const glm::dvec3& to) { return to.z < 0 ? 1 + 0.5 * to.x : 0; };
    snapshot.transmissions = {sentFrom(sender, delay, power)};
    const auto both = makePing(config, snapshot);
    std::vector<double> expected(own.bin_count);
    constexpr double step = 0.02;
    for (double x = step / 2; x < 60; x += step)
        for (double y = -40 + step / 2; y < 40; y += step) {
            const glm::dvec3 at(x, y, -4);
            const double r = glm::length(at), back = glm::distance(at, sender);
            const double elevation = std::asin(4 / r);
            if (std::abs(std::atan2(y, x)) > pi / 6 || elevation > pi / 3) continue;
            const auto bin = static_cast<size_t>((500 * delay + (r + back) / 2) / 0.1);
            if (bin >= expected.size()) continue;
            const double scattered = 0.01 * (4 / r) * (7 / back);
            expected[bin] += power((at - sender) / back) * scattered * step * step / (r * r * back * back);
        }
    for (size_t k = 130; k < 290; ++k) {
        double sum = 0, truth = 0;
        for (size_t j = k - 2; j <= k + 2; ++j) {
            sum += double{both.bins[j]} - double{own.bins[j]};
            truth += expected[j];
        }
        EXPECT_NEAR(decibels(sum / truth), 0, 0.1) << k;
    }
}

TEST(CrosstalkTest, ASenderBehindASurfaceInsonifiesNothing) {
    const SonarConfig config =
        receiving(test::getSonar({.width_deg = 60, .height_deg = 120, .bins = 300, .rows = 64}), true);
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-4, 400)}));
    const auto alone = makePing(config, snapshot);
    snapshot.transmissions = {sentFrom({5, 0, -6}, 0)};
    EXPECT_EQ(makePing(config, snapshot).bins, alone.bins);
    snapshot.geometry = test::makeScene({test::ground(-4, 400), test::quad({1, -50, -3}, {60, 0, 0}, {0, 100, 0})});
    const auto roofed = makePing(config, snapshot);
    snapshot.transmissions = {sentFrom({10, 0, -3.5}, 0)};
    EXPECT_EQ(makePing(config, snapshot).bins, roofed.bins);
}

/** Senders at extreme places and times give finite echoes. */
TEST(CrosstalkTest, ExtremeSendersLeaveFiniteBins) {
    const SonarConfig config =
        receiving(test::getSonar({.width_deg = 60, .height_deg = 120, .bins = 300, .rows = 64}), true);
    types::Snapshot snapshot = test::makeSnapshot(test::makeScene({test::ground(-4, 400)}));
    for (const glm::dvec3 place : {glm::dvec3(0), glm::dvec3(1e-9, 0, 0), glm::dvec3(1e9, 0, 0), glm::dvec3(5, 0, -4),
                                   glm::dvec3(5, 0, -4 + 1e-6)})
        for (const double delay : {-1e4, -0.03, 0.0, 0.03, 1e4}) {
            auto loud = std::make_shared<types::Transmission>(*sentFrom(place, delay));
            loud->source_level_db = 400;
            snapshot.transmissions = {loud, sentFrom(place, delay)};
            SonarConfig quiet = config;
            quiet.crosstalk->source_level_db = -300;
            for (const float bin : makePing(quiet, snapshot).bins) ASSERT_TRUE(std::isfinite(bin) && bin >= 0);
        }
}

TEST(CrosstalkTest, KeepsThePulsesOfTenSecondsHoweverTheClockIsSet) {
    OthersReceived received;
    types::Snapshot scene;
    const auto arrivals = [&](double seconds) {
        scene.time = types::Time::fromSeconds(1 + seconds);
        received.give(scene, 1e6, 1500);
        return scene.transmissions.size();
    };
    const auto add = [&](double seconds) { received.add(sentFrom({1, 0, 0}, seconds)); };
    for (int i = 0; i < 100'000; ++i) add(1000 + 0.01 * i);
    EXPECT_EQ(arrivals(1999.99), 1001u) << "older pulses are forgotten without a ping";
    add(1399);  // the clock was set back by ten minutes
    EXPECT_EQ(arrivals(1399.01), 1u) << "those of before are forgotten";
    EXPECT_EQ(arrivals(1409.01), 0u);
}

}  // namespace
}  // namespace insonify::sonar
