#include "components/logger/LoggerTask.hpp"

#include <filesystem>
#include <set>
#include <system_error>

#include "types/ConfigError.hpp"

namespace insonify::logger {

template <class T>
class LoggerTask::TypedInlet final : public Inlet {
public:
    using Port = framework::InputPort<pocolog::Carried<T>>;

    TypedInlet(std::unique_ptr<framework::InputPortBase> port, std::string source)
        : Inlet(std::move(source)), owned_(std::move(port)), port_(static_cast<Port&>(*owned_)) {}
    framework::InputPortBase& port() const override { return port_; }
    void declare(pocolog::Writer& log, const pocolog::Metadata& metadata) override {
        number_ = log.addStream<T>(stream, metadata);
    }
    void drain(LogThread& log, types::Time received) override {
        for (pocolog::Carried<T> sample{}; port_.readNew(sample);) log.push(number_, received, std::move(sample));
    }

private:
    std::unique_ptr<framework::InputPortBase> owned_;
    Port& port_;
    size_t number_ = 0;
};

framework::InputPortBase* LoggerTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    const size_t before = inlets_.size();
    pocolog::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (dynamic_cast<framework::OutputPort<pocolog::Carried<T>>*>(&source))
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

pocolog::Metadata LoggerTask::metadata() {
    pocolog::Metadata metadata = config->metadata;
    metadata["insonify_deployment"] = environment().deployment_text;
    metadata["insonify_seed"] = std::to_string(environment().seed);
    return metadata;
}

bool LoggerTask::configureHook() {
    checkInlets();
    const std::filesystem::path path = outputPath(config->file);
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (failed) throw types::ConfigError(path.parent_path(), "", "cannot be created: " + failed.message());
    log_.emplace(path);
    for (const auto& inlet : inlets_) inlet->declare(*log_, metadata());
    return true;
}

bool LoggerTask::startHook() {
    thread_.emplace(*log_, static_cast<size_t>(config->queue), config->flush_period);
    return true;
}

void LoggerTask::updateHook() {
    const types::Time received = now();
    for (const auto& inlet : inlets_) inlet->drain(*thread_, received);
}

void LoggerTask::stopHook() {
    struct End {
        std::optional<LogThread>& thread;
        ~End() { thread.reset(); }
    } end{thread_};
    if (thread_) thread_->finish();
}

void LoggerTask::cleanupHook() {
    if (log_) log_->close();
    log_.reset();
}

}  // namespace insonify::logger
