// The place of a scene in the world.
#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "components/scene/Placement.hpp"
#include "components/scene/SceneTask.hpp"
#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

using types::WorldFrame;

struct PlacementTest : SceneFiles {
    /** A node with a child, a corner of whose triangle is at (1, 2, 3) + (0, 1, 0) of the file. */
    Scene scene() const {
        return readScene(write(
            "s.gltf", gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"boat","translation":[1,2,3],"children":[1]},
                {"mesh":0,"name":"mast"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
                           triangle())));
    }
    /** The triangle's third corner, which is (1, 3, 3) of the file, in the world. */
    static glm::dvec3 corner(const Scene& scene) {
        const types::Geometry& geometry = *scene.geometry;
        const glm::vec3 in_mesh = geometry.meshes[0].positions[2];
        return glm::dvec3(geometry.objects[0].world_from_object * glm::dvec4(glm::dvec3(in_mesh), 1));
    }
    static void expectNear(glm::dvec3 a, glm::dvec3 b) {
        EXPECT_LT(glm::distance(a, b), 1e-9) << a.x << " " << a.y << " " << a.z;
    }
};

TEST_F(PlacementTest, PlacesAPointOfTheFile) {
    const Scene file = scene();
    expectNear(corner(file), {1, -3, 3});  // y up: (x, -z, y)
    expectNear(corner(placed(file, {})), {1, -3, 3});
    expectNear(corner(placed(file, {.position = {10, 20, 30}})), {11, 17, 33});
    expectNear(corner(placed(file, {.yaw_deg = 90})), {3, 1, 3});
    expectNear(corner(placed(file, {.up = UpAxis::Z})), {1, 3, 3});
    expectNear(corner(placed(file, {.up = UpAxis::X})), {3, 3, 1});
    // With z up the file has (1, 3, 3): east 1, north 3 is north 3, west -1.
    expectNear(corner(placed(file, {.frame = WorldFrame::Enu, .up = UpAxis::Z})), {3, -1, 3});
    expectNear(corner(placed(file, {.frame = WorldFrame::Ned, .up = UpAxis::Z})), {1, -3, -3});
}

TEST_F(PlacementTest, AsksWhetherALargeFileWithoutUnitIsInMillimetres) {
    using Kind = types::Notice::Kind;
    const auto ask = [](const char* file, glm::dvec3 size) { return askUnit(file, size, "scale it"); };
    const auto kind = [&](glm::dvec3 size) { return ask("a/part.STL", size)->kind; };
    EXPECT_EQ(kind({5000, 2000, 1000}), Kind::Warning) << "larger than any ship";
    EXPECT_EQ(kind({2000, 2000, 0}), Kind::Note) << "a plate of 2 m, or ground";
    EXPECT_EQ(kind({300, 200, 100}), Kind::Note) << "a box of 30 cm, or a hall";
    EXPECT_EQ(
        ask("part.stl", {300, 200, 100})->text,
        "part.stl is 300 x 200 x 100 m: it states no unit and is taken as metres; if it is in millimetres, scale it");
    EXPECT_FALSE(ask("part.obj", {99, 50, 20})) << "a ferry";
    for (const char* file : {"part.dae", "part.glb", "part.world"}) EXPECT_FALSE(ask(file, {5000, 2000, 1000})) << file;
}

/** A pose in the frame of the scene gives the same point of the file in any frame. */
TEST_F(PlacementTest, APoseOfRosMeetsTheSamePointOfASceneInTheFrameOfRos) {
    const Scene file = scene();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-50, 50);
    for (const WorldFrame frame : {WorldFrame::AsIs, WorldFrame::Enu, WorldFrame::Ned})
        for (int i = 0; i < 50; ++i) {
            const Placement placement{.frame = frame, .up = UpAxis::Z};
            Scene moved = file;
            auto geometry = std::make_shared<types::Geometry>(*file.geometry);
            const glm::dvec3 place(uniform(random), uniform(random), uniform(random));
            geometry->objects[0].world_from_object[3] = file.z_up_from_file * glm::dvec4(place, 1);
            moved.geometry = geometry;
            const Scene result = placed(moved, placement);
            expectNear(glm::dvec3(result.geometry->objects[0].world_from_object[3]),
                       types::Axes{frame}.rockFromWorld(place));
        }
}

TEST_F(PlacementTest, PlacingKeepsShapesAndTheTreeOfNodes) {
    const Scene file = scene();
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-180, 180);
    for (int i = 0; i < 100; ++i) {
        const Placement placement{.position = {uniform(random), uniform(random), uniform(random)},
                                  .yaw_deg = uniform(random),
                                  .frame = static_cast<WorldFrame>(i % 3),
                                  .up = static_cast<UpAxis>(i / 3 % 3)};
        const Scene result = placed(file, placement);
        const glm::dmat3 turned(result.geometry->objects[0].world_from_object);
        EXPECT_NEAR(glm::determinant(turned), 1, 1e-12) << "no mirror";
        const glm::dmat3 square = glm::transpose(turned) * turned;
        EXPECT_LT(glm::distance(square[0], glm::dvec3(1, 0, 0)) + glm::distance(square[1], glm::dvec3(0, 1, 0)), 1e-12);
        glm::dmat4 chain(1);
        for (int node = result.object_nodes[0]; node >= 0; node = result.nodes[static_cast<size_t>(node)].parent)
            chain = result.nodes[static_cast<size_t>(node)].parent_from_node * chain;
        expectNear(glm::dvec3(chain[3]), glm::dvec3(result.geometry->objects[0].world_from_object[3]));
        EXPECT_EQ(&result.geometry->meshes[0], &file.geometry->meshes[0]) << "meshes are shared";
    }
}

