#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/ShardFolder.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/execution/Activity.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

using console::Json;
using framework::Deployment;
using framework::DeploymentSpec;

/** Returns the inputs that determine a run's files, in addition to the files that the deployment names. */
Json getRun(const RunOptions& options, const DeploymentSpec& spec) {
    return {{"insonify", INSONIFY_VERSION},
            {"deployment", std::filesystem::path(spec.file).filename().string()},
            {"deployment_sha256", types::sha256(spec.text)},
            {"set", options.set},
            {"seed", options.seed.value_or(0)},
            {"pings", options.limits.samples},
            {"duration_s", options.limits.duration_s}};
}

/** Returns why a task cannot be cut; empty: it can. */
std::string whyWhole(const framework::TaskContext& task, const std::string& type) {
    const auto* const divisible = dynamic_cast<const framework::Divisible*>(&task);
    if (!divisible)
        return fmt::format(
            "is a {}, whose state depends on earlier pings, which a shard does not know; omit it, and "
            "run it on the joined log (insonify log cut, insonify replay)",
            type);
    const auto isRead = [](const auto* port) { return port->connected(); };
    if (task.activity().settings().periodic() && std::ranges::any_of(task.inputs(), isRead))
        return "has a period and reads from other tasks, and so may use samples from before the shard; omit the period";
    return divisible->indivisible();
}

bool stopped(const framework::RunResult& result) { return result.failed() || stopOnSignals(); }

/** Returns the number of pings of the whole run, by a run without rendering. */
uint64_t rehearsedPings(const DeploymentSpec& spec, const RunOptions& options, const std::filesystem::path& folder) {
    framework::Registry registry = coreTasks();
    Deployment deployment(spec, registry, folder, options.seed.value_or(0));
    refuseIndivisible(deployment);
    deployment.configure();
    framework::RunLimits limits = options.limits;
    limits.shard = {.first = std::numeric_limits<uint64_t>::max()};
    const framework::RunResult result = deployment.run(limits, stopOnSignals());
    if (stopped(result))
        throw std::runtime_error(result.failed() ? "rehearsal: " + result.failures.front() : "interrupted");
    return result.rehearsed;
}

/** Returns the range of a run's pings that its shard makes; the last shard includes all that follows the last ping. */
framework::RunLimits::Shard getPings(const console::Shard& shard, uint64_t pings, const std::string& file) {
    if (pings < shard.count)
        throw types::ConfigError(
            file, "--shard",
            fmt::format("is {}; the run has {} pings, and so {} shards at most", shard.text(), pings, pings));
    const auto [first, last] = shard.block(pings);
    framework::RunLimits::Shard made;
    made.first = first;
    if (shard.index + 1 < shard.count) made.last = last;
    return made;
}

/** The index next to a pocolog file has the time at which the log file was written, the only difference between
 *  machines. It is made on demand. */
void removeIndices(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> indices;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        std::filesystem::path log = entry.path();
        if (log.extension() == ".idx" && std::filesystem::exists(log.replace_extension(".log")))
            indices.push_back(entry.path());
    }
    for (const auto& index : indices) std::filesystem::remove(index);
}

void report(const RunOptions& options, const Json& manifest, const std::filesystem::path& folder, const char* how) {
    if (options.quiet) return;
    console::printResult("shard {}: {} pings from {} on, of {}; {} files {} {}\n", options.shard->text(),
                         manifest["pings"].dump(), manifest["first_ping"].dump(), manifest["pings_of_run"].dump(),
                         manifest["files"].size(), how, folder.string());
}

}  // namespace

void refuseIndivisible(const Deployment& deployment) {
    const DeploymentSpec& spec = deployment.spec();
    types::Diagnostics diagnostics;
    const auto refuse = [&](const std::string& path, const std::string& why) {
        diagnostics.push_back({path, why + " (--shard)"});
        diagnostics.back().file = spec.file;
    };
    if (!spec.lockstep) refuse("schedule", "is realtime, whose pings depend on the wall clock; must be lockstep");
    for (const auto& task : deployment.tasks())
        if (const std::string why = whyWhole(*task, spec.task(task->name())->type); !why.empty())
            refuse("tasks." + task->name(), why);
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
}

int runShard(RunOptions options) {
    if (options.out.empty()) throw types::ConfigError("", "--out", "is missing; all shards of a run share a folder");
    DeploymentSpec spec = loadSpec(options);
    for (const std::string& assignment : pinnedRays(spec)) spec.set(assignment);
    ShardFolder folder(options.out, *options.shard, getRun(options, spec));
    if (const auto manifest = folder.done()) {
        report(options, *manifest, folder.path(), "existed already, in");
        return 0;
    }
    options.out = folder.begin().string();
    const uint64_t pings =
        options.limits.samples > 0 ? options.limits.samples : rehearsedPings(spec, options, options.out);
    const auto made = getPings(*options.shard, pings, spec.file);
    options.limits.shard = made;
    const int code = runDeployment(spec, options);
    if (code != 0) return code;
    if (stopOnSignals()) throw std::runtime_error("interrupted; nothing is kept of the shard");
    removeIndices(options.out);
    const auto block = options.shard->block(pings);
    const Json more = {{"first_ping", made.first}, {"pings", block.last - block.first}, {"pings_of_run", pings}};
    report(options, folder.finish(more), folder.path(), "in");
    return 0;
}

}  // namespace insonify::command
