#include "components/framework/Graph.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "components/framework/Offers.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/framework/config/YamlText.hpp"

namespace insonify::framework {
namespace {

bool isBuffered(const Connection& connection) { return connection.policy.type != ConnPolicy::Data; }

/** Returns the first waiting task whose writers are all placed; null when there is none. */
TaskContext* nextTask(const std::vector<TaskContext*>& waiting, const std::vector<Connection>& connections,
                      bool heed_buffered) {
    const auto waits = [&](const TaskContext* task) {
        return std::find(waiting.begin(), waiting.end(), task) != waiting.end();
    };
    for (TaskContext* task : waiting) {
        const auto holdsBack = [&](const Connection& c) {
            return &c.to->owner() == task && &c.from->owner() != task && waits(&c.from->owner()) &&
                   (heed_buffered || !isBuffered(c));
        };
        if (std::none_of(connections.begin(), connections.end(), holdsBack)) return task;
    }
    return nullptr;
}

bool leadsTo(const TaskContext& from, const TaskContext& to, const std::vector<Connection>& connections,
             std::set<const TaskContext*>& seen) {
    if (&from == &to) return true;
    if (!seen.insert(&from).second) return false;
    return std::any_of(connections.begin(), connections.end(), [&](const Connection& c) {
        return !isBuffered(c) && &c.from->owner() == &from && leadsTo(c.to->owner(), to, connections, seen);
    });
}

}  // namespace

bool hasFailed(const TaskContext& task) {
    return task.state() == TaskState::Exception || task.state() == TaskState::FatalError;
}

TaskContext* Graph::task(const std::string& name) const {
    for (const auto& task : tasks_)
        if (task->name() == name) return task.get();
    return nullptr;
}

std::vector<const Connection*> Graph::unbufferedLoops() const {
    std::vector<const Connection*> loops;
    std::set<const TaskContext*> reported;
    for (const Connection& connection : connections_) {
        std::set<const TaskContext*> seen;
        if (isBuffered(connection) || !leadsTo(connection.to->owner(), connection.from->owner(), connections_, seen))
            continue;
        if (reported.insert(&connection.to->owner()).second) loops.push_back(&connection);
    }
    return loops;
}

TaskContext& Graph::add(std::unique_ptr<TaskContext> task) { return *tasks_.emplace_back(std::move(task)); }

bool Graph::connect(OutputPortBase& from, InputPortBase& to, ConnPolicy policy) {
    if (!from.connectTo(to, policy)) return false;
    connections_.push_back({&from, &to, policy, to.channels().back()});
    return true;
}

void Graph::arrange() {
    std::vector<TaskContext*> waiting;
    for (const auto& task : tasks_) waiting.push_back(task.get());
    order_.clear();
    while (!waiting.empty()) {
        TaskContext* next = nextTask(waiting, connections_, true);
        if (!next) next = nextTask(waiting, connections_, false);
        if (!next) next = waiting.front();
        order_.push_back(next);
        waiting.erase(std::find(waiting.begin(), waiting.end(), next));
    }
    counted_ = countedOutputs();
}

std::vector<const OutputPortBase*> Graph::countedOutputs() const {
    const auto isCounted = [](const PortBase* port) { return port->counted(); };
    std::vector<const OutputPortBase*> counted;
    for (const auto& task : tasks_)
        if (std::ranges::none_of(task->inputs(), isCounted))
            std::ranges::copy_if(task->outputs(), std::back_inserter(counted), isCounted);
    return counted;
}

uint64_t Graph::countedSamples() const {
    if (counted_.empty()) return 0;
    return (*std::ranges::min_element(counted_, {}, &OutputPortBase::written))->written();
}

bool Graph::hasFailed() const {
    return std::ranges::any_of(tasks_, [](const auto& task) { return framework::hasFailed(*task); });
}

bool Graph::hasSourceInError() const {
    return std::ranges::any_of(
        counted_, [](const OutputPortBase* port) { return port->owner().state() == TaskState::RunTimeError; });
}

namespace {

std::optional<types::PropertyValue> valueWithin(const std::string& block, std::string path) {
    YAML::Node node = parseValue(block);
    while (!path.empty() && node.IsDefined()) {
        const auto [key, rest] = splitPort(path);
        node.reset(child(node, key));
        path = rest;
    }
    if (!node.IsDefined() || node.IsNull()) return std::nullopt;
    if (!node.IsScalar()) return YAML::Dump(node);
    if (node.Tag() == "!") return node.Scalar();  // in quotes
    bool truth = false;
    double number = 0;
    if (YAML::convert<bool>::decode(node, truth)) return truth;
    if (YAML::convert<double>::decode(node, number)) return number;
    return node.Scalar();
}

/** Tasks that write to a port. */
std::vector<const TaskContext*> findWriters(const InputPortBase& port) {
    std::vector<const TaskContext*> writers;
    for (const auto& channel : port.channels()) writers.push_back(&channel->source().owner());
    return writers;
}

/** Calls `use` with each task that a port's samples come from, nearest first, until it returns true. */
void forEachUpstream(const InputPortBase& port, const auto& use) {
    std::vector<const TaskContext*> waiting = findWriters(port);
    for (size_t i = 0; i < waiting.size(); ++i) {
        if (use(*waiting[i])) return;
        for (const InputPortBase* input : waiting[i]->inputs())
            for (const TaskContext* writer : findWriters(*input))
                if (std::ranges::count(waiting, writer) == 0) waiting.push_back(writer);
    }
}

}  // namespace

std::optional<types::PropertyValue> valueAt(const types::TaskRecord& task, const std::string& path) {
    const auto [top, rest] = splitPort(path);
    const auto found = task.properties.find(top);
    if (found == task.properties.end()) return std::nullopt;
    if (rest.empty()) return found->second;
    const std::string* const block = std::get_if<std::string>(&found->second);
    return block ? valueWithin(*block, rest) : std::nullopt;
}

std::optional<types::PropertyValue> upstreamValue(const InputPortBase& port, std::initializer_list<const char*> paths) {
    std::optional<types::PropertyValue> value;
    forEachUpstream(port, [&](const TaskContext& task) {
        const types::TaskRecord record = task.record();
        return std::ranges::any_of(paths,
                                   [&](const char* path) { return (value = valueAt(record, path)).has_value(); });
    });
    return value;
}

std::optional<double> upstreamNumber(const InputPortBase& port, std::initializer_list<const char*> paths) {
    const auto value = upstreamValue(port, paths);
    const double* const number = value ? std::get_if<double>(&*value) : nullptr;
    return number ? std::optional(*number) : std::nullopt;
}

types::ReturnRules upstreamReturnRules(const InputPortBase& port, const char* amplified) {
    types::ReturnRules rules;
    forEachUpstream(port, [&](const TaskContext& task) {
        const auto* const source = dynamic_cast<const ReturnSource*>(&task);
        if (source) rules = source->returnRules();
        return source != nullptr;
    });
    const bool is_amplified = std::ranges::any_of(
        port.channels(), [&](const auto& channel) { return channel->source().content() == amplified; });
    if (!is_amplified) return rules;
    const double blanked = upstreamNumber(port, {"blanking.range_min"}).value_or(0);
    return {.range_min = std::max(rules.range_min, blanked)};
}

std::optional<types::Mount> upstreamMount(const InputPortBase& port) {
    const auto value = upstreamValue(port, {"mount"});
    const std::string* const text = value ? std::get_if<std::string>(&*value) : nullptr;
    types::Mount mount;
    ConfigReader reader("");
    return text && reader.readText(*text, "mount", mount) ? std::optional(mount) : std::nullopt;
}

std::string whyNoCodes(const InputPortBase& port) {
    std::string why;
    forEachUpstream(port, [&](const TaskContext& task) {
        types::TaskRecord record;  // as they are now: the task's own record follows once all tasks are checked
        for (const PropertiesBase* properties : task.properties()) record.properties.merge(properties->values());
        const auto output = valueAt(record, "output");  // of a receiver
        const std::string* const name = output ? std::get_if<std::string>(&*output) : nullptr;
        const bool is_sonar = valueAt(record, "range_rounding").has_value();
        if (name && *name != "code") why = "the output of " + task.name() + " is " + *name;
        if (is_sonar) why = task.name() + " sends intensities";
        return name || is_sonar;
    });
    return why;
}

std::vector<const OutputPortBase*> upstreamPoses(const InputPortBase& port) {
    std::vector<const OutputPortBase*> poses;
    forEachUpstream(port, [&](const TaskContext& task) {
        for (const InputPortBase* input : task.inputs())
            if (input->type() == typeid(types::Pose))
                for (const auto& channel : input->channels()) poses.push_back(&channel->source());
        return false;
    });
    return poses;
}

}  // namespace insonify::framework
