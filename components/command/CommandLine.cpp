#include "components/command/CommandLine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <sstream>

#include "components/console/Console.hpp"
#include "components/framework/ConfigReader.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "types/ConfigError.hpp"
#include "types/DidYouMean.hpp"
#include "types/Reason.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

constexpr int done = 0, failed = 1, bad_input = 2;

/** Names of the commands, or of the options, that may follow `command`. */
std::vector<std::string> namesAfter(const CLI::App& command, bool of_options) {
    std::vector<std::string> names;
    for (const CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; }))
        if (!of_options) names.push_back(each->get_name());
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            if (of_options) names.push_back("--" + name);
    return names;
}

/** Returns "did you mean run?" for the first word that should be a command or option but is not; empty: no similar
 *  name. */
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

/** Returns "there is no command rnu; did you mean run? known: ..." for the first word that should be a command but is
 *  not; empty: each is a command. */
std::string unknownCommand(const CLI::App& app, int argc, char** argv) {
    const CLI::App* command = &app;
    for (int i = 1; i < argc && command->get_require_subcommand_min() > 0; ++i) {
        const std::string word(argv[i]);
        if (word.starts_with("-")) return "";
        const std::vector<std::string> names = namesAfter(*command, false);
        if (std::ranges::count(names, word) == 0)
            return "there is no command " + word + "; " + framework::suggestion(word, names);
        command = command->get_subcommand(word);
    }
    return "";
}

/** Returns what is wrong with an option's value, in place of the parser's "Could not convert" and "At Most 1 required";
 *  empty: the parser's text is clear. */
std::string wrongValue(const std::string& text) {
    static const std::string conversion = "Could not convert: ", between = " = ", twice = ": At Most 1 required";
    if (const size_t at = text.find(twice); at != text.npos)
        return text.substr(0, at) + ": is given more than once; once is allowed";
    const size_t equals = text.find(between);
    if (!text.starts_with(conversion) || equals == text.npos) return "";
    const std::string name = text.substr(conversion.size(), equals - conversion.size());
    const std::string given = text.substr(equals + between.size());
    const bool is_number = !given.empty() && given.find_first_not_of("+-.0123456789eE") == given.npos;
    return name + ": is " + given + "; must be a " + (is_number ? "whole number" : "number");
}

/** Returns a hint at settings after a `--set` that are not its own: `--set a.b=1 c.d=2`; empty: there are none. */
std::string settingWithoutSet(int argc, char** argv) {
    for (int i = 3; i < argc; ++i)
        if (std::string(argv[i - 2]) == "--set" && argv[i][0] != '-' &&
            std::string(argv[i]).find('=') != std::string::npos)
            return fmt::format("each setting has a --set of its own: --set {} --set {}", argv[i - 1], argv[i]);
    return "";
}

/** Whether the words end where a command must follow, as in `insonify` and `insonify log`. */
bool asksForCommand(const CLI::App& app, int argc) {
    const CLI::App* command = &app;
    int words = 1;
    for (; !command->get_subcommands().empty(); ++words) command = command->get_subcommands().front();
    return words == argc && command->get_require_subcommand_min() > 0;
}

int parseAndAct(CLI::App& app, Action& action, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {  // --help and --version also end here, with code 0
        if (const std::string unknown = error.get_exit_code() == 0 ? "" : unknownCommand(app, argc, argv);
            !unknown.empty()) {
            console::printDiagnostic("{}\n", unknown);
            return bad_input;
        }
        if (asksForCommand(app, argc)) {
            console::printDiagnostic("{}", app.help());
            return bad_input;
        }
        if (const std::string wrong = wrongValue(error.what()); !wrong.empty()) {
            console::printDiagnostic("{}\n", wrong);
            return bad_input;
        }
        std::ostringstream results, diagnostics;
        const int code = app.exit(error, results, diagnostics);
        console::addResult(results.str());
        console::addDiagnostic(diagnostics.str());
        if (code == 0) return done;
        if (const std::string hint = settingWithoutSet(argc, argv); !hint.empty())
            console::printDiagnostic("{}\n", hint);
        if (const std::string near = meantWord(app, argc, argv); !near.empty()) console::printDiagnostic("{}\n", near);
        return bad_input;
    }
    return action();
}