TEST_F(PlacementTest, ANodeThatPosesMoveIsAffectedByUpAlone) {
    const Scene file = scene();
    const auto getBody = [](const Scene& scene) {
        return getParts(scene, findNode(scene, "boat"))[0].body_from_object;
    };
    const Scene turned = placed(file, {.position = {7, 8, 9}, .yaw_deg = 33, .frame = WorldFrame::Enu});
    for (int column = 0; column < 4; ++column)
        EXPECT_LT(glm::distance(getBody(turned)[column], getBody(file)[column]), 1e-12) << column;
    const glm::dvec4 tip =
        getBody(placed(file, {.up = UpAxis::Z})) * glm::dvec4(file.geometry->meshes[0].positions[2], 1);
    expectNear(glm::dvec3(tip), {0, 1, 0});
}

TEST_F(PlacementTest, DescribesTheOrientationInOneLine) {
    const Scene file = scene();
    EXPECT_EQ(describeLay(file, {}, WorldFrame::AsIs), "the file's x is north, its -z west, its y up");
    EXPECT_EQ(describeLay(file, {}, WorldFrame::Enu),
              "the file's x is north, its -z west, its y up; x of the poses, in enu, is along its z, y along its x");
    EXPECT_EQ(describeLay(file, {.frame = WorldFrame::Enu}, WorldFrame::Enu),
              "the file's -z is north, its -x west, its y up; x of the poses, in enu, is along its x, y along its -z");
    EXPECT_THAT(describeLay(file, {.yaw_deg = 45}, WorldFrame::AsIs),
                testing::HasSubstr("the file's (0.707, 0, 0.707) is"));
}

TEST_F(PlacementTest, TheTaskPlacesItsSceneAndReportsIt) {
    SceneTask task("scene");
    SceneConfig config;
    scene();
    config.file = (folder_ / "s.gltf").string();
    task.config.set(config);
    ASSERT_TRUE(task.configure()) << task.lastError();
    EXPECT_THAT(task.notices(), testing::Not(testing::Contains(testing::HasSubstr("is north"))));
    ASSERT_TRUE(task.cleanup());
    config.placement = Placement{.yaw_deg = 90};
    task.config.set(config);
    ASSERT_TRUE(task.configure()) << task.lastError();
    EXPECT_THAT(task.notices(), testing::Contains(testing::HasSubstr("the file's z is north, its x west")));
}

/** Random rotations of the file, of nodes and of scales, also of a node within another. */
TEST_F(PlacementTest, AScaledNodeScalesItsSubtreeAboutItsOrigin) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-3, 3);
    for (int round = 0; round < 50; ++round) {
        Scene file = scene();
        auto geometry = std::make_shared<types::Geometry>(*file.geometry);
        glm::dmat4 world_from_node(1);
        for (Node& node : file.nodes) {
            const glm::dquat turn =
                glm::normalize(glm::dquat(uniform(random), uniform(random), uniform(random), uniform(random)));
            node.parent_from_node =
                glm::translate(glm::dmat4(1), glm::dvec3(uniform(random), uniform(random), uniform(random))) *
                glm::mat4_cast(turn);
            world_from_node = world_from_node * node.parent_from_node;
        }
        geometry->objects[0].world_from_object = world_from_node * file.node_from_object[0];
        file.geometry = geometry;
        const glm::dvec3 boat(file.nodes[0].parent_from_node[3]), mast(world_from_node[3]), before = corner(file);
        types::Diagnostics none;
        expectNear(corner(scaled(file, {{"boat", 2.5}}, none)), boat + 2.5 * (before - boat));
        expectNear(corner(scaled(file, {{"mast", 0.5}}, none)), mast + 0.5 * (before - mast));
        const glm::dvec3 moved_mast = boat + 2.5 * (mast - boat);
        expectNear(corner(scaled(file, {{"mast", 0.5}, {"boat", 2.5}}, none)), moved_mast + 1.25 * (before - mast));
        const Scene same = scaled(file, {{"boat", 1}}, none);
        expectNear(corner(same), before);
        // A pose of the body does not change the scale.
        const Scene large = scaled(file, {{"mast", 3}}, none);
        const Part was = getParts(file, 1).front(), is = getParts(large, 1).front();
        for (int column = 0; column < 3; ++column)
            expectNear(glm::dvec3(is.body_from_object[column]), 3.0 * glm::dvec3(was.body_from_object[column]));
        EXPECT_TRUE(none.empty());
    }
}

TEST_F(PlacementTest, ReportsAnUnknownNodeToScale) {
    types::Diagnostics found;
    const Scene file = scene(), result = scaled(file, {{"bot", 2}}, found);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].text(), "scale.bot: is no node of the scene; did you mean boat? insonify scene lists them");
    EXPECT_EQ(result.geometry->objects[0].world_from_object, file.geometry->objects[0].world_from_object);
}

}  // namespace
}  // namespace insonify::scene
