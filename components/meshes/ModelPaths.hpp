#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace insonify::meshes {

/** Where the models and files that a world names are looked for: the folders of INSONIFY_MODEL_PATH,
 *  GAZEBO_MODEL_PATH, SDF_PATH, GZ_SIM_RESOURCE_PATH and IGN_GAZEBO_RESOURCE_PATH (a list with ':' each), then the
 *  folder of the world; for a model that stands alone (with its model.config) last the folder that holds its folder. */
class ModelPaths {
public:
    explicit ModelPaths(const std::filesystem::path& world);

    const std::vector<std::filesystem::path>& folders() const { return folders_; }

    /** The file or folder that `uri` means, if there is one: `model://`, `package://` and `file://` are looked for in
     *  the folders, `file:///` and an absolute path are what they say, and a relative path starts at the folder of
     *  `named_in`, the file that names it. Nothing is fetched from elsewhere. */
    std::optional<std::filesystem::path> find(const std::string& uri, const std::filesystem::path& named_in) const;

private:
    std::vector<std::filesystem::path> folders_;
};

}  // namespace insonify::meshes
