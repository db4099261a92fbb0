#include "components/scene/motion/Animator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <set>
#include <utility>

#include "types/geometry/PosedMesh.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

/** Time within an animation that is played in a loop [s]. */
double looped(double time, double duration) {
    if (!(duration > 0)) return 0;
    const double rest = std::fmod(time, duration);
    return rest < 0 ? rest + duration : rest;
}

glm::dquat quaternion(const std::vector<double>& xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }
glm::dvec3 toVector(const std::vector<double>& xyz) { return {xyz[0], xyz[1], xyz[2]}; }

glm::dquat scaledBy(const glm::dquat& q, double factor) {
    return {q.w * factor, q.x * factor, q.y * factor, q.z * factor};
}

}  // namespace

void appendJoints(const DeformingObject& object, int node, const NodePlaces& places,
                  std::vector<types::JointPose>& joints) {
    const auto mesh = static_cast<size_t>(node);
    const glm::dmat4 mesh_from_world = glm::inverse(places.world_from_node[mesh]);
    const glm::dmat4 mesh_rate = mesh_from_world * places.rate[mesh];
    for (size_t i = 0; i < object.joints.size(); ++i) {
        const auto joint = static_cast<size_t>(object.joints[i]);
        const glm::dmat4 mesh_from_joint = mesh_from_world * places.world_from_node[joint];
        const glm::dmat4 rate = mesh_from_world * places.rate[joint] - mesh_rate * mesh_from_joint;
        joints.push_back({glm::dmat4x3(mesh_from_joint * object.joint_from_bind[i]),
                          glm::dmat4x3(rate * object.joint_from_bind[i])});
    }
}

void poseAtRest(const DeformingObject& object, int node, const NodePlaces& places, types::Mesh& mesh) {
    std::vector<types::JointPose> joints;
    std::vector<types::MorphPose> morphs;
    appendJoints(object, node, places, joints);
    for (const double weight : object.rest_weights) morphs.push_back({weight, 0});
    types::poseMesh({joints, morphs}, mesh);
}

Animator::Animator(std::shared_ptr<const Scene> scene, const AnimationConfigs& configs, const std::vector<int>& driven,
                   types::Diagnostics& diagnostics)
    : scene_(std::move(scene)) {
    std::vector<std::string> names;
    if (scene_->animations)
        for (const Animation& animation : scene_->animations->all) names.push_back(animation.name);
    for (const auto& [name, config] : configs)
        if (name != "*" && std::ranges::count(names, name) == 0)
            diagnostics.push_back(
                {"animations." + name, names.empty()
                                           ? "is no animation of the scene, which has none"
                                           : fmt::format("is no animation of the scene; {}may be {}",
                                                         types::didYouMean(name, names), fmt::join(names, ", "))});
    const size_t count = scene_->nodes.size();
    slots_.assign(count, -1);
    animated_.assign(count, false);
    driven_.assign(count, nullptr);
    if (!scene_->animations) return;
    addTracks(configs);
    findMovers(driven);
    findLive();
    for (const AnimatedNode& node : scene_->animations->nodes) shapes_.push_back(node.rest);
    size_t widest = 4;
    for (const Track& track : tracks_) widest = std::max(widest, track.keys->width);
    value_.reserve(widest);
    rate_.reserve(widest);
}

AnimationConfig Animator::getConfig(const std::string& name, const AnimationConfigs& configs) const {
    if (const auto own = configs.find(name); own != configs.end()) return own->second;
    const auto all = configs.find("*");
    return all == configs.end() ? AnimationConfig{} : all->second;
}

/** Animations with a block of their own come first, then those of the file in its order; the first to move something
 *  moves it alone. */
