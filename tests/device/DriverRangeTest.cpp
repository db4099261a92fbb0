// The ranges that unmodified drivers compute from the wire, of a wall ahead of a simulated sonar.
#include <algorithm>
#include <cmath>

#include "components/device/micron/MicronEmulator.hpp"
#include "components/device/oculus/OculusEmulator.hpp"
#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "components/device/sonar3d/Sonar3dEmulator.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"
#include "tests/device/PingBench.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/MicronDriver.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::device {
namespace {

/** A wall ahead, and how a sonar listens to it. */
struct Case {
    double reach;   ///< End of the range that the driver asks for, about [m].
    double target;  ///< As a part of that range.
    bool is_exact;  ///< Bins as asked for; else of whole microseconds.
    double speed;   ///< Of sound, in the water [m/s].

    /** Returns the error that a range may have: the middle of a driver's bin for any place in it, or for any place in
     *  the sonar's, which may begin there and is longer by less than a microsecond; and the wall is flat [m]. */
    double tolerance(double bin, double range) const {
        return (is_exact ? 0.505 * bin : bin + 1e-6 * speed) + 2e-5 * range;
    }
};

std::vector<Case> cases(double shortest, double longest, double slowest, double fastest) {
    const test::Seeds seeds(60);
    std::vector<Case> all = {
        {8, 0.7875, false, 1500}, {8, 0.1125, false, 1500}, {8, 0.9875, true, 1500}, {longest, 0.998, true, fastest}};
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        const double reach = shortest * std::pow(longest / shortest, draw.between(0, 1));
        all.push_back({reach, draw.between(0.05, 0.99), draw.once(2), draw.between(slowest, fastest)});
    }
    return all;
}

sonar::SonarConfig narrowBeam(const Case& each) {
    sonar::SonarConfig config;
    config.range_min = 0.01;
    config.speed_of_sound = each.speed;
    config.range_rounding = each.is_exact ? sonar::RangeRounding::Exact : sonar::RangeRounding::Sample;
    config.beam_width_deg = config.beam_height_deg = 0.5;
    config.quality.rows = config.quality.columns_per_beam = 4;
    config.visibility = sonar::Visibility::Cpu;
    return config;
}

types::Snapshot wallAt(double range) {
    return test::makeSnapshot(test::makeScene({test::quad({range, -1, -1}, {0, 2, 0}, {0, 0, 2})}));
}

/** Returns the ping of a sonar that takes a request, in codes: the largest where there is an echo.
 *  @param range of the wall [m] */
std::shared_ptr<types::Sonar> answerTo(const types::SonarSettings& request, double range, const Case& each) {
    sonar::SonarConfig config = narrowBeam(each);
    config.range = request.range;
    config.bin_count = static_cast<int>(request.bin_count);
    if (request.speed_of_sound > 0) config.speed_of_sound = request.speed_of_sound;
    config.bearings_deg = {0};
    const types::Snapshot snapshot = wallAt(range);
    sonar::SonarRenderer renderer(config, snapshot.geometry, {.threads = 1});
    auto ping = std::make_shared<types::Sonar>();
    renderer.render(snapshot, *ping);
    ping->time = request.time;
    for (float& bin : ping->bins) bin = bin > 0 ? 65535 : 0;
    return ping;
}

/** Returns the middle of the first byte above 0 [bytes]. */
double findFirst(const Bytes& bytes) {
    return static_cast<double>(std::ranges::find_if(bytes, [](uint8_t byte) { return byte > 0; }) - bytes.begin()) +
           0.5;
}

/** Has a device request pings and be answered until it requests no more. Returns the last request.
 *  @param target as a part of the range */
types::SonarSettings answered(PingDevice& device, PingBench& bench, const Case& each, double target) {
    types::SonarSettings last;
    double range = 0;
    for (auto request = bench.request(); request; request = bench.request()) {
        if (std::isnan(last.range)) range = target * request->range * each.speed / 1500;  // requested at 1500 m/s first
        last = *request;
        device.setPing(answerTo(*request, range, each), bench.now());
    }
    bench.wait(1);
    return last;
}

