// Programs that are linked with the readers need no component libraries.
#include "components/meshes/MeshFile.hpp"
#include "components/sdf/Sdf.hpp"

namespace {

[[maybe_unused]] const bool linked = [] {
    for (const insonify::scene::SceneFormat& format : insonify::scene::sceneFormats()) {
        if (format.component == "sdf") insonify::scene::addFormat(std::string(format.ending), insonify::sdf::readSdf);
        if (format.component == "meshes")
            insonify::scene::addFormat(std::string(format.ending), insonify::meshes::readMeshScene);
    }
    return true;
}();

}  // namespace
