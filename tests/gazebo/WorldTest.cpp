// Scenes from the bytes of Gazebo's replies.
#include <gazebo_messages.pb.h>
#include <gmock/gmock.h>

#include <limits>

#include "components/gazebo/Subscriptions.hpp"
#include "components/gazebo/World.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/scene/Drawings.hpp"
#include "tests/gazebo/Recordings.hpp"
#include "tests/sdf/SdfFiles.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct WorldTest : scene::SceneFiles {
    World getWorld(const wire::Scene& message) const { return gazebo::getWorld(message.SerializeAsString(), folder_); }
    types::Notices getNotices(const wire::Scene& message) const { return getWorld(message).scene.geometry->notices; }
    static wire::Visual& addBox(wire::Model& model, const std::string& name, double side = 1) {
        wire::Link& link = *model.add_link();
        link.set_name(name);
        wire::Visual& visual = *link.add_visual();
        visual.set_name("visual");
        setVector(*visual.mutable_geometry()->mutable_box()->mutable_size(), side, side, side);
        return visual;
    }
    static wire::Model& addModel(wire::Scene& message, const std::string& name) {
        wire::Model& model = *message.add_model();
        model.set_name(name);
        return model;
    }
    static void setVector(wire::Vector3d& vector, double x, double y, double z) {
        vector.set_x(x), vector.set_y(y), vector.set_z(z);
    }
    /** Returns the box around the objects at and below a node. */
    static scene::Bounds getBounds(const scene::Scene& scene, const std::string& node) {
        const int found = scene::findNode(scene, node);
        EXPECT_GE(found, 0) << node;
        scene::Bounds bounds;
        if (found < 0) return bounds;
        for (const scene::Part& part : scene::getParts(scene, found))
            for (const glm::dvec3 corner : scene::worldCorners(*scene.geometry, scene.geometry->objects[part.object]))
                bounds.low = glm::min(bounds.low, corner), bounds.high = glm::max(bounds.high, corner);
        return bounds;
    }
};

TEST_F(WorldTest, AWorldOfHarmonicIsAScene) {
    const World world = gazebo::getWorld(recording("scene"), folder_);
    const scene::Scene& scene = world.scene;
    std::vector<std::string> nodes;
    for (const scene::Node& node : scene.nodes) nodes.push_back(node.name);
    EXPECT_THAT(nodes, ElementsAre("sea_floor", "sea_floor::link", "crate", "crate::link", "ball", "ball::link", "rig",
                                   "rig::leg", "rig::leg::pipe", "buoy", "buoy::part0", "buoy::part1", "buoy::part2",
                                   "rov", "rov::link", "hill", "hill::link"));
    scene::expectSound(*scene.geometry);
    sdf::expectBounds(getBounds(scene, "sea_floor"), {-50, -50, -10}, {50, 50, -10});
    sdf::expectBounds(getBounds(scene, "crate"), {-1, 1.5, -6}, {3, 3.5, 0});  // half a metre ahead, turned to port
    sdf::expectBounds(getBounds(scene, "ball"), {18, -2, -2}, {22, 2, 2});
    sdf::expectBounds(getBounds(scene, "rig"), {2.5, 29.5, -4}, {3.5, 30.5, 4});
    sdf::expectBounds(getBounds(scene, "buoy::part0"), {-20.5, -0.5, -1}, {-19.5, 0.5, 1});
    sdf::expectBounds(getBounds(scene, "buoy::part1"), {-21, -2, 3.5}, {-19, 2, 4.5});
    sdf::expectBounds(getBounds(scene, "buoy::part2"), {-21, -1, 6.5}, {-19, 1, 9.5});
    EXPECT_THAT(types::lines(scene.geometry->notices),
                ElementsAre("visual rov::link::visual is omitted: file:///nowhere/models/rov/meshes/hull.obj is not "
                            "found",
                            "visual hill::link::visual is omitted: /nowhere/hill.png is not found",
                            StartsWith("files of models were searched in ")));
    for (const char* name : {"crate", "link", "visual", "leg", "sun"}) EXPECT_TRUE(world.names.contains(name)) << name;
}

TEST_F(WorldTest, MaterialsAreOfTheMatterInTheNamesOfTheirScripts) {
    const World world = gazebo::getWorld(recording("scene"), folder_);
    const auto named = scene::applyMaterialNames(world.scene.geometry);
    EXPECT_THAT(named->notices, Contains(HasSubstr("Gazebo/Steel")));
}

