#include "components/command/CommandLine.hpp"

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <filesystem>
#include <regex>
#include <sstream>

#include "components/console/Console.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::command {
namespace {

constexpr const char *section_start = "--ros-args", *parameters_key = "ros__parameters";

[[noreturn]] void refuseRosArgument(const std::string& what) { throw types::ConfigError("", section_start, what); }

/** `NODE:NAME:=VALUE`; an empty node means all nodes. */
struct RosAssignment {
    std::string node, name, value;
};

RosAssignment readRosAssignment(const std::string& flag, const std::string& word) {
    const size_t middle = word.find(":=");
    const size_t colon = word.find(':');
    const bool has_node = colon < middle;
    RosAssignment read{has_node ? word.substr(0, colon) : "", "", ""};
    if (middle != std::string::npos) {
        const size_t start = has_node ? colon + 1 : 0;
        read.name = word.substr(start, middle - start);
        read.value = word.substr(middle + 2);
    }
    if (read.name.empty() || read.value.empty() || (has_node && read.node.empty()))
        refuseRosArgument(flag + " " + word + ": must be NAME:=VALUE or NODE:NAME:=VALUE");
    return read;
}

/** A task that is a node of ROS, and its full name. */
struct RosNode {
    std::string task, name;
    std::string lastWord() const { return name.substr(name.rfind('/') + 1); }
};

std::vector<RosNode> rosNodes(const framework::DeploymentSpec& spec) {
    std::vector<RosNode> nodes;
    for (const framework::TaskSpec& task : spec.tasks) {
        if (!task.type.starts_with("dds::")) continue;
        const YAML::Node given = framework::child(task.properties, "node_name");
        const bool has_name = given.IsDefined() && given.IsScalar() && !given.Scalar().empty();
        const std::string name = spec.names.node(has_name ? given.Scalar() : task.name);
        nodes.push_back({task.name, name.starts_with('/') ? name : "/" + name});
    }
    return nodes;
}

std::string rosNodeNames(const std::vector<RosNode>& nodes) {
    std::vector<std::string> names;
    for (const RosNode& node : nodes) names.push_back(node.name);
    return names.empty() ? "the deployment has no node" : fmt::format("nodes: {}", fmt::join(names, ", "));
}

// Whether a name in a parameter file matches a node: "/auv1/sonar", "/**" for any, "/auv1/*" for one word.
bool fitsNode(const std::string& pattern, const std::string& name) {
    std::string expression;
    for (size_t at = pattern.starts_with('/'); at <= pattern.size();) {
        const size_t end = std::min(pattern.find('/', at), pattern.size());
        const std::string word = pattern.substr(at, end - at);
        if (word != "**" && word != "*" && !types::isRosName(word)) return false;
        expression += word == "**" ? "(/\\w+)*" : word == "*" ? "/\\w+" : "/" + word;
        at = end + 1;
    }
    return std::regex_match(name, std::regex(expression));
}

/** The arguments of one command line, sorted by kind. */
class RosArguments {
public:
    explicit RosArguments(framework::DeploymentSpec& spec) : spec_(spec) {}

    void read(const std::vector<std::string>& words) {
        for (size_t i = 0; i < words.size(); i += 2) {
            const std::string& flag = words[i];
            const bool is_remap = flag == "-r" || flag == "--remap", is_parameter = flag == "-p" || flag == "--param";
            if (!is_remap && !is_parameter && flag != "--params-file")
                refuseRosArgument(
                    "is " + flag +
                    "; may be -r FROM:=TO, -p TASK.PROPERTY:=VALUE, --params-file FILE, and -- at the end");
            if (i + 1 == words.size()) refuseRosArgument(flag + " has no value");
            if (is_remap)
                remaps_.push_back(readRosAssignment(flag, words[i + 1]));
            else
                parameters_.emplace_back(is_parameter, words[i + 1]);
        }
    }
    void apply() {
        for (const RosAssignment& remap : remaps_)
            if (remap.name == "__ns") setNamespace(remap);
        for (const RosAssignment& remap : remaps_)
            if (remap.name == "__node" || remap.name == "__name")
                nameNodes(remap);
            else if (remap.name != "__ns")
                addTopic(remap);
        for (const auto& [is_parameter, word] : parameters_) is_parameter ? setParameter(word) : readFile(word);
    }

private:
    void setNamespace(const RosAssignment& remap) {
        if (!remap.node.empty())
            refuseRosArgument("-r " + remap.node + ":__ns: is for one node; the namespace is that of all, __ns");
        spec_.set("namespace", YAML::Node(remap.value), {section_start, "-r __ns"});
    }

