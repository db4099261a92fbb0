#include "components/logger/LoggerTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "components/framework/Graph.hpp"
#include "components/log/Stream.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::logger {

namespace {

/** Whether samples are measured in the frame of a sonar. */
template <class T>
constexpr bool in_sonar_frame = std::is_same_v<T, types::Sonar> || std::is_same_v<T, types::SonarDetections>;

template <class Input>
constexpr size_t findSample(const Input&) {
    return types::sampleIndex<typename Input::Sample>();
}

/** Declares a stream. @param sample index of its type in types::SampleTypes */
Declare declaration(size_t sample, const framework::StreamName& stream, log::Metadata metadata) {
    return [sample, name = stream.path(), metadata = std::move(metadata)](log::Writer& log) {
        return log.add(sample, name, metadata);
    };
}

/** @param streams those of the earlier inputs */
void checkInput(const framework::InputPortBase& port, const std::string& stream, std::set<std::string>& streams) {
    if (port.channels().size() > 1)
        throw types::ConfigError("", port.path(), "has several connections; give each its own port on the logger");
    if (!streams.insert(stream).second)
        throw types::ConfigError("", port.path(), "logs " + stream + " a second time; connect it once");
}

/** A JSON object. */
std::string toText(const types::Mount& mount) {
    const glm::dvec3& p = mount.position;
    return fmt::format(R"({{"position": [{}, {}, {}], "roll_deg": {}, "pitch_deg": {}, "yaw_deg": {}}})", p.x, p.y, p.z,
                       mount.roll_deg, mount.pitch_deg, mount.yaw_deg);
}

/** Returns the deployment's properties by their aliases, with their present values. */
std::vector<PropertyAlias> makeAliases(const LoggerTask& logger, const std::vector<types::TaskRecord>& records) {
    std::vector<PropertyAlias> aliases;
    for (const framework::PropertyAlias& alias : framework::propertyAliases(logger)) {
        const auto task = std::ranges::find(records, alias.task, &types::TaskRecord::name);
        auto value = task == records.end() ? std::nullopt : framework::valueAt(*task, alias.property);
        if (alias.is_switch) value = value.has_value();
        const std::string leads_to = alias.task + "." + alias.property;
        aliases.push_back({alias.name.task, alias.name.object, alias.name.model, leads_to, value, alias.in_degrees});
    }
    return aliases;
}

}  // namespace

framework::InputPortBase* LoggerTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    if (framework::InputPortBase* const made = inputs_.make(port, source, framework::streamName(source))) return made;
    throw types::ConfigError("", "",
                             source.path() + " is " + source.typeName() +
                                 ", which a log cannot hold; it holds numbers, texts and samples as " +
                                 "components/framework/README.md, A component of your own, says");
}

types::Notices LoggerTask::notices() const {
    types::Notices all;
    if (inputs_.empty()) all.emplace_back("nothing is connected to it: the log will be empty");
    for (const std::string& text : frame_notices_) all.push_back(text);
    if (health_.lost > 0)
        all.push_back(fmt::format("{} samples are in no file, because it could not be written {} times; the last: {}",
                                  health_.lost, health_.outages, health_.failure));
    if (health_.refused > 0)
        all.push_back(fmt::format("{} samples are in no file, because it cannot store them; the last: {}",
                                  health_.refused, health_.failure));
    return all;
}

std::optional<types::Recording> LoggerTask::recording() const { return board_.get(); }

bool LoggerTask::heals() const { return environment().mayLose(); }

void LoggerTask::followHealth() {
    const LogHealth before = std::exchange(health_, thread_->health());
    if (health_.refused > before.refused && before.refused == 0) warn("a sample is skipped: " + health_.failure);
    if (health_.fails) {
        if (state() != framework::TaskState::RunTimeError)
            error(health_.failure + "; samples are lost until a file can be written");
    } else if (before.fails || health_.outages > before.outages) {
        warn(fmt::format("records again, in {}; {} samples are lost", health_.file.string(),
                         health_.lost - before.lost));
        if (state() == framework::TaskState::RunTimeError) recover();
    }
}

