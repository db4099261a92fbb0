#include <gmock/gmock.h>

#include <cmath>

#include "components/acoustics/Pulse.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::acoustics {
namespace {

constexpr double speed_of_sound = 1500;

Pulse chirp(double bandwidth_khz, PulseWindow window = PulseWindow::None) {
    PulseConfig config;
    config.bandwidth_khz = bandwidth_khz;
    config.window = window;
    return Pulse(config, speed_of_sound);
}

Pulse tone(double duration_us) {
    PulseConfig config;
    config.duration_us = duration_us;
    return Pulse(config, speed_of_sound);
}

/** Returns the integral of a function over range [m]. */
template <class F>
double integral(const F& f, double from, double to) {
    constexpr int cells = 400000;
    double sum = 0;
    for (int i = 0; i < cells; ++i) sum += f(from + (to - from) * (i + 0.5) / cells);
    return sum * (to - from) / cells;
}

TEST(PulseTest, MeansMatchTheResponse) {
    EXPECT_DOUBLE_EQ(tone(100).mean(-0.0625, 0.0625), 0.6) << "0.075 m of 0.125 m";
    EXPECT_EQ(tone(100).mean(0.04, 0.05), 0);
    const Pulse pulse = chirp(10);  // a unit of 0.075 m
    const auto response = [&](double distance) { return pulse.response(distance); };
    for (const double low : {-0.2, -0.03, 0.1})
        EXPECT_NEAR(pulse.mean(low, low + 0.06), integral(response, low, low + 0.06) / 0.06, 1e-3);
}

TEST(PulseTest, AToneIsABoxOfHalfItsLengthAboutItsEcho) {
    const Pulse pulse = tone(100);  // 15 cm of water there and back: 7.5 cm of range
    EXPECT_EQ(pulse.response(0), 1);
    EXPECT_EQ(pulse.response(0.0374), 1);
    EXPECT_EQ(pulse.response(-0.0374), 1);
    EXPECT_EQ(pulse.response(0.0376), 0);
    EXPECT_NEAR(pulse.resolution(), 0.075, 1e-12);
    EXPECT_NEAR(pulse.cellLength(), 0.075, 1e-12);
    EXPECT_FALSE(pulse.peakSidelobeDb().has_value());
    EXPECT_NEAR(pulse.extent(-60), 0.0375, 1e-12);
    // An echo that started at the target would be centred a quarter of the pulse beyond it.
    EXPECT_EQ(pulse.response(0.05), 0);
}

TEST(PulseTest, AChirpHasTheResolutionAndSidelobesOfItsWindow) {
    const double unit = speed_of_sound / (2 * 50e3);
    struct Case {
        PulseWindow window;
        double width, sidelobe_db, cell;
    };
    for (const Case& c :
         {Case{PulseWindow::None, 0.886, -13.26, 1.0}, Case{PulseWindow::Hann, 1.44, -31.5, 1.5},
          Case{PulseWindow::Hamming, 1.303, -42.7, 1.363}, Case{PulseWindow::Taylor, 1.125, -30.3, 1.172}}) {
        const Pulse pulse = chirp(50, c.window);
        EXPECT_EQ(pulse.response(0), 1);
        EXPECT_EQ(pulse.response(0.011), pulse.response(-0.011));
        EXPECT_NEAR(pulse.resolution(), c.width * unit, 0.01 * c.width * unit) << static_cast<int>(c.window);
        EXPECT_NEAR(pulse.response(pulse.resolution() / 2), 0.5, 1e-9) << static_cast<int>(c.window);
        EXPECT_NEAR(pulse.peakSidelobeDb().value(), c.sidelobe_db, 0.3) << static_cast<int>(c.window);
        EXPECT_NEAR(pulse.cellLength(), c.cell * unit, 0.01 * c.cell * unit) << static_cast<int>(c.window);
    }
}

TEST(PulseTest, AChirpOfHalfTheBandIsTwiceAsLong) {
    EXPECT_NEAR(chirp(25).resolution(), 2 * chirp(50).resolution(), 1e-9);
    // Without the factor 2 of the two-way path the pulse would have the length of a chirp of half the band.
    EXPECT_GT(std::abs(chirp(50).resolution() - 0.886 * speed_of_sound / 50e3), 0.01);
}

TEST(PulseTest, ReverberationOfARangeDensityIsTheDensityTimesTheCellLength) {
    // A density that hardly changes over a cell: the intensity of a bin is the density times the integral of h.
    for (const Pulse& pulse : {tone(200), chirp(30, PulseWindow::Hann)}) {
        const auto density = [](double r) { return std::pow(r, -3); };
        const double received = integral([&](double r) { return density(r) * pulse.response(20 - r); }, 15, 25);
        EXPECT_NEAR(received, density(20) * pulse.cellLength(), 1e-3 * received);
    }
}

TEST(PulseTest, ExtentReachesToTheFloor) {
    for (const auto window : {PulseWindow::None, PulseWindow::Hann, PulseWindow::Taylor}) {
        const Pulse pulse = chirp(50, window);
        const double reach = pulse.extent(-50);
        EXPECT_GT(pulse.extent(-60), reach);
        for (double further = reach; further < 3 * reach; further += reach / 500)
            EXPECT_LT(pulse.response(further), 1.02e-5) << static_cast<int>(window) << ' ' << further;
    }
}

TEST(PulseTest, NeedsEitherABandwidthOrADuration) {
    PulseConfig config;
    EXPECT_EQ(test::countRefusals(config).size(), 1u);
    config.duration_us = 100;
    EXPECT_TRUE(test::countRefusals(config).empty());
    config.window = PulseWindow::Hann;
    EXPECT_THAT(test::countRefusals(config).at(0), testing::StartsWith("window: "));
    config.bandwidth_khz = 50;
    EXPECT_THAT(test::countRefusals(config).at(0), testing::StartsWith("duration_us: "));
    config.duration_us.reset();
    EXPECT_TRUE(test::countRefusals(config).empty());
}

}  // namespace
}  // namespace insonify::acoustics
