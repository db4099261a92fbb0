#include "components/meshes/ModelPaths.hpp"

#include <cstdlib>
#include <sstream>

namespace insonify::meshes {
namespace {

bool isThere(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::exists(path, error);
}

}  // namespace

ModelPaths::ModelPaths(const std::filesystem::path& world) {
    for (const char* variable :
         {"INSONIFY_MODEL_PATH", "GAZEBO_MODEL_PATH", "SDF_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH"}) {
        const char* list = std::getenv(variable);
        std::istringstream stream(list ? list : "");
        for (std::string folder; std::getline(stream, folder, ':');)
            if (!folder.empty()) folders_.push_back(std::filesystem::absolute(folder));
    }
    const std::filesystem::path folder = std::filesystem::absolute(world).parent_path();
    folders_.push_back(folder);
    if (isThere(folder / "model.config")) folders_.push_back(folder.parent_path());
}

std::optional<std::filesystem::path> ModelPaths::find(const std::string& uri,
                                                      const std::filesystem::path& named_in) const {
    const size_t scheme_end = uri.find("://");
    const std::string scheme = scheme_end == std::string::npos ? "" : uri.substr(0, scheme_end);
    const std::filesystem::path path = scheme.empty() ? uri : uri.substr(scheme_end + 3);
    if (!scheme.empty() && scheme != "model" && scheme != "package" && scheme != "file") return {};
    if (path.empty()) return {};
    if (path.is_absolute()) return isThere(path) ? std::optional(path) : std::nullopt;
    if (scheme.empty() && named_in.is_absolute() && isThere(named_in.parent_path() / path))
        return named_in.parent_path() / path;
    for (const std::filesystem::path& folder : folders_)
        if (isThere(folder / path)) return folder / path;
    return {};
}

}  // namespace insonify::meshes
