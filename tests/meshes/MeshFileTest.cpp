// Meshes that worlds refer to: units, up axes, submeshes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <map>

#include "components/meshes/MeshFile.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/scene/Placement.hpp"
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
    expectBounds(getBounds(*geometry), {0, 0, 0}, glm::dvec3(11, 2, 3) * 0.0254);
    EXPECT_EQ(geometry->triangleCount(), 4u);
}

TEST_F(MeshFileTest, TheUpAxisOfADaeTurnsItWhereItIsASceneOfItsOwn) {
    const auto bounds = [&](const char* up_axis) {
        return getBounds(*readMeshFile(writeDae("1", up_axis), MeshAxes::ZUp));
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
        expectBounds(getBounds(*mesh("<uri>part.dae</uri>")), {0, 0, 0}, {5.5, 1, 1.5});
        const auto robot = write("r.urdf", R"(<robot name="r"><link name="base"><visual><geometry>
            <mesh filename="part.dae"/></geometry></visual></link></robot>)");
        expectBounds(getBounds(*readScene(robot).geometry), {0, 0, 0}, {5.5, 1, 1.5});
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
                            triangle(toBytes<float>({0, 0, 0, 11, 0, 0, 11, 2, 3}))));
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
            const Bounds one = getBounds(*scene.geometry, objects[i]);
            shown = {glm::min(shown.low, one.low), glm::max(shown.high, one.high)};
        }
        const Bounds collision = getBounds(*scene.geometry, objects.back());
        expectBounds(shown, collision.low, collision.high, 1e-5);
    }
}

TEST_F(MeshFileTest, ObjAndStlAreTakenAsTheyAre) {
    const std::string stl =
        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\nvertex 0 3 1\n"
        "endloop\nendfacet\nendsolid s\n";
    for (const MeshAxes axes : {MeshAxes::AsStored, MeshAxes::ZUp}) {
        expectBounds(getBounds(*readMeshFile(write("a.stl", stl), axes)), {0, 0, 1}, {2, 3, 1});
        expectBounds(getBounds(*readMeshFile(write("a.OBJ", "v 0 0 1\nv 2 0 1\nv 2 3 1\nv 0 3 1\nf 1 2 3 4\n"), axes)),
                     {0, 0, 1}, {2, 3, 1});
    }
}

TEST_F(MeshFileTest, NamesKeepTheirBlanks) {
    const auto names = [](const types::Geometry& geometry) {
        std::vector<std::string> all;
        for (const types::Object& object : geometry.objects) all.push_back(object.name);
        return all;
    };
    const std::string points = "v 0 0 1\nv 2 0 1\nv 2 3 1\n", face = "f 1 2 3\n";
    for (const std::string end : {"\n", " \r\n", "\t\n"})
        EXPECT_THAT(
            names(*readMeshFile(write("o.obj", points + "o pile 1" + end + face + "o pile  groß 2" + end + face +
                                                   "o\tpile" + end + face + "o one # of two" + end + face),
                                MeshAxes::AsStored)),
            testing::UnorderedElementsAre("pile 1", "pile  groß 2", "pile", "one"));
    const auto solid = [](const std::string& name) {
        return "solid " + name +
               "\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\nvertex 0 3 1\nendloop\n"
               "endfacet\nendsolid " +
               name + "\n";
    };
    EXPECT_THAT(names(*readMeshFile(write("s.stl", solid("pile 1") + solid("left wall")), MeshAxes::AsStored)),
                testing::UnorderedElementsAre("pile 1", "left wall"));
}

TEST_F(MeshFileTest, AMarkOfUtf8HidesNoVertex) {
    const auto geometry =
        readMeshFile(write("b.obj", "\xef\xbb\xbfv 5 0 1\nv 2 0 1\nv 2 3 1\nv 9 9 9\nf 1 2 3\n"), MeshAxes::AsStored);
    expectBounds(getBounds(*geometry), {2, 0, 1}, {5, 3, 1});
}

