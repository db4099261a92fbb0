// Every emulated device while the clock that it reads is set: by minutes and by decades, back and forward, in the
// middle of a ping, with a sonar that answers each request and one that refuses those ahead of its clock.
#include <gmock/gmock.h>

#include <deque>
#include <functional>

#include "components/device/OculusPing.hpp"
#include "components/device/micron/MicronEmulator.hpp"
#include "components/device/oculus/OculusEmulator.hpp"
#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "components/device/sonar3d/Sonar3dEmulator.hpp"
#include "tests/support/MicronDriver.hpp"

namespace insonify::device {
namespace {

using types::Time;

Time seconds(double s) { return Time::fromSeconds(s); }

constexpr double decades = 56 * 365.25 * 86400;
constexpr double step_period = 3.0137, sonar_delay = 0.02;  // [s]

/** Time that passes evenly, and a clock that is set at each of `steps`; a sonar; and a device that is woken as its task
 *  wakes it. */
struct Bench {
    /** @param steps by which the clock is set, one after the other [s] */
    explicit Bench(std::vector<double> steps, bool sonar_refuses) : steps_(std::move(steps)), refuses_(sonar_refuses) {}

    std::function<std::optional<Time>(Time clock)> tick;
    std::function<void(const types::SonarSettings& request, Time stamp, Time clock)> answer;

