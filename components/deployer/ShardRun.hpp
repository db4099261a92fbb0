#pragma once
#include "components/deployer/RunCommand.hpp"

namespace insonify::deployer {

/** Makes a part of a run's pings, each of them as in the whole run, into a folder of its own within `options.out`, as
 *  ShardFolder.hpp says, and gives the exit code. One that is done is left as it is. Throws types::ConfigError before
 *  anything has started, where the deployment cannot be cut, too. */
int runShard(RunOptions options);

/** Throws types::ConfigError for each task that keeps what a shard cannot know, and in realtime. */
void refuseIndivisible(const framework::Deployment& deployment);

}  // namespace insonify::deployer