/** assimp would join such a vertex to any other. */
TEST_F(MeshFileTest, ATriangleWhoseVertexIsNoNumberIsDroppedWithANotice) {
    for (const char* wrong : {"nan 0 0", "0 inf 0", "0 0 -inf"})
        for (const bool is_first : {true, false}) {
            const std::string odd = std::string("v ") + wrong + "\n", good = "v 0 0 1\nv 2 0 1\nv 2 3 1\n";
            const auto geometry = readMeshFile(write("n.obj", is_first ? odd + good + "o a\nf 2 3 4\nf 1 2 3\n"
                                                                       : good + odd + "o a\nf 1 2 4\nf 1 2 3\n"),
                                               MeshAxes::AsStored);
            EXPECT_EQ(geometry->triangleCount(), 1u) << wrong;
            expectBounds(getBounds(*geometry), {0, 0, 1}, {2, 3, 1});
            EXPECT_TRUE(hasNotice(*geometry, "triangles dropped for a vertex that is not a finite number: 1")) << wrong;
        }
}

TEST_F(MeshFileTest, AGltfInAWorldIsNotTurnedAndBringsItsAcoustics) {
    write("leaf.gltf",
          gltf(R"("nodes":[{"mesh":0}],"materials":[{"name":"oak","extras":{"acoustics":{"lambert_db":-7}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)" +
               triangle(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 2, 3}))));
    const auto geometry = mesh("<uri>leaf.gltf</uri>");
    expectSound(*geometry);
    expectBounds(getBounds(*geometry), {0, 0, 0}, {1, 2, 3});
    expectBounds(getBounds(*readMeshFile(folder_ / "leaf.gltf", MeshAxes::ZUp)), {0, -3, 0}, {1, 0, 2});
    EXPECT_EQ(geometry->materials.at(0).name, "oak");
    EXPECT_FLOAT_EQ(geometry->materials.at(0).lambert_db, -7);
}

/** Names of materials are in the .obj itself. */
TEST_F(MeshFileTest, NoLibraryOfMaterialsIsRead) {
    write("near.mtl", "newmtl steel_grey\nKd 1 1 1\nnewmtl witness\nKd 1 1 1\n");
    ASSERT_EQ(mkfifo((folder_ / "pipe.mtl").c_str(), 0600), 0);
    for (const char* library : {"near.mtl", "pipe.mtl", "none.mtl", "../near.mtl"})
        for (const std::string name : {"steel_grey", "rubber", ""}) {
            write("part.obj", std::string("mtllib ") + library + "\nv 0 0 0\nv 1 0 0\nv 1 2 3\no hull\n" +
                                  (name.empty() ? "" : "usemtl " + name + "\n") + "f 1 2 3\n");
            const Scene scene = readScene(folder_ / "part.obj");
            ASSERT_EQ(scene.geometry->materials.size(), 1u) << library;
            EXPECT_EQ(scene.geometry->materials[0].name, name.empty() ? "part" : name) << library;
        }
}

