#pragma once
#include <string>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"

namespace insonify::deployer {

/** A command line in which each word between `--ros-args` and `--`, or the end, is an option `--ros-args=WORD`. */
std::vector<std::string> withRosWords(const std::vector<std::string>& words);

/** Lays what follows `--ros-args` over a deployment, as ROS 2 has it: `-r FROM:=TO` (`--remap`) for topics,
 *  `-r __ns:=/auv2`, `-r __node:=x`, `-p TASK.PROPERTY:=VALUE` (`--param`), `--params-file FILE` with the block
 *  `ros__parameters` of each node whose name or wildcard fits one of the deployment's. `NODE:` before a name confines
 *  it to one node. Of several values the last holds; `use_sim_time` is passed over.
 *
 *  Diagnostics go to the spec's. Throws types::ConfigError for what is no such argument or no parameter file. */
void applyRosArguments(const std::vector<std::string>& words, framework::DeploymentSpec& spec);

}  // namespace insonify::deployer
