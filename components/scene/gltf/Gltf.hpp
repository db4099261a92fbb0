#pragma once
#include "components/scene/Scene.hpp"

namespace insonify::scene {

/** Turns the y-up axes of glTF into z-up: (x, y, z) becomes (x, -z, y). */
inline const glm::dmat4 z_up_from_y_up{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};

/** `readScene` for glTF 2.0, text or binary. */
Scene readGltf(const std::filesystem::path& file);

}  // namespace insonify::scene
