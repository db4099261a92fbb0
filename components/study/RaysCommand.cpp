// insonify study rays DEPLOYMENT: for scripts/bench
#include <memory>

#include "components/command/Json.hpp"
#include "components/study/RayTimes.hpp"
#include "components/study/StudyCommand.hpp"

namespace insonify::study {
namespace {

struct Options {
    std::string deployment;
    uint64_t ping = 1;
    int pings = 30;
};

int runStudy(const Options& options, const FindSonar& sonarAt) {
    const SonarAt sonar = sonarAt(options.deployment, options.ping);
    const RayTimes times = timeRays(sonar.config, sonar.snapshot, options.pings);
    command::print({{"rays", times.rays},
                    {"met", times.met},
                    {"alone_median_ms", times.alone_median_ms},
                    {"alone_p99_ms", times.alone_p99_ms},
                    {"ping_median_ms", times.ping_median_ms},
                    {"ping_p99_ms", times.ping_p99_ms}});
    return 0;
}

}  // namespace

void addRaysStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = study.add_subcommand("rays", "Times as many rays (Embree) as a sonar's quality asks for");
    command->group("");  // no part of what is documented
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file with a sonar")->required();
    command->add_option("--ping", options->ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    command->add_option("--pings", options->pings, "timed of each kind")->check(CLI::Range(1, 100000));
    command->callback(
        [options, sonarAt, &action] { action = [options, sonarAt] { return runStudy(*options, sonarAt); }; });
}

}  // namespace insonify::study
