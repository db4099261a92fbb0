#include "components/deployer/RecordedLog.hpp"

namespace insonify::deployer {

RecordedLog::RecordedLog(const std::filesystem::path& recording, std::optional<framework::DeploymentSpec> spec,
                         const std::string& text, std::filesystem::path to)
    : has_deployment_(spec.has_value()),
      spec_(spec ? std::move(*spec) : framework::DeploymentSpec::parse(text, to.string())),
      to_(std::move(to)),
      run_{{"insonify_deployment", spec_.text}, {"insonify_recording", recording.filename().string()}} {}

void RecordedLog::set(const std::vector<std::string>& properties, types::Time from) {
    if (properties == last_) return;
    if (has_deployment_) record(properties, from);
    if (!log_) {
        log_ = log::createLog(to_);
        first_ = properties;
    } else
        ++changes_;
    last_ = properties;
}

void RecordedLog::record(const std::vector<std::string>& properties, types::Time from) {
    for (const std::string& property : properties) spec_.set(property);
    framework::Deployment deployment(spec_, registry_);
    run_["insonify_seed"] = std::to_string(deployment.environment().seed);
    const std::filesystem::path file = to_.parent_path() / "properties.0.log";
    if (!properties_) {
        std::error_code none;
        const bool is_own = std::filesystem::exists(to_, none) && log::propertyLog(*log::openLog(to_)) == file;
        if (std::filesystem::exists(file, none) && !is_own)
            throw types::ConfigError(file.string(), "--to", "is of another run; give the log a folder of its own");
        properties_.emplace(file);
    }
    properties_->record(deployment.environment().records(), from, run_);
}

log::Metadata RecordedLog::metadataOf(const std::string& stream, const log::Metadata& more) const {
    log::Metadata all = more;
    all.insert(run_.begin(), run_.end());
    if (const framework::TaskSpec* task = spec_.task(framework::splitPort(stream).first))
        all["rock_task_model"] = task->type;
    return all;
}

void RecordedLog::close() {
    log_->close();
    if (properties_) properties_->close();
}

}  // namespace insonify::deployer
