#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace insonify::meshes {

/** The folders in which the models and files of a world are searched.
 *
 *  They are the folders of INSONIFY_MODEL_PATH, GAZEBO_MODEL_PATH, SDF_PATH, GZ_SIM_RESOURCE_PATH and
 *  IGN_GAZEBO_RESOURCE_PATH (each a list separated by ':'), then the folder of the world. For a single model (with its
 *  model.config) the folder that contains its folder is last. */
class ModelPaths {
public:
    explicit ModelPaths(const std::filesystem::path& world);

    const std::vector<std::filesystem::path>& folders() const { return folders_; }

    /** Returns the file or folder of `uri`, if it exists. `model://`, `package://` and `file://` are searched in the
     *  folders; `file:///` and an absolute path are used as given; a relative path starts at the folder of `named_in`,
     *  the file that names it. Nothing is downloaded. */
    std::optional<std::filesystem::path> find(const std::string& uri, const std::filesystem::path& named_in) const;

private:
    std::vector<std::filesystem::path> folders_;
};

}  // namespace insonify::meshes
