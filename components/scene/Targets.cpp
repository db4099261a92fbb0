#include "components/scene/Targets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "types/DidYouMean.hpp"

namespace insonify::scene {
namespace {

std::string unknown(const Scene& scene, const std::string& node) {
    constexpr size_t shown = 50;
    std::vector<std::string> names;
    for (const Node& one : scene.nodes) names.push_back(one.name);
    std::ranges::sort(names);
    const std::string near = types::didYouMean(node, names);
    const bool all = names.size() <= shown;
    return fmt::format("is {}, which is no node of the scene; {}may be {}{}", node, near,
                       fmt::join(names.begin(), names.begin() + static_cast<long>(std::min(shown, names.size())), ", "),
                       all ? "" : ", ...");
}

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/** Places the target on a node, or returns why it cannot be there. */
std::string attach(const Scene& scene, const TargetConfig& config, const std::vector<int>& moving,
                   PlacedTarget& target) {
    const int node = findNode(scene, config.attached_to);
    if (node < 0) return unknown(scene, config.attached_to);
    const glm::dvec3 offset = config.position.value_or(glm::dvec3(0));
    target.in_world = placeOf(scene, node, -1, offset);
    target.node = node;
    target.offset = offset;
    for (int body = node; body >= 0; body = scene.nodes[static_cast<size_t>(body)].parent)
        if (std::ranges::count(moving, body) > 0) target.carriers.push_back({body, placeOf(scene, node, body, offset)});
    const bool placed = isFinite(target.in_world) &&
                        std::ranges::all_of(target.carriers, [](const auto& one) { return isFinite(one.place); });
    return placed ? ""
                  : fmt::format("is {}, which is scaled to nothing and has no axes; omit position", config.attached_to);
}

}  // namespace

void TargetConfig::check(types::Diagnostics& diagnostics) const {
    if (name.empty()) diagnostics.push_back({"name", "is missing; give each target a name of its own"});
    if (!position && attached_to.empty())
        diagnostics.push_back({"position", "is missing; give the target's place, or attached_to"});
    if (!strength_db) diagnostics.push_back({"strength_db", "is missing; give the target strength [dB re 1 m^2]"});
}

void SceneConfig::check(types::Diagnostics& diagnostics) const {
    if (gazebo && !file.empty())
        diagnostics.push_back({"gazebo", "is given, and file as well; give one of both, which holds the models"});
    std::map<std::string, size_t> first;
    for (size_t i = 0; i < targets.size(); ++i)
        if (const auto [known, is_new] = first.try_emplace(targets[i].name, i); !is_new)
            diagnostics.push_back({fmt::format("targets[{}].name", i),
                                   fmt::format("is {}, which targets[{}] has; give each target a name of its own",
                                               targets[i].name, known->second)});
}

std::vector<PlacedTarget> placeTargets(const Scene& scene, const std::vector<TargetConfig>& targets,
                                       const std::vector<int>& moving, types::Diagnostics& diagnostics) {
    std::vector<PlacedTarget> all;
    for (size_t i = 0; i < targets.size(); ++i) {
        const TargetConfig& config = targets[i];
        PlacedTarget& target = all.emplace_back();
        target.strength_db = config.strength_db.value_or(0);
        if (config.attached_to.empty())
            target.in_world = config.position.value_or(glm::dvec3(0));
        else if (const std::string diagnostic = attach(scene, config, moving, target); !diagnostic.empty())
            diagnostics.push_back({fmt::format("targets[{}].attached_to", i), diagnostic});
    }
    return all;
}

}  // namespace insonify::scene
