#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "components/log/Reader.hpp"
#include "components/log/Writer.hpp"
#include "types/text/Describe.hpp"

namespace insonify::logger {

/** x.3.log -> x.4.log, x.3.mcap -> x.4.mcap; the file must have a number. */
inline std::filesystem::path nextInSequence(const std::filesystem::path& log) {
    const std::string name = log.stem().stem().string();
    return log.parent_path() /
           (name + "." + std::to_string(uint64_t{*log::sequenceNumber(log)} + 1) + log.extension().string());
}

struct LoggerConfig {
    std::string file;
    std::string property_file = "properties.0.log";
    std::optional<double> max_file_size, max_file_duration, max_total_size;
    double flush_period = 1;
    std::optional<double> sync_period;
    int queue = 64;
    bool record = true;
    std::map<std::string, std::string> metadata;
    log::McapConfig mcap;

    static void describe(auto& self, auto& visit) {
        visit({"file", "",
               "log to write, relative to --out: NAME.0.log, or NAME.0.mcap for ROS 2 messages; an old one is "
               "replaced"},
              self.file);
        visit({"property_file", "",
               "log of all tasks' properties, in the folder of `file`, with a stream for each; empty: none"},
              self.property_file);
        visit({"max_file_size", "B", "above this size the log continues in NAME.1.log and so on", 1e6, 1e15},
              self.max_file_size);
        visit({"max_file_duration", "s", "after this time the log continues in NAME.1.log and so on", 0.1, 1e9},
              self.max_file_duration);
        visit({"max_total_size", "B",
               "of all files of the log: before it would be above this, the oldest are removed; at least twice "
               "max_file_size",
               2e6, 1e15},
              self.max_total_size);
        visit({"flush_period", "s", "at most this much is lost when the process is killed", 0.001, 1},
              self.flush_period);
        visit({"sync_period", "s",
               "at most this much is lost when the power fails: so often the log's thread waits for the disk; absent: "
               "the system writes when it likes, usually within 30 s",
               0.1, 1e6},
              self.sync_period);
        visit({"queue", "1", "max samples waiting for the file, at most 256 MiB, in addition to the ports' buffers", 1,
               65536},
              self.queue);
        visit({"record", "", "false: samples are skipped until it is true again; may be set while running"},
              self.record);
        visit({"metadata", "", "keys and values in the metadata of every stream"}, self.metadata);
        visit({"mcap", "", "how samples become ROS 2 messages, for a log that ends in .mcap"}, self.mcap);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!log::findLogFormat(file))
            diagnostics.push_back({"file", "is '" + file + "'; it must be a file name that ends in " +
                                               log::logEndings() + ", as in harbour.0.log"});
        else if ((max_file_size || max_file_duration) && !log::sequenceNumber(file))
            diagnostics.push_back(
                {"file", "is '" + file + "'; a log of several files must have a number, as in x.0.log"});
        if (max_total_size && !max_file_size)
            diagnostics.push_back({"max_total_size", "needs max_file_size: a log of one file has no oldest one"});
        else if (max_total_size && *max_total_size < 2 * *max_file_size)
            diagnostics.push_back({"max_total_size", "must be at least twice max_file_size: " +
                                                         std::to_string(static_cast<uint64_t>(2 * *max_file_size))});
        if (!property_file.empty() && (!log::findLogFormat(property_file) || log::isMcap(property_file) ||
                                       property_file.find('/') != std::string::npos))
            diagnostics.push_back({"property_file", "is '" + property_file +
                                                        "'; it must be a file name that ends in .log, as in "
                                                        "properties.0.log, or empty"});
        if (std::filesystem::path(file).filename() == property_file)
            diagnostics.push_back({"property_file", "is '" + property_file + "', the same as `file`; it must differ"});
    }
};

}  // namespace insonify::logger
