#pragma once
#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

namespace insonify::scene {

/** A glTF file as parsed; encoded images are kept in Image::image, not decoded. */
struct GltfFile {
    std::string name;  ///< For messages.
    tinygltf::Model model;
    std::vector<std::string> notices;
};

/** Reads a .gltf or .glb and what it refers to. Nothing in the model is checked but its extensions.
 *  Throws types::ConfigError for a file that is missing, no glTF, nested too deeply, or needs what we cannot read. */
GltfFile readGltfFile(const std::filesystem::path& file);

}  // namespace insonify::scene