TEST_F(WorldTest, WithoutScriptsTheMatterIsInTheNamesOfVisualsLinksAndModels) {
    wire::Scene message;
    wire::Model& model = addModel(message, "concrete_pier");
    addBox(model, "pile");
    addBox(model, "steel_ladder");
    addBox(addModel(message, "crate"), "link").set_name("wood");
    addBox(addModel(message, "thing"), "link");
    const World world = getWorld(message);
    std::vector<std::string> materials;
    for (const types::Material& material : world.scene.geometry->materials) materials.push_back(material.name);
    EXPECT_THAT(materials, ElementsAre("concrete_pier", "steel_ladder", "wood", "default"));
    EXPECT_EQ(world.scene.geometry->meshes.size(), 4u);
}

TEST_F(WorldTest, TransparencyAndShadowsAreRead) {
    wire::Scene message;
    wire::Model& model = addModel(message, "m");
    addBox(model, "a").set_transparency(1);
    addBox(model, "b").set_transparency(0.25);
    EXPECT_TRUE(getWorld(message).scene.drawings.at(1).casts_shadow) << "nobody sends shadows";
    addBox(model, "c").set_cast_shadows(true);
    const World world = getWorld(message);
    ASSERT_EQ(world.scene.drawings.size(), 3u);
    EXPECT_EQ(world.scene.drawings[0].transparency, 1);
    EXPECT_EQ(world.scene.drawings[1].transparency, 0.25);
    EXPECT_FALSE(world.scene.drawings[1].casts_shadow);
    EXPECT_TRUE(world.scene.drawings[2].casts_shadow);
    const scene::Scene kept = scene::withoutOmitted(world.scene, {{"m::c"}, true, {}, {}});
    ASSERT_EQ(kept.geometry->objects.size(), 1u);
    EXPECT_EQ(kept.geometry->objects[0].name, "m::b::visual");
}

TEST_F(WorldTest, FindsAMeshOfAnotherMachineByTheEndOfItsPath) {
    std::filesystem::create_directories(folder_ / "rov/meshes");
    write("rov/meshes/hull.gltf",
          gltf(scene::triangle() + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
               "nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}])"));
    const sdf::Variable variable("INSONIFY_MODEL_PATH", folder_.string());
    wire::Scene message;
    wire::Visual& visual = addBox(addModel(message, "rov"), "hull");
    visual.mutable_geometry()->set_type(wire::Geometry::MESH);
    for (const char* place :
         {"/home/other/models/rov/meshes/hull.gltf", "file:///home/other/models/rov/meshes/hull.gltf",
          "model://rov/meshes/hull.gltf", "package://rov/meshes/hull.gltf"}) {
        visual.mutable_geometry()->mutable_mesh()->set_filename(place);
        const World world = getWorld(message);
        EXPECT_THAT(world.scene.geometry->notices, IsEmpty()) << place;
        EXPECT_EQ(world.scene.geometry->objects.size(), 1u) << place;
    }
    visual.mutable_geometry()->mutable_mesh()->set_filename("/home/other/hull.gltf");
    EXPECT_THAT(getNotices(message), Contains(HasSubstr("/home/other/hull.gltf is not found")));
    visual.mutable_geometry()->mutable_mesh()->set_filename("https://fuel.gazebosim.org/hull.gltf");
    EXPECT_THAT(getNotices(message), Contains(HasSubstr("https://fuel.gazebosim.org/hull.gltf is not found")));
}

TEST_F(WorldTest, OmitsAndReportsInvalidPosesAndSizes) {
    wire::Scene message;
    wire::Model& lost = addModel(message, "lost");
    setVector(*lost.mutable_pose()->mutable_position(), nan, 0, 0);
    addBox(lost, "link");
    wire::Model& unturned = addModel(message, "unturned");
    unturned.mutable_pose()->mutable_orientation();  // all zero
    wire::Model& bad = addModel(message, "bad");
    addBox(bad, "negative", -1);
    addBox(bad, "nan", nan);
    addBox(bad, "flat", 0);
    setVector(*addBox(bad, "moved").mutable_pose()->mutable_position(), 0, 1 / 0.0, 0);
    for (const double radius : {0.0, 1 / 0.0}) {
        wire::Geometry& capsule = *addBox(bad, "capsule").mutable_geometry();
        capsule.set_type(wire::Geometry::CAPSULE);
        capsule.mutable_capsule()->set_radius(radius);
    }
    addBox(bad, "none").clear_geometry();
    addBox(bad, "text").mutable_geometry()->set_type(wire::Geometry::POLYLINE);
    wire::Geometry& mesh = *addBox(bad, "mesh").mutable_geometry();
    mesh.set_type(wire::Geometry::MESH);
    setVector(*mesh.mutable_mesh()->mutable_scale(), nan, 1, 1);
    wire::Geometry& plane = *addBox(bad, "plane").mutable_geometry();
    plane.set_type(wire::Geometry::PLANE);
    plane.mutable_plane()->mutable_size()->set_x(nan);
    addBox(bad, "empty").mutable_geometry()->set_type(wire::Geometry::EMPTY);
    EXPECT_THAT(
        getNotices(message),
        ElementsAre("model lost is omitted: its pose is not finite, or its orientation has no length",
                    "model unturned is omitted: its pose is not finite, or its orientation has no length",
                    "visual bad::negative::visual is omitted: its size is -1; must not be negative",
                    "visual bad::nan::visual is omitted: its size is nan; must not be negative",
                    "visual bad::moved::visual is omitted: its pose is not finite, or its orientation has no length",
                    "link bad::capsule exists twice; the second is named bad::capsule_2 here",
                    "visual bad::none::visual is omitted: it has no geometry",
                    "visual bad::text::visual is omitted: its geometry is not supported",
                    "visual bad::mesh::visual is omitted: its scale is not finite",
                    "visual bad::plane::visual is omitted: its normal or size is not finite",
                    "visuals omitted, their size is zero in some direction or not finite: 3",
                    "the scene has no triangles: an empty sea"));
}

