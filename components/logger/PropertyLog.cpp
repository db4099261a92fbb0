#include "components/logger/PropertyLog.hpp"

namespace insonify::logger {

template <class T>
void PropertyLog::write(std::optional<size_t>& stream, const std::string& name, types::Time now, const T& value,
                        const log::Metadata& metadata) {
    if (!stream) stream = log_->addStream<T>(name, metadata);
    log_->write(*stream, now, value);
}

void PropertyLog::writePresence(Written& property, const std::string& name, types::Time now,
                                const log::Metadata& metadata) {
    write(property.presence, name + ".present", now, property.value.has_value(), metadata);
}

void PropertyLog::record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata) {
    for (const types::TaskRecord& task : tasks) {
        auto& written = written_[task.name];
        log::Metadata all = metadata;
        all["rock_stream_type"] = "property";
        all["rock_task_model"] = task.type;
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
    log_->flush();
}

}  // namespace insonify::logger
