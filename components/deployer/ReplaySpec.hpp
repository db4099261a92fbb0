#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** How a log is played. */
struct ReplayOptions {
    std::string log;        ///< File.
    double from = 0;        ///< After its first stamp [s].
    bool loop = false;      ///< On and on.
    bool rerender = false;  ///< Its poses drive the sonars, which sound again; otherwise its pings are played.
    bool outside = false;   ///< With the tasks that talk to others than their deployment.
};

/** Tasks that talk to others than their deployment. */
std::set<std::string> outsideTasks(const framework::DeploymentSpec& spec);

/** The stream that drives a sonar whose pings are rendered again: where each of them was rendered; empty: the log has
 *  no such stream. */
std::string poseStreamOf(const log::Reader& log, const std::string& sonar);

/** The deployment, in lockstep on the log's time, with the log in the place of the tasks that it has streams of; where
 *  it is rendered again, only of those that have nothing to do with pings, and each sonar pings where the log says that
 *  it did, if it does. Throws types::ConfigError when that leaves nothing to play. */
framework::DeploymentSpec replaying(framework::DeploymentSpec spec, const log::Reader& log,
                                    const ReplayOptions& options);

/** The task that writes what is in a stream, whose name may be an alias. */
std::string writerOf(const framework::DeploymentSpec& spec, const std::string& stream);

/** Streams of pings in the log that a task of the deployment writes. */
std::vector<std::string> pingStreams(const log::Reader& log, const framework::DeploymentSpec& spec);

/** Adds a logger that writes these ports, or aliases of ports, to a file. */
void addLogger(framework::DeploymentSpec& spec, const std::vector<std::string>& ports, const std::string& file);

}  // namespace insonify::deployer
