#include "components/scene/Drawings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include "components/scene/Acoustics.hpp"
#include "types/geometry/Extent.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::scene {
namespace {

constexpr double max_slope = 0.02;    ///< Height of a level object over its shorter side.
constexpr double sheet = 0.1;         ///< Greatest thickness of a sheet [m].
constexpr double near_surface = 0.1;  ///< Distance of a drawn surface from the water surface [m].
constexpr double large = 10;          ///< Shorter side of a large object [m].

bool isAmong(const std::string& word, const auto& words) { return std::ranges::find(words, word) != std::end(words); }

constexpr std::array waters{"water", "sea", "ocean", "lake", "river", "pool"};

/** Whether a visual's name says nothing about what it shows. */
bool isPlain(const std::string& name) {
    static constexpr std::array plain{"visual", "v",    "vis",   "mesh",  "link", "geometry",
                                      "plane",  "body", "model", "shape", "box",  "surface"};
    return std::ranges::all_of(splitWords(name),
                               [&](const std::string& word) { return word.empty() || isAmong(word, plain); });
}

/** Whether a name is one of water, or of the surface of a water. */
bool namesWater(const std::string& name) {
    static constexpr std::array water{"water", "waves", "watersurface", "seasurface", "oceansurface", "wasser", "agua"};
    static constexpr std::array others{"floor", "bed",    "bottom", "wall",  "ground",  "tank", "tower",
                                       "line",  "seabed", "pipe",   "craft", "terrain", "rock"};
    const std::vector<std::string> words = splitWords(name);
    const auto has = [&](const auto& list) {
        return std::ranges::any_of(words, [&](const std::string& word) { return isAmong(word, list); });
    };
    if (has(others)) return false;
    return has(water) || (has(waters) && std::ranges::find(words, "surface") != words.end());
}

std::string lastPart(const std::string& name) {
    const size_t colons = name.rfind("::");
    return colons == std::string::npos ? name : name.substr(colons + 2);
}

/** Returns the box around a box at its place. */
types::Extent placed(const types::Extent& box, const glm::dmat4& world_from_box) {
    types::Extent around;
    for (int corner = 0; !box.isEmpty() && corner < 8; ++corner)
        around.add(glm::dvec3(world_from_box * glm::dvec4((corner & 1) ? box.high.x : box.low.x,
                                                          (corner & 2) ? box.high.y : box.low.y,
                                                          (corner & 4) ? box.high.z : box.low.z, 1)));
    return around;
}

/** Decides which objects of a scene are omitted. */
class Sorting {
public:
    Sorting(const Scene& scene, const OmitRules& rules) : scene_(scene), rules_(rules), matched_(rules.names.size()) {
        std::vector<types::Extent> meshes;
        for (const types::Mesh& mesh : scene.geometry->meshes) meshes.push_back(types::getExtent(mesh, glm::dmat4(1)));
        types::Extent all;
        for (const types::Object& object : objects()) {
            boxes_.push_back(placed(meshes[static_cast<size_t>(object.mesh)], object.world_from_object));
            all.add(boxes_.back());
        }
        area_ = all.size().x * all.size().y;
        for (const Node& node : scene.nodes) node_patterns_.push_back(findPattern(node.name));
    }

    /** Returns why an object is omitted; empty: it is. */
    std::string reasonAgainst(size_t object) {
        for (int node = scene_.object_nodes[object]; node >= 0; node = scene_.nodes[static_cast<size_t>(node)].parent)
            if (const auto pattern = node_patterns_[static_cast<size_t>(node)]) return byPattern(*pattern);
        if (const auto pattern = findPattern(objects()[object].name)) return byPattern(*pattern);
        return rules_.drawings && !isSolid(object) ? drawnReason(object) : "";
    }

