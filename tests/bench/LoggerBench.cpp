// Measures whether the logger keeps up: pings of 512 x 1000 floats, 40 a second, through a deployment into a log.
//   logger_bench SECONDS FOLDER      prints JSON; exits with 1 if a ping is not in the log or the p99 of the
//   writing times is above the bound in the JSON. Writes 82 MB a second to disk.
#include <fmt/core.h>

#include <chrono>
#include <filesystem>

#include "components/framework/Deployment.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/logger/LoggerTask.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify {
namespace {

constexpr double period = 0.025;           // [s]
constexpr double write_p99_at_max = 1e-3;  // [s]

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/** Writes a ping in each cycle, and measures the time of writing and the interval of cycles. */
struct PingTask final : framework::TaskContext {
    using TaskContext::TaskContext;
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "512 beams of 1000 bins"};

    bool startHook() override {
        before_ = std::chrono::steady_clock::now();
        return true;
    }
    void updateHook() override {
        recordStage("interval", secondsSince(std::exchange(before_, std::chrono::steady_clock::now())));
        const auto sample = pool_.take();
        sample->resize(1000, 512);
        sample->time = now();
        const auto begin = std::chrono::steady_clock::now();
        ping.write(sample);
        recordStage("write", secondsSince(begin));
    }

private:
    framework::SamplePool<types::Sonar> pool_;
    std::chrono::steady_clock::time_point before_;
};

std::string getTimes(const framework::TaskContext& task, const char* stage, double scale) {
    const framework::Statistics& times = task.stages().at(stage);
    return fmt::format(R"({{"median": {:.3f}, "p99": {:.3f}, "max": {:.3f}}})", times.median() * scale,
                       times.p99() * scale, times.max() * scale);
}

int bench(double seconds, const std::filesystem::path& folder) {
    framework::Registry registry;
    logger::registerTasks(registry);
    registry.add<PingTask>("bench::PingTask", "a ping in each cycle");
    const std::string yaml = fmt::format(R"(
schedule: realtime
tasks:
  sonar: {{type: bench::PingTask, activity: {{period: {}}}}}
  log: {{type: logger::LoggerTask, properties: {{file: bench.0.log}}}}
connections:
  - {{from: sonar.ping, to: log.ping, policy: {{type: buffer, size: 256}}}}
)",
                                         period);
    framework::Deployment deployment(framework::DeploymentSpec::parse(yaml, "bench.yml"), registry, folder);
    deployment.configure();
    const std::atomic<bool> never{false};
    const framework::RunResult result = deployment.run({.duration_s = seconds}, never);
    for (const std::string& failure : result.failures) fmt::print(stderr, "{}\n", failure);
    deployment.cleanup();

    const auto log = folder / "bench.0.log";
    const size_t in_log = log::pocolog::Reader(log).samples().size();
    const uint64_t lost = deployment.losses().begin()->second;
    const framework::TaskContext& sonar = *deployment.task("sonar");
    fmt::print(R"({{"pings": {}, "expected": {:.0f}, "in_log": {}, "lost": {}, "megabytes_per_s": {:.1f}, )"
               R"("write_us": {}, "write_p99_at_most_us": {:.0f}, "interval_ms": {}, "logger_update_ms": {:.3f}}})"
               "\n",
               result.samples, seconds / period, in_log, lost,
               static_cast<double>(std::filesystem::file_size(log)) / 1e6 / result.wall_s,
               getTimes(sonar, "write", 1e6), write_p99_at_max * 1e6, getTimes(sonar, "interval", 1e3),
               deployment.task("log")->cycles().max() * 1e3);
    const bool slow = sonar.stages().at("write").p99() > write_p99_at_max;
    return result.failed() || in_log != result.samples || lost > 0 || slow ? 1 : 0;
}

}  // namespace
}  // namespace insonify

int main(int count, char** arguments) {
    if (count != 3) {
        fmt::print(stderr, "usage: logger_bench SECONDS FOLDER\n");
        return 2;
    }
    return insonify::bench(std::stod(arguments[1]), arguments[2]);
}