TEST(DriverRangeTest, ThePing360sDriverFindsTheEchoByItsSamplePeriod) {
    for (const Case& each : cases(1, 50, 1400, 1600)) {
        Ping360Emulator device{{}};
        PingBench bench(device);
        constexpr uint16_t samples = 1200;
        const auto period =
            static_cast<uint16_t>(std::max(80.0, std::round(2 * each.reach / each.speed / samples / 25e-9)));
        bench.say(Ping360Transducer{1, 0, {1, 50, period, 750, samples}, 1, 0});
        const types::SonarSettings request = answered(device, bench, each, each.target);
        const double bin = period * 25e-9 * each.speed / 2, target = each.target * samples * bin;
        EXPECT_NEAR(request.range, samples * bin, 1e-6 * request.range) << "at the water's speed";
        EXPECT_NEAR(findFirst(bench.only<Ping360DeviceData>().data) * bin, target, each.tolerance(bin, target))
            << target << " of " << each.reach << " m at " << each.speed << " m/s, " << each.is_exact;
    }
}

TEST(DriverRangeTest, ThePing1dReportsTheDistanceAndItsProfileHasIt) {
    test::Draw draw(1);
    for (const Case& each : cases(1, 100, 1400, 1600)) {
        Ping1dEmulator device{{}};
        PingBench bench(device);
        const double own_speed = draw.between(1300, 1700);  // as the driver has set it
        const auto end = static_cast<uint32_t>(1000 * each.reach);
        const auto start = draw.once(2) ? 0 : static_cast<uint32_t>(draw.between(0, end - 1000.0));
        bench.say(Ping1dSetModeAuto{0});
        bench.say(Ping1dSetRange{start, end - start});
        bench.say(Ping1dSetSpeedOfSound{static_cast<uint32_t>(1000 * own_speed)});
        bench.received();
        bench.say(PingGeneralRequest{Ping1dProfile::message});
        const double target = 1e-3 * (start + each.target * (end - start));  // as the driver will see it [m]
        const types::SonarSettings last = answered(device, bench, each, 1000 * target / end);
        const auto profile = bench.only<Ping1dProfile>();
        const double sample = 1e-3 * (end - start) / 200, bin = 1e-3 * end / last.bin_count;  // samples cut bins
        EXPECT_NEAR(profile.measurement.distance * 1e-3, target, each.tolerance(bin, target) + 0.51e-3)
            << start << " to " << end << " mm";
        ASSERT_EQ(profile.data.size(), 200u);
        EXPECT_NEAR(1e-3 * start + findFirst(profile.data) * sample, target, bin + 1.1e-6 * each.speed + 2e-5 * target)
            << start << " to " << end << " mm";
    }
}

