#include "components/deployer/log/RecordedSettings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <type_traits>
#include <utility>
#include <variant>

#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/log/Export.hpp"
#include "components/deployer/log/ReplaySpec.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/log/Reader.hpp"
#include "components/replay/ReplayTask.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "types/samples/TaskRecord.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::deployer {
namespace {

using framework::Deployment;
using framework::splitPort;

/** A log's record of the quality of a sonar. */
struct Recorded {
    int rows = 0, columns_per_beam = 0;
    bool chosen = false;  ///< False: given, or the placeholder before the first ping with an echo.
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
                                     std::string("its insonify_plan is invalid: ") + error.what());
        }
    }
    return quality;
}

std::string toText(const types::PropertyValue& value) {
    const std::string* const text = std::get_if<std::string>(&value);
    if (!text) return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
    const bool is_block = text->starts_with('{') || text->starts_with('[');
    return is_block ? *text : Json(*text).dump();
}

/** Removes a property, for a setter and `--set`. */
const std::string absent_value = "null";

/** The values of a property, as setters take them, and the time at which the logger received each. */
using Values = std::vector<std::pair<types::Time, std::string>>;

Values readValues(log::Reader& log, const log::Stream& stream) {
    Values values;
    const auto read = [&]<class T>(std::type_identity<T>) {
        if (stream.holds<T>())
            log.forEach<T>(stream.name, [&](const T& sample, const log::SampleRef& at) {
                values.emplace_back(at.received, toText(sample));
            });
    };
    read(std::type_identity<bool>{});
    read(std::type_identity<int64_t>{});
    read(std::type_identity<double>{});
    read(std::type_identity<std::string>{});
    return values;
}

/** Adds the time at which the property was removed, see logger::PropertyLog. */
void addAbsence(log::Reader& log, const std::string& property, Values& values) {
    const log::Stream* const presence = log.find(property + ".present");
    if (!presence || !presence->holds<bool>()) return;
    log.forEach<bool>(presence->name, [&](bool is_there, const log::SampleRef& at) {
        if (!is_there) values.emplace_back(at.received, absent_value);
    });
    std::ranges::stable_sort(values, {}, &Values::value_type::first);
}

/** Returns the time of the logger's first record of each task. */
std::map<std::string, types::Time> firstRecords(const log::Reader& properties) {
    std::map<std::string, types::Time> first;
    for (const log::SampleRef& at : properties.samples())
        first.emplace(splitPort(properties.streams()[at.stream].name).first, at.received);
    return first;
}

/** Returns the properties in a property log that belong to `tasks`, by "task.property". */
std::map<std::string, Values> readHistories(log::Reader& log, const std::set<std::string>& tasks) {
    std::map<std::string, Values> histories;
    const auto first = firstRecords(log);
    for (const log::Stream& stream : log.streams()) {
        const auto [task, property] = splitPort(stream.name);
        const bool is_alias = stream.metadata.contains("insonify_alias_of");  // the log has its target as well
        if (!tasks.contains(task) || is_alias || property.find('.') != std::string::npos) continue;
        Values values = readValues(log, stream);
        if (values.empty()) continue;
        addAbsence(log, stream.name, values);
        if (values.front().first > first.at(task)) values.insert(values.begin(), {first.at(task), absent_value});
        histories.emplace(stream.name, std::move(values));
    }
    return histories;
}

/** The pings of a stream, which convert a time of the logger to a time of the world. */
struct Pings {
    std::string driver;
    std::vector<log::SampleRef> samples;

    Pings(const log::Reader& log, const std::string& stream, const std::string& writer)
        : driver(poseStream(log, writer)) {
        log.forEachRef(stream, [&](const log::SampleRef& at) { samples.push_back(at); });
    }
    /** Returns the stamp of the first ping that the logger received at or after this time; none: there is none. */
    std::optional<types::Time> firstFrom(types::Time received) const {
        const auto first = std::ranges::lower_bound(samples, received, {}, &log::SampleRef::received);
        return first == samples.end() ? std::nullopt : std::optional(first->time);
    }
};

/** Returns the history of a property, for pings after `start`. */
RecordedProperty makeHistory(const std::string& property, const Values& values, const Pings& pings, types::Time start) {
    RecordedProperty found{
        splitPort(property).first, splitPort(property).second, values.front().second, pings.driver, {}};
    for (const auto& [received, value] : values) {
        const auto from = pings.firstFrom(received);
        if (!from) break;
        if (*from <= start)
            found.start = value;
        else
            found.changes.push_back({*from, value});
    }
    return found;
}

