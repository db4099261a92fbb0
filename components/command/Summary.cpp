#include "components/command/Summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "components/framework/Offers.hpp"
#include "components/sonar/tasks/PingTask.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

Summary::Times getTimes(const framework::Statistics& seconds) {
    return {seconds.count(), seconds.median() * 1e3, seconds.p99() * 1e3, seconds.max() * 1e3};
}

Summary::Task taskSummary(const framework::TaskContext& task) {
    Summary::Task summary{task.name(), framework::toString(task.state()), getTimes(task.cycles()), {}, {}, {}, {}};
    if (const auto* one = dynamic_cast<const sonar::PingTask*>(&task)) summary.counted = one->counted();
    const framework::Timing& timing = task.timing();
    summary.jitter = getTimes(timing.jitter);
    summary.latency = getTimes(timing.latency);
    summary.overruns = timing.overruns;
    summary.late = timing.late;
    summary.errors = timing.errors;
    summary.hangs = timing.hangs;
    for (const auto& [name, seconds] : task.stages()) summary.stages[name] = getTimes(seconds);
    return summary;
}

void addOnce(std::vector<types::Omission>& all, const types::Omission& omission) {
    const auto same = [&](const types::Omission& other) {
        return other.name == omission.name && other.reason == omission.reason;
    };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(omission);
}

Json timesJson(const Summary::Times& times) {
    return {
        {"count", times.cycles}, {"median_ms", times.median_ms}, {"p99_ms", times.p99_ms}, {"max_ms", times.max_ms}};
}

/** A count of a sonar's pings, where it is not 0. */
struct CountRow {
    const sonar::CounterMeaning& of;
    uint64_t total;
    double per_ping, per_second;  ///< Of the time in its stage; 0: that is too short to measure.
};

std::vector<CountRow> countRows(const sonar::CountedPings& counted) {
    std::vector<CountRow> rows;
    for (size_t i = 0; i < sonar::counter_count; ++i) {
        const sonar::CounterMeaning& meaning = sonar::counter_meanings[i];
        const auto stage = std::ranges::find(sonar::empty_stages, std::string_view(meaning.stage), &sonar::Stage::name);
        const double seconds = counted.seconds[static_cast<size_t>(stage - sonar::empty_stages.begin())];
        const auto total = static_cast<double>(counted.counts[i]);
        if (total > 0)
            rows.push_back({meaning, counted.counts[i], total / static_cast<double>(counted.pings),
                            seconds > 0 ? total / seconds : 0});
    }
    return rows;
}

/** Returns the share of the pings' time in which no work was divided among threads [1]. */
double getUndividedShare(const sonar::CountedPings& counted) {
    return counted.all_seconds > 0 ? 1 - counted.divided_seconds / counted.all_seconds : 0;
}

Json countsJson(const sonar::CountedPings& counted) {
    Json counts = {{"pings", counted.pings}, {"undivided_share", getUndividedShare(counted)}};
    for (const CountRow& row : countRows(counted))
        counts[row.of.name] = {
            {"stage", row.of.stage}, {"total", row.total}, {"per_ping", row.per_ping}, {"per_second", row.per_second}};
    return counts;
}

std::string statsText(const Summary::Task& task) {
    std::string text =
        fmt::format("{}, {} pings\n  {:10} {:>10} {:>10}   {:16} {:>12} {:>12}\n", task.name, task.counted.pings,
                    "stage", "median ms", "p99 ms", "count", "per ping", "per second");
    const std::vector<CountRow> rows = countRows(task.counted);
    for (const auto& [stage, seconds] : sonar::empty_stages) {
        const auto times = task.stages.find(stage);
        if (times == task.stages.end()) continue;
        std::string begin =
            fmt::format("  {:10} {:>10.3f} {:>10.3f}", stage, times->second.median_ms, times->second.p99_ms);
        for (const CountRow& row : rows) {
            if (std::string_view(row.of.stage) != stage) continue;
            text += fmt::format("{:34}   {:16} {:>12.1f} {:>12.4g}\n", std::exchange(begin, ""), row.of.name,
                                row.per_ping, row.per_second);
        }
        if (!begin.empty()) text += begin + "\n";
    }
    return text +
           fmt::format("  not divided among threads: {:.1f} % of a ping\n", 100 * getUndividedShare(task.counted));
}

Json taskJson(const Summary::Task& task, bool realtime) {
    Json stages = Json::object();
    for (const auto& [name, times] : task.stages)
        stages[name] = {{"median_ms", times.median_ms}, {"p99_ms", times.p99_ms}};
    Json json = {{"state", task.state},          {"cycles", task.update.cycles}, {"median_ms", task.update.median_ms},
                 {"p99_ms", task.update.p99_ms}, {"max_ms", task.update.max_ms}, {"stages", stages}};
    if (task.counted.pings > 0) json["counts"] = countsJson(task.counted);
    if (!realtime) return json;
    json["jitter"] = timesJson(task.jitter);
    json["latency"] = timesJson(task.latency);
    json["overruns"] = task.overruns;
    json["late"] = task.late;
    json["errors"] = task.errors;
    json["hangs"] = task.hangs;
    return json;
}

std::string timesLine(const std::string& name, const std::string& state, const Summary::Times& times) {
    return fmt::format("  {:20} {:14} {:>8} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, state, times.cycles,
                       times.median_ms, times.p99_ms, times.max_ms);
}

