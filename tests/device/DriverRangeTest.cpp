// A driver computes the range of an echo from its own settings, whatever bins the simulated sonar has.
#include <cmath>

#include "components/device/Ping1dEmulator.hpp"
#include "components/device/Ping360Emulator.hpp"
#include "tests/device/PingBench.hpp"
#include "tests/support/Draw.hpp"

namespace insonify::device {
namespace {

/** A sonar's answer with one echo [m]. Its bins are as long as asked, or of whole microseconds, as of
 *  `range_rounding: sample`. */
std::shared_ptr<types::Sonar> echoAt(const types::SonarSettings& asked, double range, bool is_exact, double speed) {
    auto ping = pingFor(asked, static_cast<float>(speed));
    const double width = asked.range / asked.bin_count, rounded = std::ceil(1e6 * width / speed - 1e-6) * 1e-6 * speed;
    ping->setBins(is_exact ? width : rounded, speed);
    std::ranges::fill(ping->bins, 0.0f);
    ping->bins.at(static_cast<size_t>(range / ping->binWidth())) = 60000;
    return ping;
}

struct Case {
    double reach, target;  ///< [m]
    bool is_exact;
};

std::vector<Case> cases(double shortest, double longest) {
    const test::Seeds seeds(60);
    std::vector<Case> all = {{8, 6.3, false}, {8, 0.9, false}, {8, 7.9, true}};
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        const double reach = shortest * std::pow(longest / shortest, draw.between(0, 1));
        all.push_back({reach, reach * draw.between(0.1, 0.98), draw.once(2)});
    }
    return all;
}

TEST(DriverRangeTest, ThePing360sDriverFindsTheEchoByItsSamplePeriod) {
    for (const Case& each : cases(1, 50)) {
        Ping360Emulator device{{}};
        PingBench bench(device);
        constexpr uint16_t samples = 1200;
        const auto period = static_cast<uint16_t>(std::max(80.0, std::round(2 * each.reach / 1500 / samples / 25e-9)));
        bench.say(Ping360Transducer{1, 0, {1, 50, period, 750, samples}, 1, 0});
        const auto asked = bench.asked();
        ASSERT_TRUE(asked);
        const double target = each.target / each.reach * asked->range;
        device.takePing(echoAt(*asked, target, each.is_exact, 1500), bench.now());
        bench.wait(1);
        const auto data = bench.only<Ping360DeviceData>().data;
        const auto first = std::ranges::find_if(data, [](uint8_t byte) { return byte > 0; }) - data.begin();
        ASSERT_LT(first, samples) << each.reach;
        const double bin = period * 25e-9 * 1500 / 2;
        EXPECT_NEAR((static_cast<double>(first) + 0.5) * bin, target, bin + 0.00151)
            << each.reach << " m, " << each.is_exact;
    }
}

TEST(DriverRangeTest, ThePing1dReportsTheDistanceAndItsProfileHasIt) {
    for (const Case& each : cases(1, 100)) {
        Ping1dEmulator device{{}};
        PingBench bench(device);
        const auto length = static_cast<uint32_t>(1000 * each.reach);
        bench.say(Ping1dSetModeAuto{0});
        bench.say(Ping1dSetRange{0, length});
        bench.received();
        bench.say(PingGeneralRequest{Ping1dProfile::message});
        const auto asked = bench.asked();
        ASSERT_TRUE(asked);
        device.takePing(echoAt(*asked, each.target, each.is_exact, 1500), bench.now());
        bench.waitForNext();
        const auto profile = bench.only<Ping1dProfile>();
        const double bin = each.reach / 200;
        EXPECT_NEAR(profile.measurement.distance * 1e-3, each.target, bin + 0.0025) << each.reach;
        const auto first =
            std::ranges::find_if(profile.data, [](uint8_t byte) { return byte > 0; }) - profile.data.begin();
        const double shown = each.reach / static_cast<double>(profile.data.size());
        EXPECT_NEAR((static_cast<double>(first) + 0.5) * shown, each.target, shown + 0.0025) << each.reach;
    }
}

}  // namespace
}  // namespace insonify::device
