// The component library sdf: reads scenes from SDF files.
#include "components/loader/Interface.hpp"
#include "components/sdf/Sdf.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_read_sonars(const std::filesystem::path& file, insonify::scene::WorldSonars& sonars) {
    sonars = insonify::sdf::readSonars(file);
}

extern "C" void insonify_read_scene(const std::filesystem::path& file, insonify::scene::Scene& scene) {
    scene = insonify::sdf::readSdf(file);
}