TEST_F(WorldTest, AWorldWithoutVisualsIsAnEmptySea) {
    EXPECT_THAT(getNotices({}), ElementsAre("the scene has no triangles: an empty sea"));
}

TEST_F(WorldTest, ReportsDuplicateNames) {
    wire::Scene message;
    for (int i = 0; i < 2; ++i) addBox(addModel(message, "buoy"), "link");
    const World world = getWorld(message);
    EXPECT_THAT(world.scene.geometry->notices,
                ElementsAre("model buoy exists twice; the second is named buoy_2 here",
                            "link buoy::link exists twice; the second is named buoy::link_2 here"));
    EXPECT_GE(scene::findNode(world.scene, "buoy_2"), 0);
}

TEST_F(WorldTest, InvalidBytesAndTooLargeWorldsAreErrors) {
    const auto findDiagnostic = [&](const std::string& bytes) -> std::string {
        return test::computeError<types::ConfigError>([&] { gazebo::getWorld(bytes, folder_); });
    };
    EXPECT_THAT(findDiagnostic("no message"),
                HasSubstr("world: has a service that answers bytes which are no message"));
    const std::string whole = recording("scene");
    EXPECT_THAT(findDiagnostic(whole.substr(0, whole.size() - 1)), HasSubstr("bytes which are no message Scene"));
    wire::Scene message;
    for (int i = 0; i < 100'001; ++i) message.add_model();
    EXPECT_THAT(findDiagnostic(message.SerializeAsString()), HasSubstr("more than 100000 models, links and visuals"));
}

PoseMessage getPoses(const std::vector<std::string>& names) {
    PoseMessage message;
    for (const std::string& name : names) message.entities.push_back({name, {}});
    return message;
}

TEST(WorldWatchTest, ReportsEntitiesThatAppearOrDisappearOnce) {
    WorldWatch watch(std::set<std::string>{"rov", "link", "buoy"});
    WorldWatch::Change change = watch.take(getPoses({"rov", "link", "buoy", "crate"}));
    EXPECT_THAT(change.came, ElementsAre("crate")) << "it came before the first message";
    EXPECT_THAT(change.went, IsEmpty());
    EXPECT_TRUE(watch.take(getPoses({"rov", "link", "buoy", "crate"})).isEmpty());
    change = watch.take(getPoses({"rov", "link", "crate"}));
    EXPECT_THAT(change.went, ElementsAre("buoy"));
    EXPECT_TRUE(watch.take(getPoses({"rov", "link"})).isEmpty()) << "the scene does not show the crate";
    EXPECT_TRUE(watch.take(getPoses({"rov", "link", "buoy", "crate"})).isEmpty());
}

TEST(WorldWatchTest, ComparesWithTheFirstMessageWithoutASceneOfGazebo) {
    WorldWatch watch({});
    EXPECT_TRUE(watch.take(getPoses({"rov", "link"})).isEmpty());
    EXPECT_THAT(watch.take(getPoses({"rov", "link", "crate"})).came, ElementsAre("crate"));
}

TEST(WorldWatchTest, RemembersABoundedNumberOfNames) {
    WorldWatch watch(std::set<std::string>{"rov"});
    for (size_t i = 0; i < 10 * WorldWatch::max_reported; ++i) {
        const std::string bubble = "bubble_" + std::to_string(i);
        ASSERT_THAT(watch.take(getPoses({"rov", bubble})).came, ElementsAre(bubble));
        ASSERT_LE(watch.remembered(), WorldWatch::max_reported + 2);
    }
}

}  // namespace
}  // namespace insonify::gazebo
