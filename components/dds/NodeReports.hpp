#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/dds/NodeServer.hpp"
#include "components/ros/NodeMessages.hpp"
#include "types/samples/DeploymentControl.hpp"

namespace insonify::dds {

/** Lines for the log of ROS that wait to be sent; any thread. */
class LogLines {
public:
    /** Levels of rcl_interfaces/msg/Log. */
    static constexpr uint8_t info = 20, warning = 30, error = 40;
    struct Line {
        uint8_t level;
        std::string text;  ///< "task: what happened"
    };
    /** Keeps the last thousand. */
    void add(uint8_t level, std::string text);
    std::vector<Line> take();

private:
    std::mutex mutex_;
    std::deque<Line> lines_;
};

/** Counts of a task since the start. */
struct TaskCounts {
    uint64_t missed = 0, hangs = 0;  ///< Periods, cycles.
};

/** What a node reports of its deployment.
 *
 *  `/rosout`: warnings at once, notices at the start, tasks that fail, recover, stop and run. `/diagnostics`, once a
 *  second: a status for each task. Its level is an error for a task in error, a warning for one that does not run, that
 *  has warned during the last ten seconds, or that has missed periods, hung or lost samples since the last report. Its
 *  values are rates of samples, times of the last cycle, and counts. */
class NodeReports {
public:
    /** @param counts returns those of a task, by its name; any thread
     *  Server and deployment must outlive this. Throws types::ConfigError. */
    NodeReports(NodeServer& server, types::DeploymentControl& deployment,
                std::function<TaskCounts(const std::string&)> counts, std::shared_ptr<LogLines> lines, bool diagnostics,
                bool rosout);
    NodeReports(const NodeReports&) = delete;
    NodeReports& operator=(const NodeReports&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    /** What was last seen of a task. */
    struct Seen {
        std::string state;
        std::map<std::string, uint64_t> written;  ///< By port.
        TaskCounts counts;
        uint64_t lost = 0;
        std::string warning;
        std::optional<Clock::time_point> warned;
    };

    void log();
    void diagnose();
    /** @param task with the ports that lead somewhere
     *  @param lost samples on the way to it, so far
     *  @param seconds since the last report [s] */
    ros::DiagnosticStatus diagnosed(const types::TaskStatus& task, uint64_t lost, double seconds);

    NodeServer& server_;
    types::DeploymentControl& deployment_;
    std::function<TaskCounts(const std::string&)> counts_;
    std::shared_ptr<LogLines> lines_;
    std::optional<MessageWriter<ros::DiagnosticArray>> diagnostics_;
    std::optional<MessageWriter<ros::Log>> rosout_;
    std::map<std::string, Seen> seen_;  ///< By task.
    Clock::time_point last_ = Clock::now();
};

}  // namespace insonify::dds
