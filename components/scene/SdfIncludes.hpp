#pragma once
#include <filesystem>

#include "components/scene/SdfPaths.hpp"

namespace insonify::scene {

/** More work is refused. One is what libsdformat has with an element, about half a millisecond; besides it compares
 *  what stands in one element with each other, 2000 pairs in the same time. What is included counts each time. */
inline constexpr size_t max_sdf_work = 100'000;

/** Models that include each other deeper are refused. */
inline constexpr size_t max_sdf_depth = 50;

/** Larger files are refused, whatever is in them [bytes]. */
inline constexpr size_t max_sdf_bytes = size_t{64} << 20;

/** Follows the includes of an SDF file, and throws types::ConfigError where libsdformat would follow them until its
 *  stack or its user's patience ends: at a model that includes itself, and at more than may be read. */
void checkIncludes(const std::filesystem::path& file, const SdfPaths& paths);

}  // namespace insonify::scene
