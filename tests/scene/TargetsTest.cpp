// Point targets of a scene: their places, the nodes they move with, and errors.
#include <gmock/gmock.h>

#include "tests/scene/SceneTaskFiles.hpp"
#include "tests/support/Refused.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/** A boat, turned by 90 degrees and twice as large, with a mast that leans; a quay. */
struct TargetsTest : SceneTaskFiles {
    TargetsTest()
        : SceneTaskFiles(R"("scenes":[{"nodes":[0,2,3]}],
            "nodes":[{"mesh":0,"name":"boat","translation":[1,2,3],"rotation":[0,0.70710678118,0,0.70710678118],
                      "scale":[2,2,2],"children":[1]},
                     {"name":"mast","translation":[0,5,0]},{"name":"quay","translation":[10,0,0]},
                     {"name":"dot","scale":[0,0,0]}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
                         triangle()) {}
    void follow(test::Writer<types::Pose>& mover, const std::string& node) {
        mover.port.connectTo(*task_.makeInput(node + ".pose", mover.port), {});
    }
    types::SnapshotPtr pingAt(double seconds) { return ping(at(seconds, {0, 0, 0})); }
    std::string diagnostic() const {
        SceneTask task("scene");
        task.config.set(config_);
        return task.configure() ? "" : task.lastError();
    }

    test::Writer<types::Pose> boat_{"boat"}, mast_{"mast"};
};

void expectClose(glm::dvec3 a, glm::dvec3 b) {
    EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

TEST_F(TargetsTest, ASnapshotHasNoTargetsByDefault) {
    start();
    EXPECT_TRUE(pingAt(1)->targets.empty());
}

TEST_F(TargetsTest, ATargetIsInTheWorldOrOnANodeWithAnOffset) {
    config_.targets = {{"buoy", glm::dvec3(4, 5, -6), "", -20},    {"keel", {}, "boat", -10},
                       {"bow", glm::dvec3(3, 0, 1), "boat", -30},  {"top", glm::dvec3(1, 0, 0), "mast", -40},
                       {"fender", glm::dvec3(0, 1, 0), "quay", 0}, {"dot", {}, "dot", 0}};
    start();
    const auto snapshot = pingAt(1);
    ASSERT_EQ(snapshot->targets.size(), 6u);
    EXPECT_EQ(snapshot->target_names->at(2), "bow");
    EXPECT_EQ(snapshot->targets[2].strength_db, -30);
    expectClose(snapshot->targets[0].position, {4, 5, -6});
    expectClose(snapshot->targets[1].position, {1, -3, 2});
    expectClose(snapshot->targets[2].position, {1, 0, 3});    // ahead is to port where a boat is turned by 90 degrees
    expectClose(snapshot->targets[3].position, {1, -2, 12});  // 10 m up, as the boat is twice as large
    expectClose(snapshot->targets[4].position, {10, 1, 0});
    expectClose(snapshot->targets[5].position, {0, 0, 0});
}

TEST_F(TargetsTest, ATargetMovesWithTheInnermostMovingNode) {
    follow(boat_, "boat");
    follow(mast_, "mast");
    config_.targets = {{"bow", glm::dvec3(3, 0, 1), "boat", 0},
                       {"top", glm::dvec3(1, 0, 0), "mast", 0},
                       {"buoy", glm::dvec3(4, 5, -6), "", 0}};
    start();
    expectClose(pingAt(1)->targets[0].position, {1, 0, 3});  // before its first pose it is at its place in the file
    boat_.port.write(at(2, {100, 0, 0}, {0, 0, 0, 1}));
    const auto moved = pingAt(2);
    expectClose(moved->targets[0].position, {97, 0, 1});
    expectClose(moved->targets[1].position, {99, 0, 10});
    expectClose(moved->targets[2].position, {4, 5, -6});
    mast_.port.write(at(3, {0, 0, 50}));
    const auto apart = pingAt(3);
    expectClose(apart->targets[0].position, {97, 0, 1});
    expectClose(apart->targets[1].position, {1, 0, 50});
}

TEST_F(TargetsTest, ReportsErrorsWithTheirPlace) {
    config_.targets = {{"buoy", glm::dvec3(0), "", 0}, {"bow", {}, "baot", 0}};
    EXPECT_THAT(diagnostic(), AllOf(HasSubstr("scene.targets[1].attached_to: is baot, which is no node of the scene"),
                                    HasSubstr("boat")));
    config_.targets = {{"on dot", glm::dvec3(1, 0, 0), "dot", 0}};
    EXPECT_THAT(diagnostic(), HasSubstr("scene.targets[0].attached_to: is dot, which is scaled to nothing"));
}

TEST_F(TargetsTest, APlaceOnTheEarthIsWhereTheDatumHasIt) {
    const types::Datum datum{54.5, 10.25, 40};
    if (!test::refused([&] { geodetic(datum, {}); }).empty()) GTEST_SKIP() << "this build has no GeographicLib";
    TargetConfig wreck;
    wreck.name = "wreck";
    wreck.strength_db = -20;
    wreck.geodetic = geodetic(datum, {300, 1200, -25});
    config_.targets = {wreck};
    config_.datum = datum;
    start();
    expectClose(pingAt(1)->targets[0].position, {1200, -300, -25});
}

TEST_F(TargetsTest, PlacesOnTheEarthThatHaveNoMeaningAreRefused) {
    const types::Datum datum{54.5, 10.25, 40};
    if (!test::refused([&] { geodetic(datum, {}); }).empty()) GTEST_SKIP() << "this build has no GeographicLib";
    TargetConfig wreck;
    wreck.name = "wreck";
    wreck.strength_db = -20;
    wreck.geodetic = datum;
    config_.targets = {wreck};
    EXPECT_THAT(diagnostic(), HasSubstr("targets[0].geodetic: needs the deployment's datum"));
    config_.datum = types::Datum{10.25, 54.5, 0};
    EXPECT_THAT(diagnostic(), AllOf(HasSubstr("km from the datum {latitude_deg: 10.25"), HasSubstr("exchanged?")));
    config_.datum = datum;
    EXPECT_EQ(diagnostic(), "");
    wreck.position = glm::dvec3(0);
    EXPECT_THAT(test::countRefusals(wreck),
                testing::ElementsAre(HasSubstr("geodetic: is given, and position as well")));
    wreck.position.reset();
    wreck.attached_to = "boat";
    EXPECT_THAT(test::countRefusals(wreck),
                testing::ElementsAre(HasSubstr("geodetic: is given, and attached_to as well")));
}

}  // namespace
}  // namespace insonify::scene