    /** Returns warnings of patterns without a match, and of a large level object that stays at the water surface. */
    std::vector<std::string> warnings(const std::vector<size_t>& kept) const {
        std::vector<std::string> all, names;
        for (const Node& node : scene_.nodes) names.push_back(node.name);
        for (const types::Object& object : objects()) names.push_back(object.name);
        for (size_t i = 0; i < matched_.size(); ++i) {
            if (matched_[i]) continue;
            std::string plain = rules_.names[i];
            std::erase(plain, '*');
            all.push_back(
                fmt::format("omit: \"{}\" matches no node or visual of the scene; {}insonify scene lists them",
                            rules_.names[i], types::didYouMean(plain, names)));
        }
        for (const size_t i : kept)
            if (const std::string text = surfaceWarning(i, kept); !text.empty()) all.push_back(text);
        return all;
    }

private:
    const std::vector<types::Object>& objects() const { return scene_.geometry->objects; }
    const types::Mesh& getMesh(size_t object) const {
        return scene_.geometry->meshes[static_cast<size_t>(objects()[object].mesh)];
    }
    std::optional<size_t> findPattern(const std::string& name) {
        std::optional<size_t> first;
        for (size_t i = 0; i < rules_.names.size(); ++i) {
            const std::string& pattern = rules_.names[i];
            const bool by_part = pattern.find("::") == std::string::npos && matches(pattern, lastPart(name));
            if (!by_part && !matches(pattern, name)) continue;
            matched_[i] = true;
            if (!first) first = i;
        }
        return first;
    }
    std::string byPattern(size_t pattern) const { return fmt::format("omit: \"{}\"", rules_.names[pattern]); }

    /** Whether an object has acoustic values, of the file or the task. */
    bool isSolid(size_t object) const {
        for (int node = scene_.object_nodes[object]; node >= 0; node = scene_.nodes[static_cast<size_t>(node)].parent)
            if (rules_.solid.contains(scene_.nodes[static_cast<size_t>(node)].name)) return true;
        return std::ranges::any_of(getMesh(object).clusters, [&](const types::Cluster& cluster) {
            const types::Material& material = scene_.geometry->materials[static_cast<size_t>(cluster.material)];
            return material.has_acoustics || rules_.solid.contains(material.name);
        });
    }
    Drawing getDrawing(size_t object) const {
        return object < scene_.drawings.size() ? scene_.drawings[object] : Drawing{};
    }
    bool isNamedMatter(size_t object) const {
        return std::ranges::any_of(getMesh(object).clusters, [&](const types::Cluster& cluster) {
            return !matterIn(scene_.geometry->materials[static_cast<size_t>(cluster.material)].name).empty();
        });
    }
    bool isNamedWater(size_t object) const {
        const std::string& name = objects()[object].name;
        if (namesWater(lastPart(name)) || (isPlain(lastPart(name)) && namesWater(name))) return true;
        return std::ranges::any_of(getMesh(object).clusters, [&](const types::Cluster& cluster) {
            return namesWater(scene_.geometry->materials[static_cast<size_t>(cluster.material)].name);
        });
    }
    /** Whether a visual and its model are named as a sea, and as nothing else. */
    bool isOfSea(size_t object) const {
        const std::string& name = objects()[object].name;
        const auto is_water = [](const std::string& word) { return isAmong(word, waters); };
        const std::vector<std::string> own = splitWords(lastPart(name)), all = splitWords(name);
        return std::ranges::all_of(own, [&](const std::string& word) { return isPlain(word) || is_water(word); }) &&
               std::ranges::any_of(all, is_water);
    }
    bool isLevel(size_t object) const {
        const glm::dvec3 size = boxes_[object].size();
        return !boxes_[object].isEmpty() && size.z <= max_slope * std::min(size.x, size.y);
    }
    bool isAt(size_t object, double height) const {
        const double margin = std::max(near_surface, boxes_[object].size().z);
        return boxes_[object].low.z - margin <= height && height <= boxes_[object].high.z + margin;
    }

    std::string drawnReason(size_t object) const {
        const Drawing drawing = getDrawing(object);
        if (drawing.transparency >= 1) return "its drawing is wholly transparent";
        if (drawing.is_for_none) return "no camera sees its drawing (visibility_flags)";
        if (isNamedMatter(object)) return "";
        const bool is_water = isNamedWater(object);
        if (is_water && drawing.transparency > 0) return "it is named as water, and transparent";
        if (!isLevel(object)) return "";
        if (is_water) return "it is named as water, and level";
        std::vector<const char*> marks;
        if (drawing.transparency > 0) marks.push_back("transparent");
        if (drawing.is_for_some) marks.push_back("for some cameras only");
        if (!drawing.casts_shadow) marks.push_back("without a shadow");
        if (marks.size() >= 2) return fmt::format("it is level, {}", fmt::join(marks, ", "));
        if (!rules_.water_surface || !isAt(object, *rules_.water_surface)) return "";
        if (isOfSea(object)) marks.push_back("of a model named as a sea");
        if (!marks.empty()) return fmt::format("it is level at the water surface, {}", marks.front());
        const glm::dvec3 size = boxes_[object].size();
        if (size.z <= sheet && std::min(size.x, size.y) >= large && size.x * size.y >= area_ / 2)
            return "it is a level sheet at the water surface that covers the scene";
        return "";
    }

