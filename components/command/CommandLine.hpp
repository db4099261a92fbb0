#pragma once
#include <string>
#include <vector>

#include "components/console/Action.hpp"
#include "components/framework/config/DeploymentSpec.hpp"

namespace insonify::command {

/** Returns a command line in which each word between `--ros-args` and `--`, or the end, is an option
 *  `--ros-args=WORD`, and an option `--NAME=` without a value has an empty word as value. */
std::vector<std::string> withRosWords(const std::vector<std::string>& words);

/** Applies the words after `--ros-args` to a deployment, by the rules of ROS 2: `-r FROM:=TO` (`--remap`) for topics,
 *  `-r __ns:=/auv2`, `-r __node:=x`, `-p TASK.PROPERTY:=VALUE` (`--param`), `--params-file FILE` with the block
 *  `ros__parameters` of each node whose name or wildcard matches a node of the deployment. `NODE:` before a name
 *  restricts it to one node. Of several values the last applies; `use_sim_time` is ignored.
 *
 *  Diagnostics are added to the spec's. Throws types::ConfigError for an argument that is not one of these, or an
 *  unreadable parameter file. */
void applyRosArguments(const std::vector<std::string>& words, framework::DeploymentSpec& spec);

/** Runs the `insonify` command. Results are printed to stdout, diagnostics to stderr; nothing is thrown. Exit code: 0
 *  done; 1 failed while running; 2 wrong usage, file or configuration.
 *  @param commit that --version prints; empty: not known. */
int runCommandLine(int argc, char** argv, const char* commit);

using console::Action;

// Each function adds one command with its options to `app`; parsing that command sets `action`.
void addRunCommand(CLI::App& app, Action& action);
void addCheckCommand(CLI::App& app, Action& action);
void addPlanCommand(CLI::App& app, Action& action);
void addExplainCommand(CLI::App& app, Action& action);
void addDescribeCommand(CLI::App& app, Action& action);
void addExamplesCommand(CLI::App& app, Action& action);
void addInitCommand(CLI::App& app, Action& action);
/** Adds the names of sonars to the help of `init`; reads their table, which the start of other commands does not. */
void describeSonars(CLI::App& init);
void addGazeboCommand(CLI::App& app, Action& action);
void addLogCommand(CLI::App& app, Action& action);
void addReplayCommand(CLI::App& app, Action& action);
void addSceneCommand(CLI::App& app, Action& action);
void addBeamCommand(CLI::App& app, Action& action);
void addWaterCommand(CLI::App& app, Action& action);
void addBackscatterCommand(CLI::App& app, Action& action);
void addLibrariesCommand(CLI::App& app, Action& action);
void addSchemaCommand(CLI::App& app, Action& action);
void addCompletionCommand(CLI::App& app, Action& action);
void addManCommand(CLI::App& app, Action& action);

}  // namespace insonify::command
