#include "components/deployer/CommandLine.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <iostream>

#include "components/deployer/Commands.hpp"
#include "types/ConfigError.hpp"

namespace insonify::deployer {
namespace {

constexpr int done = 0, failed = 1, wrong = 2;

int parseAndAct(CLI::App& app, Action& action, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {  // also how --help and --version end, with code 0
        return app.exit(error, std::cout, std::cerr) == 0 ? done : wrong;
    }
    return action();
}

int guarded(CLI::App& app, Action& action, int argc, char** argv) {
    try {
        return parseAndAct(app, action, argc, argv);
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics()) fmt::print(stderr, "{}\n", diagnostic.text());
        return wrong;
    } catch (const std::exception& error) {
        fmt::print(stderr, "insonify: {}\n", error.what());
        return failed;
    }
}

/** Results that could not be written are no results. */
bool flushed() { return std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout); }

}  // namespace

int runCommandLine(int argc, char** argv) {
    CLI::App app{"What an imaging sonar would hear, from a 3-D scene, in real time", "insonify"};
    app.set_version_flag("--version", INSONIFY_VERSION);
    app.require_subcommand(1);
    Action action;
    addInitCommand(app, action);
    addRunCommand(app, action);
    addCheckCommand(app, action);
    addPlanCommand(app, action);
    addDescribeCommand(app, action);
    addSceneCommand(app, action);
    addSchemaCommand(app, action);
    addLogCommand(app, action);
    addReplayCommand(app, action);
    addStudyCommand(app, action);
    addCompletionCommand(app, action);
    addManCommand(app, action);

    const int code = guarded(app, action, argc, argv);
    if (flushed()) return code;
    fmt::print(stderr, "insonify: the standard output cannot be written\n");
    return code == done ? failed : code;
}

}  // namespace insonify::deployer