    std::string surfaceWarning(size_t object, const std::vector<size_t>& kept) const {
        const glm::dvec3 size = boxes_[object].size();
        if (!rules_.drawings || isSolid(object) || !isLevel(object) || std::min(size.x, size.y) < large) return "";
        const bool is_at = rules_.water_surface && isAt(object, *rules_.water_surface);
        const bool is_above_all =
            !rules_.water_surface && kept.size() > 1 && std::ranges::all_of(kept, [&](size_t other) {
                return other == object || boxes_[other].high.z < boxes_[object].low.z - 1;
            });
        if (!is_at && !is_above_all) return "";
        return fmt::format(
            "{} is level, {:.3g} x {:.3g} m wide, and a solid {} If it is drawn water, omit it: omit: [{}]; a material "
            "with "
            "acoustics says that it is solid",
            objects()[object].name, size.x, size.y,
            is_at ? "at the water surface." : fmt::format("above all others, at z = {:.3g} m.", boxes_[object].high.z),
            objects()[object].name);
    }

    const Scene& scene_;
    const OmitRules& rules_;
    std::vector<bool> matched_;                         ///< For each pattern, whether a name matches.
    std::vector<std::optional<size_t>> node_patterns_;  ///< For each node, the first pattern that matches it.
    std::vector<types::Extent> boxes_;                  ///< For each object, about the box of its mesh, in the world.
    double area_ = 0;                                   ///< Area of the box of the scene, seen from above [m^2].
};

/** Returns the scene with only these objects. */
Scene restrictedTo(const Scene& scene, const std::vector<size_t>& kept) {
    Scene result = scene;
    auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
    geometry->objects.clear(), result.object_nodes.clear(), result.node_from_object.clear(), result.drawings.clear();
    std::vector<int> index(scene.geometry->objects.size(), -1);
    for (const size_t i : kept) {
        index[i] = static_cast<int>(geometry->objects.size());
        geometry->objects.push_back(scene.geometry->objects[i]);
        result.object_nodes.push_back(scene.object_nodes[i]);
        result.node_from_object.push_back(scene.node_from_object[i]);
        if (i < scene.drawings.size()) result.drawings.push_back(scene.drawings[i]);
    }
    if (scene.animations) {
        Animations animations = *scene.animations;
        std::erase_if(animations.objects, [&](const DeformingObject& object) { return index[object.object] < 0; });
        for (DeformingObject& object : animations.objects) object.object = static_cast<size_t>(index[object.object]);
        result.animations = std::make_shared<const Animations>(std::move(animations));
    }
    if (geometry->objects.empty()) geometry->notices.push_back("nothing of the scene is left: an empty sea");
    result.geometry = std::move(geometry);
    return result;
}

}  // namespace

bool matches(std::string_view pattern, std::string_view name) {
    size_t p = 0, n = 0, star = std::string_view::npos, retry = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*')
            star = p++, retry = n;
        else if (p < pattern.size() && pattern[p] == name[n])
            ++p, ++n;
        else if (star != std::string_view::npos)
            p = star + 1, n = ++retry;
        else
            return false;
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

Scene withoutOmitted(const Scene& scene, const OmitRules& rules) {
    Sorting sorting(scene, rules);
    std::vector<size_t> kept;
    std::vector<types::Omission> omitted = scene.omitted;
    for (size_t i = 0; i < scene.geometry->objects.size(); ++i) {
        const std::string reason = sorting.reasonAgainst(i);
        if (reason.empty())
            kept.push_back(i);
        else
            omitted.push_back({scene.geometry->objects[i].name, reason});
    }
    Scene result = kept.size() == scene.geometry->objects.size() ? scene : restrictedTo(scene, kept);
    result.omitted = std::move(omitted);
    result.warnings = sorting.warnings(kept);
    return result;
}

void addOmissions(const Scene& scene, types::Notices& notices) {
    constexpr size_t shown = 5;
    std::map<std::string, std::vector<std::string>> names;  // by reason
    for (const types::Omission& omission : scene.omitted) names[omission.reason].push_back(omission.name);
    for (auto& [reason, all] : names) {
        const size_t more = all.size() > shown ? all.size() - shown : 0;
        all.resize(all.size() - more);
        notices.push_back(fmt::format("omitted: {}{}: {}", fmt::join(all, ", "),
                                      more > 0 ? fmt::format(" and {} more", more) : "", reason));
    }
    for (const std::string& warning : scene.warnings) notices.push_back(types::warning(warning));
}

}  // namespace insonify::scene
