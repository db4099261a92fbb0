#pragma once
#include <filesystem>

#include "components/scene/Surface.hpp"

namespace insonify::scene {

/** Ground from a grey picture, 8 or 16 bits, PNG, JPEG or binary PGM: white is `size.z` above black, columns run along
 *  x, the top row is at +y, and the centre of its black plane is at the origin. Each pixel is a corner; a picture of
 *  more than 2049 a side is read in steps. Throws std::runtime_error for a picture that cannot be read. */
Surface readHeightmap(const std::filesystem::path& file, glm::dvec3 size);

}  // namespace insonify::scene