/** Returns the tasks' present properties, as setters take them, by "task.property". */
std::map<std::string, std::string> getProperties(Deployment& deployment, const std::set<std::string>& tasks) {
    std::map<std::string, std::string> all;
    for (const types::TaskRecord& task : deployment.environment().records())
        if (tasks.contains(task.name))
            for (const auto& [name, value] : task.properties) all[task.name + "." + name] = toText(value);
    return all;
}

/** Returns the tasks' properties that may be absent, as "task.property". */
std::set<std::string> findOptionals(const Deployment& deployment, const std::set<std::string>& tasks) {
    std::set<std::string> optionals;
    for (const auto& task : deployment.tasks())
        for (const auto* const properties : task->properties())
            for (const types::PropertyInfo& info : properties->list())
                if (tasks.contains(task->name()) && info.type.ends_with(", optional"))
                    optionals.insert(task->name() + "." + info.name);
    return optionals;
}

bool names(const std::vector<std::string>& set, const std::string& property) {
    return std::ranges::any_of(set, [&](const std::string& assignment) {
        return assignment.starts_with(property + "=") || assignment.starts_with(property + ".");
    });
}

/** Returns the stamp in a log this time after its first, without the steps of the logger's clock [s]. */
types::Time stampAt(const log::Reader& log, double seconds) {
    const std::vector<log::SampleRef>& samples = log.samples();
    const log::LoggerClock clock(samples);
    const types::Time even = samples.front().time + types::Time::fromSeconds(seconds);
    const size_t index = clock.indexAt(samples, seconds);
    return index == samples.size() ? even : even - (clock.evenTime(samples[index]) - samples[index].time);
}

/** Collects the differences. */
struct Settings : RecordedSettings {
    std::set<std::string> settled;  ///< "task.property" that needs no further assignment.

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
    void addProperties(Deployment& deployment, const log::Reader& log, const std::map<std::string, Pings>& pings,
                       const std::set<std::string>& tasks, double from) {
        const auto file = propertyLog(log);
        if (!file) {
            if (!log.metadatum("insonify_deployment").empty())
                notice = log.path().string() +
                         " has no properties.0.log of its run next to it: what was set by --set or during the run is "
                         "not known";
            addFormerSeeds(deployment, log, tasks);
            return;
        }
        const auto properties = log::openLog(*file);
        const auto histories = readHistories(*properties, tasks);
        const auto present = getProperties(deployment, tasks);
        for (const auto& [property, values] : histories) {
            if (settled.contains(property)) continue;
            const Pings& of_task = pings.at(splitPort(property).first);
            const types::Time begin = stampAt(log, from);
            const types::Time start = of_task.samples.empty() ? begin : std::max(begin, of_task.samples.front().time);
            const RecordedProperty history = makeHistory(property, values, of_task, start);
            const auto now = present.find(property);
            if ((now == present.end() ? absent_value : now->second) != history.start)
                assignments.push_back(property + "=" + history.start);
            if (!history.changes.empty()) changed.push_back(history);
        }
        removeAbsent(deployment, present, histories);
    }
    /** Logs without a version were written before each task had its own seed: the default was 1. */
    void addFormerSeeds(const Deployment& deployment, const log::Reader& log, const std::set<std::string>& tasks) {
        if (!log.metadatum("insonify_version").empty() || recordedSeed(log).value_or(1) != 0) return;
        for (const std::string& property : findOptionals(deployment, tasks)) {
            const auto [task, name] = splitPort(property);
            const bool is_written = framework::child(deployment.spec().task(task)->properties, name).IsDefined();
            if (name == "seed" && !is_written && !settled.contains(property)) assignments.push_back(property + "=1");
        }
    }
    /** Removes properties that the deployment has and the log never had, for tasks that the log knows. */
    void removeAbsent(const Deployment& deployment, const std::map<std::string, std::string>& present,
                      const std::map<std::string, Values>& histories) {
        std::set<std::string> known;
        for (const auto& history : histories) known.insert(splitPort(history.first).first);
        for (const std::string& property : findOptionals(deployment, known))
            if (present.contains(property) && !histories.contains(property) && !settled.contains(property))
                assignments.push_back(property + "=" + absent_value);
    }
};

/** Returns the pings of the first stream that depends on a task, for each task that contributes to the log's pings. */
std::map<std::string, Pings> pingsByTask(const log::Reader& log, const framework::DeploymentSpec& spec,
                                         const Deployment& deployment) {
    std::map<std::string, Pings> pings;
    for (const std::string& stream : pingStreams(log, spec))
        for (const std::string& task : upstream({findWriter(spec, stream)}, deployment))
            if (!pings.contains(task)) pings.emplace(task, Pings(log, stream, findWriter(spec, stream)));
    return pings;
}

