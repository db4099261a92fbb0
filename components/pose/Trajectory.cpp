#include "components/pose/Trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "types/geometry/Angle.hpp"
#include "types/text/Csv.hpp"

namespace insonify::pose {
namespace {

/** Returns the second derivatives of one column at its knots: a tridiagonal system, zero at both ends. */
std::vector<double> curvatures(const std::vector<double>& times, const std::vector<Spline::Row>& rows, size_t column) {
    const size_t count = times.size();
    std::vector<double> curvature(count, 0), factor(count, 0);
    const auto slope = [&](size_t i) { return (rows[i + 1][column] - rows[i][column]) / (times[i + 1] - times[i]); };
    for (size_t i = 1; i + 1 < count; ++i) {
        const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
        const double pivot = 2 * (before + after) - before * factor[i - 1];
        factor[i] = after / pivot;
        curvature[i] = (6 * (slope(i) - slope(i - 1)) - before * curvature[i - 1]) / pivot;
    }
    for (size_t i = count - 1; i-- > 1;) curvature[i] -= factor[i] * curvature[i + 1];
    return curvature;
}

std::vector<Trajectory::Stamp> getStamps(const std::vector<Waypoint>& waypoints) {
    std::vector<Trajectory::Stamp> stamps;
    for (const Waypoint& waypoint : waypoints)
        stamps.push_back({waypoint.time, waypoint.position, waypoint.orientation()});
    return stamps;
}

std::vector<Trajectory::Stamp> inRun(std::vector<Trajectory::Stamp> stamps, const TrajectoryTimes& times) {
    const double first = stamps.empty() ? 0 : stamps.front().time;
    for (Trajectory::Stamp& stamp : stamps) stamp.time = times.inRun(stamp.time, first);
    return stamps;
}

/** Returns the body rate that rotates `from` into `to` in `seconds`, the shorter way [rad/s]. */
glm::dvec3 angularVelocity(const glm::dquat& from, const glm::dquat& to, double seconds) {
    glm::dquat turn = glm::conjugate(from) * to;
    if (turn.w < 0) turn = -turn;
    const glm::dvec3 half(turn.x, turn.y, turn.z);
    const double sine = glm::length(half);
    return sine == 0 ? glm::dvec3(0) : half * (2 * std::atan2(sine, turn.w) / (sine * seconds));
}

/** Returns the spline through stamps. Each quaternion gets the sign that is nearer to the previous quaternion. */
Spline splineThrough(const std::vector<Trajectory::Stamp>& stamps) {
    std::vector<double> times;
    std::vector<Spline::Row> rows;
    glm::dquat before = stamps.front().orientation;
    for (const Trajectory::Stamp& stamp : stamps) {
        const glm::dvec3& p = stamp.position;
        const glm::dquat q = glm::dot(before, stamp.orientation) < 0 ? -stamp.orientation : stamp.orientation;
        times.push_back(stamp.time);
        rows.push_back({p.x, p.y, p.z, q.w, q.x, q.y, q.z});
        before = q;
    }
    return {std::move(times), std::move(rows)};
}

constexpr double shortest_quaternion = 1e-6;

/** The forms of files of trajectories. */
enum class Form { Csv, Tum, Euroc };

/** Returns the first line that is neither blank nor, where `comments` are skipped, begins with #; without spaces before
 *  it. */
std::string_view firstLine(std::string_view text, bool comments) {
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        const size_t begin = text.substr(0, end).find_first_not_of(" \t\r");
        if (begin != text.npos && !(comments && text[begin] == '#')) return text.substr(begin, end - begin);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return {};
}

/** Returns the form of a file: one without a header, or with comments, is of TUM where no commas separate its
 *  numbers. */
Form getForm(std::string_view text) {
    const std::string_view first = firstLine(text, false), row = firstLine(text, true);
    const bool has_commas = row.find(',') != row.npos;
    if (first.starts_with('#'))
        return has_commas || (row.empty() && first.find(',') != first.npos) ? Form::Euroc : Form::Tum;
    const bool is_number =
        !first.empty() && std::string_view("+-.0123456789").find(first.front()) != std::string_view::npos;
    return is_number && !has_commas ? Form::Tum : Form::Csv;
}

types::TableForm makeTable(Form form) {
    using Header = types::TableForm::Header;
    if (form == Form::Tum) return {{{"time"}, {"x"}, {"y"}, {"z"}, {"qx"}, {"qy"}, {"qz"}, {"qw"}}, Header::None, ' '};
    if (form == Form::Euroc)
        return {
            {{"timestamp"}, {"p_RS_R_x"}, {"p_RS_R_y"}, {"p_RS_R_z"}, {"q_RS_w"}, {"q_RS_x"}, {"q_RS_y"}, {"q_RS_z"}},
            Header::Comment};
    return {{{"time"}, {"x"}, {"y"}, {"z"}, {"qw"}, {"qx"}, {"qy"}, {"qz"}}};
}

std::vector<types::CsvDiagnostic> evaluate(const std::vector<double>& row, const std::vector<double>* before) {
    std::vector<types::CsvDiagnostic> diagnostics;
    if (before && !(row[0] > before->front()))
        diagnostics.push_back({0, "is not after the line before; times must increase"});
    const double length = glm::length(glm::dquat(row[4], row[5], row[6], row[7]));  // in any order
    if (!(length >= shortest_quaternion) || !std::isfinite(length))
        diagnostics.push_back({4, "starts a quaternion of no usable length; it must be about 1"});
    return diagnostics;
}

}  // namespace

Spline::Spline(std::vector<double> times, std::vector<Row> rows)
    : times_(std::move(times)), rows_(std::move(rows)), curvatures_(rows_.size()) {
    for (size_t column = 0; column < columns; ++column) {
        const std::vector<double> curvature = curvatures(times_, rows_, column);
        for (size_t i = 0; i < curvature.size(); ++i) curvatures_[i][column] = curvature[i];
    }
}

Spline::Point Spline::at(size_t knot, double time) const {
    const double length = times_[knot] - times_[knot - 1];
    const double b = (time - times_[knot - 1]) / length, a = 1 - b;
    const Row &from = rows_[knot - 1], &to = rows_[knot];
    const Row &bent_from = curvatures_[knot - 1], &bent_to = curvatures_[knot];
    Point point;
    for (size_t i = 0; i < columns; ++i) {
        point.value[i] = a * from[i] + b * to[i] +
                         ((a * a * a - a) * bent_from[i] + (b * b * b - b) * bent_to[i]) * length * length / 6;
        point.rate[i] =
            (to[i] - from[i]) / length + ((3 * b * b - 1) * bent_to[i] - (3 * a * a - 1) * bent_from[i]) * length / 6;
    }
    return point;
}

glm::dquat Waypoint::orientation() const {
    return glm::angleAxis(types::radians(yaw_deg), glm::dvec3(0, 0, 1)) *
           glm::angleAxis(types::radians(pitch_deg), glm::dvec3(0, 1, 0)) *
           glm::angleAxis(types::radians(roll_deg), glm::dvec3(1, 0, 0));
}

void TrajectoryTimes::check(types::Diagnostics& diagnostics) const {
    if (start_s && start == TrajectoryStart::FirstPose)
        diagnostics.push_back({"start_s", "is given together with start: first_pose; give one of the two"});
}

TimeUnit TrajectoryTimes::findUnit(double first) const {
    if (time_unit) return *time_unit;
    constexpr double since_1973 = 1e8;  // [s] since 1970; in seconds the next units would be after the year 5000
    for (const auto& [unit, per_second] :
         {std::pair(TimeUnit::Nanoseconds, 1e9), std::pair(TimeUnit::Microseconds, 1e6),
          std::pair(TimeUnit::Milliseconds, 1e3)})
        if (first >= since_1973 * per_second) return unit;
    return TimeUnit::Seconds;
}

double TrajectoryTimes::inRun(double time, double first) const {
    constexpr double per_second[] = {1, 1e3, 1e6, 1e9};
    const double scale = per_second[static_cast<size_t>(findUnit(first))];
    return (time - (start == TrajectoryStart::FirstPose ? first : start_s.value_or(0) * scale)) / scale;
}

void TrajectoryConfig::check(types::Diagnostics& diagnostics) const {
    times.check(diagnostics);
    if (file && !waypoints.empty())
        diagnostics.push_back({"waypoints", "is given together with file; give one of the two"});
    if (!file && waypoints.empty())
        diagnostics.push_back({"file", "is not given; give a file or at least one waypoint"});
    if (!file && world_frame != types::WorldFrame::AsIs)
        diagnostics.push_back({"world_frame", "is that of a file; waypoints are x north, y west, z up"});
    for (size_t i = 1; i < waypoints.size(); ++i)
        if (!(waypoints[i].time > waypoints[i - 1].time))
            diagnostics.push_back({"waypoints[" + std::to_string(i) + "].time",
                                   "is not after the previous waypoint; times must increase"});
}

Trajectory::Trajectory(std::vector<Stamp> stamps, bool smooth) : stamps_(std::move(stamps)) {
    const auto out_of_order = [](const Stamp& a, const Stamp& b) { return !(a.time < b.time); };
    if (stamps_.empty() || std::adjacent_find(stamps_.begin(), stamps_.end(), out_of_order) != stamps_.end())
        throw std::invalid_argument("a trajectory needs a stamp, and increasing times");
    if (smooth && stamps_.size() > 1) spline_.emplace(splineThrough(stamps_));
}

Trajectory::Trajectory(const std::vector<Stamp>& stamps, bool smooth, const TrajectoryTimes& times)
    : Trajectory(inRun(stamps, times), smooth) {
    unit_ = times.findUnit(stamps.front().time);
}

Trajectory::Trajectory(const std::vector<Waypoint>& waypoints, bool smooth, const TrajectoryTimes& times)
    : Trajectory(getStamps(waypoints), smooth, times) {}

void Trajectory::placeOnSpline(size_t stamp, double time, types::Pose& pose) const {
    const auto [v, rate] = spline_->at(stamp, time);
    const glm::dquat q(v[3], v[4], v[5], v[6]), turning(rate[3], rate[4], rate[5], rate[6]);
    const glm::dquat turn = glm::inverse(q) * turning;
    pose.position = {v[0], v[1], v[2]};
    pose.velocity = {rate[0], rate[1], rate[2]};
    pose.orientation = glm::normalize(q);
    pose.angular_velocity = 2.0 * glm::dvec3(turn.x, turn.y, turn.z);
}

types::Pose Trajectory::at(double time) const {
    types::Pose pose;
    pose.source_frame = "body";
    pose.target_frame = "world";
    pose.velocity = pose.angular_velocity = glm::dvec3(0);
    const auto after = std::upper_bound(stamps_.begin(), stamps_.end(), time,
                                        [](double t, const Stamp& stamp) { return t < stamp.time; });
    const bool moving = after != stamps_.begin() && after != stamps_.end();
    const Stamp& from = after == stamps_.begin() ? *after : *(after - 1);
    const Stamp& to = moving ? *after : from;
    pose.position = from.position;
    pose.orientation = from.orientation;
    if (!moving) return pose;
    if (spline_) {
        placeOnSpline(static_cast<size_t>(after - stamps_.begin()), time, pose);
        return pose;
    }
    const double seconds = to.time - from.time;
    types::interpolate(from, to, (time - from.time) / seconds, pose);
    pose.velocity = (to.position - from.position) / seconds;
    pose.angular_velocity = angularVelocity(from.orientation, to.orientation, seconds);
    return pose;
}

double Trajectory::inLoop(double time) const {
    const double first = stamps_.front().time, length = stamps_.back().time - first;
    return length > 0 && time > first ? first + std::fmod(time - first, length) : time;
}

Trajectory Trajectory::fromFile(const std::filesystem::path& file, bool smooth, const TrajectoryTimes& times,
                                types::WorldFrame frame) {
    const types::Axes axes{frame};
    Form form = Form::Csv;
    const auto recognise = [&](std::string_view text) { return makeTable(form = getForm(text)); };
    std::vector<Stamp> stamps;
    size_t odd_lengths = 0;
    for (const std::vector<double>& row : types::readTable(file, recognise, 1, evaluate)) {
        const glm::dquat orientation =
            form == Form::Tum ? glm::dquat(row[7], row[4], row[5], row[6]) : glm::dquat(row[4], row[5], row[6], row[7]);
        odd_lengths += types::isOddlyLong(orientation);
        stamps.push_back({row[0], axes.rockFromWorld({row[1], row[2], row[3]}),
                          axes.rockFromOrientation(orientation / glm::length(orientation))});
    }
    TrajectoryTimes of_form = times;
    if (form != Form::Csv && !times.time_unit)
        of_form.time_unit = form == Form::Euroc ? TimeUnit::Nanoseconds : TimeUnit::Seconds;
    Trajectory trajectory(stamps, smooth, of_form);
    trajectory.odd_lengths_ = odd_lengths;
    return trajectory;
}

}  // namespace insonify::pose
