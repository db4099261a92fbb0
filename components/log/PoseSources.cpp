#include "components/log/PoseSources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "components/ros/Cdr.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Stamps.hpp"
#include "components/ros/TransformTree.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::log {
namespace {

constexpr std::string_view arrow = "->";

bool hasFixes(const Stream& stream) { return stream.holds<types::Fix>(); }

/** Calls `use(at, transform, is_static)` for each transform, those of /tf_static first. Returns what is wrong with the
 *  messages that cannot be decoded. */
std::vector<std::string> forEachTransform(Reader& log, auto&& use) {
    std::vector<std::string> lost;
    ros::TFMessage message;
    for (const bool is_static : {true, false})
        for (const SampleRef& at : log.samples()) {
            const Stream& stream = log.streams()[at.stream];
            if (stream.message != ros::TFMessage::type_name || stream.topic.ends_with("tf_static") != is_static)
                continue;
            try {
                ros::decode(log.toBytes(at), message);
            } catch (const ros::CdrError& error) {
                lost.push_back(fmt::format("message {} of the log is not of its type: {}", at.number, error.what()));
                continue;
            }
            for (const ros::TransformStamped& transform : message.transforms) use(at, transform, is_static);
        }
    return lost;
}

/** @param why of each that is lost */
types::Notices omissions(const std::vector<std::string>& why, const std::string& of) {
    if (why.empty()) return {};
    return {types::warning(
        fmt::format("messages of {} are omitted: {}, the first because: {}", of, why.size(), why.front()))};
}

/** Calls dropDamaged(). */
types::Notices dropDamaged(Reader& log, size_t stream, const std::string& source) {
    return omissions(log.dropDamaged(stream), source);
}

void append(types::Notices& notices, types::Notices more) {
    notices.insert(notices.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
}

types::Time getStamp(const ros::Time& stamp, types::Time otherwise) {
    return stamp == ros::Time{} ? otherwise : ros::fromRos(stamp);
}

std::string getName(const std::string& frame) { return frame.substr(frame.starts_with('/')); }

/** What the transforms of a log say of one frame. */
struct Edge {
    std::string parent;
    bool moves = false;
    size_t count = 0;
    types::Time first, last;
};

/** Returns the frame that a chain upwards ends at; empty: the parents form a circle. */
std::string findRoot(const std::map<std::string, Edge>& edges, const std::string& frame) {
    std::string root = frame;
    for (size_t steps = 0; steps <= edges.size(); ++steps) {
        const auto edge = edges.find(root);
        if (edge == edges.end()) return root;
        root = edge->second.parent;
    }
    return {};
}

void findTransforms(Reader& log, std::vector<FoundPoses>& found) {
    std::map<std::string, Edge> edges;
    forEachTransform(log, [&](const SampleRef& at, const ros::TransformStamped& transform, bool is_static) {
        if (edges.size() >= ros::TransformTree::max_frames && !edges.contains(getName(transform.child_frame_id)))
            return;
        Edge& edge = edges[getName(transform.child_frame_id)];
        const types::Time time = getStamp(transform.header.stamp, at.time);
        if (edge.count++ == 0) edge.parent = getName(transform.header.frame_id), edge.first = time;
        edge.last = time;
        edge.moves |= !is_static;
    });
    for (const auto& [child, edge] : edges) {
        const std::string root = edge.moves ? findRoot(edges, child) : "";
        if (root.empty()) continue;
        for (const std::string& parent : std::set<std::string>{root, edge.parent})
            found.push_back({fmt::format("{}{}{}", parent, arrow, child), ros::TFMessage::type_name, parent, child,
                             edge.count, edge.first, edge.last});
    }
}

/** Returns the frame of a fix, which only messages name. Throws std::runtime_error for a damaged message. */
std::string frameOfFixes(Reader& log, const SampleRef& at) {
    if (log.streams()[at.stream].message != ros::NavSatFix::type_name) return "";
    ros::NavSatFix fix;
    ros::decode(log.toBytes(at), fix);
    return fix.header.frame_id;
}

/** Sets the frames that the first sample names. */
void readFrames(Reader& log, size_t stream, FoundPoses& found) try {
    const auto first = std::ranges::find(log.samples(), stream, &SampleRef::stream);
    if (found.has_fixes) return void(found.child = frameOfFixes(log, *first));
    types::Pose pose;
    log.read(*first, pose);
    found.parent = pose.target_frame;
    found.child = pose.source_frame;
} catch (const std::runtime_error&) {  // reported where it is used
}

/** Returns the sources that there are, to end a message. */
std::string choices(Reader& log) {
    std::string text;
    for (const FoundPoses& each : findPoses(log)) text += (text.empty() ? "" : ", ") + each.source + " " + each.text();
    return text.empty() ? "the log has none" : "there are: " + text;
}

[[noreturn]] void refuseSource(Reader& log, const PoseSource& asked, const std::string& what) {
    throw types::ConfigError(log.path(), asked.source, what);
}

template <class T>
std::vector<types::Attitude> readAttitudes(Reader& log, size_t stream) {
    std::vector<types::Attitude> attitudes;
    T sample;
    for (const SampleRef& at : log.samples()) {
        if (at.stream != stream) continue;
        log.read(at, sample);
        const double length = glm::length(sample.orientation);
        if (std::isfinite(length) && length > 1e-6)
            attitudes.push_back({types::sampleTime(sample, at.time), sample.orientation / length});
    }
    std::ranges::stable_sort(attitudes, {}, &types::Attitude::time);
    return attitudes;
}

/** Returns the orientations of a body over time, in their order, and adds to the notices. */
std::vector<types::Attitude> findAttitudes(Reader& log, const std::string& source, types::Notices& notices) {
    const size_t index = log.findIndex(source);
    const Stream& stream = log.streams()[index];
    const auto refuse = [&](const std::string& what) {
        throw types::ConfigError(log.path(), source, "is the orientation, and " + what);
    };
    const auto read = stream.holds<types::Imu>() ? readAttitudes<types::Imu> : readAttitudes<types::Pose>;
    if (!stream.holds<types::Imu>() && !stream.holds<types::Pose>())
        refuse("holds " + stream.type + "; may be a stream of poses or of sensor_msgs/msg/Imu");
    append(notices, dropDamaged(log, index, source));
    auto attitudes = read(log, index);
    if (attitudes.empty()) refuse("has none that is known");
    return attitudes;
}

types::Notices renamePoses(Reader& log, const PoseSource& asked, size_t stream) {
    types::Notices notices = dropDamaged(log, stream, asked.source);
    const size_t count = log.streams()[stream].count;
    types::Pose pose;
    log.keepSamples(stream, [&](SampleRef& at) {
        log.read(at, pose);
        at.time = types::sampleTime(pose, at.time);
        return types::isUsable(pose);
    });
    const size_t kept = log.streams()[stream].count;
    if (kept == 0) refuseSource(log, asked, "has no pose that is finite and has an orientation");
    log.rename(stream, asked.stream);
    if (kept < count)
        notices.push_back(types::warning(
            fmt::format("{} of {} poses of {} are omitted: they are not finite, or their orientation has no length",
                        count - kept, count, asked.source)));
    return notices;
}

/** Follows one frame in another through a log. */
class Follower {
public:
    /** @param stamped whether the transforms of the log have stamps: those of a simulator may begin at 0 */
    Follower(std::string parent, std::string child, types::WorldFrame frame, bool stamped)
        : made_{std::move(parent), std::move(child), {}}, axes_{frame}, stamped_(stamped) {}

    void add(const SampleRef& at, const ros::TransformStamped& transform, bool is_static) {
        if (current_ != at.number) take();
        current_ = at.number;
        const types::Time stamp = stamped_ ? std::max(ros::fromRos(transform.header.stamp), types::Time{1}) : at.time;
        if (!is_static && !offset_) offset_ = stamp - at.received;
        // The clock of the senders, of which a log knows only the stamps: these may run faster than it was received.
        const types::Time by_reception = at.received + offset_.value_or(types::Time{});
        now_ = std::max(by_reception, stamp - ros::TransformTree::max_ahead);
        const std::string refused = tree_.add(transform, is_static, stamp, now_);
        if (!refused.empty() && omitted_++ == 0) first_omitted_ = refused;
        moves_ |= !is_static;
    }
    /** Takes the pose that is known after the messages so far. */
    void take() {
        if (!current_ || !moves_) return;
        const auto [placed, diagnostic] = tree_.newest(made_.parent, made_.child, now_);
        if (!diagnostic.empty()) diagnostic_ = diagnostic;
        if (!placed || !std::isfinite(glm::length(placed->position))) return;
        is_fixed_ = placed->time.isNull();
        const bool is_old = !made_.poses.empty() && placed->time <= made_.poses.back().time && life_ == tree_.lives();
        if (is_fixed_ || is_old || (!made_.poses.empty() && placed->time == made_.poses.back().time)) return;
        life_ = tree_.lives();
        made_.poses.push_back({*current_, placed->time, axes_.rockFromWorld(placed->position),
                               axes_.rockFromOrientation(placed->orientation)});
    }
    /** Returns why there are no poses. */
    std::string reason() const {
        if (is_fixed_) return "is a fixed pose: all transforms between them are static";
        return diagnostic_.empty() ? "the log has no transforms that move" : diagnostic_;
    }
    types::Notices notices() const {
        if (omitted_ == 0) return {};
        return {
            types::warning(fmt::format("{} transforms are omitted, the first because: {}", omitted_, first_omitted_))};
    }
    Reader::MadePoses& made() { return made_; }

private:
    Reader::MadePoses made_;
    const types::Axes axes_;
    const bool stamped_;
    ros::TransformTree tree_;
    std::optional<size_t> current_;  ///< The message that is being added.
    std::optional<types::Time> offset_;
    types::Time now_;
    uint64_t life_ = 0;
    bool moves_ = false, is_fixed_ = false;
    size_t omitted_ = 0;
    std::string first_omitted_, diagnostic_;
};

types::Notices followFrames(Reader& log, const PoseSource& asked, types::WorldFrame frame) {
    const size_t middle = asked.source.find(arrow);
    bool stamped = false;
    forEachTransform(log, [&](const SampleRef&, const ros::TransformStamped& transform, bool is_static) {
        stamped |= !is_static && transform.header.stamp != ros::Time{};
    });
    Follower follower(getName(asked.source.substr(0, middle)), getName(asked.source.substr(middle + arrow.size())),
                      frame, stamped);
    const std::vector<std::string> lost =
        forEachTransform(log, [&](const SampleRef& at, const ros::TransformStamped& transform, bool is_static) {
            follower.add(at, transform, is_static);
        });
    follower.take();
    if (follower.made().poses.empty())
        refuseSource(
            log, asked,
            fmt::format("gives no poses: {}; {}", lost.empty() ? follower.reason() : lost.front(), choices(log)));
    Stream stream;
    stream.name = asked.stream;
    types::Notices notices = omissions(lost, "tf");
    append(notices, follower.notices());
    log.addPoses(std::move(stream), std::move(follower.made()));
    return notices;
}

/** Adds what there is to say of fixes that became poses. */
void addNotices(Reader& log, const PoseSource& asked, size_t omitted, glm::dvec3 first, types::Notices& notices) {
    if (omitted > 0)
        notices.push_back(
            types::warning(fmt::format("{} messages of {} are omitted: they have no fix", omitted, asked.source)));
    if (asked.orientation.empty()) {
        std::string turning;
        for (const Stream& stream : log.streams())
            if (stream.holds<types::Imu>() || (stream.holds<types::Pose>() && stream.name != asked.stream))
                turning += (turning.empty() ? "" : ", ") + (stream.topic.empty() ? stream.name : stream.topic);
        notices.push_back(fmt::format("{} has only positions: the body is level and looks to the north{}", asked.source,
                                      turning.empty() ? "" : "; orientation may be " + turning));
    }
    if (glm::length(first) > types::far_from_datum)
        notices.push_back(types::warning(fmt::format("{} begins {:.0f} km from the datum; is that of another place?",
                                                     asked.source, glm::length(first) / 1e3)));
}

/** Returns the datum of a source, or else of the world. */
types::Datum findDatum(Reader& log, const PoseSource& asked, const std::optional<types::Datum>& world,
                       const types::Datum& first) {
    if (asked.datum && world && !isSamePlace(*asked.datum, *world))
        refuseSource(
            log, asked,
            fmt::format("has the datum {}, and the deployment's is {}; a world has one origin: omit that of the "
                        "source",
                        text(*asked.datum), text(*world)));
    if (asked.datum || world) return asked.datum ? *asked.datum : *world;
    refuseSource(
        log, asked,
        fmt::format("has latitudes and longitudes, and needs a datum, the origin of the world; that of its "
                    "first fix is datum: {{latitude_deg: {0:.9g}, longitude_deg: {1:.9g}, height_m: {2:.6g}}}, "
                    "or --datum {0:.9g},{1:.9g},{2:.6g}",
                    first.latitude_deg, first.longitude_deg, std::isnan(first.height_m) ? 0 : first.height_m));
}

types::Notices placeFixes(Reader& log, const PoseSource& asked, size_t stream,
                          const std::optional<types::Datum>& world) {
    types::Notices notices = dropDamaged(log, stream, asked.source);
    std::vector<types::Attitude> attitudes;
    if (!asked.orientation.empty()) attitudes = findAttitudes(log, asked.orientation, notices);
    Reader::MadePoses made;
    std::optional<types::Datum> datum;
    types::Fix fix;
    for (const SampleRef& at : log.samples()) {
        if (at.stream != stream) continue;
        log.read(at, fix);
        if (!datum && fix.hasPosition()) datum = findDatum(log, asked, world, fix.place());
        const std::optional<types::Pose> pose = datum ? placeFix(fix, *datum) : std::nullopt;
        if (!pose) continue;
        if (made.poses.empty()) made.child = frameOfFixes(log, at);
        const types::Time time = types::sampleTime(fix, at.time);
        made.poses.push_back({at.number,
                              time,
                              pose->position,
                              attitudes.empty() ? pose->orientation : findOrientation(attitudes, time),
                              {pose->cov_position[0][0], pose->cov_position[1][1], pose->cov_position[2][2]}});
    }
    const size_t omitted = log.streams()[stream].count - made.poses.size();
    if (made.poses.empty()) refuseSource(log, asked, fmt::format("has no fix in its {} messages", omitted));
    const glm::dvec3 first = made.poses.front().position;
    Stream placed;
    placed.name = asked.stream;
    log.addPoses(std::move(placed), std::move(made));
    addNotices(log, asked, omitted, first, notices);
    return notices;
}

}  // namespace

bool isSourceOf(const PoseSource& poses, const Stream& stream) {
    return poses.source == stream.name || poses.source == stream.topic ||
           (stream.message == ros::TFMessage::type_name && poses.source.find(arrow) != std::string::npos);
}

std::string FoundPoses::text() const {
    const std::string frames =
        (parent.empty() && child.empty()) || source.find(arrow) != source.npos
            ? ""
            : fmt::format("{} {} {}, ", parent.empty() ? "?" : parent, arrow, child.empty() ? "?" : child);
    return fmt::format("({}, {}{} in {:.6g} s)", type, frames, count, (last - first).seconds());
}

std::vector<FoundPoses> findPoses(Reader& log) {
    std::vector<FoundPoses> found;
    for (size_t i = 0; i < log.streams().size(); ++i) {
        const Stream& stream = log.streams()[i];
        if (stream.count == 0 || !(stream.holds<types::Pose>() || hasFixes(stream))) continue;
        FoundPoses poses;
        poses.source = stream.topic.empty() ? stream.name : stream.topic;
        poses.type = stream.message.empty() ? stream.type : stream.message;
        poses.count = stream.count;
        poses.first = stream.first;
        poses.last = stream.last;
        poses.has_fixes = hasFixes(stream);
        readFrames(log, i, poses);
        found.push_back(std::move(poses));
    }
    findTransforms(log, found);
    return found;
}

std::string makeTable(const std::vector<FoundPoses>& found) {
    std::string table =
        fmt::format("  {:24} {:44} {:28} {:>8} {:>26} {:>26}\n", "--pose", "type", "frames", "number", "first", "last");
    for (const FoundPoses& each : found)
        table +=
            fmt::format("  {:24} {:44} {:28} {:>8} {:>26} {:>26}{}\n", each.source, each.type,
                        fmt::format("{} {} {}", each.parent.empty() ? "?" : each.parent, arrow,
                                    each.child.empty() ? "?" : each.child),
                        each.count, readable(each.first), readable(each.last), each.has_fixes ? "  needs --datum" : "");
    return table;
}

types::Notices addPoses(Reader& log, const PoseSource& asked, types::WorldFrame foreign,
                        const std::optional<types::Datum>& world) {
    const Stream* const stream = log.find(asked.source);
    const bool is_pair = !stream && asked.source.find(arrow) != asked.source.npos;
    if (!stream && !is_pair) {
        std::vector<std::string> known;
        for (const FoundPoses& each : findPoses(log)) known.push_back(each.source);
        refuseSource(log, asked, "is no stream of the log; " + types::didYouMean(asked.source, known) + choices(log));
    }
    if (stream && !stream->holds<types::Pose>() && !hasFixes(*stream))
        refuseSource(log, asked, "holds " + stream->type + ", which is no pose; " + choices(log));
    const size_t index = stream ? static_cast<size_t>(stream - log.streams().data()) : 0;
    if (const Stream* const same = log.find(asked.stream); same && same != stream)
        log.rename(static_cast<size_t>(same - log.streams().data()), same->name + "_recorded");
    if (!is_pair && hasFixes(log.streams()[index])) return placeFixes(log, asked, index, world);
    types::Notices notices = is_pair ? followFrames(log, asked, foreign) : renamePoses(log, asked, index);
    if (asked.datum || !asked.orientation.empty())
        notices.push_back(types::warning(
            fmt::format("datum and orientation are without effect on {}, which has whole poses", asked.source)));
    return notices;
}

}  // namespace insonify::log
