#include "components/ros/TransformTree.hpp"

#include <algorithm>
#include <iterator>

#include "types/Time.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::ros {
namespace {

constexpr size_t longest_name = 255;

/** Strips a leading slash, as tf2 does: "/map" is "map". */
std::string getName(const std::string& frame) { return frame.starts_with('/') ? frame.substr(1) : frame; }

types::Pose getPose(const Transform& transform) {
    types::Pose pose;
    pose.position = {transform.translation.x, transform.translation.y, transform.translation.z};
    pose.orientation = {transform.rotation.w, transform.rotation.x, transform.rotation.y, transform.rotation.z};
    return pose;
}

}  // namespace

std::string TransformTree::findDiagnostic(const TransformStamped& transform, bool is_static, types::Time stamp,
                                          types::Time now) const {
    const std::string child = getName(transform.child_frame_id), parent = getName(transform.header.frame_id);
    if (child.empty() || parent.empty()) return "a transform without the name of its frame or of its parent";
    if (std::max(child.size(), parent.size()) > longest_name) return "a name of more than 255 characters";
    if (child == parent) return child + " is its own parent";
    if (!types::isUsable(getPose(transform.transform)))
        return child + ": translation and rotation are not finite, or the rotation has no length";
    if (!is_static && stamp - now > max_ahead) return child + ": the stamp is more than ten seconds ahead of the clock";
    const auto found = links_.find(child);
    if (found == links_.end()) return links_.size() < max_frames ? "" : "more frames than are kept";
    const Link& link = found->second;
    if (link.is_static && is_static) return "";
    if (!link.is_static && types::elapsed(link.came, now) > max_silence) return "";
    if (link.is_static != is_static) return child + " is published on /tf and on /tf_static";
    if (link.parent != parent) return child + " has two parents, " + link.parent + " and " + parent;
    return stamp < link.samples.back().time ? child + ": the stamp is before the previous stamp" : "";
}

std::string TransformTree::add(const TransformStamped& transform, bool is_static, types::Time stamp, types::Time now) {
    if (std::string diagnostic = findDiagnostic(transform, is_static, stamp, now); !diagnostic.empty())
        return diagnostic;
    Link& link = links_[getName(transform.child_frame_id)];
    const std::string parent = getName(transform.header.frame_id);
    const bool begins_anew = link.is_static != is_static || link.parent != parent ||
                             (!link.samples.empty() && stamp < link.samples.back().time);
    if (is_static || begins_anew) link.samples.clear();
    if (begins_anew) ++lives_;
    link.parent = parent;
    link.is_static = is_static;
    link.came = now;
    if (!link.samples.empty() && link.samples.back().time == stamp) return "";  // a repeated transform
    const types::Pose pose = getPose(transform.transform);
    link.samples.push_back({stamp, pose.position, glm::normalize(pose.orientation)});
    while (link.samples.size() > max_kept || stamp - link.samples.front().time > memory) link.samples.pop_front();
    return "";
}

std::optional<TransformTree::Chain> TransformTree::findChain(const std::string& frame, std::string& diagnostic) const {
    Chain chain;
    for (auto link = links_.find(frame); link != links_.end(); link = links_.find(link->second.parent)) {
        chain.push_back(&*link);
        if (chain.size() > links_.size()) {
            diagnostic = "the parents of " + frame + " form a circle";
            return std::nullopt;
        }
    }
    return chain;
}

std::optional<TransformTree::Sample> TransformTree::at(const Chain& chain, types::Time time) {
    Sample all{time, glm::dvec3(0), glm::dquat(1, 0, 0, 0)};
    for (const auto* named : chain) {
        const Link& link = named->second;
        const auto after = std::ranges::lower_bound(link.samples, time, {}, &Sample::time);
        Sample one = after == link.samples.end() ? link.samples.back() : *after;
        if (!link.is_static && one.time != time) {
            if (after == link.samples.begin() || after == link.samples.end()) return std::nullopt;
            const Sample& before = *std::prev(after);
            const double share = (time - before.time).seconds() / (after->time - before.time).seconds();
            types::Pose between;
            types::interpolate(before, *after, share, between);
            one = {time, between.position, between.orientation};
        }
        all.position = one.position + one.orientation * all.position;
        all.orientation = glm::normalize(one.orientation * all.orientation);
    }
    return all;
}

const TransformTree::Links::value_type* TransformTree::findOldest(const Chain& up, const Chain& down) {
    const Links::value_type* oldest = nullptr;
    const auto newestTime = [](const auto* link) { return link->second.samples.back().time; };
    for (const Chain* chain : {&up, &down})
        for (const auto* link : *chain)
            if (!link->second.is_static && (!oldest || newestTime(link) < newestTime(oldest))) oldest = link;
    return oldest;
}

TransformTree::Found TransformTree::newest(const std::string& world, const std::string& frame, types::Time now) const {
    std::string diagnostic;
    auto up = findChain(getName(frame), diagnostic), down = findChain(getName(world), diagnostic);
    if (!up || !down) return {{}, diagnostic};
    const std::string root = up->empty() ? getName(frame) : up->back()->second.parent;
    if (root != (down->empty() ? getName(world) : down->back()->second.parent))
        return {{}, "no transforms lead from " + frame + " to " + world + (up->empty() ? "" : ", only to " + root)};
    while (!up->empty() && !down->empty() && up->back() == down->back()) {
        up->pop_back();
        down->pop_back();
    }
    const auto* oldest = findOldest(*up, *down);
    if (oldest && types::elapsed(oldest->second.came, now) > max_silence)
        diagnostic = oldest->first + " in " + oldest->second.parent + " was not published for a second";
    const types::Time time = oldest ? oldest->second.samples.back().time : types::Time{};
    const auto of_frame = at(*up, time), of_world = at(*down, time);
    if ((!of_frame || !of_world) && diagnostic.empty())
        diagnostic =
            oldest->first + " in " + oldest->second.parent + " is stamped before all kept transforms of the others";
    if (!of_frame || !of_world) return {{}, diagnostic};
    const glm::dquat world_from_root = glm::conjugate(of_world->orientation);
    return {Placed{time, world_from_root * (of_frame->position - of_world->position),
                   world_from_root * of_frame->orientation},
            diagnostic};
}

}  // namespace insonify::ros
