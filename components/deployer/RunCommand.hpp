#pragma once
#include <CLI/App.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/command/Shard.hpp"
#include "components/framework/Deployment.hpp"

namespace insonify::deployer {

/** What `run` and `replay` can be told. */
struct RunOptions {
    std::string deployment;          ///< File.
    std::string out;                 ///< Folder for what the run writes; empty: a fresh one.
    std::string summary;             ///< File for the summary in JSON; empty: none.
    std::vector<std::string> set;    ///< "task.property.path=value"
    std::vector<std::string> ros;    ///< The words after `--ros-args`.
    std::vector<std::string> calls;  ///< "task.operation=argument,...", made in this order once all is configured.
    framework::RunLimits limits;
    std::optional<uint64_t> seed;  ///< None or 0: tasks keep the seeds of the file.
    bool quiet = false;
    std::optional<command::Shard> shard;  ///< Part of the run that is made; none: all of it.
    /** Called after each instant of a lockstep run. */
    std::function<void(framework::Deployment&, const framework::Progress&)> progress;

    /** All but `deployment`. */
    void addTo(CLI::App& command);
};

/** The deployment as written, with `--set` and `--ros-args` laid over it, in this order. */
framework::DeploymentSpec loadSpec(const RunOptions& options);

/** Makes and runs a deployment as asked, tells how it went, and gives the exit code. Throws types::ConfigError, with
 *  every diagnostic, before anything has started.
 *  @param folder where its files went; null when nobody wants to know. */
int runDeployment(framework::DeploymentSpec spec, const RunOptions& options, std::filesystem::path* folder = nullptr);

std::string refuseUnlessWhole(const std::string& text);     ///< Why it is no uint64_t; empty when it is.
std::string refuseUnlessPositive(const std::string& text);  ///< Why it is no number above 0; empty when it is.

}  // namespace insonify::deployer
