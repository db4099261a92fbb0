#pragma once
#include "components/console/Action.hpp"

namespace insonify::command {

/** Runs the `insonify` command. Results are printed to stdout, diagnostics to stderr; nothing is thrown. Exit code: 0
 *  done; 1 failed while running; 2 wrong usage, file or configuration. */
int runCommandLine(int argc, char** argv);

using console::Action;

// Each function adds one command with its options to `app`; parsing that command sets `action`.
void addRunCommand(CLI::App& app, Action& action);
void addCheckCommand(CLI::App& app, Action& action);
void addPlanCommand(CLI::App& app, Action& action);
void addExplainCommand(CLI::App& app, Action& action);
void addDescribeCommand(CLI::App& app, Action& action);
void addExamplesCommand(CLI::App& app, Action& action);
void addInitCommand(CLI::App& app, Action& action);
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
