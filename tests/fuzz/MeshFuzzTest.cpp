#include "components/meshes/FileMeshes.hpp"
#include "components/meshes/MeshFile.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

void readMesh(const Input& input) try {
    const scene::Scene scene = meshes::readMeshScene(input.file());
    const types::GeometryPtr& geometry = scene.geometry;
    EXPECT_EQ(scene.object_nodes.size(), geometry->objects.size());
    for (const types::Mesh& mesh : geometry->meshes) scene::expectSoundMesh(mesh, geometry->materials.size());
} catch (const types::ConfigError& error) {
    expectOurWords(error.what());
}

TEST(MeshFuzzTest, EveryDaeIsAMeshOrAnError) {
    push({"dae",
          "part.dae",
          {"<node id=\"a\" name=\"a\">", "<instance_node url=\"#a\"/>", "<instance_geometry url=\"#g\"/>",
           "<vcount>0 3</vcount>", "<p>0 1 2</p>", "stride=\"", "count=\"", "offset=\"", "set=\"", "</node>",
           "<polylist count=\"1\">", "#v", ",", " "},
          readMesh});
}

TEST(MeshFuzzTest, EveryObjIsAMeshOrAnError) {
    push({"obj",
          "part.obj",
          {"v 0 0 0\n", "f 1 2 3\n", "f 1//1 2//1 -1//1\n", "vn 0 0 1\n", "vt 0 0\n", "o a\n", "usemtl b\n",
           "mtllib part.mtl\n", "\\\n", "l 1 2\n", "cstype bezier\n"},
          readMesh});
}

TEST(MeshFuzzTest, EveryStlIsAMeshOrAnError) {
    push({"stl",
          "part.stl",
          {"solid a\n", "facet normal 0 0 1\n", "outer loop\n", "vertex 0 0 0\n", "endloop\n", "endfacet\n",
           "endsolid\n"},
          readMesh});
}

TEST(MeshFuzzTest, EveryPlyIsAMeshOrAnError) {
    push({"ply",
          "part.ply",
          {"format ascii 1.0\n", "format binary_little_endian 1.0\n", "element vertex 3\n", "element face 1\n",
           "property float x\n", "property list uchar int vertex_indices\n", "end_header\n", "3 0 1 2\n", "-1 "},
          readMesh});
}

/** Parses the reply of the process that reads mesh files as untrusted input. */
void parse(const Input& input) try {
    const meshes::MeshReply reply = meshes::parseReply(std::as_bytes(input.span()));
    for (const auto& part : reply.meshes.parts)
        for (const uint32_t index : part.surface.indices) ASSERT_LT(index, part.surface.positions.size());
} catch (const std::runtime_error&) {
}

TEST(MeshFuzzTest, EveryAnswerIsMeshesOrAnError) { push({"mesh_reply", "reply", {"insonify meshes 1\n"}, parse}); }

}  // namespace
}  // namespace insonify::fuzz
