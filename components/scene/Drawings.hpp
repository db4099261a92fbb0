#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/scene/Scene.hpp"

namespace insonify::scene {

/** Parts of a scene that are omitted. */
struct OmitRules {
    std::vector<std::string> names;       ///< Patterns of nodes and objects; `*` is any text.
    bool drawings = true;                 ///< Whether drawn water and invisible drawings are omitted.
    std::optional<double> water_surface;  ///< Its height in the world [m].
    std::set<std::string> solid;          ///< Materials and nodes that are bodies, however they are drawn.

    bool operator==(const OmitRules&) const = default;
};

/** Whether a name matches a pattern, in which each `*` is any text. */
bool matches(std::string_view pattern, std::string_view name);

/** Returns the scene without the objects that are omitted, each in Scene::omitted with the reason. Nodes stay, and
 * meshes are shared.
 *
 *  A pattern omits nodes with all that is below them, and objects. Without "::" it is also compared with the last part
 * of names such as "ocean::link::water". One that matches nothing is a warning in Scene::warnings, with near names.
 *
 *  Drawings are: objects that are wholly transparent; objects that are named as water and are transparent or level;
 *  level objects with two marks of a drawing (transparent, for some cameras only, no shadow); and, where the height of
 * the water surface is given, level objects there that have one mark or the name of a sea, or that are thinner than 0.1
 * m and cover half of the scene. Materials named as a matter, such as steel, are bodies unless they are invisible.
 * Level: the height of the box is at most 1/50 of its shorter side. Objects with acoustic values are never drawings.
 * Large level objects at the water surface that stay are a warning. */
Scene withoutOmitted(const Scene& scene, const OmitRules& rules);

/** Adds the scene's omissions, one sentence for each reason, and its warnings to notices. */
void addOmissions(const Scene& scene, types::Notices& notices);

}  // namespace insonify::scene