void LoggerTask::checkInputs() const {
    std::set<std::string> streams;
    inputs_.forEach([&](const auto& input) { checkInput(input.port, input.kept.name.path(), streams); });
}

log::Metadata LoggerTask::runMetadata() const {
    log::Metadata metadata = config->metadata;
    metadata["insonify_seed"] = std::to_string(environment().seed);
    metadata["insonify_version"] = INSONIFY_VERSION;
    return metadata;
}

log::Metadata LoggerTask::streamMetadata(const framework::StreamName& stream) {
    log::Metadata metadata = runMetadata();
    if (!stream.model.empty()) metadata["rock_task_model"] = stream.model;
    if (declared_ == 0) metadata["insonify_deployment"] = environment().deployment_text;
    if (!environment().records) return metadata;
    std::string plans;
    for (const types::TaskRecord& task : environment().records())
        if (!task.plan.empty()) plans += (plans.empty() ? "\"" : ", \"") + task.name + "\": " + task.plan;
    if (!plans.empty()) metadata["insonify_plan"] = "{" + plans + "}";
    return metadata;
}

std::string LoggerTask::getBody(const framework::InputPortBase& port) const {
    std::set<std::string> logged;
    inputs_.forEach([&]<class Input>(const Input& input) {
        if (std::is_same_v<typename Input::Sample, types::Pose>) logged.insert(input.kept.name.path());
    });
    for (const framework::OutputPortBase* pose : framework::upstreamPoses(port))
        if (std::string name = framework::streamName(*pose).path(); logged.contains(name)) return name;
    return "";
}

template <class Input>
log::Metadata LoggerTask::getMetadata(const Input& input) {
    log::Metadata metadata = streamMetadata(input.kept.name);
    if constexpr (in_sonar_frame<typename Input::Sample>) {
        if (const auto khz = framework::upstreamNumber(input.port, {"frequency_khz", "absorption.frequency_khz"}))
            metadata["insonify_frequency_khz"] = fmt::format("{}", *khz);
        const auto mount = framework::upstreamMount(input.port);
        if (!mount) return metadata;
        metadata["insonify_mount"] = toText(*mount);
        if (const std::string body = getBody(input.port); !body.empty()) metadata["insonify_body"] = body;
    }
    return metadata;
}

std::vector<std::string> LoggerTask::sharedFrames() const {
    struct Claim {
        std::string stream, place;
    };
    std::map<std::string, Claim> claims;
    std::vector<std::string> shared;
    inputs_.forEach([&]<class Input>(const Input& input) {
        const auto mount = in_sonar_frame<typename Input::Sample> ? framework::upstreamMount(input.port) : std::nullopt;
        if (!mount) return;
        const std::string stream = input.kept.name.path();
        const auto given = config->mcap.streams.find(stream);
        const bool is_given = given != config->mcap.streams.end() && given->second.frame_id;
        const std::string frame = is_given ? *given->second.frame_id : config->mcap.frame_id;
        const Claim own{stream, toText(*mount) + getBody(input.port)};
        const Claim& first = claims.emplace(frame, own).first->second;
        if (first.place != own.place)
            shared.push_back(
                fmt::format("frame_id {} is the place of {} in /tf_static, not that of {}; give {} another "
                            "under mcap.streams, and its poses a child_frame_id of their own if it is on "
                            "another vehicle",
                            frame, first.stream, stream, stream));
    });
    return shared;
}

std::filesystem::path LoggerTask::makePath(const std::string& file) const {
    const std::filesystem::path path = outputPath(file);
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (failed) throw types::ConfigError(path.parent_path(), "", "cannot be created: " + failed.message());
    return path;
}

bool LoggerTask::logsProperties() {
    if (config->property_file.empty() || !environment().records) return false;
    const auto records = environment().records();
    const auto own =
        std::find_if(records.begin(), records.end(), [&](const auto& task) { return task.name == name(); });
    const auto folder = [](const types::TaskRecord& task) {
        return std::filesystem::path(std::get<std::string>(task.properties.at("file"))).parent_path();
    };
    const auto first = std::find_if(records.begin(), records.end(), [&](const types::TaskRecord& task) {
        return task.type == own->type && folder(task) == folder(*own) &&
               task.properties.at("property_file") == own->properties.at("property_file");
    });
    return first == own;
}

