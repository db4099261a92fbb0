// insonify completion bash|zsh, and insonify man: both generated from the present commands.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <memory>

#include "components/command/CommandLine.hpp"
#include "components/command/init/Starter.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

std::vector<std::string> subcommands(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        if (!command->get_group().empty()) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> flags(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/** Words other than files that may follow a command. */
std::vector<std::string> wordsAfter(const std::string& command) {
    std::vector<std::string> words;
    if (command == " describe") {
        words.emplace_back("materials");
        const framework::Registry registry = allTasks();
        for (const auto& entry : registry.list()) words.push_back(entry.type);
    }
    if (command == " init")
        for (const sonars::SonarFigures* sonar : starterSonars()) words.push_back(sonar->name);
    if (command == " completion") words = {"bash", "zsh"};
    return words;
}

/** Returns the script's case for a command, and those of its subcommands. `path`: "", " log", " log info". */
std::string cases(const CLI::App& app, const std::string& path) {
    std::vector<std::string> words = subcommands(app);
    const bool asks_for_one_more = app.get_require_subcommand_min() > 0;
    const bool takes_files = !asks_for_one_more && path != " describe" && path != " completion";
    for (const auto& more : {flags(app), wordsAfter(path)}) words.insert(words.end(), more.begin(), more.end());
    std::string text = fmt::format("        \"{}\") words=\"{}\"{} ;;\n", path, fmt::join(words, " "),
                                   takes_files ? " files=yes" : "");
    for (const std::string& name : subcommands(app)) text += cases(*app.get_subcommand(name), path + " " + name);
    return text;
}

/** The command so far consists of the words that are subcommands. Zsh runs the script as well; there `path` is a
 *  variable of the shell and offsets need a dollar. */
std::string bashCompletion(const CLI::App& app) {
    return R"(_insonify() {
    local i word command="" words="" files="" current="${COMP_WORDS[COMP_CWORD]}" typed
    typed="$current"
    for ((i = 1; i < COMP_CWORD; ++i)); do
        word="${COMP_WORDS[i]}"
        case "$command $word" in
)" +
           [&] {
               std::string paths;
               for (const std::string& name : subcommands(app)) {
                   paths += fmt::format("            \" {}\"", name);
                   for (const std::string& inner : subcommands(*app.get_subcommand(name)))
                       paths += fmt::format("|\" {} {}\"", name, inner);
                   paths += ") command+=\" $word\" ;;\n";
               }
               return paths;
           }() +
           R"(        esac
    done
    case "$command" in
)" + cases(app, "") +
           R"(    esac
    # Bash splits words at colons, which task types hold, and replaces what follows the last one.
    local before=""
    if [[ ${COMP_WORDBREAKS-} == *:* ]]; then
        typed="${COMP_LINE:0:$COMP_POINT}"
        typed="${typed##*[[:space:]]}"
        [[ $typed != *:* ]] || before="${typed%:*}:"
    fi
    COMPREPLY=()
    for word in $(compgen -W "$words" -- "$typed"); do
        COMPREPLY+=("${word#"$before"}")
        [[ $word != *:* ]] || compopt +o filenames 2> /dev/null  # or colons are quoted
    done
    [[ $files && $current != -* ]] || return 0
    current="${current#=}"
    while IFS= read -r word; do
        COMPREPLY+=("$word")
    done < <(compgen -f -- "$current")
}
complete -o filenames -F _insonify insonify
)";
}

int printCompletion(const CLI::App& app, const std::string& shell) {
    if (shell == "zsh") console::printResult("autoload -U +X bashcompinit && bashcompinit\n");
    console::printResult("{}", bashCompletion(app));
    return 0;
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) safe += c == '-' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return safe.starts_with('.') || safe.starts_with('\'') ? "\\&" + safe : safe;
}

void printManCommand(const CLI::App& app, const std::string& path) {
    console::printResult(".SS {}\n{}\n", escaped(path), escaped(app.get_description()));
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_name() == "--help") continue;
        const std::string type =
            option->get_type_size() == 0 || option->get_positional() ? "" : " " + option->get_type_name();
        const std::string name = option->get_positional() ? option->get_name(true) : option->get_name(false, true);
        console::printResult(".TP\n.B {}{}\n{}\n", escaped(name), escaped(type), escaped(option->get_description()));
    }
    for (const std::string& name : subcommands(app)) printManCommand(*app.get_subcommand(name), path + " " + name);
}

int printMan(const CLI::App& app) {
    console::printResult(".TH INSONIFY 1 \"\" \"Insonify {}\" \"User Commands\"\n.SH NAME\ninsonify \\- {}\n",
                         INSONIFY_VERSION, escaped(app.get_description()));
    console::printResult(".SH SYNOPSIS\n.B insonify\n.I COMMAND\n[options]\n.SH COMMANDS\n");
    for (const std::string& name : subcommands(app)) printManCommand(*app.get_subcommand(name), name);
    console::printResult(
        ".SH EXIT STATUS\n0: done. 1: failed while running. 2: wrong usage, file or configuration.\n"
        ".SH ENVIRONMENT\n.TP\n.B INSONIFY_EGL_DEVICE\nThe device for rasterisation: a number, software or auto.\n"
        ".TP\n.B INSONIFY_MODEL_PATH, GAZEBO_MODEL_PATH, SDF_PATH, GZ_SIM_RESOURCE_PATH, "
        "IGN_GAZEBO_RESOURCE_PATH, GAZEBO_RESOURCE_PATH\nFolders in which the models of a world are searched.\n"
        ".TP\n.B AMENT_PREFIX_PATH, ROS_PACKAGE_PATH\nWhere packages of ROS are searched that a world or a robot "
        "names.\n"
        ".TP\n.B GZ_FUEL_CACHE_PATH, IGN_FUEL_CACHE_PATH\nCaches of models of Fuel, before ~/.gz/fuel.\n");
    return 0;
}

}  // namespace

void addCompletionCommand(CLI::App& app, Action& action) {
    const auto shell = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("completion", "Prints a script by which a shell completes this command");
    command->add_option("SHELL", *shell, "bash or zsh: source <(insonify completion bash)")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh"}));
    command->callback([&app, shell, &action] { action = [&app, shell] { return printCompletion(app, *shell); }; });
}

void addManCommand(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("man", "Prints the manual page")->group("");
    command->callback([&app, &action] {
        action = [&app] {
            describeSonars(*app.get_subcommand("init"));
            return printMan(app);
        };
    });
}

}  // namespace insonify::command
