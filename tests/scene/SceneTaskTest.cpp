#include <gmock/gmock.h>

#include "tests/scene/SceneTaskFiles.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::scene {
namespace {

struct SceneTaskTest : SceneTaskFiles {
    SceneTaskTest()
        : SceneTaskFiles(R"("scenes":[{"nodes":[0,2]}],
            "nodes":[{"mesh":0,"name":"boat","translation":[1,2,3],"scale":[2,2,2],"children":[1]},
                     {"mesh":0,"name":"mast","translation":[0,5,0]},{"mesh":0,"name":"quay"}],
            "materials":[{"name":"wood"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)" +
                         triangle()) {}

    test::Writer<types::Pose> boat_{"boat"}, mast_{"mast"};
};

glm::dquat turn(double deg, glm::dvec3 axis) { return glm::angleAxis(types::radians(deg), axis); }

void expectAt(glm::dvec3 a, glm::dvec3 b) { EXPECT_LT(glm::distance(a, b), 1e-9) << a.x << " " << a.y << " " << a.z; }

glm::dvec3 getPlace(const types::MovedObject& moved) { return glm::dvec3(moved.world_from_object[3]); }

TEST_F(SceneTaskTest, EachPoseGivesASnapshotOfItsTimeAndTheSharedGeometry) {
    config_.water_surface = 1.5;
    start();
    const auto first = ping(at(2, {1, 2, 3}));
    const auto second = ping(at(3, {1, 2, 3}));
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->time, types::Time::fromSeconds(2));
    EXPECT_EQ(second->sonar.time, types::Time::fromSeconds(3));
    EXPECT_EQ(first->geometry, second->geometry);
    EXPECT_EQ(first->geometry->objects.size(), 3u);
    EXPECT_EQ(first->water_surface, 1.5);
    EXPECT_TRUE(first->moved.empty());
}

TEST_F(SceneTaskTest, ASonarAboveTheWaterSurfaceIsReportedOnce) {
    std::vector<std::string> reported;
    task_.environment().warn = [&](const std::string& text) { reported.push_back(text); };
    config_.water_surface = 1.5;
    start();
    for (const double seconds : {1, 2}) ASSERT_TRUE(ping(at(seconds, {0, 0, 2})));
    EXPECT_THAT(reported, testing::ElementsAre("scene: scene.pose: the sonar is 0.5 m above the water surface (z is "
                                               "up: depths are negative)"));
}

TEST_F(SceneTaskTest, TheMountPlacesTheSonar) {
    config_.mount = {.position = {1, 0, -0.5}, .roll_deg = 0, .pitch_deg = 90, .yaw_deg = 0};
    start();
    const auto snapshot = ping(at(1, {10, 20, 30}, turn(90, {0, 0, 1})));
    ASSERT_TRUE(snapshot);
    expectAt(snapshot->sonar.position, {10, 21, 29.5});
    expectAt(snapshot->sonar.orientation * glm::dvec3(1, 0, 0), {0, 0, -1});  // positive pitch looks down
    expectAt(snapshot->sonar.orientation * glm::dvec3(0, 1, 0), {-1, 0, 0});
}

TEST_F(SceneTaskTest, TheMountTurnsByRollThenPitchThenYaw) {
    const Mount mount{.position = {}, .roll_deg = 10, .pitch_deg = 20, .yaw_deg = 30};
    const glm::dvec3 v{1, 2, 3};
    expectAt(mount.orientation() * v, turn(30, {0, 0, 1}) * (turn(20, {0, 1, 0}) * (turn(10, {1, 0, 0}) * v)));
    expectAt(Mount{.position = {}, .yaw_deg = 90}.orientation() * glm::dvec3(1, 0, 0), {0, 1, 0});  // to port
}

TEST_F(SceneTaskTest, AQuaternionThatIsNotOfUnitLengthIsNormalised) {
    config_.mount.position = {100, 0, 0};
    start();
    expectAt(ping(at(1, {0, 0, 0}, {1.001, 0, 0, 0}))->sonar.position, {100, 0, 0});
}

TEST_F(SceneTaskTest, ANodeFollowsItsPortWithItsScaleAndSubtree) {
    task_.config.set(config_);
    auto* port = task_.makeInput("boat.pose", boat_.port);
    ASSERT_NE(port, nullptr);
    EXPECT_EQ(port->need(), framework::Need::Optional);
    ASSERT_TRUE(boat_.port.connectTo(*port, {}));
    start();
    const auto before = ping(at(1, {0, 0, 0}));  // its first pose
    EXPECT_TRUE(before->moved.empty());
    ASSERT_TRUE(before->movable) << "sonars know what may move";
    EXPECT_EQ(*before->movable, (std::vector<uint32_t>{0, 1}));
    boat_.port.write(at(1.5, {100, 0, 0}, turn(90, {0, 0, 1})));
    const auto snapshot = ping(at(2, {0, 0, 0}));
    ASSERT_EQ(snapshot->moved.size(), 2u);
    const types::MovedObject& hull = snapshot->moved[0];
    EXPECT_EQ(snapshot->geometry->objects[hull.object].name, "boat");
    expectAt(getPlace(hull), {100, 0, 0});
    // x of the model is x of the body, which looks along y of the world now; scale 2
    expectAt(glm::dvec3(hull.world_from_object * glm::dvec4(1, 0, 0, 1)), {100, 2, 0});
    expectAt(getPlace(snapshot->moved[1]), {100, 0, 10});
}

TEST_F(SceneTaskTest, TheInnermostNodeWithAPoseDecides) {
    task_.config.set(config_);
    mast_.port.connectTo(*task_.makeInput("mast.pose", mast_.port), {});
    boat_.port.connectTo(*task_.makeInput("boat.pose", boat_.port), {});
    start();
    mast_.port.write(at(1, {7, 7, 7}));
    boat_.port.write(at(1, {100, 0, 0}));
    const auto snapshot = ping(at(2, {0, 0, 0}));
    ASSERT_EQ(snapshot->moved.size(), 2u);
    expectAt(getPlace(snapshot->moved[0]), {100, 0, 0});
    expectAt(getPlace(snapshot->moved[1]), {7, 7, 7});
}

TEST_F(SceneTaskTest, OnlyNodesOfTheFileHaveAPort) {
    task_.config.set(config_);
    EXPECT_EQ(task_.makeInput("submarine.pose", boat_.port), nullptr);
    EXPECT_EQ(task_.makeInput("boat", boat_.port), nullptr);
    EXPECT_NE(task_.makeInput("quay.pose", boat_.port), nullptr);
}

TEST_F(SceneTaskTest, ANodesPoseDoesNotTrigger) {
    task_.config.set(config_);
    auto* port = task_.makeInput("boat.pose", boat_.port);
    start();
    EXPECT_FALSE(port->triggers());
    EXPECT_TRUE(task_.pose.triggers());
}

TEST_F(SceneTaskTest, AnUnusablePoseIsAnErrorUntilTheNextGoodOne) {
    start();
    const double nan = types::Pose::unknown;
    for (const types::Pose& bad :
         {at(1, {nan, 0, 0}), at(1, {0, 0, 0}, {0, 0, 0, 0}), at(1, {0, 0, 0}, {nan, 0, 0, 0})}) {
        EXPECT_EQ(ping(bad), nullptr);
        EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
        EXPECT_NE(task_.lastError().find("scene.pose: pose dropped"), std::string::npos);
        EXPECT_NE(ping(at(2, {0, 0, 0})), nullptr);
        EXPECT_EQ(task_.state(), framework::TaskState::Running);
    }
}

TEST_F(SceneTaskTest, AnUnusablePoseOfANodeLeavesItWhereItWas) {
    task_.config.set(config_);
    boat_.port.connectTo(*task_.makeInput("boat.pose", boat_.port), {});
    start();
    boat_.port.write(at(1, {5, 0, 0}));
    ping(at(1, {0, 0, 0}));
    boat_.port.write(at(2, {types::Pose::unknown, 0, 0}));
    const auto snapshot = ping(at(2, {0, 0, 0}));
    ASSERT_TRUE(snapshot);
    expectAt(getPlace(snapshot->moved.at(0)), {5, 0, 0});
    EXPECT_EQ(task_.state(), framework::TaskState::RunTimeError);
}

TEST_F(SceneTaskTest, AnUnusedSnapshotIsUsedAgain) {
    start();
    auto first = ping(at(1, {0, 0, 0}));
    const types::Snapshot* address = first.get();
    first.reset();
    ping(at(2, {0, 0, 0}));  // the port still holds the first as its last
    EXPECT_EQ(ping(at(3, {0, 0, 0})).get(), address);
}

TEST_F(SceneTaskTest, ReportsAWrongTableOfAMaterial) {
    config_.materials["wood"].table = "none.csv";
    task_.config.set(config_);
    types::Diagnostics diagnostics;
    task_.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].path, "materials.wood.table");
    EXPECT_NE(diagnostics[0].message.find("none.csv"), std::string::npos) << diagnostics[0].message;
    config_.materials["wood"].table = write("wood.csv", "grazing_deg,strength_db\n0,-40\n90,-10\n").string();
    start();
    EXPECT_EQ(ping(at(1, {0, 0, 0}))->geometry->materials.at(0).measured.size(), 2u);
}