/** Throws for a task that is of another type than in the log: its recorded properties would be wrong. */
void refuseOtherTypes(const log::Reader& log, const framework::DeploymentSpec& spec,
                      const std::set<std::string>& tasks) {
    const framework::DeploymentSpec recorded = getDeployment(log);
    for (const std::string& task : tasks)
        if (const auto* before = recorded.task(task); before && before->type != spec.task(task)->type)
            throw types::ConfigError(log.path(), task,
                                     fmt::format("is a {} in the log and a {} in {}; give the deployment of the log",
                                                 before->type, spec.task(task)->type, spec.file));
}

}  // namespace

std::optional<uint64_t> recordedSeed(const log::Reader& log) {
    const std::string seed = log.metadatum("insonify_seed");
    if (seed.empty()) return {};
    return std::strtoull(seed.c_str(), nullptr, 10);
}

void setRecorded(const log::Reader& log, framework::DeploymentSpec& spec) try {
    const auto file = log::propertyLog(log);
    if (!file || log.samples().empty()) return;
    const types::Time begin = log.samples().front().received;
    std::set<std::string> tasks;
    for (const framework::TaskSpec& task : spec.tasks) tasks.insert(task.name);
    for (const auto& [property, values] : readHistories(*log::openLog(*file), tasks)) {
        const auto [task, name] = splitPort(property);
        YAML::Node properties = spec.task(task)->properties;
        std::string value = values.front().second;
        for (const auto& [received, later] : values)
            if (received <= begin) value = later;
        if (value == absent_value)
            properties.remove(name);
        else
            properties[name] = YAML::Load(value);
    }
} catch (const types::ConfigError& error) {
    static std::set<std::string> told;  // the commands that read meanings have one thread
    if (told.insert(error.what()).second)
        console::printDiagnostic("notice: {}; what was set from outside is unknown\n", error.what());
}

RecordedSettings recordedSettings(const log::Reader& log, const framework::DeploymentSpec& spec,
                                  const std::vector<std::string>& set, std::optional<uint64_t> seed, double from) {
    framework::Registry registry = coreTasks();
    Deployment deployment(spec, registry, ".", seed ? *seed : recordedSeed(log).value_or(0));
    const std::map<std::string, Pings> pings = pingsByTask(log, spec, deployment);
    std::set<std::string> tasks;
    for (const auto& entry : pings) tasks.insert(entry.first);
    refuseOtherTypes(log, spec, tasks);

    Settings settings;
    for (const std::string& task : tasks) {
        if (names(set, task + ".quality")) settings.settled.insert(task + ".quality");
        if (seed) settings.settled.insert(task + ".seed");
        if (spec.datum) settings.settled.insert(task + ".datum");  // where the world is now, not an effect
    }
    settings.addQualities(deployment, log, tasks);
    settings.addProperties(deployment, log, pings, tasks, from);
    std::erase_if(settings.assignments, [&](const std::string& assignment) {
        const std::string property = assignment.substr(0, assignment.find('=') + 1);
        return std::ranges::any_of(set, [&](const std::string& given) { return given.starts_with(property); });
    });
    std::erase_if(settings.changed, [&](const RecordedProperty& p) { return names(set, p.task + "." + p.name); });
    return settings;
}

void LiveSettings::follow(Deployment& deployment) {
    const auto* const replay = dynamic_cast<const replay::ReplayTask*>(deployment.tasks().front().get());
    for (size_t i = 0; replay && i < changed_.size(); ++i) {
        const RecordedProperty& property = changed_[i];
        const auto next = replay->nextStamp(property.driver);
        if (!next) continue;
        const auto later = std::ranges::upper_bound(property.changes, *next, {}, &RecordedProperty::Change::from);
        const auto holding = static_cast<size_t>(later - property.changes.begin());
        if (std::exchange(applied_[i], holding) == holding) continue;
        std::string setter = property.task + ".set" + property.name;
        char& first = setter[property.task.size() + 4];
        first = types::raised(first);
        deployment.call(setter, {holding == 0 ? property.start : property.changes[holding - 1].value});
    }
}

std::string withShortLists(const std::string& text) {
    constexpr size_t max_values = 8;
    std::string shortened;
    size_t at = 0;
    for (size_t begin = text.find('['); begin != text.npos; begin = text.find('[', begin + 1)) {
        const size_t end = text.find(']', begin);
        if (end == text.npos) break;
        std::istringstream list(text.substr(begin + 1, end - begin - 1));
        std::vector<double> values;
        for (double value = 0; list >> value; list.ignore(1)) values.push_back(value);
        if (!list.eof() || values.size() <= max_values) continue;
        const auto [lowest, highest] = std::ranges::minmax_element(values);
        shortened += text.substr(at, begin - at) +
                     fmt::format("[{} values, {:.4g} to {:.4g}]", values.size(), *lowest, *highest);
        at = end + 1;
    }
    return shortened + text.substr(at);
}

}  // namespace insonify::deployer
