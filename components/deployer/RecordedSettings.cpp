#include "components/deployer/RecordedSettings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <type_traits>
#include <variant>

#include "components/deployer/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/ReplaySpec.hpp"
#include "components/deployer/Tasks.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/YamlText.hpp"
#include "components/sonar/PingTask.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::deployer {
namespace {

using framework::Deployment;
using framework::splitPort;

/** What a log tells of the quality of a sonar. */
struct Recorded {
    int rows = 0, columns_per_beam = 0;
    bool chosen = false;  ///< Not given; with neither, the placeholder before the first ping that hears anything.
};

std::optional<Recorded> recordedQuality(const log::Reader& log, const std::string& sonar) {
    std::optional<Recorded> quality;
    for (const log::Stream& stream : log.streams()) {
        const auto plans = stream.metadata.find("insonify_plan");
        if (plans == stream.metadata.end()) continue;
        try {
            const YAML::Node all = YAML::Load(plans->second), plan = all[sonar];
            if (!plan.IsDefined() || (quality && quality->chosen)) continue;
            quality = Recorded{plan["rows"].as<int>(), plan["columns_per_beam"].as<int>(),
                               plan["predicted_error"].as<double>(-1) >= 0};
        } catch (const YAML::Exception& error) {
            throw types::ConfigError(log.path(), stream.name,
                                     std::string("its insonify_plan is none: ") + error.what());
        }
    }
    return quality;
}

std::string textOf(const types::PropertyValue& value) {
    const std::string* const text = std::get_if<std::string>(&value);
    if (!text) return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
    const bool is_block = text->starts_with('{') || text->starts_with('[');
    return is_block ? *text : Json(*text).dump();
}

std::optional<types::PropertyValue> lastValue(log::Reader& log, const log::Stream& stream) {
    std::optional<types::PropertyValue> value;
    const auto read = [&]<class T>(std::type_identity<T>) {
        if (stream.holds<T>())
            log.forEach<T>(stream.name, [&](const T& sample, const log::SampleRef&) { value.emplace(sample); });
    };
    read(std::type_identity<bool>{});
    read(std::type_identity<int64_t>{});
    read(std::type_identity<double>{});
    read(std::type_identity<std::string>{});
    return value;
}

/** Properties of the tasks as they are, by "task.property". */
std::map<std::string, types::PropertyValue> propertiesOf(Deployment& deployment, const std::set<std::string>& tasks) {
    std::map<std::string, types::PropertyValue> all;
    for (const types::TaskRecord& task : deployment.environment().records())
        if (tasks.contains(task.name))
            for (const auto& [name, value] : task.properties) all[task.name + "." + name] = value;
    return all;
}

bool names(const std::vector<std::string>& set, const std::string& property) {
    return std::ranges::any_of(set, [&](const std::string& assignment) {
        return assignment.starts_with(property + "=") || assignment.starts_with(property + ".");
    });
}

/** Collects what differs. */
struct Settings {
    std::vector<std::string> assignments;
    std::set<std::string> settled;  ///< "task.property" to which nothing is to be added.

    void addQualities(const Deployment& deployment, const log::Reader& log, const std::set<std::string>& tasks) {
        for (const auto& task : deployment.tasks()) {
            const auto* const sonar = dynamic_cast<const sonar::PingTask*>(task.get());
            const std::string property = task->name() + ".quality";
            if (!sonar || !tasks.contains(task->name()) || settled.contains(property)) continue;
            const auto recorded = recordedQuality(log, task->name());
            if (!recorded) continue;
            const sonar::SonarConfig config = sonar->sonarConfig();
            if (config.quality.rows == recorded->rows && config.quality.columns_per_beam == recorded->columns_per_beam)
                continue;
            if (!recorded->chosen && (config.targetError() || config.quality.budget_ms)) continue;
            assignments.push_back(fmt::format("{}={{rows: {}, columns_per_beam: {}}}", property, recorded->rows,
                                              recorded->columns_per_beam));
            if (recorded->chosen) settled.insert(property);
        }
    }
    void addProperties(Deployment& deployment, const log::Reader& log, const std::set<std::string>& tasks) {
        const auto file = propertyLogOf(log);
        if (!file) return;
        const auto opened = log::openLog(*file);
        log::Reader& properties = *opened;
        const auto present = propertiesOf(deployment, tasks);
        for (const log::Stream& stream : properties.streams()) {
            if (!tasks.contains(splitPort(stream.name).first) || settled.contains(stream.name)) continue;
            const auto value = lastValue(properties, stream);
            const auto now = present.find(stream.name);
            if (value && (now == present.end() || now->second != *value))
                assignments.push_back(stream.name + "=" + textOf(*value));
        }
    }
};

}  // namespace

std::optional<uint64_t> recordedSeed(const log::Reader& log) {
    const std::string seed = log.metadatum("insonify_seed");
    if (seed.empty()) return {};
    return std::strtoull(seed.c_str(), nullptr, 10);
}

std::vector<std::string> recordedSettings(const log::Reader& log, const framework::DeploymentSpec& spec,
                                          const std::vector<std::string>& set, std::optional<uint64_t> seed) {
    framework::Registry registry = builtInTasks();
    Deployment deployment(spec, registry, ".", seed ? *seed : recordedSeed(log).value_or(0));
    std::set<std::string> tasks;
    for (const std::string& stream : pingStreams(log, spec)) tasks.insert(splitPort(stream).first);
    tasks = upstreamOf(std::move(tasks), deployment);

    Settings settings;
    for (const std::string& task : tasks) {
        if (names(set, task + ".quality")) settings.settled.insert(task + ".quality");
        if (seed) settings.settled.insert(task + ".seed");
    }
    settings.addQualities(deployment, log, tasks);
    settings.addProperties(deployment, log, tasks);
    return settings.assignments;
}

}  // namespace insonify::deployer