void Animator::addTracks(const AnimationConfigs& configs) {
    std::vector<const Animation*> order;
    for (const bool named : {true, false})
        for (const Animation& animation : scene_->animations->all)
            if (configs.contains(animation.name) == named) order.push_back(&animation);
    std::set<std::pair<int, AnimatedPath>> taken;
    std::vector<std::string> played, still, hindered;
    for (const Animation* animation : order) {
        const AnimationConfig config = getConfig(animation->name, configs);
        if (!config.play) {
            still.push_back(animation->name);
            continue;
        }
        size_t lost = 0;
        playing_.push_back({animation, config});
        for (const Channel& channel : animation->channels) {
            if (!taken.insert({channel.node, channel.path}).second) {
                ++lost;
                continue;
            }
            const auto slot = std::ranges::find(scene_->animations->nodes, channel.node, &AnimatedNode::node) -
                              scene_->animations->nodes.begin();
            tracks_.push_back({playing_.size() - 1, &animation->keys[channel.keys], channel.node, channel.path,
                               static_cast<size_t>(slot)});
            if (channel.path != AnimatedPath::Weights)
                slots_[static_cast<size_t>(channel.node)] = static_cast<int>(slot);
        }
        played.push_back(fmt::format("{} ({:.3g} s)", animation->name, animation->duration));
        if (lost > 0)
            hindered.push_back(
                fmt::format("{} ({} of {} channels)", animation->name, lost, animation->channels.size()));
    }
    constexpr size_t shown = 8;
    const auto listed = [](std::vector<std::string> names) {
        const size_t count = names.size();
        if (count > shown) names.resize(shown);
        return fmt::format("{}{}", fmt::join(names, ", "),
                           count > shown ? fmt::format(" and {} more", count - shown) : "");
    };
    if (!played.empty())
        notices_.push_back(
            fmt::format("animations that play: {}; `animations: {{\"*\": {{play: false}}}}` keeps the "
                        "scene at rest",
                        listed(played)));
    if (!still.empty()) notices_.push_back("animations that do not play: " + listed(still));
    if (!hindered.empty())
        notices_.push_back("animations that move what an earlier one moves, which is taken: " + listed(hindered));
}

void Animator::findMovers(const std::vector<int>& driven) {
    is_mover_.assign(scene_->nodes.size(), false);
    for (const int node : driven) is_mover_[static_cast<size_t>(node)] = true;
    for (size_t i = 0; i < slots_.size(); ++i)
        if (slots_[i] >= 0) is_mover_[i] = true;
    std::vector<bool> below(scene_->nodes.size());
    for (size_t i = 0; i < scene_->nodes.size(); ++i) {
        const Node& node = scene_->nodes[i];
        const bool has_parent = node.parent >= 0;
        const auto parent = static_cast<size_t>(node.parent);
        places_.world_from_node.push_back(has_parent ? places_.world_from_node[parent] * node.parent_from_node
                                                     : node.parent_from_node);
        below[i] = is_mover_[i] || (has_parent && below[parent]);
        if (below[i]) involved_.push_back(static_cast<int>(i));
    }
    places_.rate.assign(scene_->nodes.size(), glm::dmat4(0));
}

std::vector<int> Animator::movers(int node) const {
    std::vector<int> all;
    for (; node >= 0; node = scene_->nodes[static_cast<size_t>(node)].parent)
        if (is_mover_[static_cast<size_t>(node)]) all.push_back(node);
    return all;
}

/** An object keeps its shape where its mesh and all of its joints move alike. */
void Animator::findLive() {
    for (const DeformingObject& object : scene_->animations->objects) {
        const int node = getNode(object);
        const std::vector<int> with_mesh = movers(node);
        const bool bends = std::ranges::any_of(object.joints, [&](int joint) { return movers(joint) != with_mesh; });
        const bool morphs = std::ranges::any_of(
            tracks_, [&](const Track& track) { return track.path == AnimatedPath::Weights && track.node == node; });
        if (!bends && !morphs) continue;
        Live& live = live_.emplace_back(&object);
        for (const double weight : object.rest_weights) live.morphs.push_back({weight, 0});
    }
}

void Animator::setTime(const std::string& animation, double time, double rate) {
    for (Playing& playing : playing_)
        if (playing.animation->name == animation) playing.time = time, playing.rate = rate;
}

void Animator::forgetTimes() {
    for (Playing& playing : playing_) playing.time.reset();
}

