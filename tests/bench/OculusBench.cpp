// Measures the share of requested pings that a driver of an Oculus receives over a TCP connection: 512 beams x 1000
// bins of 16 bits to 10 m, 40 a second, in the harbour. With a scene: the processing time of the sonar's pings, 10 a
// second, while the driver changes a setting each second.
//   oculus_bench SECONDS [SCENE]    prints JSON
#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "components/device/DeviceTask.hpp"
#include "components/device/oculus/OculusTask.hpp"
#include "components/framework/Deployment.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "tests/support/OculusDriver.hpp"
#include "tests/support/Paths.hpp"

namespace insonify {
namespace {

using Clock = std::chrono::steady_clock;

/** The times that a sonar worked on its pings, without waiting for their echoes [ms]. */
class PingTimes {
public:
    void add(double ms) {
        const std::lock_guard alone(mutex_);
        all_.push_back(ms);
    }
    std::vector<double> take() {
        const std::lock_guard alone(mutex_);
        return std::exchange(all_, {});
    }

private:
    std::mutex mutex_;
    std::vector<double> all_;
};
PingTimes ping_times;

/** A sonar that adds the cycles with a ping to `ping_times`. */
class TimedSonarTask final : public sonar::PingTask {
public:
    using PingTask::PingTask;
    framework::Properties<sonar::SonarConfig> config{this};
    sonar::SonarConfig sonarConfig() const override { return config->fan(); }

protected:
    void updateHook() override {
        if (std::exchange(has_pinged_, false)) ping_times.add(1e3 * timing().lastCycle());
        PingTask::updateHook();
    }
    void writeMore(const types::Sonar&, const types::Pose&) override { has_pinged_ = true; }

private:
    bool has_pinged_ = false;  ///< Whether the last cycle had a ping.
};

framework::Registry registry() {
    framework::Registry all;
    pose::registerTasks(all);
    scene::registerTasks(all);
    sonar::registerTasks(all);
    noise::registerTasks(all);
    receiver::registerTasks(all);
    device::registerTasks(all);
    all.add<TimedSonarTask>("sonar::SonarTask", "a fan whose pings are timed");
    return all;
}

/** Counts the pings that arrive in this number of seconds, and missing pings by their numbers. */
void count(uint16_t port, double seconds) {
    test::OculusDriver driver(port);
    driver.send(device::toBytes(device::OculusFire{.rate = 2, .flags = 0x4B, .range = 10}));
    for (int i = 0; i < 20; ++i) driver.nextPing();  // shaders are compiled, the quality is chosen
    const auto begin = Clock::now();
    const uint32_t first = driver.nextPing().number;
    uint32_t last = first;
    size_t received = 0, bytes = 0;
    for (; Clock::now() - begin < std::chrono::duration<double>(seconds); ++received) {
        const device::OculusResult ping = driver.nextPing();
        last = ping.number;
        bytes += ping.message_size;
    }
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    const double asked = 40 * elapsed;
    fmt::print(
        "{{\"seconds\": {:.2f}, \"asked\": {:.0f}, \"received\": {}, \"made\": {}, \"share\": {:.3f}, \"mb_per_s\": "
        "{:.1f}}}\n",
        elapsed, asked, received, last - first, static_cast<double>(received) / asked,
        static_cast<double>(bytes) / elapsed / 1e6);
}

/** A setting that a driver changes each second: the requests, in turn. */
struct Change {
    const char* name;
    std::vector<device::OculusFire> requests;
};

std::vector<Change> changes() {
    using device::OculusFire;
    constexpr uint8_t flags = 0x4B;
    const auto ranges = {5.0, 30.0, 12.0, 20.0};
    Change range{"range", {}}, gain{"gain", {}}, frequency{"frequency", {}}, speed{"speed of sound", {}};
    for (const double each : ranges) range.requests.push_back({.flags = flags, .range = each});
    for (const double each : {20.0, 80.0}) gain.requests.push_back({.flags = flags, .range = 20, .gain_percent = each});
    for (const uint8_t each : {1, 2}) frequency.requests.push_back({.mode = each, .flags = flags, .range = 20});
    for (const double each : {1450.0, 1540.0})
        speed.requests.push_back({.flags = flags, .range = 20, .speed_of_sound = each});
    return {range, gain, frequency, speed};
}

/** Prints the sonar's times of pings [ms] while a driver changes a setting each second: the median of all, and the
 *  longest among the first four pings of each second. */
void change(uint16_t port, double seconds) {
    test::OculusDriver driver(port);
    driver.send(device::toBytes(device::OculusFire{.flags = 0x4B, .range = 20}));
    for (int i = 0; i < 30; ++i) driver.nextPing();  // shaders are compiled, the quality is chosen
    std::string rows;
    for (const Change& changed : changes()) {
        std::vector<double> all, first;
        ping_times.take();
        for (size_t second = 0; static_cast<double>(second) < seconds; ++second) {
            driver.send(device::toBytes(changed.requests[second % changed.requests.size()]));
            for (int ping = 0; ping < 10; ++ping) driver.nextPing();
            const std::vector<double> times = ping_times.take();
            all.insert(all.end(), times.begin(), times.end());
            first.insert(first.end(), times.begin(), times.begin() + std::min<ptrdiff_t>(4, std::ssize(times)));
        }
        std::ranges::sort(all);
        const double median = all[all.size() / 2], longest = *std::ranges::max_element(first);
        rows += fmt::format(
            "{}{{\"changed\": \"{}\", \"pings\": {}, \"median_ms\": {:.2f}, \"after_change_ms\": {:.2f}, "
            "\"longest_ms\": {:.2f}}}",
            rows.empty() ? "" : ", ", changed.name, all.size(), median, longest, all.back());
    }
    fmt::print("[{}]\n", rows);
}

void bench(double seconds, const std::string& scene) {
    auto spec = framework::DeploymentSpec::load(test::sourceFile("deploy/hil_oculus.yml"));
    spec.set("device.port=0");
    if (!scene.empty())
        for (const std::string& each :
             {"scene.file=" + scene, std::string("sonar.quality={budget_ms: null, target_error: 0.05}"),
              std::string("vehicle.file=null"), std::string("vehicle.waypoints=[{time: 0, position: [0, 0, 0]}]")})
            spec.set(each);
    framework::Registry tasks = registry();
    framework::Deployment deployment(spec, tasks);
    deployment.configure();
    const uint16_t port = dynamic_cast<device::OculusTask&>(*deployment.task("device")).port();
    std::atomic<bool> stop{false};
    std::thread running([&] { deployment.run({}, stop); });
    if (scene.empty())
        count(port, seconds);
    else
        change(port, seconds);
    stop = true;
    running.join();
}

}  // namespace
}  // namespace insonify

int main(int count, char** words) {
    if (count != 2 && count != 3) {
        fmt::print(stderr, "oculus_bench SECONDS [SCENE]\n");
        return 2;
    }
    insonify::bench(std::atof(words[1]), count == 3 ? words[2] : "");
}
