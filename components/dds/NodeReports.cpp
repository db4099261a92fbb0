#include "components/dds/NodeReports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/ros/Stamps.hpp"

namespace insonify::dds {
namespace {

/** Levels of diagnostic_msgs/msg/DiagnosticStatus. */
enum class Level : uint8_t { Right, Warning, Error };

/** Returns the task that a line "task: text" is about; empty if none. */
std::string getTask(const std::string& line, const types::DeploymentStatus& status) {
    const std::string word = line.substr(0, line.find(':'));
    for (const types::TaskStatus& task : status.tasks)
        if (task.record.name == word) return word;
    return "";
}

/** Returns "auv.insonify" for "/auv/insonify", as loggers of ROS are named. */
std::string loggerName(const std::string& node) {
    std::string name = node.substr(1);
    std::ranges::replace(name, '/', '.');
    return name;
}

bool isInError(const std::string& state) {
    return state == "RunTimeError" || state == "Exception" || state == "FatalError";
}

}  // namespace

void LogLines::add(uint8_t level, std::string text) {
    constexpr size_t at_most = 1000;  // as many as /rosout keeps
    std::lock_guard lock(mutex_);
    lines_.push_back({level, std::move(text)});
    if (lines_.size() > at_most) lines_.pop_front();
}

std::vector<LogLines::Line> LogLines::take() {
    std::lock_guard lock(mutex_);
    std::vector<Line> lines(std::make_move_iterator(lines_.begin()), std::make_move_iterator(lines_.end()));
    lines_.clear();
    return lines;
}

NodeReports::NodeReports(NodeServer& server, types::DeploymentControl& deployment,
                         std::function<TaskCounts(const std::string&)> counts, std::shared_ptr<LogLines> lines,
                         bool diagnostics, bool rosout)
    : server_(server), deployment_(deployment), counts_(std::move(counts)), lines_(std::move(lines)) {
    constexpr auto often = std::chrono::milliseconds(100), each_second = std::chrono::milliseconds(1000);
    const Quality of_rosout{
        .reliability = Reliability::Reliable, .depth = 1000, .transient_local = true, .lifespan_s = 10};
    if (rosout) rosout_.emplace(server.node(), server.named("/rosout"), of_rosout);
    if (diagnostics)
        diagnostics_.emplace(server.node(), server.named("/diagnostics"),
                             Quality{.reliability = Reliability::Reliable, .depth = 10});
    for (const types::TaskStatus& task : deployment.status().tasks) seen_[task.record.name].state = task.state;
    server_.every(often, [this] { log(); });
    if (diagnostics) server_.every(each_second, [this] { diagnose(); });
}

void NodeReports::log() {
    const types::DeploymentStatus status = deployment_.status();
    for (const types::TaskStatus& task : status.tasks) {
        Seen& seen = seen_[task.record.name];
        if (seen.state == task.state) continue;
        const bool fails = isInError(task.state);
        lines_->add(fails ? LogLines::error : LogLines::info,
                    fmt::format("{}: is {}{}", task.record.name, task.state, fails ? ": " + task.error : ""));
        seen.state = task.state;
    }
    for (const LogLines::Line& line : lines_->take()) {
        const std::string task = getTask(line.text, status);
        if (!task.empty() && line.level == LogLines::warning) {
            seen_[task].warning = line.text.substr(std::min(task.size() + 2, line.text.size()));
            seen_[task].warned = Clock::now();
        }
        if (!rosout_) continue;
        const std::string logger = loggerName(server_.nodeName());
        rosout_->send(
            {ros::toRos(status.now), line.level, task.empty() ? logger : logger + "." + task, line.text, "", "", 0});
    }
}

void NodeReports::diagnose() {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    const types::DeploymentStatus status = deployment_.status();
    ros::DiagnosticArray all;
    all.header.stamp = ros::toRos(status.now);
    for (types::TaskStatus task : status.tasks) {
        uint64_t lost = 0;
        for (const types::ConnectionStatus& connection : status.connections)
            if (connection.to.starts_with(task.record.name + ".")) lost += connection.lost;
        std::erase_if(task.outputs, [&](const types::PortStatus& port) {
            const std::string path = task.record.name + "." + port.name;
            return std::ranges::count(status.connections, path, &types::ConnectionStatus::from) == 0;
        });
        all.status.push_back(diagnosed(task, lost, seconds));
    }
    diagnostics_->send(all);
}

ros::DiagnosticStatus NodeReports::diagnosed(const types::TaskStatus& task, uint64_t lost, double seconds) {
    constexpr auto recent = std::chrono::seconds(10);
    Seen& seen = seen_[task.record.name];
    const TaskCounts counts = counts_(task.record.name);
    ros::DiagnosticStatus status;
    const auto judge = [&](Level level, const std::string& message) {
        if (static_cast<uint8_t>(level) <= static_cast<uint8_t>(status.level) && !status.message.empty()) return;
        status.level = static_cast<std::byte>(level);
        status.message = message;
    };
    if (isInError(task.state)) judge(Level::Error, task.state + ": " + task.error);
    if (!isInError(task.state) && task.state != "Running") judge(Level::Warning, "is " + task.state);
    if (counts.hangs > seen.counts.hangs) judge(Level::Warning, "a cycle hangs");
    if (counts.missed > seen.counts.missed)
        judge(Level::Warning, fmt::format("{} periods missed", counts.missed - seen.counts.missed));
    if (lost > seen.lost) judge(Level::Warning, fmt::format("{} samples lost", lost - seen.lost));
    if (seen.warned && Clock::now() - *seen.warned < recent) judge(Level::Warning, seen.warning);
    judge(Level::Right, task.state);
    status.name = server_.nodeName().substr(1) + ": " + task.record.name;
    status.hardware_id = task.record.type;
    const auto add = [&](const std::string& key, const std::string& value) { status.values.push_back({key, value}); };
    for (const types::PortStatus& port : task.outputs) {
        const auto before = seen.written.find(port.name);
        const uint64_t more = before == seen.written.end() ? 0 : port.written - before->second;
        add(port.name + " rate [1/s]", fmt::format("{:.3g}", static_cast<double>(more) / std::max(seconds, 1e-3)));
        seen.written[port.name] = port.written;
    }
    add("last cycle [ms]", fmt::format("{:.3g}", task.cycle_s * 1e3));
    add("latency [ms]", fmt::format("{:.3g}", task.latency_s * 1e3));
    add("missed periods", std::to_string(counts.missed));
    add("hangs", std::to_string(counts.hangs));
    add("lost samples", std::to_string(lost));
    seen.counts = counts, seen.lost = lost;
    return status;
}

}  // namespace insonify::dds
