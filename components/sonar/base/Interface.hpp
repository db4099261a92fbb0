#pragma once
// shaders/interface.glsl as C++ structs: one file describes the layout to both languages.
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace insonify::sonar {

using glm::vec2, glm::vec4;
using uint = uint32_t;
#include "shaders/interface.glsl"

static_assert(sizeof(ObjectRecord) == 144 && sizeof(PlaneRecord) == 32 && sizeof(FacetRecord) == 48 &&
              sizeof(CurveRecord) == 16 && sizeof(CommandRecord) == 16 && sizeof(MaterialRecord) == 32 &&
              sizeof(DeviceShare) == 32 && sizeof(ClusterRecord) == 80 && sizeof(ViewedObject) == 160);

}  // namespace insonify::sonar