TEST_F(MeshFileTest, AMeshFileIsASceneOfItsOwn) {
    write("part.mtl", "newmtl steel_grey\nKd 1 1 1\n");
    write("part.obj", "mtllib part.mtl\nv 0 0 0\nv 11 0 0\nv 11 2 3\nv 0 2 3\no hull\nusemtl steel_grey\nf 1 2 3 4\n");
    write("part.stl",
          "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 11 0 0\nvertex 11 2 3\nendloop\nendfacet\n"
          "endsolid s\n");
    write("part.PLY",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
          "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n11 0 0\n11 2 3\n3 0 1 2\n");
    for (const char* file : {"part.obj", "part.stl", "part.PLY"}) {
        SCOPED_TRACE(file);
        const Scene scene = readScene(folder_ / file);
        expectSound(*scene.geometry);
        expectBounds(getBounds(*scene.geometry), {0, 0, 0}, {11, 2, 3});
        ASSERT_EQ(findNode(scene, "part"), 0) << "the whole file moves with the node of its name";
        EXPECT_EQ(getParts(scene, 0).size(), scene.geometry->objects.size());
        expectBounds(getBounds(*placed(scene, {.position = {1, 2, 3}, .scale = 0.1}).geometry), {1, 2, 3},
                     {2.1, 2.2, 3.3});
        expectBounds(getBounds(*placed(scene, {.up = UpAxis::Y}).geometry), {0, -3, 0}, {11, 0, 2});
        expectBounds(getBounds(*placed(scene, {.up = UpAxis::Z}).geometry), {0, 0, 0}, {11, 2, 3});
        const auto used = static_cast<size_t>(scene.geometry->meshes.at(0).clusters.at(0).material);
        EXPECT_EQ(scene.geometry->materials.at(used).name, std::string(file) == "part.obj" ? "steel_grey" : "part");
    }
    types::Diagnostics faults;
    const std::map<std::string, Acoustics> steel = {{"part", readAcoustics({{"material", "steel"}}, "", faults)}};
    EXPECT_EQ(overrideMaterials(readScene(folder_ / "part.stl"), steel, faults)->materials.at(0).matter, "steel");
    EXPECT_TRUE(faults.empty());
}

TEST_F(MeshFileTest, ADaeAsASceneIsUprightAndItsAxesMayBeOverridden) {
    const std::map<std::string, Bounds> upright = {
        {"Z_UP", {{0, 0, 0}, {11, 2, 3}}}, {"Y_UP", {{0, -3, 0}, {11, 0, 2}}}, {"X_UP", {{-2, -3, 0}, {0, 0, 11}}}};
    for (const auto& [up_axis, bounds] : upright) {
        SCOPED_TRACE(up_axis);
        const Scene scene = readScene(writeDae("1", up_axis));
        expectBounds(getBounds(*scene.geometry), bounds.low, bounds.high);
        for (const char* node : {"part", "near", "far"}) EXPECT_GE(findNode(scene, node), 0) << node;
        EXPECT_EQ(getParts(scene, findNode(scene, "part")).size(), 2u);
        expectBounds(getBounds(*placed(scene, {.up = UpAxis::Z}).geometry), {0, 0, 0}, {11, 2, 3});
        expectBounds(getBounds(*placed(scene, {.up = UpAxis::Y}).geometry), {0, -3, 0}, {11, 0, 2});
    }
}

TEST_F(MeshFileTest, ABodyLargerThanAnyShipWhoseFileStatesNoUnitIsAsked) {
    const auto obj = [&](double x, double y, double z) {
        return write("big.obj", fmt::format("v 0 0 0\nv {} 0 0\nv 0 {} {}\nf 1 2 3\n", x, y, z));
    };
    const auto warns = [&](const Scene& scene) { return hasNotice(*scene.geometry, "if it is in millimetres"); };
    obj(5000, 2000, 1000);
    const std::string uri = "<mesh><uri>big.obj</uri>";
    const Scene twice = world("<model name='m'><link name='l'>" + visual("a", uri + "</mesh>") +
                              visual("b", uri + "</mesh>") + "</link></model>");
    EXPECT_TRUE(warns(twice));
    EXPECT_EQ(twice.geometry->notices.size(), 1u);
    EXPECT_EQ(twice.geometry->notices.front().kind, types::Notice::Kind::Warning);
    EXPECT_FALSE(warns(world(model("m", uri + "<scale>0.001 0.001 0.001</scale></mesh>"))));
}

