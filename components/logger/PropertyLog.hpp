#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/log/Writer.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::logger {

/** A property by another name, at one moment. */
struct PropertyAlias {
    std::string task, name, model;              ///< Whose it is by that name, and what kind of task that is.
    std::string leads_to;                       ///< "task.property"
    std::optional<types::PropertyValue> value;  ///< None: it is not there.
    bool in_degrees = false;
};

/** Writes the properties of tasks into a log of their own: a stream `task.property` for each that is present, a sample
 *  when it is first seen and whenever it has changed. As Rock's logger does it, in properties.0.log. What Rock has no
 *  word for: an optional property that is taken out writes false to a stream `task.property.present`, and true, before
 *  its value, when it is there again. A property with an alias has a stream of that name as well, an angle as Rock's
 *  `base::Angle`; its metadata name where it leads, `insonify_alias_of`. */
class PropertyLog {
public:
    /** Throws ConfigError when the file cannot be created. `deployment` goes into the metadata of the first stream. */
    explicit PropertyLog(const std::filesystem::path& path, std::string deployment = "")
        : log_(log::createLog(path)), deployment_(std::move(deployment)) {}

    /** Throws std::runtime_error when the file cannot be written.
     *  @param models what Rock calls the kind of each task; of one that is not there, its type. */
    void record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata,
                const std::vector<PropertyAlias>& aliases = {}, const std::map<std::string, std::string>& models = {});
    void close() { log_->close(); }

private:
    struct Written {
        std::optional<size_t> stream, presence;     ///< Of its value, and of whether it is there: once declared.
        std::optional<types::PropertyValue> value;  ///< None: it is not there now.
    };

    /** A sample of a stream, which is declared with its first. */
    template <class T>
    void write(std::optional<size_t>& stream, const std::string& name, types::Time now, const T& value,
               const log::Metadata& metadata);
    void writePresence(Written& property, const std::string& name, types::Time now, const log::Metadata& metadata);
    void recordAlias(const PropertyAlias& alias, types::Time now, const log::Metadata& metadata);

    std::unique_ptr<log::Writer> log_;
    std::string deployment_;                                         ///< Until it is written.
    std::map<std::string, Written> written_aliases_;                 ///< By "task.alias".
    std::map<std::string, std::map<std::string, Written>> written_;  ///< By task and property.
};

}  // namespace insonify::logger
