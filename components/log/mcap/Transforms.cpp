#include "components/log/mcap/Transforms.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/log/mcap/Reader.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Schema.hpp"
#include "types/Time.hpp"

namespace insonify::log::mcap {
namespace {

ros::Time getStamp(uint64_t ns) {
    return {static_cast<int32_t>(ns / 1'000'000'000), static_cast<uint32_t>(ns % 1'000'000'000)};
}

template <class E>
E getEnum(const Texts& texts, const char* key, E otherwise) {
    const auto found = texts.find(key);
    const auto& names = types::EnumNames<E>::names;
    const auto name = found == texts.end() ? std::end(names) : std::ranges::find(names, found->second);
    return name == std::end(names) ? otherwise : static_cast<E>(name - std::begin(names));
}

std::string toText(const Metadata& metadata, const char* key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? "" : found->second;
}

/** None: the text is missing or damaged. */
std::optional<types::Mount> findMount(const Metadata& stream) try {
    const YAML::Node node = YAML::Load(toText(stream, "insonify_mount"));
    if (!node.IsMap()) return std::nullopt;
    types::Mount mount;
    for (int i = 0; i < 3; ++i) mount.position[i] = node["position"][i].as<double>();
    mount.roll_deg = node["roll_deg"].as<double>();
    mount.pitch_deg = node["pitch_deg"].as<double>();
    mount.yaw_deg = node["yaw_deg"].as<double>();
    return mount;
} catch (const YAML::Exception&) {
    return std::nullopt;
}

glm::dquat toRotation(const ros::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

/** False: listeners of transforms would refuse it. */
bool normalise(ros::Transform& transform) {
    const glm::dquat q = toRotation(transform.rotation);
    const double length = glm::length(q);
    const auto& [x, y, z] = transform.translation;
    if (!std::isfinite(x + y + z) || !std::isfinite(length) || length < 1e-6) return false;
    transform.rotation = {q.x / length, q.y / length, q.z / length, q.w / length};
    return true;
}

/** For late subscribers. */
std::string latchedProfile() {
    std::string profile = qos_profile;
    return profile.replace(profile.find("durability: 2"), 13, "durability: 1");
}

}  // namespace

void Transforms::follow(uint16_t channel, const Metadata& stream) {
    const Channel& declared = out_.channels()[channel];
    if (declared.schema == 0) return;
    const std::string& schema = out_.schemas()[declared.schema - 1u].name;
    if (schema == ros::Odometry::type_name) poses_[channel].name = toText(declared.metadata, "insonify_stream");
    if (schema != ros::ProjectedSonarImage::type_name && schema != ros::SonarDetections::type_name) return;
    Pings& pings = pings_[channel];
    pings.frame = toText(declared.metadata, frame_id_key);
    pings.body = toText(stream, "insonify_body");
    pings.axes = getEnum(declared.metadata, "insonify_frame", pings.axes);
    pings.world = getEnum(declared.metadata, "insonify_world_frame", pings.world);
    if (!pings.frame.empty()) pings.mount = findMount(stream);
}

void Transforms::before(uint16_t channel, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes) {
    const auto poses = poses_.find(channel);
    if (poses == poses_.end() && !pings_.contains(channel)) return;
    if (!first_ns_) first_ns_ = log_ns;
    if (mounts_due_) writeMounts(log_ns);
    constexpr auto lateness_ns = static_cast<uint64_t>(1000 * types::max_lateness.microseconds);
    if (!clock_ns_ || publish_ns > *clock_ns_ || *clock_ns_ - publish_ns > lateness_ns) {  // or the clock was set back
        clock_ns_ = publish_ns;
        write("/clock", log_ns, publish_ns, ros::Clock{getStamp(publish_ns)});
    }
    if (poses != poses_.end()) addPose(channel, poses->second, log_ns, publish_ns, bytes);
    placeMounts(log_ns, AtEnd::No);
}

void Transforms::addPose(uint16_t channel, Poses& poses, uint64_t log_ns, uint64_t publish_ns,
                         std::span<const char> bytes) {
    try {
        ros::decode(bytes, odometry_);
    } catch (const ros::CdrError&) {
        return;  // the file is damaged and copied unchanged
    }
    const auto& [p, q] = odometry_.pose.pose;
    ros::TransformStamped placed{odometry_.header, odometry_.child_frame_id, {{p.x, p.y, p.z}, q}};
    if (placed.header.frame_id.empty()) placed.header.frame_id = "map";
    if (placed.child_frame_id.empty()) placed.child_frame_id = "base_link";
    const std::string& child = placed.child_frame_id;
    if (child == placed.header.frame_id || publish_ns == poses.last_ns || !normalise(placed.transform)) return;
    if (owners_.emplace(child, channel).first->second != channel) return;
    poses.last_ns = publish_ns;
    if (!turnToPings(placed)) poses.child = child;
    write("/tf", log_ns, publish_ns, ros::TFMessage{{placed}});
}

bool Transforms::turnToPings(ros::TransformStamped& placed) const {
    for (const auto& [channel, pings] : pings_) {
        if (pings.frame != placed.child_frame_id) continue;
        const glm::dquat own = toRotation(ros::toTransform({}, pings.world, pings.axes).rotation),
                         turned = toRotation(placed.transform.rotation) * own;
        placed.transform.rotation = {turned.x, turned.y, turned.z, turned.w};
        return true;
    }
    return false;
}

std::string Transforms::getBody(const Pings& pings, AtEnd at_end) const {
    const auto isKnown = [](const auto& each) { return !each.second.child.empty(); };
    const auto own = std::ranges::find_if(poses_, [&](const auto& each) { return each.second.name == pings.body; });
    if (own != poses_.end()) return own->second.child;
    if (!pings.body.empty() && at_end == AtEnd::No) return "";  // its poses may still arrive
    const auto first = std::ranges::find_if(poses_, isKnown);
    if (first != poses_.end()) return first->second.child;
    return at_end == AtEnd::Yes ? "base_link" : "";
}

void Transforms::placeMounts(uint64_t log_ns, AtEnd at_end) {
    const size_t before = mounts_.transforms.size();
    for (auto& [channel, pings] : pings_) {
        if (!pings.mount) continue;
        const std::string body = getBody(pings, at_end);
        if (body.empty()) continue;
        const types::Mount mount = *std::exchange(pings.mount, {});
        if (owners_.emplace(pings.frame, channel).second)
            mounts_.transforms.push_back(
                {{getStamp(log_ns), body}, pings.frame, ros::toTransform(mount, pings.world, pings.axes)});
    }
    if (mounts_.transforms.size() > before) writeMounts(log_ns);
}

void Transforms::writeMounts(uint64_t log_ns) {
    mounts_due_ = false;
    write("/tf_static", log_ns, log_ns, mounts_);
}

void Transforms::finish() {
    if (first_ns_) placeMounts(*first_ns_, AtEnd::Yes);
}

void Transforms::nextFile() {
    mounts_due_ = !mounts_.transforms.empty();
    first_ns_.reset();
}

template <class Message>
void Transforms::write(const std::string& topic, uint64_t log_ns, uint64_t publish_ns, const Message& message) {
    if (taken_.contains(topic)) return;
    auto found = channels_.find(topic);
    if (found == channels_.end()) {
        if (std::ranges::count(out_.channels(), topic, &Channel::topic) > 0) {
            taken_.insert(topic);
            return;
        }
        uint16_t& schema = schemas_[Message::type_name];
        if (schema == 0) schema = out_.addSchema({Message::type_name, "ros2msg", ros::describeSchema<Message>()});
        const std::string profile = topic == "/tf_static" ? latchedProfile() : qos_profile;
        Texts texts{
            {"offered_qos_profiles", profile}, {"topic_type_hash", ros::typeHash<Message>()}, {derived_key, "yes"}};
        found = channels_.emplace(topic, out_.addChannel({schema, topic, "cdr", std::move(texts)})).first;
    }
    bytes_.clear();
    ros::encode(message, bytes_);
    out_.write(found->second, log_ns, publish_ns, bytes_, ChunkWriter::Counts::No);
}

}  // namespace insonify::log::mcap