    void nameNodes(const RosAssignment& remap) {
        if (!types::isRosName(remap.value) || remap.value.find('/') != std::string::npos)
            refuseRosArgument("-r __node: is " + remap.value + "; must be a word of letters, digits and _");
        std::vector<RosNode> nodes = rosNodes(spec_);
        std::erase_if(nodes, [&](const RosNode& node) { return !remap.node.empty() && remap.node != node.lastWord(); });
        if (nodes.empty() && !remap.node.empty())
            refuseRosArgument("-r " + remap.node + ":__node: there is no such node; " + rosNodeNames(rosNodes(spec_)));
        const auto sends = [&](const RosNode& node) { return spec_.task(node.task)->type == "dds::PublisherTask"; };
        const auto first = std::ranges::find_if(nodes, sends);
        const std::string named = nodes.empty() ? "" : (first == nodes.end() ? nodes.front() : *first).task;
        for (const RosNode& node : nodes)
            spec_.set(node.task + ".node_name",
                      YAML::Node(node.task == named ? remap.value : remap.value + "_" + node.task),
                      {section_start, "-r __node"});
    }

    void addTopic(const RosAssignment& remap) {
        for (const std::string& name : {remap.name, remap.value})
            if (!types::isRosName(name.starts_with("~/") ? name.substr(2) : name))
                refuseRosArgument("-r " + remap.name + ":=" + remap.value + ": " + name +
                                  " is no topic; must be words of letters, digits and _, as /auv/sonar or ~/sonar");
        spec_.names.remaps.push_back({remap.node, remap.name, remap.value});
    }

    void setParameter(const std::string& word) {
        const RosAssignment parameter = readRosAssignment("-p", word);
        const auto nodes = rosNodes(spec_);
        if (!parameter.node.empty() && std::ranges::count(nodes, parameter.node, &RosNode::lastWord) == 0)
            refuseRosArgument("-p " + word + ": there is no node " + parameter.node + "; " + rosNodeNames(nodes));
        try {
            set(parameter.name, framework::parseValue(parameter.value), {section_start, "-p " + parameter.name});
        } catch (const types::ConfigError& error) {
            refuseRosArgument("-p " + word + ": " + error.diagnostics().front().message);
        }
    }

    void readFile(const std::string& file) {
        const auto documents = framework::parseYaml(framework::readFile(file, "a file of parameters"), file);
        bool fits = false;
        std::vector<std::string> names;
        for (const YAML::Node& document : documents) readBlock(file, document, "", names, fits);
        if (!fits)
            throw types::ConfigError(file, "",
                                     fmt::format("is of no node of the deployment, but of {}; {}; /** fits all",
                                                 names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")),
                                                 rosNodeNames(rosNodes(spec_))));
    }

    /** @param name the keys that lead to the block: a node's name or a part of it. */
    void readBlock(const std::string& file, const YAML::Node& block, const std::string& name,
                   std::vector<std::string>& names, bool& fits) {
        if (!block.IsMap())
            throw types::ConfigError(file, name, "must be a block of nodes, each with " + std::string(parameters_key));
        for (const auto& entry : block) {
            const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
            if (key != parameters_key) {
                readBlock(file, entry.second, name.empty() || name.ends_with('/') ? name + key : name + "/" + key,
                          names, fits);
                continue;
            }
            names.push_back(name);
            const auto nodes = rosNodes(spec_);
            const bool of_all = name == "/**" || name == "**";  // also where no task is a node
            if (!of_all && std::ranges::none_of(nodes, [&](const auto& node) { return fitsNode(name, node.name); }))
                continue;
            fits = true;
            setParameters(file, entry.second);
        }
    }

    void setParameters(const std::string& file, const YAML::Node& block) {
        if (block.IsNull()) return;
        if (!block.IsMap()) throw types::ConfigError(file, parameters_key, "must be a block of tasks");
        for (const auto& entry : block) {
            const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
            const bool is_task = entry.second.IsMap() && key.find('.') == std::string::npos;
            if (!is_task) {
                set(key, entry.second, {file, key, entry.first.Mark()});
                continue;
            }
            for (const auto& property : entry.second) {
                const std::string path = key + "." + (property.first.IsScalar() ? property.first.Scalar() : "");
                set(path, property.second, {file, path, property.first.Mark()});
            }
        }
    }

    void set(const std::string& property, const YAML::Node& value, const framework::Origin& origin) {
        if (property != "use_sim_time") spec_.set(property, value, origin);
    }

    framework::DeploymentSpec& spec_;
    std::vector<RosAssignment> remaps_;
    std::vector<std::pair<bool, std::string>> parameters_;  ///< In order: whether it is an assignment, and the text.
};

}  // namespace