bool LoggerTask::configureHook() {
    checkInputs();
    const std::filesystem::path path = makePath(config->file);
    refuseSequels(path);
    log_.reset();
    log::McapConfig mcap = config->mcap;
    mcap.names = environment().names;
    mcap.names.remaps.clear();  // a log is not a node
    log_ = log::createLog(path, mcap);
    rotation_.emplace(*config, *log_);
    frame_notices_.clear();
    if (log::isMcap(path) && config->mcap.transforms) frame_notices_ = sharedFrames();
    if (logsProperties())
        properties_.emplace(log_->path().parent_path() / config->property_file, environment().deployment_text);
    configured_ = fixedValues();
    declared_ = 0;
    inputs_.forEach([](auto& input) { input.kept.number.reset(); });
    return true;
}

std::map<std::string, types::PropertyValue> LoggerTask::fixedValues() const {
    auto values = config.values();
    values.erase("record");
    return values;
}

bool LoggerTask::propertiesHook() { return !isRunning() || fixedValues() == configured_; }

bool LoggerTask::startHook() {
    removeSequels(log_->path());
    has_started_ = true;
    recorded_changes_ = 0;
    recordProperties();
    constexpr double never = 1e9;  // [s]
    health_ = {};
    board_.set(reportOn(log_->path(), 0));
    thread_.emplace(*log_, *rotation_, static_cast<size_t>(config->queue),
                    environment().is_shard ? never : config->flush_period, heals() ? AtFailure::Heal : AtFailure::Throw,
                    config->sync_period.value_or(never), &board_);
    return true;
}

void LoggerTask::recordProperties() {
    const uint64_t changes = *environment().record_changes;
    if (!properties_ || changes == recorded_changes_) return;
    recorded_changes_ = changes;
    const std::vector<types::TaskRecord> records = environment().records();
    try {
        properties_->record(records, now(), runMetadata(), makeAliases(*this, records), framework::taskModels(*this));
    } catch (const std::exception& failure) {
        if (!heals()) throw;
        warn(fmt::format("{} ends here: {}", config->property_file, failure.what()));
        properties_.reset();
    }
}

void LoggerTask::updateHook() {
    const types::Time received = now();
    recordProperties();
    inputs_.forEach([&]<class Input>(Input& input) {
        if (!config->record || environment().rehearsing) return input.port.clear();
        for (typename Input::Carried sample{}; input.port.readNew(sample);) {
            if (!input.kept.number) {
                log::Metadata metadata = getMetadata(input);
                log::addSampleMetadata(types::carriedSample(sample), metadata);
                thread_->declare(declaration(findSample(input), input.kept.name, std::move(metadata)));
                input.kept.number = declared_++;
            }
            thread_->push(*input.kept.number, received, std::move(sample));
        }
    });
    followHealth();
}

void LoggerTask::stopHook() {
    struct End {
        std::optional<LogThread>& thread;
        ~End() { thread.reset(); }
    } end{thread_};
    if (thread_) {
        thread_->finish();
        health_ = thread_->health();
    }
    recordProperties();
}

void LoggerTask::cleanupHook() {
    struct End {
        LoggerTask& task;
        ~End() {
            task.log_.reset();
            task.properties_.reset();
        }
    } end{*this};
    if (!std::exchange(has_started_, false)) return;  // the files of an earlier run stay
    inputs_.forEach([&](const auto& input) {
        if (input.kept.number) return;
        declaration(findSample(input), input.kept.name, getMetadata(input))(*log_);
        ++declared_;
    });
    log_->close();
    if (properties_) properties_->close();
}

void registerTasks(framework::Registry& registry) {
    registry.add<LoggerTask>("logger::LoggerTask",
                             "writes the samples of its connected ports to a pocolog or MCAP file");
}

}  // namespace insonify::logger