TEST_F(SceneTaskTest, MaterialsOfThePropertiesOverrideThoseOfTheFile) {
    config_.materials["wood"].lambert_db = -5;
    start();
    EXPECT_FLOAT_EQ(ping(at(1, {0, 0, 0}))->geometry->materials.at(0).lambert_db, -5);
}

TEST_F(SceneTaskTest, AMaterialWithoutAcousticsTakesTheMatterOfItsNameUnlessDisabled) {
    start();
    EXPECT_EQ(ping(at(1, {0, 0, 0}))->geometry->materials.at(0).matter, "wood");
    const auto by_name = testing::Contains(testing::HasSubstr("taken by their names: \"wood\" as wood"));
    EXPECT_THAT(task_.notices(), by_name);
    task_.stop();
    task_.cleanup();
    config_.materials_by_name = false;
    start();
    EXPECT_FALSE(ping(at(2, {0, 0, 0}))->geometry->materials.at(0).has_acoustics);
    EXPECT_THAT(task_.notices(), testing::Not(by_name));
    task_.stop();
    task_.cleanup();
    config_.materials_by_name = true;
    config_.materials["wood"].reflectivity = 0.5;
    start();
    EXPECT_EQ(ping(at(3, {0, 0, 0}))->geometry->materials.at(0).matter, "") << "it has acoustic values";
}

