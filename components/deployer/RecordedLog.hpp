#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/deployer/Pipeline.hpp"
#include "components/deployer/Tasks.hpp"
#include "components/log/Stream.hpp"
#include "components/log/Writer.hpp"
#include "components/logger/PropertyLog.hpp"
#include "types/ConfigError.hpp"

namespace insonify::deployer {

/** Returns the names of the deployment's sonar whose pings were recorded, and of its receiver: the first receiver that
 *  outputs codes. Throws types::ConfigError where there is no such receiver, or none of its inputs come from a
 *  Sonar. */
template <class Sonar>
std::pair<std::string, std::string> recordedTasks(const framework::Deployment& deployment, const char* sonar_type) {
    const std::string& file = deployment.spec().file;
    const std::string receiver = codingReceiverOf(deployment, file).name();
    for (const std::string& name : upstream({receiver}, deployment))
        if (dynamic_cast<const Sonar*>(deployment.task(name))) return {name, receiver};
    throw types::ConfigError(file, "tasks." + receiver,
                             std::string("has no input from a ") + sonar_type + ", whose pings are recorded");
}

/** The log made from a recording. With a deployment, properties.0.log is next to it, as the logger of a run writes it.
 *  Without one, only what the recording states is known of the tasks. */
class RecordedLog {
public:
    /** @param text a deployment for the metadata, if `spec` is none */
    RecordedLog(const std::filesystem::path& recording, std::optional<framework::DeploymentSpec> spec,
                const std::string& text, std::filesystem::path to);

    /** Sets properties, as `--set` takes them, that apply from the ping at `from` on; before the first sample. Changed
     *  properties are written again. Throws types::ConfigError for properties that the tasks refuse, and where a file
     *  cannot be made. */
    void set(const std::vector<std::string>& properties, types::Time from);
    /** Adds a sample to "task.port". @param more metadata of the stream */
    template <class T>
    void write(const std::string& stream, const T& sample, const log::Metadata& more = {}) {
        const auto [found, is_new] = streams_.try_emplace(stream);
        if (is_new) {
            log::Metadata metadata = metadataOf(stream, more);
            log::addSampleMetadata(&sample, metadata);
            found->second = log_->addStream<T>(stream, metadata);
        }
        log_->write(found->second, sample.time, sample);
    }
    void close();

    /** Properties of the first ping. */
    const std::vector<std::string>& properties() const { return first_; }
    /** How often the properties changed after the first ping. */
    size_t changes() const { return changes_; }

private:
    void record(const std::vector<std::string>& properties, types::Time from);
    log::Metadata metadataOf(const std::string& stream, const log::Metadata& more) const;

    const bool has_deployment_;
    framework::DeploymentSpec spec_;
    std::filesystem::path to_;
    framework::Registry registry_ = coreTasks();
    std::unique_ptr<log::Writer> log_;
    std::optional<logger::PropertyLog> properties_;
    log::Metadata run_;  ///< Shared by all streams.
    std::map<std::string, size_t> streams_;
    std::vector<std::string> first_, last_;
    size_t changes_ = 0;
};

}  // namespace insonify::deployer