TEST_F(MeshFileTest, HasOnlyTheMaterialsOfItsSurfaces) {
    write("own.mtl", "newmtl unused\nKd 1 1 1\nnewmtl steel\nKd 1 0 0\nnewmtl concrete\nKd 0 1 0\n");
    const auto getNames = [&](const std::string& faces) {
        write("part.obj", "mtllib own.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\n" + faces);
        const Scene scene = readScene(folder_ / "part.obj");
        std::vector<std::string> names;
        for (const types::Material& material : scene.geometry->materials) names.push_back(material.name);
        for (const types::Mesh& mesh : scene.geometry->meshes)
            for (const types::Cluster& cluster : mesh.clusters)
                EXPECT_LT(static_cast<size_t>(cluster.material), names.size());
        return names;
    };
    using testing::UnorderedElementsAre;
    EXPECT_THAT(getNames("usemtl concrete\nf 1 2 3\nusemtl steel\nf 1 3 4\n"),
                UnorderedElementsAre("steel", "concrete"));
    EXPECT_THAT(getNames("usemtl rubber\nf 1 2 3\nusemtl steel\nf 1 3 4\n"), UnorderedElementsAre("steel", "rubber"))
        << "which the .mtl lacks";
}

TEST_F(MeshFileTest, AMeshFileWithoutTrianglesOrThatIsNoMeshIsNoScene) {
    write("points.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
          "z\nend_header\n0 0 0\n");
    write("empty.stl", "");
    write("words.obj", "hello\n");
    write("words.ply", "ply\nhello\n");
    for (const char* file : {"points.ply", "empty.stl", "words.obj", "words.ply"})
        EXPECT_NE(findDiagnostic(folder_ / file).find(file), std::string::npos) << findDiagnostic(folder_ / file);
}

TEST_F(MeshFileTest, ADaeWhoseTextureHasNoPictureIsReadWithoutIt) {
    std::string text = Dae().text();
    const std::string effects =
        R"(<library_images><image id="i"/></library_images><library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><phong><diffuse><texture texture="t" texcoord="u"/></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="paint"><instance_effect url="#e"/></material></library_materials>)";
    text.insert(text.find("<library_geometries>"), effects);
    expectBounds(getBounds(*readMeshFile(write("paint.dae", text), MeshAxes::AsStored)), {0, 0, 0}, {1, 2, 3});
}

TEST_F(MeshFileTest, TheScaleOfAMeshMayMirrorIt) {
    writeDae("1", "Z_UP");
    expectBounds(getBounds(*mesh("<uri>part.dae</uri><scale>2 -1 1</scale>")), {0, -2, 0}, {22, 0, 3});
}

TEST_F(MeshFileTest, ASubmeshIsChosenByItsNodeOrMeshAndMayBeCentred) {
    writeDae("1", "Z_UP");
    const auto submesh = [&](const std::string& name, const std::string& more = "") {
        return mesh("<uri>part.dae</uri><submesh><name>" + name + "</name>" + more + "</submesh>");
    };
    expectBounds(getBounds(*submesh("far")), {10, 0, 0}, {11, 2, 3});
    expectBounds(getBounds(*submesh("plate")), {0, 0, 0}, {11, 2, 3});
    expectBounds(getBounds(*submesh("far", "<center>true</center>")), {-0.5, -1, -1.5}, {0.5, 1, 1.5});
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
    const std::string whole = toBytes<float>({1, 2, 3});
    const std::map<std::string, std::string> files = {
        {"cut.dae", "<COLLADA><asset>"},
        {"words.obj", "no mesh"},
        {"cut.stl", std::string(80, ' ') + toBytes<uint32_t>({1000000}) + whole},
        {"empty.dae", ""},
        {"a.blend", "BLENDER"}};
    for (const auto& [name, bytes] : files) {
        write(name, bytes);
        const Scene scene = world(model("m", "<mesh><uri>" + name + "</uri></mesh>"));
        EXPECT_TRUE(hasNotice(*scene.geometry, name)) << name;
    }
    EXPECT_TRUE(hasNotice(*world(model("m", "<mesh><uri>cut.stl</uri></mesh>")).geometry,
                          "is a binary .stl of 1000000 triangles, which take 50000084 bytes, and has 96"));
    write("wide.obj", std::string("\xff\xfev\0 \0", 6));
    EXPECT_TRUE(hasNotice(*world(model("m", "<mesh><uri>wide.obj</uri></mesh>")).geometry, "it is text in UTF-16"));
}

}  // namespace
}  // namespace insonify::meshes
