#include "components/command/RosArguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>

#include "components/framework/YamlText.hpp"
#include "types/ConfigError.hpp"

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
            if (!types::isRosName(name))
                refuseRosArgument("-r " + remap.name + ":=" + remap.value + ": " + name +
                                  " is no topic; must be words of letters, digits and _, as /auv/sonar");
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
        else
            plain.push_back(inside ? std::string(section_start) + "=" + (word.empty() ? "''" : word) : word);
    }
    return plain;
}

void applyRosArguments(const std::vector<std::string>& words, framework::DeploymentSpec& spec) {
    RosArguments arguments(spec);
    arguments.read(words);
    arguments.apply();
}

}  // namespace insonify::command
