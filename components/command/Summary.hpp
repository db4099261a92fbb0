#pragma once
#include <map>
#include <string>
#include <vector>

#include "components/deployer/Json.hpp"
#include "components/framework/Deployment.hpp"
#include "components/sonar/base/Counters.hpp"

namespace insonify::command {

/** The result of a run, for `--summary` and for the text at the end. Taken before tasks are cleaned up. */
struct Summary {
    struct Times {
        uint64_t cycles = 0;
        double median_ms = 0, p99_ms = 0, max_ms = 0;
    };
    struct Task {
        std::string name, state;
        Times update;                         ///< Times of updateHook.
        std::map<std::string, Times> stages;  ///< Stages of updateHook, by name.
        sonar::CountedPings counted;          ///< What a sonar's pings have counted; of other tasks 0 pings.
        Times jitter;                         ///< In realtime: delay of the begin of periodic cycles.
        Times latency;                        ///< In realtime: from a sample's stamp to its writing.
        uint64_t overruns = 0, late = 0, errors = 0, hangs = 0;  ///< As in framework::Timing.
    };
    uint64_t pings = 0;                             ///< Of the sonar that has sent most.
    std::map<std::string, uint64_t> pings_by_port;  ///< Empty if all sonars have sent as many.
    double wall_s = 0;
    bool realtime = false;
    std::vector<Task> tasks;                      ///< In file order.
    std::map<std::string, uint64_t> losses;       ///< By "from>to" [samples].
    std::map<std::string, uint64_t> passed_over;  ///< Skipped for newer samples, by "from>to" [samples].
    std::vector<types::Omission> omitted;         ///< Omissions of all sonars, without repeats.
    std::map<std::string, types::Plan> plans;     ///< Plans of the sonars that have sent a ping, by task.
    std::vector<std::string> warnings;            ///< In realtime, as from framework::Deployment::onWarning.

    Summary(const framework::Deployment& deployment, const framework::RunResult& result);
    console::Json json() const;
    /** Returns pings, time per ping, and what went wrong. */
    std::string text() const;
    /** Returns the times of all tasks and stages, the quality, and what is omitted. */
    std::string details() const;
    /** Returns a table for each sonar: times of its stages, and what they count per ping and per second. */
    std::string stats() const;

private:
    std::string realtimeText() const;
};

}  // namespace insonify::command
