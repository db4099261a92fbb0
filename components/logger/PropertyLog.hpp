#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/log/Writer.hpp"
#include "types/samples/TaskRecord.hpp"

namespace insonify::logger {

/** A property under another name, at one time. */
struct PropertyAlias {
    std::string task, name, model;              ///< The task that has the alias, the alias, and the task's kind.
    std::string leads_to;                       ///< "task.property"
    std::optional<types::PropertyValue> value;  ///< None: absent.
    bool in_degrees = false;
};

/** Writes the properties of tasks into a separate log, like Rock's logger into properties.0.log: a stream
 *  `task.property` for each present property, with a sample when it is first seen and whenever it has changed. Addition
 *  to Rock: when an optional property is removed, false is written to a stream `task.property.present`; when it is
 *  present again, true is written before its value. A property with an alias also has a stream of that name, an angle
 *  as Rock's `base::Angle`; metadata `insonify_alias_of` names its target. */
class PropertyLog {
public:
    /** Throws ConfigError when the file cannot be created. `deployment` is stored in the metadata of the first
     *  stream. */
    explicit PropertyLog(const std::filesystem::path& path, std::string deployment = "")
        : log_(log::createLog(path)), deployment_(std::move(deployment)) {}

    /** Throws std::runtime_error when the file cannot be written.
     *  @param models Rock's name of the kind of each task; a missing task has its type */
    void record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata,
                const std::vector<PropertyAlias>& aliases = {}, const std::map<std::string, std::string>& models = {});
    void close() { log_->close(); }

private:
    struct Written {
        std::optional<size_t> stream, presence;     ///< Streams of its value, and of its presence, once declared.
        std::optional<types::PropertyValue> value;  ///< None: absent now.
    };

    /** Adds a sample to a stream; the first sample declares the stream. */
    template <class T>
    void write(std::optional<size_t>& stream, const std::string& name, types::Time now, const T& value,
               const log::Metadata& metadata);
    void writePresence(Written& property, const std::string& name, types::Time now, const log::Metadata& metadata);
    void recordAlias(const PropertyAlias& alias, types::Time now, const log::Metadata& metadata);

    std::unique_ptr<log::Writer> log_;
    std::string deployment_;                                         ///< Until written.
    std::map<std::string, Written> written_aliases_;                 ///< By "task.alias".
    std::map<std::string, std::map<std::string, Written>> written_;  ///< By task and property.
};

}  // namespace insonify::logger