/** The resolution is stated with each ping. */
TEST(DriverRangeTest, TheOculussDriverFindsTheEchoByTheRangeResolution) {
    test::Draw draw(2);
    const types::Time now{1'000'000'000};
    for (const Case& each : cases(0.3, 40, 1300, 1700)) {
        OculusConfig config;
        config.model = OculusModel::M1200d;
        config.bin_count = 100 + draw.upTo(1000);
        OculusEmulator device(config, now);
        device.opened(1);
        OculusFire fire{.mode = static_cast<uint8_t>(1 + draw.upTo(2)), .range = each.reach};
        fire.flags |= draw.once(2) ? OculusFire::wide_16 : draw.once(2) ? OculusFire::row_gains : 0;
        fire.speed_of_sound = draw.once(2) ? 0 : draw.between(1300, 1700);  // 0: the water's own
        fire.header.version = static_cast<uint16_t>(1 + draw.upTo(2));
        if (draw.once(4)) {
            fire.flags &= static_cast<uint8_t>(~OculusFire::range_in_metres);
            fire.range = std::min(100.0, 10 * each.reach);  // [%]
        }
        device.received(1, toBytes(fire));
        const auto request = device.tick(now).ask;
        ASSERT_TRUE(request);
        const double target = std::max(0.05, each.target * request->range);
        const auto result = oculusResult(device.ping(*answerTo(*request, target, each)));
        ASSERT_TRUE(result);
        const OculusPing ping = makePing(*result);
        const auto first = std::ranges::find_if(ping.codes, [](uint32_t code) { return code > 0; });
        const double bin = ping.range_resolution;
        EXPECT_LE(std::abs(bin * request->bin_count - request->range), request->bin_count * 1e-6 * ping.speed_of_sound);
        EXPECT_NEAR((static_cast<double>(first - ping.codes.begin()) + 0.5) * bin, target, 0.5 * bin + 2e-5 * target)
            << request->range << " m, mode " << int{fire.mode};
        EXPECT_EQ(ping.speed_of_sound,
                  static_cast<double>(static_cast<float>(fire.speed_of_sound > 0 ? fire.speed_of_sound : each.speed)));
    }
}

/** The driver and the device are given the same speed of sound. */
TEST(DriverRangeTest, TheMicronsDriverFindsTheEchoByTheSamplingInterval) {
    test::Draw draw(3);
    for (const Case& each : cases(2, 75, 1400, 1600)) {
        types::Time now{1'700'000'000'000'000};
        Bytes sent;
        std::optional<types::SonarSettings> request;
        MicronEmulator device({.speed_of_sound = each.speed, .centring_time = 0},
                              {[&](const types::SonarSettings& settings) { request = settings; },
                               [&](Client, Bytes bytes) { sent.insert(sent.end(), bytes.begin(), bytes.end()); },
                               [](const std::string& text) { ADD_FAILURE() << text; }});
        const Client client{0, 1};
        test::MicronDriver driver([&](const Bytes& bytes) { device.received(client, bytes, now); },
                                  [&] { return std::exchange(sent, {}); });
        device.opened(client);
        for (int i = 0; i < 3; ++i) device.tick(now = now + types::Time::fromSeconds(0.5));
        const double resolution = each.reach / (150 + draw.upTo(400));
        driver.configure({.resolution = resolution,
                          .max_distance = each.reach,
                          .speed_of_sound = each.speed,
                          .low_resolution = draw.once(3)});
        driver.request();
        device.tick(now);
        ASSERT_TRUE(request);
        const double target = each.target * request->range;
        device.setPing(*answerTo(*request, target, each));
        device.tick(now + types::Time::fromSeconds(1));
        const auto beam = driver.beam();
        const double bin = beam.sampling_interval * each.speed / 2;
        EXPECT_NEAR(findFirst(beam.bins) * bin, target, each.tolerance(bin, target))
            << each.reach << " m by " << resolution << " m at " << each.speed << " m/s, " << each.is_exact;
    }
}

/** A 3D-15 with the simulated sonar that its task is connected to. The beam ahead is one of three by three. */
class Sonar3dBench {
public:
    explicit Sonar3dBench(const Case& each, int bins) {
        sonar::Sonar3dConfig config;
        config.sonar = narrowBeam(each);
        config.sonar.bin_count = bins;
        config.horizontal.beam_count = config.vertical.beam_count = 3;
        snapshot_.port.connectTo(sonar_.snapshot, {});
        settings_.port.connectTo(sonar_.settings, framework::ConnPolicy::buffer(4));
        sonar_.range_image.connectTo(maps_.port, framework::ConnPolicy::buffer(4));
        sonar_.config.set(config);
        if (!sonar_.configure() || !sonar_.start()) throw std::runtime_error(sonar_.lastError());
        post("acoustics/enabled", "true");
    }
    void post(const std::string& path, const std::string& body) {
        const HttpReply reply = device_.answer({"POST", "/api/v1/integration/" + path, body}, now_);
        if (reply.status >= 300) throw std::runtime_error(path + ": " + reply.body);
    }
    /** Returns the range of the beam ahead in the image of the next ping, as clients compute it; 0: none [m]. */
    double rangeAhead(double wall) {
        packets_.clear();
        now_ = now_ + types::Time::fromSeconds(0.2);
        types::Snapshot scene = wallAt(wall);
        scene.time = now_;
        snapshot_.port.write(std::make_shared<types::Snapshot>(scene));
        device_.tick(now_);
        sonar_.update();
        types::DepthMapPtr map;
        if (!maps_.port.readNew(map)) throw std::runtime_error("no map: " + sonar_.lastError());
        device_.setPing(*map);
        const auto image = std::get<RangePixels>(ripMessages(packets_.at(0)).at(0));
        return image.pixels.at(4) * static_cast<double>(image.pixel_scale);
    }
    const types::SonarSettings& request() const { return requests_; }
    double bin() const { return sonar::makeBinGrid(sonar_.sonarConfig()).bin_width; }  ///< [m]

private:
    types::Time now_{1'700'000'000'000'000};
    test::Writer<types::SnapshotPtr> snapshot_;
    test::Writer<types::SonarSettings> settings_;
    test::Reader<types::DepthMapPtr> maps_;
    sonar::Sonar3dTask sonar_{"sonar"};
    types::SonarSettings requests_;
    std::vector<Bytes> packets_;
    Sonar3dEmulator device_{{.longest_range = 65},
                            {[this](const types::SonarSettings& settings) {
                                 requests_ = settings;
                                 settings_.port.write(settings);
                             },
                             [this](const std::string&, uint16_t, Bytes packet) { packets_.push_back(packet); },
                             [](const std::string& text) { ADD_FAILURE() << text; }}};
};

std::string rangeBody(double min, double max) { return fmt::format(R"({{"min": {}, "max": {}}})", min, max); }

TEST(DriverRangeTest, TheSonar3dsClientFindsTheWallAtItsPixel) {
    test::Draw draw(4);
    for (const Case& each : cases(1, 65, 1000, 2000)) {
        Sonar3dBench bench(each, std::min(100 + draw.upTo(900), static_cast<int>(each.reach / 0.01)));
        const double automatic = draw.once(3);
        bench.post("acoustics/range", rangeBody(0.01 * each.reach, each.reach));
        bench.post("acoustics/speed_of_sound", automatic ? "0" : fmt::format("{}", each.speed));
        if (draw.once(2)) bench.post("acoustics/mode", R"("high-frequency")");
        const double target = each.target * each.reach;
        const double range = bench.rangeAhead(target);
        EXPECT_NEAR(range, target, 0.505 * bench.bin() + 2e-5 * target + 0.51e-3)
            << each.reach << " m, " << each.is_exact;
        if (!automatic) {
            EXPECT_EQ(bench.request().speed_of_sound, each.speed);
        }
    }
}

/** Limits may divide bins anywhere. */
TEST(DriverRangeTest, TheSonar3dLosesNoWallBetweenItsLimits) {
    test::Draw draw(5);
    int nearer = 0, farther = 0;
    for (const Case& each : cases(2, 30, 1400, 1600)) {
        Sonar3dBench bench(each, 50 + draw.upTo(400));
        const double min = std::round(1e4 * draw.between(0.1, 0.5) * each.reach) * 1e-4, max = each.reach;
        bench.post("acoustics/range", rangeBody(min, max));
        bench.post("acoustics/speed_of_sound", fmt::format("{}", each.speed));
        bench.rangeAhead(max / 2);
        const double bin = bench.bin();
        for (const double off : {-1.5, -0.4, -0.01, 0.01, 0.4, 1.5}) {
            const double near = min + off * bin, far = max + off * bin;
            const double range = bench.rangeAhead(near), behind = bench.rangeAhead(far);
            const double first = bin * std::floor(min / bin + 1e-9), last = bin * std::ceil(max / bin - 1e-9);
            const bool is_between = off > 0 || near > first + 1e-4 * bin,
                       is_before = off < 0 || far < last - 1e-4 * bin;
            const double tolerance = 0.5 * bin + 2e-5 * far + 0.51e-3;
            const bool is_nearer = near<first - 1e-4 * bin, is_farther = far> last + 1e-4 * bin;
            if (is_between) {
                EXPECT_NEAR(range, std::max(near, min), tolerance) << off << " bins from " << min;
            }
            if (is_before) {
                EXPECT_NEAR(behind, std::min(far, max), tolerance) << off << " bins from " << max;
            }
            EXPECT_FALSE(is_nearer && range != 0) << off << " bins from " << min;
            EXPECT_FALSE(is_farther && behind != 0) << off << " bins from " << max;
            nearer += is_nearer, farther += is_farther;
            EXPECT_TRUE(range == 0 || range > min - 0.51e-3) << range << " m is nearer than " << min;
            EXPECT_LT(behind, max + 0.51e-3);
        }
    }
    EXPECT_GT(nearer, 10);
    EXPECT_GT(farther, 10);
}

}  // namespace
}  // namespace insonify::device
