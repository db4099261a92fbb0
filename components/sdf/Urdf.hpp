#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace insonify::sdf {

/** A robot in URDF, as libsdformat takes it. */
struct Urdf {
    std::string text;  ///< With an inertia for each link that has none, for libsdformat leaves such links out; fixed
                       ///< joints stay.
    std::map<std::string, std::vector<std::string>> materials;  ///< Of each link's visuals, by the name of the link.
};

/** Whether a file is one of URDF, by its extension. */
bool isUrdf(const std::filesystem::path& file);

/** Reads a robot. Throws types::ConfigError for what is no XML, no robot, or a macro file that xacro has to expand. */
Urdf readUrdf(const std::filesystem::path& file, const std::string& text);

}  // namespace insonify::sdf
