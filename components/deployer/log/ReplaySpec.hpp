#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/framework/config/DeploymentSpec.hpp"
#include "components/log/PoseSources.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** How a log is replayed. */
struct ReplayOptions {
    std::string log;        ///< File.
    double from = 0;        ///< After its first stamp [s].
    bool loop = false;      ///< Repeats without end.
    bool rerender = false;  ///< Renders the log's pings again from its poses; otherwise plays the log's pings.
    bool outside = false;   ///< With the tasks that communicate outside the deployment.
    std::vector<log::PoseSource> poses = {};                 ///< Streams that are made from others of the log.
    types::WorldFrame world_frame = types::WorldFrame::Enu;  ///< Of poses in messages of other programs.
};

/** Returns the tasks that communicate outside the deployment. */
std::set<std::string> outsideTasks(const framework::DeploymentSpec& spec);

/** Returns the stream of poses that triggers a sonar when its pings are rendered again: the pose of each recorded ping.
 *  Empty: the log has no such stream. */
std::string poseStream(const log::Reader& log, const std::string& sonar);

/** Returns the deployment in lockstep on the log's time, with the log in place of the tasks that it has streams of.
 *  When rendering again, it replaces only tasks that neither write nor read pings, and each sonar pings at the log's
 *  poses of its pings, if the log has them and no poses are chosen. The log has the streams of `poses` already. Throws
 * types::ConfigError when that leaves nothing to play. */
framework::DeploymentSpec replaying(framework::DeploymentSpec spec, const log::Reader& log,
                                    const ReplayOptions& options);

/** Returns the task that writes a stream, whose name may be an alias. */
std::string findWriter(const framework::DeploymentSpec& spec, const std::string& stream);

/** Returns the ports whose poses place the bodies of the deployment's sonars: those that lead to `pose` of its scenes,
 *  by their aliases where they have one. */
std::vector<std::string> bodyPorts(const framework::DeploymentSpec& spec);

/** Whether the log has a stream of a task of the deployment. */
bool hasStream(const framework::DeploymentSpec& spec, const log::Reader& log);

/** Returns the log's streams of pings that a task of the deployment writes. */
std::vector<std::string> pingStreams(const log::Reader& log, const framework::DeploymentSpec& spec);

/** Adds a logger that writes these ports, or aliases of ports, to a file. */
void addLogger(framework::DeploymentSpec& spec, const std::vector<std::string>& ports, const std::string& file);

}  // namespace insonify::deployer
