#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace insonify::meshes {

/** The places in which the models and files of a world are searched. Nothing is downloaded. In this order:
 *
 *  - folders of INSONIFY_MODEL_PATH, GAZEBO_MODEL_PATH, SDF_PATH, GZ_SIM_RESOURCE_PATH, IGN_GAZEBO_RESOURCE_PATH and
 *    GAZEBO_RESOURCE_PATH (each a list separated by ':');
 *  - the folder of the world; for a single model (with its model.config) the folder that contains its folder; in a
 *    repository or a ROS package each folder above up to its root, and the folders `models` in them;
 *  - ~/.gazebo/models and Gazebo classic's own models;
 *  - by name: packages of ROS in share/NAME of AMENT_PREFIX_PATH; packages and models (folders with a model.config)
 *    below ROS_PACKAGE_PATH and anywhere in the world's repository.
 *
 * Files outside of these are not read, unless that is said: a world of somebody else could name any file of this
 * machine. Links are followed in the folders of variables and of Gazebo; in the world's own they may not lead out of
 * those.
 */
class ModelPaths {
public:
    enum class Reach { OwnPlaces, Anywhere };
    explicit ModelPaths(const std::filesystem::path& world, Reach reach = Reach::OwnPlaces);

    const std::vector<std::filesystem::path>& folders() const { return folders_; }

    /** Returns the file or folder of `uri`, if it exists, as it stands or with %20 and the like decoded. `model://`,
     *  `package://` and `file://` are searched in all places; `file:///` and an absolute path are used as given, in
     * these places; a relative path starts at the folder of `named_in`, the file that names it. A URL of Fuel is taken
     * from the caches of GZ_FUEL_CACHE_PATH, IGN_FUEL_CACHE_PATH, ~/.gz/fuel and ~/.ignition/fuel: its version, else
     * the newest. */
    std::optional<std::filesystem::path> find(const std::string& uri, const std::filesystem::path& named_in) const;

    /** Returns a sentence with the places that were searched for a file of this kind, and how to add others. */
    std::string searched(const std::string& uri) const;

private:
    std::optional<std::filesystem::path> findRaw(const std::string& uri, const std::filesystem::path& named_in) const;
    std::optional<std::filesystem::path> findByName(const std::filesystem::path& path) const;
    bool mayRead(const std::filesystem::path& file, const std::filesystem::path& named_in) const;

    std::vector<std::filesystem::path> folders_;
    std::vector<std::filesystem::path> trusted_;  ///< Of the user and of Gazebo.
    std::vector<std::filesystem::path> own_;      ///< Of the world.
    Reach reach_;
    std::filesystem::path root_;  ///< Of the world's repository, or of its package's folder; empty: neither.
    mutable std::optional<std::map<std::string, std::filesystem::path>>
        named_;  ///< Packages and models, once searched.
};

}  // namespace insonify::meshes
