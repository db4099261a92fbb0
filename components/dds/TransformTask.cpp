#include "components/dds/TransformTask.hpp"

#include "components/ros/Cdr.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Schema.hpp"
#include "components/ros/Stamps.hpp"

namespace insonify::dds {
namespace {

constexpr int max_transforms_at_once = 1000;      ///< Messages of a topic in one cycle; then the other topic follows.
constexpr int depth = 1000;                       ///< Queued messages of all senders.
constexpr size_t maximum = size_t{1} << 20;       ///< Size of a message [B].
constexpr types::Time chain_patience{2'000'000};  ///< Before an incomplete chain is reported.
constexpr types::Time static_period{100'000};

std::unique_ptr<Reader> transformReader(Node& node, const std::string& topic, const Quality& quality,
                                        std::function<void()> arrived) {
    auto made = std::make_unique<Reader>(node, ddsTopic(topic), ros::TFMessage::type_name,
                                         ros::typeHash<ros::TFMessage>(), quality, std::move(arrived), maximum);
    node.addReader(made->handle());
    return made;
}

/** Converts a pose to Rock's axes. */
types::Pose getPose(const ros::TransformTree::Placed& placed, const std::string& frame_id,
                    const TransformConfig& config) {
    ros::PoseStamped message;
    message.header.frame_id = config.world_frame_id;
    const glm::dvec3& p = placed.position;
    const glm::dquat& q = placed.orientation;
    message.pose = {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
    types::Pose pose;
    ros::convert(message, config.node.world_frame, pose);
    pose.source_frame = frame_id;
    pose.time = placed.time;
    return pose;
}

}  // namespace

TransformConfig::TransformConfig() = default;

TransformConfig TransformConfig::namedBy(const types::RosNames& names, const std::string& task) const {
    TransformConfig named = *this;
    named.node.node_name = node.nameIn(names, task);
    for (std::string* each : {&named.topic, &named.static_topic}) *each = names.topic(*each, named.node.node_name);
    for (FrameOut& frame : named.frames) frame.frame_id = names.frame(frame.frame_id);
    return named;
}

void TransformConfig::check(types::Diagnostics& diagnostics) const {
    node.check(diagnostics);
    for (const auto& [key, name] : {std::pair{"topic", &topic}, {"static_topic", &static_topic}})
        if (const std::string diagnostic = diagnosticOfTopic(*name); !diagnostic.empty())
            diagnostics.push_back({key, diagnostic});
    if (frames.empty()) diagnostics.push_back({"frames", "is empty; must hold a frame"});
    std::set<std::string> ports;
    ros::checkFrame("world_frame_id", world_frame_id, diagnostics);
    for (size_t i = 0; i < frames.size(); ++i) {
        const std::string path = "frames[" + std::to_string(i) + "].";
        ros::checkFrame(path + "frame_id", frames[i].frame_id, diagnostics);
        if (frames[i].frame_id == world_frame_id)
            diagnostics.push_back({path + "frame_id", "is " + world_frame_id + ", the world_frame_id itself"});
        if (!ports.insert(frames[i].port).second)
            diagnostics.push_back({path + "port", "is " + frames[i].port + " a second time"});
    }
}

types::Notices TransformTask::notices() const {
    types::Notices all;
    for (const auto* counted : {&drops_, &gaps_})
        for (std::string& line : counted->summary()) all.push_back(std::move(line));
    return all;
}

bool TransformTask::configureHook() {
    drops_.reset();
    gaps_.reset();
    tree_ = {};
    moving_.reset();  // remains of a failed configure
    fixed_.reset();
    const TransformConfig named = config->namedBy(environment().names, name());
    refuseWrong(named);
    node_.emplace(domainId(named.node.domain), named.node.node_name, static_cast<size_t>(named.node.gid_size));
    moving_ = transformReader(*node_, named.topic, {.reliability = config->reliability, .depth = depth},
                              [this] { arrived_.raise(); });
    fixed_ = transformReader(*node_, named.static_topic, {.depth = depth, .transient_local = true},
                             [this] { arrived_.raise(); });
    node_->announce();
    return true;
}

bool TransformTask::startHook() {
    outputs_.forEach([this](auto& output) {
        output.kept = {environment().names.frame(findEntry(output.port.name())->frame_id), {}, {}, 0, {}};
    });
    return true;
}

void TransformTask::updateHook() {
    take(*fixed_, true);
    take(*moving_, false);
    outputs_.forEach([this](auto& output) { report(output); });
    for (auto* counted : {&drops_, &gaps_})
        if (const std::string reported = counted->consumeWarning(); !reported.empty()) warn(reported);
}

void TransformTask::take(Reader& reader, bool is_static) {
    int taken = 0;
    uint64_t sender = 0;
    for (; taken < max_transforms_at_once && reader.take(bytes_, sender); ++taken) try {
            ros::decode(std::span<const char>(bytes_), message_);
            for (const ros::TransformStamped& transform : message_.transforms) add(transform, is_static);
        } catch (const ros::CdrError& error) {
            drops_.add(bytes_.empty() ? "a message is empty or larger than any message of its type"
                                      : "a message is not of its type",
                       std::string(": ") + error.what());
        }
    if (taken == max_transforms_at_once) arrived_.raise();
}

void TransformTask::add(const ros::TransformStamped& transform, bool is_static) {
    const ros::Time& stamp = transform.header.stamp;
    const bool is_stamped = config->stamp == StampFrom::Message && stamp != ros::Time{};
    const std::string diagnostic = tree_.add(transform, is_static, is_stamped ? ros::fromRos(stamp) : now(), now());
    if (!diagnostic.empty()) return drops_.add(diagnostic);
    if (is_stamped && !is_static) ros::fineStamps().note(stamp);
}

void TransformTask::report(auto& output) {
    auto& kept = output.kept;
    auto [placed, diagnostic] = tree_.newest(config->world_frame_id, kept.frame_id, now());
    if (placed && diagnostic.empty())
        kept.lacking.reset();
    else if (!kept.lacking)
        kept.lacking = now();
    if (kept.lacking && !diagnostic.empty() && types::due(*kept.lacking, chain_patience, now()))
        gaps_.add(output.port.name() + ": " + diagnostic);
    if (!placed) return;
    const bool is_fixed = placed->time.isNull();
    if (is_fixed ? types::elapsed(kept.written, now()) < static_period
                 : placed->time == kept.time || (placed->time < kept.time && kept.life == tree_.lives()))
        return;
    kept.time = placed->time;
    kept.life = tree_.lives();
    kept.written = now();
    types::Pose pose = getPose(*placed, kept.frame_id, *config);
    if (is_fixed) pose.time = kept.written;
    output.port.write(pose);
}

void TransformTask::cleanupHook() {
    moving_.reset();
    fixed_.reset();
    node_.reset();
}

}  // namespace insonify::dds