/** Component libraries with commands: the library named like its command, and one with another name. */
struct LibraryCommands {
    const char *library, *other;
};
constexpr LibraryCommands commands_of_libraries[] = {{"dataset", nullptr}, {"device", nullptr}, {"study", "fit"}};

/** Adds a command that prints what to install, for any arguments. */
void addAbsent(CLI::App& app, Action& action, const std::string& name, const std::string& library) {
    CLI::App* command =
        app.add_subcommand(name, std::string(loader::findComponent(library)->gives) + " (not installed)");
    command->prefix_command()->set_help_flag();
    command->callback([name, library, &action] {
        action = [name, library]() -> int { throw types::ConfigError("", name, "is in " + loader::absence(library)); };
    });
}

/** Adds the commands of libraries, for a first word that is not a command of the core. Adds those of all libraries,
 *  because help, completion and suggestions list them. A library that cannot be loaded is a notice, and an error only
 *  for its own command. */
void addLibraryCommands(CLI::App& app, Action& action, const std::string& word) {
    for (const auto& [name, other] : commands_of_libraries) {
        if (!loader::isPresent(name)) {
            addAbsent(app, action, name, name);
            if (other) addAbsent(app, action, other, name);
            continue;
        }
        try {
            loader::load(name).entry<void(CLI::App&, Action&)>("insonify_add_command")(app, action);
        } catch (const types::ConfigError& error) {
            if (word == name || (other && word == other)) throw;
            console::printDiagnostic("notice: {}\n", error.diagnostics().front().text());
        }
    }
}

/** Whether the core's commands suffice for a command line. */
bool isOfCore(const CLI::App& app, const std::string& word) {
    static constexpr std::string_view of_all[] = {"completion", "man"};
    return word == "--version" ||
           (std::ranges::count(namesAfter(app, false), word) > 0 && std::ranges::count(of_all, word) == 0);
}

int guarded(CLI::App& app, Action& action, int argc, char** argv) {
    try {
        const std::string word = argc > 1 ? argv[1] : "";
        if (!isOfCore(app, word)) addLibraryCommands(app, action, word);
        return parseAndAct(app, action, argc, argv);
    } catch (const types::ConfigError& error) {
        for (const types::Diagnostic& diagnostic : error.diagnostics())
            console::printDiagnostic("{}\n", diagnostic.text());
        return bad_input;
    } catch (const std::exception& error) {
        console::printDiagnostic("insonify: {}\n", types::reasonOf(error));
        return failed;
    } catch (...) {  // of a library of the user
        console::printDiagnostic("insonify: failed, by an exception without a reason\n");
        return failed;
    }
}

}  // namespace

int runCommandLine(int argc, char** argv) {
    console::prepareConsole();
    CLI::App app{"Simulates imaging sonars in real time, from a 3-D scene", "insonify"};
    app.set_version_flag("--version", INSONIFY_VERSION);
    app.require_subcommand(1);
    Action action;
    addInitCommand(app, action);
    addExamplesCommand(app, action);
    addRunCommand(app, action);
    addCheckCommand(app, action);
    addPlanCommand(app, action);
    addExplainCommand(app, action);
    addDescribeCommand(app, action);
    addSceneCommand(app, action);
    addBeamCommand(app, action);
    addWaterCommand(app, action);
    addBackscatterCommand(app, action);
    addLibrariesCommand(app, action);
    addSchemaCommand(app, action);
    addLogCommand(app, action);
    addReplayCommand(app, action);
    addCompletionCommand(app, action);
    addManCommand(app, action);

    std::vector<std::string> words = withRosWords({argv, argv + argc});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const int code = guarded(app, action, static_cast<int>(words.size()), arguments.data());
    const std::string unwritten = console::flushResults();
    if (!unwritten.empty())
        console::printDiagnostic("insonify: the standard output cannot be written: {}\n", unwritten);
    console::finishPrinting();
    return code == done && !unwritten.empty() ? failed : code;
}

}  // namespace insonify::command
