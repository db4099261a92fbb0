#include "components/deployer/Summary.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace insonify::deployer {
namespace {

Summary::Times timesOf(const framework::Statistics& seconds) {
    return {seconds.count(), seconds.median() * 1e3, seconds.p99() * 1e3, seconds.max() * 1e3};
}

Summary::Task taskSummary(const framework::TaskContext& task) {
    Summary::Task summary{task.name(), framework::toString(task.state()), timesOf(task.cycles()), {}};
    for (const auto& [name, seconds] : task.stages()) summary.stages[name] = timesOf(seconds);
    return summary;
}

void addOnce(std::vector<types::Omission>& all, const types::Omission& omission) {
    const auto same = [&](const types::Omission& other) {
        return other.name == omission.name && other.reason == omission.reason;
    };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(omission);
}

Json taskJson(const Summary::Task& task) {
    Json stages = Json::object();
    for (const auto& [name, times] : task.stages)
        stages[name] = {{"median_ms", times.median_ms}, {"p99_ms", times.p99_ms}};
    return {{"state", task.state},          {"cycles", task.update.cycles}, {"median_ms", task.update.median_ms},
            {"p99_ms", task.update.p99_ms}, {"max_ms", task.update.max_ms}, {"stages", stages}};
}

std::string timesLine(const std::string& name, const std::string& state, const Summary::Times& times) {
    return fmt::format("  {:20} {:14} {:>8} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, state, times.cycles,
                       times.median_ms, times.p99_ms, times.max_ms);
}

}  // namespace

Summary::Summary(const framework::Deployment& deployment, const framework::RunResult& result)
    : pings(result.pings), wall_s(result.wall_s), losses(deployment.losses()) {
    for (const auto& task : deployment.tasks()) {
        tasks.push_back(taskSummary(*task));
        if (const types::Plan* plan = task->plan()) {
            for (const types::Omission& omission : plan->omitted) addOnce(omitted, omission);
            plans[task->name()] = *plan;
        }
    }
}

Json Summary::json() const {
    Json by_name = Json::object();
    for (const Task& task : tasks) by_name[task.name] = taskJson(task);
    Json lost = Json::object();
    for (const auto& [connection, count] : losses) lost[connection] = count;
    Json quality = Json::object();
    for (const auto& [task, plan] : plans) quality[task] = toJson(plan)["quality"];
    return {{"pings", pings}, {"wall_s", wall_s},           {"tasks", by_name},
            {"losses", lost}, {"omitted", toJson(omitted)}, {"quality", quality}};
}

std::string Summary::text() const {
    std::string text = fmt::format("{} pings in {:.2f} s: {:.1f} per second\n", pings, wall_s,
                                   wall_s > 0 ? static_cast<double>(pings) / wall_s : 0.0);
    text += fmt::format("  {:20} {:14} {:>8} {:>10} {:>10} {:>10}\n", "task", "state", "cycles", "median ms", "p99 ms",
                        "max ms");
    for (const Task& task : tasks) {
        text += timesLine(task.name, task.state, task.update);
        for (const auto& [name, times] : task.stages) text += timesLine("  " + name, "", times);
    }
    for (const auto& [task, plan] : plans) text += fmt::format("{}: {}\n", task, qualityText(plan));
    text += "lost samples\n";
    for (const auto& [connection, count] : losses) text += fmt::format("  {:6}  {}\n", count, connection);
    if (!omitted.empty()) text += "left out\n";
    for (const types::Omission& omission : omitted) text += fmt::format("  {}: {}\n", omission.name, omission.reason);
    return text;
}

}  // namespace insonify::deployer