TEST_F(SceneTaskTest, ReportsAMissingFileWithoutConfiguring) {
    config_.file = (folder_ / "nowhere.glb").string();
    config_.materials["wood"];
    task_.config.set(config_);
    types::Diagnostics diagnostics;
    task_.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].path, "file");
    EXPECT_NE(diagnostics[0].message.find("does not exist"), std::string::npos);
    EXPECT_FALSE(task_.configure());
    ASSERT_NE(task_.configError(), nullptr);
    EXPECT_NE(task_.makeInput("boat.pose", boat_.port), nullptr);  // the file is what is wrong, not the port
}

TEST_F(SceneTaskTest, ReportsAnUnknownMaterialWithoutConfiguring) {
    config_.materials["woood"];
    task_.config.set(config_);
    types::Diagnostics diagnostics;
    task_.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].path, "materials.woood");
    EXPECT_FALSE(task_.configure());
}

TEST_F(SceneTaskTest, ScalesNodesByNameAndReportsUnknownNames) {
    start();
    const auto plain = ping(at(1, {0, 0, 0}));
    task_.stop();
    task_.cleanup();
    config_.scale = {{"boat", 2.0}};
    start();
    const auto scaled = ping(at(2, {0, 0, 0}));
    bool any_larger = false;
    for (size_t i = 0; i < plain->geometry->objects.size(); ++i) {
        const double was = glm::determinant(plain->geometry->objects[i].world_from_object),
                     is = glm::determinant(scaled->geometry->objects[i].world_from_object);
        EXPECT_TRUE(is == was || std::abs(is / was - 8) < 1e-9) << is / was;
        any_larger |= is != was;
    }
    EXPECT_TRUE(any_larger);
    config_.scale = {{"bot", 2.0}};
    task_.config.set(config_);
    types::Diagnostics diagnostics;
    task_.check(diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].text(),
              "scale.bot: is no node of the scene; did you mean boat? insonify scene lists them");
}

TEST_F(SceneTaskTest, NoticesAreThoseOfTheLoader) {
    config_.file = write("empty.gltf", R"({"asset":{"version":"2.0"}})").string();
    start();
    ASSERT_EQ(task_.notices().size(), 1u);
    EXPECT_NE(task_.notices()[0].text.find("an empty sea"), std::string::npos);
}

TEST_F(SceneTaskTest, ItCanBeConfiguredAgainWithAnotherFile) {
    start();
    ASSERT_TRUE(task_.stop());
    ASSERT_TRUE(task_.cleanup());
    config_.file = write("empty.gltf", R"({"asset":{"version":"2.0"}})").string();
    start();
    EXPECT_TRUE(ping(at(1, {0, 0, 0}))->geometry->objects.empty());
}

}  // namespace
}  // namespace insonify::scene
