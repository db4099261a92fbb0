#include "components/logger/PropertyLog.hpp"

namespace insonify::logger {

void PropertyLog::record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata) {
    for (const types::TaskRecord& task : tasks)
        for (const auto& [name, value] : task.properties) {
            const std::string stream = task.name + "." + name;
            const auto before = written_.find(stream);
            if (before != written_.end() && before->second.value == value) continue;
            std::visit(
                [&]<class T>(const T& held) {
                    size_t number = before == written_.end() ? 0 : before->second.stream;
                    if (before == written_.end()) {
                        log::Metadata all = metadata;
                        all["rock_stream_type"] = "property";
                        all["rock_task_model"] = task.type;
                        number = log_->addStream<T>(stream, all);
                    }
                    log_->write(number, now, held);
                    written_[stream] = {number, value};
                },
                value);
        }
    log_->flush();
}

}  // namespace insonify::logger
