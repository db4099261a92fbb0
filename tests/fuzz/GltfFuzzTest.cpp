#include "tests/fuzz/SceneDoor.hpp"

namespace insonify::fuzz {
namespace {

const std::vector<std::string> words = {"\"nodes\":[",
                                        "\"mesh\":0",
                                        "\"children\":[0]",
                                        "\"extras\":{\"acoustics\":{}}",
                                        "\"sparse\":{",
                                        "\"extensions\":{",
                                        "\"KHR_texture_transform\":{",
                                        "\"EXT_mesh_gpu_instancing\":{\"attributes\":{",
                                        "\"byteStride\":",
                                        "\"byteOffset\":",
                                        "\"count\":",
                                        "\"componentType\":5121",
                                        "\"type\":\"VEC3\"",
                                        "\"mode\":5",
                                        "\"skin\":0",
                                        "\"joints\":[0]",
                                        "\"inverseBindMatrices\":0",
                                        "\"JOINTS_0\":1",
                                        "\"targets\":[{\"POSITION\":0}]",
                                        "\"weights\":[1e38]",
                                        "\"animations\":[{\"samplers\":[",
                                        "\"path\":\"weights\"",
                                        "\"interpolation\":\"CUBICSPLINE\"",
                                        "\"matrix\":[",
                                        "{",
                                        "}",
                                        "[",
                                        "]",
                                        ",",
                                        "null",
                                        "\"uri\":\"data:;base64,",
                                        "\\u0000",
                                        "\"name\":\"",
                                        "true"};

TEST(GltfFuzzTest, EveryTextIsASoundSceneOrAnError) { push({"gltf", "scene.gltf", words, readScene}); }

TEST(GltfFuzzTest, EveryBinaryIsASoundSceneOrAnError) { push({"glb", "scene.glb", words, readScene}); }

}  // namespace
}  // namespace insonify::fuzz
