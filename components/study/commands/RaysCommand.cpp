// insonify study rays DEPLOYMENT: for scripts/bench
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "components/console/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/oracles/EmbreeTracer.hpp"

namespace insonify::study {
namespace {

struct RaysOptions {
    std::string deployment;
    uint64_t ping = 1;
    int pings = 30;
};

/** Times of ray tracing (EmbreeTracer) with the number of rays that a sonar's quality requires, for comparison with a
 *  renderer. */
struct RayTimes {
    size_t rays = 0, met = 0;                      ///< Rays traced in a ping, and those that hit something [1].
    double alone_median_ms = 0, alone_p99_ms = 0;  ///< Primary rays only [ms].
    double ping_median_ms = 0, ping_p99_ms = 0;    ///< With their energies in bins [ms].
};

/** Returns the times of `pings` calls after a first call, in ascending order [ms]. */
std::vector<double> sortedTimes(int pings, const auto& work) {
    using Clock = std::chrono::steady_clock;
    work();
    std::vector<double> times;
    for (int i = 0; i < pings; ++i) {
        const Clock::time_point start = Clock::now();
        work();
        times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    std::ranges::sort(times);
    return times;
}

double share(const std::vector<double>& sorted, double part) {
    return sorted[static_cast<size_t>(std::ceil(part * static_cast<double>(sorted.size()))) - 1];
}

/** Times `pings` pings of each kind after a first ping, without building the tree. `config` as for EmbreeTracer. */
RayTimes timeRays(const sonar::SonarConfig& config, const types::Snapshot& scene, int pings) {
    EmbreeTracer tracer(scene);
    tracer.prepare(config);
    RayTimes result;
    result.rays = static_cast<size_t>(config.rows()) * static_cast<size_t>(config.columnsPerBeam() * config.beams());
    const auto alone = sortedTimes(pings, [&] { result.met = tracer.traceOnly(scene.sonar); });
    std::vector<float> energies;
    const auto whole = sortedTimes(pings, [&] { tracer.render(scene.sonar, energies); });
    result.alone_median_ms = share(alone, 0.5), result.alone_p99_ms = share(alone, 0.99);
    result.ping_median_ms = share(whole, 0.5), result.ping_p99_ms = share(whole, 0.99);
    return result;
}

int runStudy(const RaysOptions& options) {
    const deployer::SonarAt sonar = deployer::sonarAt(options.deployment, options.ping);
    const RayTimes times = timeRays(sonar.config, sonar.snapshot, options.pings);
    console::print({{"rays", times.rays},
                    {"met", times.met},
                    {"alone_median_ms", times.alone_median_ms},
                    {"alone_p99_ms", times.alone_p99_ms},
                    {"ping_median_ms", times.ping_median_ms},
                    {"ping_p99_ms", times.ping_p99_ms}});
    return 0;
}

}  // namespace

void addRaysStudy(CLI::App& study, console::Action& action) {
    const auto options = std::make_shared<RaysOptions>();
    CLI::App* command =
        study.add_subcommand("rays", "Times ray tracing (Embree) with the number of rays of a sonar's quality");
    command->group("");  // not documented
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file with a sonar")->required();
    command->add_option("--ping", options->ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    command->add_option("--pings", options->pings, "pings timed of each kind")->check(CLI::Range(1, 100000));
    command->callback([options, &action] { action = [options] { return runStudy(*options); }; });
}

}  // namespace insonify::study
