#pragma once
#include <filesystem>

namespace insonify::types {

// Files whose names are written in a file of another program.

/** Whether a path is a folder or below it, once `..` and symbolic links are resolved, as far as the path exists. */
bool isBelow(const std::filesystem::path& path, const std::filesystem::path& folder);

/** Whether a file that `naming` names may be read: it is in the folder of `naming` or below it, or in the folder of its
 *  model (with a model.config) or ROS package (package.xml), which may be up to three folders above. Otherwise a model
 *  of somebody else could show any file of this machine. Links are resolved, also that of `naming`. */
bool belongsTo(const std::filesystem::path& named, const std::filesystem::path& naming);

/** What a message says of a file that does not belong to the file that names it. */
inline constexpr const char* not_its_own =
    "is outside of its folder (links resolved), and is not read; put a copy next to it";

}  // namespace insonify::types