std::vector<std::string> withRosWords(const std::vector<std::string>& words) {
    std::vector<std::string> plain;
    bool inside = false;
    for (const std::string& word : words) {
        if (word == section_start)
            inside = true;
        else if (inside && word == "--")
            inside = false;
        else if (inside)
            plain.push_back(std::string(section_start) + "=" + (word.empty() ? "''" : word));
        else if (word.starts_with("--") && word.find('=') == word.size() - 1)
            plain.insert(plain.end(), {word.substr(0, word.size() - 1), ""});  // the parser would skip the empty value
        else
            plain.push_back(word);
    }
    return plain;
}

void applyRosArguments(const std::vector<std::string>& words, framework::DeploymentSpec& spec) {
    RosArguments arguments(spec);
    arguments.read(words);
    arguments.apply();
}

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

/** Returns the number at the begin of a text, infinity for one beyond all numbers; 0: there is none. */
double readNumber(const std::string& text) {
    double number = 0;
    const auto read = std::from_chars(text.data() + text.starts_with('+'), text.data() + text.size(), number);
    return read.ec == std::errc::result_out_of_range ? INFINITY : number;
}

/** Returns what is wrong with an option's value, in place of the parser's "Could not convert", "At Most 1 required" and
 *  "not in range"; empty: the parser's text is clear. */
std::string wrongValue(const std::string& text) {
    static const std::string conversion = "Could not convert: ", between = " = ", twice = ": At Most 1 required";
    if (const size_t at = text.find(twice); at != text.npos)
        return text.substr(0, at) + ": is given more than once; once is allowed";
    static const std::regex outside("(.*): Value (.*) not in range (\\S+) to (\\S+)");
    if (std::smatch found; std::regex_match(text, found, outside)) {
        const double min = readNumber(found[3]), max = readNumber(found[4]);
        const std::string bounds = max < 1e100 ? fmt::format("from {:g} to {:g}", min, max) : "above 0";
        return found.str(1) + ": is " + found.str(2) + "; must be a number " + bounds;
    }
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

/** Makes an empty value of any option or argument, and a number that is not finite, an error before other checks. */
void checkValues(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        if (option->get_items_expected_max() == 0) continue;  // a flag
        const std::string type = option->get_type_name(), wanted = type + ": " + option->get_description();
        option->transform(CLI::Validator(
            [wanted, is_number = type.starts_with("FLOAT")](std::string& text) -> std::string {
                if (text.empty()) return "is empty; must be " + wanted;
                const bool is_finite = !is_number || std::isfinite(readNumber(text));
                return is_finite ? "" : "is " + text + "; must be a finite number";
            },
            ""));
    }
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) checkValues(*command);
}

/** Whether the words end where a command must follow, as in `insonify` and `insonify log`. */
bool asksForCommand(const CLI::App& app, int argc) {
    const CLI::App* command = &app;
    int words = 1;
    for (; !command->get_subcommands().empty(); ++words) command = command->get_subcommands().front();
    return words == argc && command->get_require_subcommand_min() > 0;
}

int parseAndAct(CLI::App& app, Action& action, int argc, char** argv) {
    checkValues(app);
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

/** Returns the version, and on further lines the commit, and the parts that are here and absent. */
std::string describeVersion(const std::string& commit) {
    std::string text = INSONIFY_VERSION, here, absent;
    for (const loader::Component& part : loader::components())
        (loader::isPresent(part.name) ? here : absent) += std::string(" ") + part.name;
    if (!commit.empty()) text += "\ncommit " + commit;
    text += "\nparts:" + (here.empty() ? " none" : here);
    return absent.empty() ? text : text + "\nabsent:" + absent;
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
    } catch (const std::filesystem::filesystem_error& error) {
        const bool is_name = error.code() == std::errc::filename_too_long;  // wherever a path is looked at first
        console::printDiagnostic("insonify: {}\n",
                                 is_name ? error.path1().string() + ": the name is too long" : types::getReason(error));
        return is_name ? bad_input : failed;
    } catch (const std::exception& error) {
        console::printDiagnostic("insonify: {}\n", types::getReason(error));
        return failed;
    } catch (...) {  // of a library of the user
        console::printDiagnostic("insonify: failed, by an exception without a reason\n");
        return failed;
    }
}

}  // namespace

int runCommandLine(int argc, char** argv, const char* commit) {
    console::prepareConsole();
    CLI::App app{"Simulates imaging sonars in real time, from a 3-D scene", "insonify"};
    app.set_version_flag("--version", [commit] { return describeVersion(commit); });
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
    addGazeboCommand(app, action);
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
