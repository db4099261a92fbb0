#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/scene/Acoustics.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Returns the names of matter and sediments that the name of a material contains, as modellers write it: "Steel.001",
 *  "M_Rusty-Steel", "Material_Aluminium" and "castIron 2". Each once, in the order of the name. */
std::vector<std::string_view> matterIn(const std::string& name);

/** Returns the geometry in which materials without acoustic values have those of the one matter or sediment that their
 *  names contain. One notice lists them, and those whose names contain several, which keep the default. Returns the
 *  same pointer where no name contains any. */
types::GeometryPtr takeNames(const types::GeometryPtr& geometry);

}  // namespace insonify::scene
