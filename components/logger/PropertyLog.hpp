#pragma once
#include <map>
#include <string>
#include <vector>

#include "components/pocolog/Writer.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::logger {

/** Writes the properties of tasks into a log of their own: a stream `task.property` for each that is present, a sample
 *  when it is first seen and whenever it has changed. As Rock's logger does it, in properties.0.log. */
class PropertyLog {
public:
    /** Throws ConfigError when the file cannot be created. */
    explicit PropertyLog(std::filesystem::path path) : log_(std::move(path)) {}

    /** Throws std::runtime_error when the file cannot be written. */
    void record(const std::vector<types::TaskRecord>& tasks, types::Time now, const pocolog::Metadata& metadata);
    void close() { log_.close(); }

private:
    struct Written {
        size_t stream = 0;
        types::PropertyValue value;
    };

    pocolog::Writer log_;
    std::map<std::string, Written> written_;  ///< By stream.
};

}  // namespace insonify::logger