/** Returns a line for each count that is not 0. */
std::string countsText(const std::map<std::string, uint64_t>& counts) {
    std::string text;
    for (const auto& [connection, count] : counts)
        if (count > 0) text += fmt::format("  {:6}  {}\n", count, connection);
    return text;
}

/** Returns a line for each omission, and one line for all that is not configured. */
std::string omittedText(const std::vector<types::Omission>& omitted) {
    std::string text, absent;
    for (const types::Omission& omission : omitted)
        if (omission.not_configured)
            absent += (absent.empty() ? "" : ", ") + omission.name;
        else
            text += fmt::format("  {}: {}\n", omission.name, omission.reason);
    if (!absent.empty()) text += "  not configured: " + absent + "\n";
    return text.empty() ? text : "omitted\n" + text;
}

}  // namespace

Summary::Summary(const framework::Deployment& deployment, const framework::RunResult& result)
    : pings(result.rehearsed > 0 ? result.samples : result.most),
      pings_by_port(pings > result.samples ? result.by_port : decltype(pings_by_port)()),
      wall_s(result.wall_s),
      realtime(!deployment.spec().lockstep),
      losses(deployment.losses()),
      passed_over(deployment.passedOver()),
      warnings(result.warnings) {
    for (const auto& task : deployment.tasks()) {
        tasks.push_back(taskSummary(*task));
        if (const types::Plan* plan = framework::makePlan(*task)) {
            for (const types::Omission& omission : plan->omitted) addOnce(omitted, omission);
            plans[task->name()] = *plan;
        }
    }
}

Json Summary::json() const {
    Json by_name = Json::object();
    for (const Task& task : tasks) by_name[task.name] = taskJson(task, realtime);
    Json quality = Json::object(), devices = Json::object();
    for (const auto& [task, plan] : plans) {
        quality[task] = toJson(plan)["quality"];
        devices[task] = plan.device;
    }
    Json json = {{"pings", pings},     {"wall_s", wall_s},           {"tasks", by_name},
                 {"losses", losses},   {"passed_over", passed_over}, {"omitted", toJson(omitted)},
                 {"quality", quality}, {"devices", devices}};
    if (!pings_by_port.empty()) json["pings_by_port"] = pings_by_port;
    if (realtime) json["warnings"] = warnings;
    return json;
}

std::string Summary::text() const {
    std::string text = fmt::format("{} ping{} in {:.2f} s: {:.1f} per second", pings, pings == 1 ? "" : "s", wall_s,
                                   wall_s > 0 ? static_cast<double>(pings) / wall_s : 0.0);
    for (const auto& [port, count] : pings_by_port) text += fmt::format(", {} {}", port, count);
    text += "\n";
    for (const Task& task : tasks) {
        if (plans.contains(task.name) && task.update.cycles > 0)
            text += fmt::format("{}: {:.1f} ms per ping, the median; {:.1f} ms at most\n", task.name,
                                task.update.median_ms, task.update.max_ms);
        if (task.state == "Exception") text += task.name + ": Exception\n";
        if (task.overruns + task.late + task.errors + task.hangs > 0)
            text += fmt::format("{}: {} overruns, {} cycles late, {} errors, {} hangs\n", task.name, task.overruns,
                                task.late, task.errors, task.hangs);
    }
    if (const std::string lost = countsText(losses); !lost.empty()) text += "lost samples\n" + lost;
    return text;
}

std::string Summary::stats() const {
    std::string text;
    for (const Task& task : tasks)
        if (task.counted.pings > 0) text += statsText(task);
    return text.empty() ? "no sonar has made a ping\n" : text;
}

std::string Summary::details() const {
    std::string text = fmt::format("  {:20} {:14} {:>8} {:>10} {:>10} {:>10}\n", "task", "state", "cycles", "median ms",
                                   "p99 ms", "max ms");
    for (const Task& task : tasks) {
        text += timesLine(task.name, task.state, task.update);
        for (const auto& [name, times] : task.stages) text += timesLine("  " + name, "", times);
    }
    if (realtime) text += realtimeText();
    for (const auto& [task, plan] : plans) text += fmt::format("{}: {}\n", task, qualityText(plan));
    if (const std::string skipped = countsText(passed_over); !skipped.empty())
        text += "skipped for newer samples\n" + skipped;
    return text + omittedText(omitted);
}

std::string Summary::realtimeText() const {
    const auto times = [](const Times& t) {
        return t.cycles == 0 ? std::string(31, ' ')
                             : fmt::format("{:>9.3f} {:>10.3f} {:>10.3f}", t.median_ms, t.p99_ms, t.max_ms);
    };
    std::string text = fmt::format("  {:20} {:>8} {:>6} {:>6} {:>5} | {:31} | {:31}\n", "in time", "overruns", "late",
                                   "errors", "hangs", "jitter median, p99, max ms", "latency median, p99, max ms");
    for (const Task& task : tasks)
        text += fmt::format("  {:20} {:>8} {:>6} {:>6} {:>5} | {} | {}\n", task.name, task.overruns, task.late,
                            task.errors, task.hangs, times(task.jitter), times(task.latency));
    return text;
}

}  // namespace insonify::command
