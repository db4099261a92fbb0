#pragma once
#include "components/command/RunCommand.hpp"

namespace insonify::command {

/** Makes a part of a run's pings, each equal to that of the whole run, in its own folder within `options.out`
 *  (ShardFolder.hpp), and returns the exit code. A finished shard is left unchanged. Throws types::ConfigError before
 *  anything has started, also where the deployment cannot be cut. */
int runShard(RunOptions options);

/** Throws types::ConfigError for each task whose state a shard cannot know, and in realtime. */
void refuseIndivisible(const framework::Deployment& deployment);

}  // namespace insonify::command