    Time clock() const { return seconds(1.7e9) + offset_ + now_; }
    double now() const { return now_.seconds(); }
    double end() const { return step_period * static_cast<double>(steps_.size() + 1); }
    const std::vector<double>& asks() const { return asks_; }
    void ask(const types::SonarSettings& settings) {
        asks_.push_back(now());
        EXPECT_EQ(settings.time, clock()) << "on the clock that the sonar reads";
        waiting_.push_back({now_ + seconds(sonar_delay), settings});
    }
    /** Advances by a millisecond. */
    void advance() {
        now_ = now_ + Time{1000};
        if (done_ < steps_.size() && now() >= step_period * static_cast<double>(done_ + 1))
            offset_ = offset_ + seconds(steps_[done_++]);
        bool has_news = false;
        for (; !waiting_.empty() && waiting_.front().first <= now_; waiting_.pop_front()) {
            const types::SonarSettings& request = waiting_.front().second;
            if (refuses_ && request.time - clock() > seconds(1)) continue;
            answer(request, std::max(std::min(request.time, clock()), clock() - seconds(sonar_delay)), clock());
            has_news = true;
        }
        if (has_news || now_ >= wake_) wake();
    }
    void wake() {
        const Time read = clock();
        const auto next = tick(read);
        const Time longest = seconds(0.1);  // of a task
        wake_ = next ? now_ + std::clamp(*next - read, Time{}, longest) : Time{std::numeric_limits<int64_t>::max()};
    }
    void run() {
        while (now() < end()) advance();
    }
    /** Expects that no two of these times are further apart than this [s]. */
    void expectNoGap(std::vector<double> times, double longest) const {
        longest += steps_.empty() ? 0 : 0.11;  // until the step is noticed, and what it costs
        ASSERT_FALSE(times.empty());
        times.push_back(end());
        double gap = 0, at = 0;
        for (size_t i = 1; i < times.size(); ++i)
            if (times[i] - times[i - 1] > gap) gap = times[i] - times[i - 1], at = times[i - 1];
        EXPECT_LE(gap, longest) << "after " << at << " s of " << end() << " s";
    }

private:
    std::vector<double> steps_;
    bool refuses_;
    size_t done_ = 0;
    Time now_, offset_, wake_;
    std::deque<std::pair<Time, types::SonarSettings>> waiting_;
    std::vector<double> asks_;
};

struct Case {
    std::vector<double> steps;  ///< [s]
    bool sonar_refuses;
};

class SetClockTest : public testing::TestWithParam<Case> {
protected:
    Bench bench_{GetParam().steps, GetParam().sonar_refuses};
};

types::Sonar makePing(const types::SonarSettings& request, Time stamp, uint32_t beams) {
    types::Sonar ping;
    ping.time = stamp;
    ping.speed_of_sound = 1500;
    ping.bin_duration = {1};
    ping.bin_count = request.bin_count;
    ping.beam_count = beams;
    for (uint32_t beam = 0; beam < beams; ++beam) ping.bearings.push_back({0.01 * beam});
    ping.bins.assign(size_t{ping.bin_count} * beams, 300);
    return ping;
}

TEST_P(SetClockTest, OculusPingsAtItsRateSendsItsStatusAndItsClockNeverGoesBack) {
    OculusConfig config;
    config.bin_count = 50;
    OculusEmulator device(config, bench_.clock());
    std::vector<double> statuses, pings;
    double device_time = 0;
    device.opened(1);
    OculusFire fire{.range = 5};
    fire.header.version = 2;
    device.received(1, toBytes(fire));
    bench_.tick = [&](Time clock) {
        const auto due = device.tick(clock);
        if (due.ask) bench_.ask(*due.ask);
        if (!due.status.empty()) statuses.push_back(bench_.now());
        return std::optional(due.next);
    };
    bench_.answer = [&](const types::SonarSettings& request, Time stamp, Time) {
        device.follow(bench_.clock());
        const Bytes message = device.ping(makePing(request, stamp, request.beam_count));
        if (message.empty()) return;
        pings.push_back(bench_.now());
        const double start_s = oculusResult(message).value().start_s;
        EXPECT_GE(start_s, device_time);
        device_time = start_s;
    };
    bench_.run();
    bench_.expectNoGap(bench_.asks(), 0.11);
    bench_.expectNoGap(pings, 0.25);
    bench_.expectNoGap(statuses, 1.01);
    EXPECT_LE(bench_.asks().size(), 10 * bench_.end() + 2 * static_cast<double>(GetParam().steps.size()) + 2);
}

TEST_P(SetClockTest, Ping1dStreamsAndAnswersRequests) {
    Ping1dEmulator device{{}};
    std::vector<double> profiles;
    const auto serve = [&] {
        if (const auto request = device.consumeRequest()) bench_.ask(*request);
        for (const PingOutgoing& out : device.consumeOutgoing())
            for (const PingFrame& frame : pingFrames(out.bytes, 4096))
                if (frame.message == Ping1dProfile::message) profiles.push_back(bench_.now());
    };
    bench_.tick = [&](Time clock) {
        device.tick(clock);
        serve();
        return device.wakeAt();
    };
    bench_.answer = [&](const types::SonarSettings& request, Time stamp, Time clock) {
        device.setPing(std::make_shared<types::Sonar>(makePing(request, stamp, 1)), clock);
    };
    device.receive(1, pingBytes(Ping1dSetModeAuto{0}, 0, 0), true, bench_.clock());
    device.receive(1, pingBytes(Ping1dSetRange{0, 5000}, 0, 0), true, bench_.clock());
    device.receive(1, pingBytes(Ping1dContinuousStart{Ping1dProfile::message}, 0, 0), true, bench_.clock());
    serve();
    bench_.wake();
    bench_.run();
    bench_.expectNoGap(profiles, 0.25);
    EXPECT_EQ(device.consumeWarnings().size(), 0u);
}

TEST_P(SetClockTest, Ping360ScansItsSector) {
    Ping360Emulator device{{}};
    std::vector<double> lines;
    bench_.tick = [&](Time clock) {
        device.tick(clock);
        if (const auto request = device.consumeRequest()) bench_.ask(*request);
        for (const PingOutgoing& out : device.consumeOutgoing())
            for (const PingFrame& frame : pingFrames(out.bytes, 4096))
                if (frame.message == Ping360AutoDeviceData::message) lines.push_back(bench_.now());
        return device.wakeAt();
    };
    bench_.answer = [&](const types::SonarSettings& request, Time stamp, Time clock) {
        device.setPing(std::make_shared<types::Sonar>(makePing(request, stamp, 1)), clock);
    };
    const Ping360Acoustics acoustics{1, 50, 100, 750, 600};
    device.receive(1, pingBytes(Ping360AutoTransmit{1, acoustics, {0, 399, 4, 20}}, 0, 0), true, bench_.clock());
    bench_.wake();
    bench_.run();
    bench_.expectNoGap(lines, 0.4);
}

TEST_P(SetClockTest, Ping360HearsAgainAfterARestart) {
    Ping360Emulator device{{}};
    bench_.tick = [&](Time clock) { return device.tick(clock), device.wakeAt(); };
    device.receive(1, pingBytes(Ping360Reset{1}, 0, 0), true, bench_.clock());
    while (bench_.now() < 5.1) bench_.advance();
    device.consumeOutgoing();
    device.receive(1, pingBytes(PingGeneralRequest{PingProtocolVersion::message}, 0, 0), true, bench_.clock());
    EXPECT_EQ(device.consumeOutgoing().size(), 1u);
}

TEST_P(SetClockTest, MicronScansLineAfterLine) {
    Bytes sent;
    std::vector<double> lines;
    const Client client{0, 1};
    MicronEmulator device{
        {.centring_time = 0},
        {[&](const types::SonarSettings& request) { bench_.ask(request); },
         [&](Client, Bytes bytes) { sent.insert(sent.end(), bytes.begin(), bytes.end()); }, [](const std::string&) {}}};
    bench_.tick = [&](Time clock) { return device.tick(clock); };
    bench_.answer = [&](const types::SonarSettings& request, Time stamp, Time) {
        device.follow(bench_.clock());
        device.setPing(makePing(request, stamp, 1));
    };
    device.opened(client);
    test::MicronDriver driver(
        [&](const Bytes& bytes) {
            device.received(client, bytes, bench_.clock());
            bench_.wake();
        },
        [&] {
            for (const double begin = bench_.now(); sent.empty();) {
                bench_.advance();
                if (bench_.now() > begin + 2) throw std::runtime_error("the head is silent for two seconds");
            }
            return std::exchange(sent, {});
        });
    bench_.wake();
    driver.configure({.resolution = 0.1, .max_distance = 20});
    while (bench_.now() < bench_.end()) {
        driver.request();
        driver.beam();
        lines.push_back(bench_.now());
    }
    bench_.expectNoGap(lines, 0.2);
}

TEST_P(SetClockTest, MicronReportsThatItIsAliveEachSecondAndCountsOn) {
    std::vector<double> reports;
    std::vector<uint32_t> counts;
    MicronEmulator device{{},
                          {[](const types::SonarSettings&) {},
                           [&](Client, const Bytes& bytes) {
                               SeaNetReader reader;
                               reader.add(bytes);
                               const auto message = reader.next();
                               const auto alive = message ? SeaNetAlive::in(*message) : std::nullopt;
                               if (!alive) return;
                               reports.push_back(bench_.now());
                               counts.push_back(alive->milliseconds);
                           },
                           [](const std::string&) {}}};
    bench_.tick = [&](Time clock) { return device.tick(clock); };
    device.opened({0, 1});
    bench_.wake();
    bench_.run();
    bench_.expectNoGap(reports, 1.01);
    const bool wraps = std::ranges::any_of(GetParam().steps, [](double step) { return step > 1e6; });
    EXPECT_TRUE(wraps || std::ranges::is_sorted(counts)) << "milliseconds since it was switched on";
}

TEST_P(SetClockTest, Sonar3dPingsAtItsRateAndItsClockRunsOnOnceItIsSet) {
    std::vector<double> images;
    Sonar3dEmulator device{{},
                           {[&](const types::SonarSettings& request) { bench_.ask(request); },
                            [&](const std::string&, uint16_t, const Bytes&) { images.push_back(bench_.now()); },
                            [](const std::string&) {}}};
    const auto post = [&](const std::string& path, const std::string& body) {
        return device.answer({"POST", "/api/v1/integration/" + path, body}, bench_.clock()).status;
    };
    const auto since = [&] {
        return device.answer({"GET", "/api/v1/integration/time/status", ""}, bench_.clock()).body;
    };
    bench_.tick = [&](Time clock) { return device.tick(clock); };
    bench_.answer = [&](const types::SonarSettings&, Time stamp, Time) {
        types::DepthMap map;
        map.time = stamp;
        map.vertical_size = map.horizontal_size = 1;
        map.vertical_interval = map.horizontal_interval = {0};
        map.distances = {1};
        map.remissions = {1};
        device.follow(bench_.clock());
        device.setPing(map);
    };
    EXPECT_EQ(post("time/manual", R"({"now":"2030-01-01T00:00:00Z"})"), 204);
    EXPECT_EQ(post("acoustics/enabled", "true"), 204);
    bench_.wake();
    bench_.run();
    bench_.expectNoGap(bench_.asks(), 0.21);
    bench_.expectNoGap(images, 0.43);
    const bool only_back = std::ranges::all_of(GetParam().steps, [](double step) { return step <= 0; });
    if (!only_back) return;
    EXPECT_THAT(since(), testing::HasSubstr("2030-01-01T00:00:"));
}

INSTANTIATE_TEST_SUITE_P(Steps, SetClockTest,
                         testing::Values(Case{{}, false}, Case{{-600, -600, -0.4, -0.001}, false},
                                         Case{{-600, -600, -0.4, -0.001}, true}, Case{{600, 0.4, 0.001, 600}, false},
                                         Case{{600, -600, 1200, -1200}, true},
                                         Case{{decades, -decades, decades}, false},
                                         Case{{-decades + 5e7, decades, -60, 60}, true}));

}  // namespace
}  // namespace insonify::device
