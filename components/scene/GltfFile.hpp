#pragma once
#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

#include "types/Notice.hpp"

namespace insonify::scene {

/** A glTF file as parsed; encoded images are kept in Image::image, not decoded. */
struct GltfFile {
    std::string name;  ///< For messages.
    tinygltf::Model model;
    types::Notices notices;
};

/** Reads a .gltf or .glb and the files that it refers to. In the model, only the extensions are checked.
 *  Throws types::ConfigError if the file is missing, is no glTF, is nested too deeply, or needs an unsupported
 *  extension. */
GltfFile readGltfFile(const std::filesystem::path& file);

}  // namespace insonify::scene
