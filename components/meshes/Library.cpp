// The component library meshes: reads scenes from single mesh files.
#include "components/loader/Interface.hpp"
#include "components/meshes/MeshFile.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_read_scene(const std::filesystem::path& file, insonify::scene::Scene& scene) {
    scene = insonify::meshes::readMeshScene(file);
}
