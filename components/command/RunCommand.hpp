#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/console/Action.hpp"
#include "components/console/Shard.hpp"
#include "components/framework/Deployment.hpp"

namespace insonify::command {

/** The options of `run` and `replay`. */
struct RunOptions {
    std::string deployment;             ///< File.
    std::string out;                    ///< Folder for the run's files; empty: a new one.
    std::string health;                 ///< File or port for the state of the run, see Supervision; empty: neither.
    std::string summary;                ///< File for the summary in JSON; empty: none.
    std::vector<std::string> set;       ///< "task.property.path=value"
    std::vector<std::string> recorded;  ///< As `set`, below it: settings of the log that is rendered again.
    std::vector<std::string> ros;       ///< The words after `--ros-args`.
    std::vector<std::string> calls;     ///< "task.operation=argument,...", called in this order after configuring.
    framework::RunLimits limits;
    std::optional<uint64_t> seed;  ///< None or 0: tasks keep the seeds of the file.
    bool quiet = false, verbose = false, stats = false;
    std::optional<console::Shard> shard;  ///< The part of the run to make; none: the whole run.
    /** Called after each instant of a lockstep run. */
    std::function<void(framework::Deployment&, const framework::Progress&)> progress;

    /** Adds all options except `deployment`. */
    void addTo(CLI::App& command);
    /** Adds `DEPLOYMENT` and `--set`, for commands that run nothing. */
    void addDeploymentTo(CLI::App& command);
};

/** Origin of values in RunOptions::recorded. */
inline constexpr const char* recorded_origin = "--rerender";

/** Returns the deployment with `recorded`, then `--set` and then `--ros-args` applied to it. */
framework::DeploymentSpec loadSpec(const RunOptions& options);

/** Returns "notice: NAME..." or "warning: NAME...". */
std::string labelled(const types::Notice& notice, const std::string& name = "");

/** Makes and runs a deployment, prints the result and returns the exit code. Throws types::ConfigError, with every
 *  diagnostic, before anything has started.
 *  @param folder receives the folder of the run's files, unless null. */
int runDeployment(framework::DeploymentSpec spec, const RunOptions& options, std::filesystem::path* folder = nullptr);

/** Makes a part of a run's pings, each equal to that of the whole run, in its own folder within `options.out`
 *  (ShardFolder.hpp), and returns the exit code. A finished shard is left unchanged. Throws types::ConfigError before
 *  anything has started, also where the deployment cannot be cut. */
int runShard(RunOptions options);

/** Throws types::ConfigError for each task whose state a shard cannot know, and in realtime. */
void refuseIndivisible(const framework::Deployment& deployment);

}  // namespace insonify::command
