#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "components/scene/Acoustics.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Splits the name of an object or material into lower-case words of letters: "seaSurface_2::Water" is sea, surface,
 *  water. At least one word is returned, which may be empty. */
std::vector<std::string> wordsOf(const std::string& name);

/** Returns the names of matter and sediments in the name of a material, as modellers write it: "Steel.001",
 *  "M_Rusty-Steel", "Material_Aluminium" and "traceIron 2". Each name occurs once, in the order of the material's
 *  name. */
std::vector<std::string_view> matterIn(const std::string& name);

/** Returns a geometry in which materials without acoustic values take those of the matter or sediment in their names.
 *  One notice lists these materials, and those whose names contain several, which keep the default. Returns the same
 *  pointer if no name contains any. */
types::GeometryPtr takeNames(const types::GeometryPtr& geometry);

}  // namespace insonify::scene
