#pragma once
#include <string>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"

namespace insonify::command {

/** Returns a command line in which each word between `--ros-args` and `--`, or the end, is an option
 *  `--ros-args=WORD`. */
std::vector<std::string> withRosWords(const std::vector<std::string>& words);

/** Applies the words after `--ros-args` to a deployment, by the rules of ROS 2: `-r FROM:=TO` (`--remap`) for topics,
 *  `-r __ns:=/auv2`, `-r __node:=x`, `-p TASK.PROPERTY:=VALUE` (`--param`), `--params-file FILE` with the block
 *  `ros__parameters` of each node whose name or wildcard matches a node of the deployment. `NODE:` before a name
 *  restricts it to one node. Of several values the last applies; `use_sim_time` is ignored.
 *
 *  Diagnostics are added to the spec's. Throws types::ConfigError for an argument that is not one of these, or an
 *  unreadable parameter file. */
void applyRosArguments(const std::vector<std::string>& words, framework::DeploymentSpec& spec);

}  // namespace insonify::command
