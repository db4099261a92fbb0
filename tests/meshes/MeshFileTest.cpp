// Meshes that worlds refer to: units, up axes, submeshes.
#include <map>

#include "components/meshes/MeshFile.hpp"
#include "tests/meshes/Dae.hpp"
#include "tests/sdf/SdfFiles.hpp"

namespace insonify::meshes {

using namespace scene;
using namespace sdf;
namespace {

struct MeshFileTest : SdfFiles {
    /** A rectangle from (0, 0, 0) to (1, 2, 3) of the file, twice: node "near" and, 10 along x, node "far". */
    std::filesystem::path writeDae(const std::string& unit, const std::string& up_axis) const {
        Dae dae;
        dae.unit = unit;
        dae.up_axis = up_axis;
        dae.nodes += R"(<node id="far" name="far"><translate>10 0 0</translate><instance_geometry url="#g"/></node>)";
        return write("part.dae", dae.text());
    }
    types::GeometryPtr mesh(const std::string& elements) const {
        return world(model("m", "<mesh>" + elements + "</mesh>")).geometry;
    }
};

TEST_F(MeshFileTest, TheUnitOfADaeIsHonoured) {
    const auto geometry = readMeshFile(writeDae("0.0254", "Z_UP"), MeshAxes::AsStored);
    expectSound(*mesh("<uri>part.dae</uri>"));
    expectBounds(boundsOf(*geometry), {0, 0, 0}, glm::dvec3(11, 2, 3) * 0.0254);
    EXPECT_EQ(geometry->triangleCount(), 4u);
}

TEST_F(MeshFileTest, TheUpAxisOfADaeTurnsItWhereItIsASceneOfItsOwn) {
    const auto bounds = [&](const char* up_axis) {
        return boundsOf(*readMeshFile(writeDae("1", up_axis), MeshAxes::ZUp));
    };
    expectBounds(bounds("Z_UP"), {0, 0, 0}, {11, 2, 3});
    // y is up: (x, y, z) of the file is (x, -z, y) of the world; so it is where the file says nothing (COLLADA 1.4)
    for (const char* up_axis : {"Y_UP", ""}) expectBounds(bounds(up_axis), {0, -3, 0}, {11, 0, 2});
    expectBounds(bounds("X_UP"), {-2, -3, 0}, {0, 0, 11});  // (-y, -z, x)
}

TEST_F(MeshFileTest, ADaeInAWorldAndInARobotIsNotTurnedWhateverItsUpAxis) {
    for (const char* up_axis : {"X_UP", "Y_UP", "Z_UP", ""}) {
        SCOPED_TRACE(up_axis);
        writeDae("0.5", up_axis);
        expectBounds(boundsOf(*mesh("<uri>part.dae</uri>")), {0, 0, 0}, {5.5, 1, 1.5});
        const auto robot = write("r.urdf", R"(<robot name="r"><link name="base"><visual><geometry>
            <mesh filename="part.dae"/></geometry></visual></link></robot>)");
        expectBounds(boundsOf(*readScene(robot).geometry), {0, 0, 0}, {5.5, 1, 1.5});
    }
}

/** Model makers put the collision box where Gazebo shows the mesh: the box of a model is the place of its mesh. */
TEST_F(MeshFileTest, AMeshOfAnyFormatFillsTheCollisionBoxOfItsModel) {
    writeDae("1", "Y_UP");
    write("part.obj", "v 0 0 0\nv 11 0 0\nv 11 2 3\nv 0 2 3\nf 1 2 3 4\n");
    write("part.stl",
          "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 11 0 0\nvertex 11 2 3\nendloop\nendfacet\n"
          "endsolid s\n");
    write("part.gltf", gltf(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
                            triangle(bytesOf<float>({0, 0, 0, 11, 0, 0, 11, 2, 3}))));
    const std::string box = pose("5.5 1 1.5 0 0 0"), place = pose("10 -4 2 1.5707963267948966 0 0");
    for (const char* file : {"part.dae", "part.obj", "part.stl", "part.gltf"}) {
        SCOPED_TRACE(file);
        const std::string uri = std::string("<mesh><uri>") + file + "</uri></mesh>";
        const Scene scene = world("<model name='mesh'>" + place + "<link name='l'>" + visual("v", uri) +
                                  "</link></model><model name='box'>" + place + "<link name='l'>" +
                                  visual("v", "<box><size>11 2 3</size></box>", box) + "</link></model>");
        const auto objects = scene.geometry->objects;
        ASSERT_GE(objects.size(), 2u);
        Bounds shown;
        for (size_t i = 0; i + 1 < objects.size(); ++i) {
            const Bounds one = boundsOf(*scene.geometry, objects[i]);
            shown = {glm::min(shown.low, one.low), glm::max(shown.high, one.high)};
        }
        const Bounds collision = boundsOf(*scene.geometry, objects.back());
        expectBounds(shown, collision.low, collision.high, 1e-5);
    }
}

TEST_F(MeshFileTest, ObjAndStlAreTakenAsTheyAre) {
    const std::string stl =
        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\nvertex 0 3 1\n"
        "endloop\nendfacet\nendsolid s\n";
    for (const MeshAxes axes : {MeshAxes::AsStored, MeshAxes::ZUp}) {
        expectBounds(boundsOf(*readMeshFile(write("a.stl", stl), axes)), {0, 0, 1}, {2, 3, 1});
        expectBounds(boundsOf(*readMeshFile(write("a.OBJ", "v 0 0 1\nv 2 0 1\nv 2 3 1\nv 0 3 1\nf 1 2 3 4\n"), axes)),
                     {0, 0, 1}, {2, 3, 1});
    }
}

TEST_F(MeshFileTest, AGltfInAWorldIsNotTurnedAndBringsItsAcoustics) {
    write("leaf.gltf",
          gltf(R"("nodes":[{"mesh":0}],"materials":[{"name":"oak","extras":{"acoustics":{"lambert_db":-7}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)" +
               triangle(bytesOf<float>({0, 0, 0, 1, 0, 0, 0, 2, 3}))));
    const auto geometry = mesh("<uri>leaf.gltf</uri>");
    expectSound(*geometry);
    expectBounds(boundsOf(*geometry), {0, 0, 0}, {1, 2, 3});
    expectBounds(boundsOf(*readMeshFile(folder_ / "leaf.gltf", MeshAxes::ZUp)), {0, -3, 0}, {1, 0, 2});
    EXPECT_EQ(geometry->materials.at(0).name, "oak");
    EXPECT_FLOAT_EQ(geometry->materials.at(0).lambert_db, -7);
}

TEST_F(MeshFileTest, TheScaleOfAMeshMayMirrorIt) {
    writeDae("1", "Z_UP");
    expectBounds(boundsOf(*mesh("<uri>part.dae</uri><scale>2 -1 1</scale>")), {0, -2, 0}, {22, 0, 3});
}

TEST_F(MeshFileTest, ASubmeshIsChosenByItsNodeOrMeshAndMayBeCentred) {
    writeDae("1", "Z_UP");
    const auto submesh = [&](const std::string& name, const std::string& more = "") {
        return mesh("<uri>part.dae</uri><submesh><name>" + name + "</name>" + more + "</submesh>");
    };
    expectBounds(boundsOf(*submesh("far")), {10, 0, 0}, {11, 2, 3});
    expectBounds(boundsOf(*submesh("plate")), {0, 0, 0}, {11, 2, 3});
    expectBounds(boundsOf(*submesh("far", "<center>true</center>")), {-0.5, -1, -1.5}, {0.5, 1, 1.5});
    EXPECT_TRUE(hasNotice(*submesh("rudder"), "part.dae has no submesh \"rudder\""));
}

TEST_F(MeshFileTest, AMeshUsedTwiceIsReadOnce) {
    writeDae("1", "Z_UP");
    const Scene scene = world(model("a", "<mesh><uri>part.dae</uri></mesh>") +
                              model("b", "<mesh><uri>part.dae</uri><scale>3 3 3</scale></mesh>"));
    EXPECT_EQ(scene.geometry->objects.size(), 4u);
    EXPECT_EQ(scene.geometry->meshes.size(), 1u);
}

TEST_F(MeshFileTest, ReportsADamagedMesh) {
    const std::string whole = bytesOf<float>({1, 2, 3});
    const std::map<std::string, std::string> files = {
        {"cut.dae", "<COLLADA><asset>"},
        {"words.obj", "no mesh"},
        {"cut.stl", std::string(80, ' ') + bytesOf<uint32_t>({1000000}) + whole},
        {"empty.dae", ""},
        {"a.blend", "BLENDER"}};
    for (const auto& [name, bytes] : files) {
        write(name, bytes);
        const Scene scene = world(model("m", "<mesh><uri>" + name + "</uri></mesh>"));
        EXPECT_TRUE(hasNotice(*scene.geometry, name)) << name;
    }
}

}  // namespace
}  // namespace insonify::meshes
