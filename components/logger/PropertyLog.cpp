#include "components/logger/PropertyLog.hpp"

#include <utility>

namespace insonify::logger {

template <class T>
void PropertyLog::write(std::optional<size_t>& stream, const std::string& name, types::Time now, const T& value,
                        const log::Metadata& metadata) {
    if (!stream) {
        log::Metadata all = metadata;
        if (!deployment_.empty()) all["insonify_deployment"] = std::exchange(deployment_, {});
        stream = log_->addStream<T>(name, all);
    }
    log_->write(*stream, now, value);
}

void PropertyLog::writePresence(Written& property, const std::string& name, types::Time now,
                                const log::Metadata& metadata) {
    write(property.presence, name + ".present", now, property.value.has_value(), metadata);
}

void PropertyLog::record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata,
                         const std::vector<PropertyAlias>& aliases, const std::map<std::string, std::string>& models) {
    for (const types::TaskRecord& task : tasks) {
        auto& written = written_[task.name];
        log::Metadata all = metadata;
        all["rock_stream_type"] = "property";
        const auto model = models.find(task.name);
        all["rock_task_model"] = model == models.end() ? task.type : model->second;
        for (const auto& [name, value] : task.properties) {
            Written& property = written[name];
            if (property.value == value) continue;
            const std::string stream = task.name + "." + name;
            const bool is_back = property.stream && !property.value;
            property.value = value;
            if (is_back) writePresence(property, stream, now, all);
            std::visit([&](const auto& held) { write(property.stream, stream, now, held, all); }, value);
        }
        for (auto& [name, property] : written) {
            if (!property.value || task.properties.contains(name)) continue;
            property.value.reset();
            writePresence(property, task.name + "." + name, now, all);
        }
    }
    for (const PropertyAlias& alias : aliases)
        if (!written_[alias.task].contains(alias.name)) recordAlias(alias, now, metadata);
    log_->flush();
}

void PropertyLog::recordAlias(const PropertyAlias& alias, types::Time now, const log::Metadata& metadata) {
    const std::string stream = alias.task + "." + alias.name;
    Written& written = written_aliases_[stream];
    const bool is_other_type = written.value && alias.value && written.value->index() != alias.value->index();
    if (!alias.value || written.value == alias.value || is_other_type) return;
    written.value = alias.value;
    log::Metadata all = metadata;
    all["rock_stream_type"] = "property";
    all["rock_task_model"] = alias.model;
    all["insonify_alias_of"] = alias.leads_to;
    const double* const number = std::get_if<double>(&*alias.value);
    if (alias.in_degrees && number) return write(written.stream, stream, now, types::Angle::fromDeg(*number), all);
    std::visit([&](const auto& held) { write(written.stream, stream, now, held, all); }, *alias.value);
}

}  // namespace insonify::logger
