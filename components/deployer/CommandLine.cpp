#include "components/deployer/CommandLine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>

#include "components/deployer/Pipeline.hpp"
#include "types/ConfigError.hpp"
#include "types/DidYouMean.hpp"
#include "types/Reason.hpp"

namespace insonify::deployer {
namespace {

constexpr int done = 0, failed = 1, bad_input = 2;

/** Names of the commands, or of the options, that may stand after `command`. */
std::vector<std::string> namesAfter(const CLI::App& command, bool of_options) {
    std::vector<std::string> names;
    for (const CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; }))
        if (!of_options) names.push_back(each->get_name());
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            if (of_options) names.push_back("--" + name);
    return names;
}

/** "did you mean run?" for the first word that is no command or option where one is wanted; empty when none is near. */
std::string meantWord(const CLI::App& app, int argc, char** argv) {
    const CLI::App* command = &app;
    for (int i = 1; i < argc; ++i) {
        const std::string word(argv[i]), name = word.substr(0, word.find('='));
        const bool is_option = word.starts_with("--");
        const std::vector<std::string> names = namesAfter(*command, is_option);
        if (std::ranges::count(names, name) > 0) {
            if (!is_option) command = command->get_subcommand(name);
            continue;
        }
        if (std::string near = types::didYouMean(name, names); !near.empty()) return near.substr(0, near.size() - 1);
    }
    return "";
}

int parseAndAct(CLI::App& app, Action& action, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {  // also how --help and --version end, with code 0
        if (app.exit(error, std::cout, std::cerr) == 0) return done;
        if (const std::string near = meantWord(app, argc, argv); !near.empty()) fmt::print(stderr, "{}\n", near);
        return bad_input;
    }
    return action();
}

int guarded(CLI::App& app, Action& action, int argc, char** argv) {
    try {
        return parseAndAct(app, action, argc, argv);
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics()) fmt::print(stderr, "{}\n", diagnostic.text());
        return bad_input;
    } catch (const std::exception& error) {
        fmt::print(stderr, "insonify: {}\n", types::reasonOf(error));
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
    addBeamCommand(app, action);
    addWaterCommand(app, action);
    addBackscatterCommand(app, action);
    addDeviceCommand(app, action);
    addSchemaCommand(app, action);
    addLogCommand(app, action);
    addReplayCommand(app, action);
    addDatasetCommand(app, action);
    study::addCommand(app, action, sonarAt, codedPingAt);
    addCompletionCommand(app, action);
    addManCommand(app, action);

    const int code = guarded(app, action, argc, argv);
    if (flushed()) return code;
    fmt::print(stderr, "insonify: the standard output cannot be written\n");
    return code == done ? failed : code;
}

}  // namespace insonify::deployer
