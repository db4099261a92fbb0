#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace insonify::sdf {

/** A robot in URDF, prepared for libsdformat. */
struct Urdf {
    std::string text;  ///< With an inertia for each link that has none, as libsdformat omits links without inertia;
                       ///< fixed joints stay.
    std::map<std::string, std::vector<std::string>> materials;  ///< Per link, of its visuals.
};

/** Returns whether a file is URDF, by its extension. */
bool isUrdf(const std::filesystem::path& file);

/** Reads a robot. Throws types::ConfigError for text that is not XML, has no robot, or is a macro file that xacro has
 *  to expand. */
Urdf readUrdf(const std::filesystem::path& file, const std::string& text);

}  // namespace insonify::sdf
