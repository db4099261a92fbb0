#include "components/logger/LoggerTask.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "types/ConfigError.hpp"

namespace insonify::logger {

template <class T>
class LoggerTask::TypedInlet final : public Inlet {
public:
    using Port = framework::InputPort<types::Carried<T>>;

    TypedInlet(std::unique_ptr<framework::InputPortBase> port, std::string source)
        : Inlet(std::move(source)), owned_(std::move(port)), port_(static_cast<Port&>(*owned_)) {}
    framework::InputPortBase& port() const override { return port_; }
    Declare declaration(log::Metadata metadata) const override {
        return [name = stream, metadata = std::move(metadata)](log::Writer& log) {
            return log.addStream<T>(name, metadata);
        };
    }
    void drain(LogThread& log, types::Time received) override {
        for (types::Carried<T> sample{}; port_.readNew(sample);) log.push(*number, received, std::move(sample));
    }

private:
    std::unique_ptr<framework::InputPortBase> owned_;
    Port& port_;
};

framework::InputPortBase* LoggerTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    const size_t before = inlets_.size();
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (dynamic_cast<framework::OutputPort<types::Carried<T>>*>(&source))
            inlets_.push_back(std::make_unique<TypedInlet<T>>(source.makeReader(this, port), source.path()));
    });
    if (inlets_.size() == before)
        throw types::ConfigError("", "", source.path() + " is " + source.typeName() + ", which a log cannot hold");
    return &inlets_.back()->port();
}

std::vector<std::string> LoggerTask::notices() const {
    if (!inlets_.empty()) return {};
    return {"nothing is connected to it: the log will be empty"};
}

void LoggerTask::checkInlets() const {
    std::set<std::string> streams;
    for (const auto& inlet : inlets_) {
        const std::string path = inlet->port().path();
        if (inlet->port().channels().size() > 1)
            throw types::ConfigError("", path, "has several connections; give each a port of its own on the logger");
        if (!streams.insert(inlet->stream).second)
            throw types::ConfigError("", path, "logs " + inlet->stream + " a second time; connect it once");
    }
}

log::Metadata LoggerTask::runMetadata() {
    log::Metadata metadata = config->metadata;
    metadata["insonify_deployment"] = environment().deployment_text;
    metadata["insonify_seed"] = std::to_string(environment().seed);
    return metadata;
}

log::Metadata LoggerTask::streamMetadata() {
    log::Metadata metadata = runMetadata();
    if (!environment().records) return metadata;
    std::string plans;
    for (const types::TaskRecord& task : environment().records())
        if (!task.plan.empty()) plans += (plans.empty() ? "\"" : ", \"") + task.name + "\": " + task.plan;
    if (!plans.empty()) metadata["insonify_plan"] = "{" + plans + "}";
    return metadata;
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
    checkInlets();
    const std::filesystem::path path = makePath(config->file);
    removeSequels(path);
    log_ = log::createLog(path, config->mcap);
    rotation_.emplace(*config, *log_);
    if (logsProperties()) properties_.emplace(log_->path().parent_path() / config->property_file);
    configured_ = fixedValues();
    declared_ = 0;
    for (const auto& inlet : inlets_) inlet->number.reset();
    return true;
}

std::map<std::string, types::PropertyValue> LoggerTask::fixedValues() const {
    auto values = config.values();
    values.erase("record");
    return values;
}

bool LoggerTask::propertiesHook() { return !isRunning() || fixedValues() == configured_; }

bool LoggerTask::startHook() {
    recorded_changes_ = 0;
    recordProperties();
    thread_.emplace(*log_, *rotation_, static_cast<size_t>(config->queue), config->flush_period);
    return true;
}

void LoggerTask::recordProperties() {
    const uint64_t changes = *environment().record_changes;
    if (!properties_ || changes == recorded_changes_) return;
    recorded_changes_ = changes;
    properties_->record(environment().records(), now(), runMetadata());
}

void LoggerTask::updateHook() {
    const types::Time received = now();
    recordProperties();
    for (const auto& inlet : inlets_) {
        if (!config->record) {
            inlet->port().clear();
            continue;
        }
        if (!inlet->number && inlet->port().hasNew()) {
            thread_->declare(inlet->declaration(streamMetadata()));
            inlet->number = declared_++;
        }
        inlet->drain(*thread_, received);
    }
}

void LoggerTask::stopHook() {
    struct End {
        std::optional<LogThread>& thread;
        ~End() { thread.reset(); }
    } end{thread_};
    if (thread_) thread_->finish();
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
    for (const auto& inlet : inlets_)
        if (!inlet->number) inlet->declaration(streamMetadata())(*log_);
    log_->close();
    if (properties_) properties_->close();
}

void registerTasks(framework::Registry& registry) {
    registry.add<LoggerTask>("logger::LoggerTask", "writes what it is connected to into a pocolog or MCAP file");
}

}  // namespace insonify::logger
