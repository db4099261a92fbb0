#include "components/logger/PropertyLog.hpp"

#include <algorithm>

#include "components/framework/Upstream.hpp"

namespace insonify::logger {
namespace {

/** Of the property that an alias leads to; none: it is not there. Of a switch, whether its block is there. */
std::optional<types::PropertyValue> valueOf(const framework::PropertyAlias& alias, const types::TaskRecord& task) {
    const auto value = framework::valueAt(task, alias.property);
    if (alias.is_switch) return value.has_value();
    return value;
}

}  // namespace

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

void PropertyLog::record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata) {
    for (const framework::PropertyAlias& alias : aliases_) models_[alias.name.task] = alias.name.model;
    for (const types::TaskRecord& task : tasks) {
        auto& written = written_[task.name];
        log::Metadata all = metadata;
        all["rock_stream_type"] = "property";
        all["rock_task_model"] = models_.contains(task.name) ? models_.at(task.name) : task.type;
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
    recordAliases(tasks, now, metadata);
    log_->flush();
}

void PropertyLog::recordAliases(const std::vector<types::TaskRecord>& tasks, types::Time now,
                                const log::Metadata& metadata) {
    for (const framework::PropertyAlias& alias : aliases_) {
        const auto task = std::ranges::find(tasks, alias.task, &types::TaskRecord::name);
        const auto value = task == tasks.end() ? std::nullopt : valueOf(alias, *task);
        const std::string stream = alias.name.path();
        Written& written = written_aliases_[stream];
        if (!value || written.value == value || written_[alias.name.task].contains(alias.name.object)) continue;
        log::Metadata all = metadata;
        all["rock_stream_type"] = "property";
        all["rock_task_model"] = alias.name.model;
        all["insonify_alias_of"] = alias.task + "." + alias.property;
        const double* const number = std::get_if<double>(&*value);
        if (written.value && written.value->index() != value->index()) continue;  // its stream has another type
        written.value = value;
        if (alias.in_degrees && number)
            write(written.stream, stream, now, types::Angle::fromDeg(*number), all);
        else
            std::visit([&](const auto& held) { write(written.stream, stream, now, held, all); }, *value);
    }
}

}  // namespace insonify::logger