void Animator::applyTracks(double seconds) {
    for (const Track& track : tracks_) {
        const Playing& playing = playing_[track.playing];
        const AnimationConfig& config = playing.config;
        double time = playing.time.value_or(config.start_s + config.speed * seconds);
        if (config.loop) time = looped(time, playing.animation->duration);
        const double per_second = playing.time ? playing.rate : config.speed;
        value_.resize(track.keys->width);
        rate_.resize(track.keys->width);
        track.keys->at(time, value_, rate_);
        if (track.path == AnimatedPath::Weights) {
            for (Live& live : live_)
                for (size_t i = 0; getNode(*live.object) == track.node && i < live.morphs.size(); ++i)
                    live.morphs[i] = {value_[i], rate_[i] * per_second};
            continue;
        }
        NodeShape& shape = shapes_[track.slot];
        if (track.path == AnimatedPath::Translation) {
            shape.translation = toVector(value_);
            shape.translation_rate = per_second * toVector(rate_);
        } else if (track.path == AnimatedPath::Scale) {
            shape.scale = toVector(value_);
            shape.scale_rate = per_second * toVector(rate_);
        } else {
            shape.rotation = quaternion(value_);
            shape.rotation_rate = scaledBy(quaternion(rate_), per_second);
        }
    }
}

void Animator::applyNodes(const std::vector<DrivenNode>& driven) {
    std::ranges::fill(driven_, nullptr);
    for (const DrivenNode& one : driven)
        if (one.world_from_node) driven_[static_cast<size_t>(one.node)] = &one;
    for (const int number : involved_) {
        const auto i = static_cast<size_t>(number);
        glm::dmat4& world = places_.world_from_node[i];
        glm::dmat4& rate = places_.rate[i];
        animated_[i] = false;
        if (driven_[i]) {
            world = *driven_[i]->world_from_node;
            rate = driven_[i]->rate;
            continue;
        }
        const Node& node = scene_->nodes[i];
        glm::dmat4 local = node.parent_from_node, local_rate(0);
        if (slots_[i] >= 0) {
            const auto slot = static_cast<size_t>(slots_[i]);
            const AnimatedNode& about = scene_->animations->nodes[slot];
            local = about.before * shapes_[slot].matrix() * about.after;
            local_rate = about.before * shapes_[slot].matrixRate() * about.after;
            animated_[i] = true;
        }
        if (node.parent < 0) {
            world = local;
            rate = local_rate;
            continue;
        }
        const auto parent = static_cast<size_t>(node.parent);
        animated_[i] = animated_[i] || animated_[parent];
        world = places_.world_from_node[parent] * local;
        rate = places_.rate[parent] * local + places_.world_from_node[parent] * local_rate;
    }
}

void Animator::take(double seconds, const std::vector<DrivenNode>& driven) {
    applyTracks(seconds);
    applyNodes(driven);
}

glm::dvec3 Animator::getPlace(int node, const glm::dvec3& point) const {
    return placeIn(*scene_, node, places_.world_from_node[static_cast<size_t>(node)], point);
}

void Animator::addMoved(std::vector<types::MovedObject>& moved) const {
    const auto isOurs = [&](size_t object) {
        return object < scene_->object_nodes.size() && scene_->object_nodes[object] >= 0 &&
               isAnimated(scene_->object_nodes[object]);
    };
    std::erase_if(moved, [&](const types::MovedObject& one) { return isOurs(one.object); });
    for (size_t i = 0; i < scene_->object_nodes.size(); ++i) {
        if (!isOurs(i)) continue;
        const auto node = static_cast<size_t>(scene_->object_nodes[i]);
        moved.push_back({static_cast<uint32_t>(i), places_.world_from_node[node] * scene_->node_from_object[i],
                         places_.rate[node] * scene_->node_from_object[i]});
    }
}

void Animator::addDeformed(types::Snapshot& snapshot) const {
    snapshot.deformed.clear();
    snapshot.joints.clear();
    snapshot.morphs.clear();
    for (const Live& live : live_) {
        snapshot.deformed.push_back({static_cast<uint32_t>(live.object->object),
                                     static_cast<uint32_t>(snapshot.joints.size()),
                                     static_cast<uint32_t>(snapshot.morphs.size())});
        appendJoints(*live.object, getNode(*live.object), places_, snapshot.joints);
        snapshot.morphs.insert(snapshot.morphs.end(), live.morphs.begin(), live.morphs.end());
    }
}

}  // namespace insonify::scene
