#pragma once
#include <optional>

#include "components/log/Writer.hpp"
#include "components/logger/LoggerConfig.hpp"

namespace insonify::logger {

/** Throws ConfigError when another logger writes one of the files that removeSequels() removes. */
void refuseSequels(const std::filesystem::path& log);

/** Removes the files that follow `log` from an earlier run, also after missing numbers, because Rock would read them as
 *  parts of this run. Call it when the run starts: until then, it may still fail. Throws as refuseSequels(), when
 * another logger writes the last of them, before removing any. */
void removeSequels(const std::filesystem::path& log);

/** Decides when a log continues in its next file: x.0.log, x.1.log... */
class Rotation {
public:
    Rotation(const LoggerConfig& config, log::Writer& log);

    /** Continues in the next file if this one is full or old enough, or the clock was set back to before its start,
     *  before a sample received at `now`. Throws as log::Writer::next. */
    void before(types::Time now);

private:
    bool due(types::Time now) const;

    log::Writer& log_;
    std::optional<double> max_size_, max_duration_;
    std::optional<types::Time> began_;  ///< When the file's first sample was received.
};

}  // namespace insonify::logger
