// Measures the share of requested pings that a driver of an Oculus receives over a TCP connection: 512 beams x 1000
// bins of 16 bits to 10 m, 40 a second, in the harbour.
//   oculus_bench SECONDS            prints JSON
#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <thread>

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

framework::Registry registry() {
    framework::Registry all;
    pose::registerTasks(all);
    scene::registerTasks(all);
    sonar::registerTasks(all);
    noise::registerTasks(all);
    receiver::registerTasks(all);
    device::registerTasks(all);
    return all;
}

/** Counts the pings that arrive in this number of seconds, and missing pings by their numbers. */
void count(uint16_t port, double seconds) {
    test::OculusDriver driver(port);
    driver.send(device::bytesOf(device::OculusFire{.rate = 2, .flags = 0x4B, .range = 10}));
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

void bench(double seconds) {
    auto spec = framework::DeploymentSpec::load(test::sourceFile("deploy/hil_oculus.yml"));
    spec.set("device.port=0");
    framework::Registry tasks = registry();
    framework::Deployment deployment(spec, tasks);
    deployment.configure();
    const uint16_t port = dynamic_cast<device::OculusTask&>(*deployment.task("device")).port();
    std::atomic<bool> stop{false};
    std::thread running([&] { deployment.run({}, stop); });
    count(port, seconds);
    stop = true;
    running.join();
}

}  // namespace
}  // namespace insonify

int main(int count, char** words) {
    if (count != 2) {
        fmt::print(stderr, "oculus_bench SECONDS\n");
        return 2;
    }
    insonify::bench(std::atof(words[1]));
}
