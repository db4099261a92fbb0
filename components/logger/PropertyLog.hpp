#pragma once
#include <map>
#include <string>
#include <vector>

#include "components/log/Writer.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::logger {

/** Writes the properties of tasks into a log of their own: a stream `task.property` for each that is present, a sample
 *  when it is first seen and whenever it has changed. As Rock's logger does it, in properties.0.log. */
class PropertyLog {
public:
    /** Throws ConfigError when the file cannot be created. */
    explicit PropertyLog(const std::filesystem::path& path) : log_(log::createLog(path)) {}

    /** Throws std::runtime_error when the file cannot be written. */
    void record(const std::vector<types::TaskRecord>& tasks, types::Time now, const log::Metadata& metadata);
    void close() { log_->close(); }

private:
    struct Written {
        size_t stream = 0;
        types::PropertyValue value;
    };

    std::unique_ptr<log::Writer> log_;
    std::map<std::string, Written> written_;  ///< By stream.
};

}  // namespace insonify::logger
