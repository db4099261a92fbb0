// Warnings of a sonar's task about empty pings, and their frequency.
#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "components/scene/Clusters.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/sonar/WallScene.hpp"
#include "tests/support/Deformed.hpp"
#include "tests/support/Hills.hpp"
#include "tests/support/Ports.hpp"
#include "types/geometry/Extent.hpp"

namespace insonify::sonar {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct PingDiagnosticsTest : testing::Test {
    PingDiagnosticsTest() {
        const auto environment = std::make_shared<framework::Environment>();
        environment->warn = [this](const std::string& text) { reported_.push_back(text); };
        task_.setEnvironment(environment);
        in_.port.connectTo(task_.snapshot, framework::ConnPolicy::buffer(4));
        SonarConfig config = smallSonar();
        config.device.clear();
        config.visibility = Visibility::Cpu;
        task_.config.set(config);
        EXPECT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    /** Renders a number of pings of a scene, with the sonar rotated by `yaw_deg`. */
    void ping(const types::GeometryPtr& geometry, double yaw_deg, int count,
              const std::vector<types::PointTarget>& targets = {}) {
        types::Snapshot snapshot = test::makeSnapshot(geometry, {}, types::radians(yaw_deg));
        snapshot.targets = targets;
        ping(snapshot, count);
    }
    void ping(types::Snapshot snapshot, int count) {
        for (int i = 0; i < count; ++i) {
            snapshot.time = types::Time::fromSeconds(++pings_);
            in_.port.write(std::make_shared<const types::Snapshot>(snapshot));
            task_.update();
        }
    }

    SonarTask task_{"sonar"};
    test::Writer<types::SnapshotPtr> in_;
    std::vector<std::string> reported_;
    int pings_ = 0;
};

TEST_F(PingDiagnosticsTest, WarnsOnceAboutSilenceAndAgainAfterEnoughEchoes) {
    const auto wall = wallAt(5);
    ping(wall, 0, 2);
    EXPECT_THAT(reported_, IsEmpty());
    ping(wall, 180, 5);
    EXPECT_THAT(reported_, ElementsAre(HasSubstr("sonar: receives no echo")));
    ping(wall, 0, 3);
    ping(wall, 180, 5);
    EXPECT_EQ(reported_.size(), 1u) << "only three pings with echoes";
    ping(wall, 0, types::RecurringDiagnostic::well_after);
    ping(wall, 180, 5);
    EXPECT_EQ(reported_.size(), 2u);
}

TEST_F(PingDiagnosticsTest, ATargetAloneIsAnEcho) {
    ping(wallAt(-50), 0, 3, {{{5, 0, 0}, 0}});
    EXPECT_THAT(reported_, IsEmpty());
    ping(wallAt(-50), 0, 1, {{{-5, 0, 0}, 0}});
    EXPECT_THAT(reported_, ElementsAre(HasSubstr("; its nearest target 5 m away at [-5, 0, 0]")));
}

TEST_F(PingDiagnosticsTest, WarnsAboutASonarInsideAMeshInsteadOfSilence) {
    const auto hull = test::makeScene({test::sphere(0.05f, 12)});  // nearer than range_min
    ping(hull, 0, 40);
    EXPECT_THAT(reported_,
                ElementsAre(HasSubstr("is inside of object_0, which has its faces outward: the sonar is at [0, 0, "
                                      "0], its nearest surface 0.04")));
}

TEST_F(PingDiagnosticsTest, FindsMeshesThatDeformWhereTheyArePosed) {
    types::Snapshot scene = test::makeSnapshot(test::makeScene({test::jointed(test::sphere(0.5f, 12))}));
    test::pose(scene, 0, glm::translate(glm::dmat4(1), {0, 7, 0}));
    ping(scene, 40);  // at rest it would be around the sonar
    EXPECT_THAT(reported_,
                ElementsAre(HasSubstr("the scene extends from [-0.5, 6.5, -0.5] to [0.5, 7.5, 0.5], its nearest "
                                      "point 6.5")));
    reported_.clear();
    scene.joints[0].mesh_from_bind = glm::dmat4x3(1);
    ping(scene, 40);
    EXPECT_THAT(reported_, ElementsAre(HasSubstr("is inside of object_0")));
}

/** The nearest point and the extent of a scene, as the text of a silent sonar needs them on the thread of its pings. */
void describeScene(const types::Snapshot& scene, types::NearestPoint& nearest, types::Extent& extent) {
    nearest = types::nearestPoint(scene, scene.sonar.position);
    extent = types::getExtent(scene);
}

TEST(LargeSceneTest, ASilentSonarLooksAtAShareOfTheTriangles) {
    types::Mesh whole = test::hills(500), parts = whole;
    scene::buildClusters(parts);
    ASSERT_GT(parts.clusters.size(), 1000u);
    whole = parts;
    whole.clusters.clear(), whole.cluster_nodes.clear();  // so that every triangle is looked at
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    double by_parts = 0, by_all = 0;
    for (int trial = 0; trial < 12; ++trial) {
        const glm::dvec3 at = 700.0 * glm::dvec3(any(random), any(random), 0.1 * any(random));
        types::Snapshot scene =
            test::makeSnapshot(test::makeScene({parts, test::sphere(3, 20)}, 0, {{}, {1, 2, 3}}), at);
        types::Snapshot all = test::makeSnapshot(test::makeScene({whole, test::sphere(3, 20)}, 0, {{}, {1, 2, 3}}), at);
        glm::dmat4 place(1);
        if (trial % 3 != 0) place = glm::rotate(place, any(random), glm::dvec3(any(random), any(random), 1));
        if (trial % 3 == 2) place = glm::scale(place, glm::dvec3(1, -0.5, 2));
        place[3] = glm::dvec4(trial % 2 == 0 ? glm::dvec3(0) : glm::dvec3(463'000, 5'937'000, 0), 1);
        scene.moved = all.moved = {{0, place}};
        scene.sonar.position = all.sonar.position = at + glm::dvec3(place[3]);
        types::NearestPoint nearest, expected;
        types::Extent extent, expected_extent;
        by_parts += test::processorSeconds([&] { describeScene(scene, nearest, extent); });
        by_all += test::processorSeconds([&] { describeScene(all, expected, expected_extent); });
        EXPECT_EQ(nearest.distance, expected.distance) << trial;
        EXPECT_EQ(nearest.point, expected.point) << trial;
        EXPECT_EQ(nearest.object, expected.object) << trial;
        EXPECT_EQ(extent.low, expected_extent.low) << trial;
        EXPECT_EQ(extent.high, expected_extent.high) << trial;
    }
    RecordProperty("share", std::to_string(by_parts / by_all));
    EXPECT_LT(by_parts, by_all / 10) << 1e3 * by_parts << " and " << 1e3 * by_all << " ms";
}

}  // namespace
}  // namespace insonify::sonar
