// First returns, compared with closed forms.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "components/framework/execution/Activity.hpp"
#include "components/sonar/rays/SceneTrees.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "tests/support/Hills.hpp"
#include "tests/support/TaskBench.hpp"

namespace insonify::sonar {
namespace {

using test::ground;
using test::makeScene;

constexpr double bin = 0.03;  // 20 us at 1500 m/s [m]

struct AltimeterTaskTest : test::TaskBench<AltimeterTask, types::SnapshotPtr, types::Range> {
    AltimeterTaskTest() : TaskBench(&AltimeterTask::snapshot, &AltimeterTask::range) {}
    void startWide(double opening_deg) {
        AltimeterConfig config;
        config.sonar.range = 30;
        config.sonar.bin_count = 1000;
        config.sonar.beam_width_deg = config.sonar.beam_height_deg = opening_deg;
        config.sonar.quality.rows = config.sonar.quality.columns_per_beam = 128;
        task_.stop();
        task_.cleanup();
        startWith(config);
    }
    /** Returns the range at a height above a bottom, with the vehicle pitched and rolled [deg]. */
    types::Range rangeAt(double height, double pitch = 0, double roll = 0) {
        types::Snapshot snapshot =
            test::makeSnapshot(makeScene({ground(0)}), {0, 0, height}, 0, types::radians(pitch), types::radians(roll));
        snapshot.sonar.orientation *= glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
        return answerTo(std::make_shared<types::Snapshot>(snapshot));
    }
};

TEST_F(AltimeterTaskTest, MeasuresTheHeightOverAFlatBottom) {
    for (const double opening : {2.0, 25.0, 120.0}) {
        startWide(opening);
        for (const double height : {1.0, 7.777, 12.34, 28.0})
            EXPECT_NEAR(rangeAt(height).range, height, bin) << opening << " deg";
    }
}

/** `range_min` divides a bin, in which the bottom lies behind it. */
TEST_F(AltimeterTaskTest, ARangeIsNotNearerThanTheMinRange) {
    for (const double range_min : {1.201, 1.215, 1.229}) {
        AltimeterConfig config;
        config.sonar.range = 30;
        config.sonar.bin_count = 1000;
        config.sonar.range_min = range_min;
        config.sonar.beam_width_deg = config.sonar.beam_height_deg = 1;
        task_.stop();
        task_.cleanup();
        startWith(config);
        for (const double height : {range_min + 1e-4, 1.2299}) {
            const types::Range range = rangeAt(height);
            EXPECT_NEAR(range.range, height, bin / 2) << range_min;
            EXPECT_GE(range.range, range.range_min) << range_min;
        }
    }
}

TEST_F(AltimeterTaskTest, MeasuresTheNearestPointInTheBeamOnATiltedVehicle) {
    const auto nearest = [](double height, double tilt, double half) {
        return tilt <= half ? height : height / std::cos(types::radians(tilt - half));
    };
    for (const double opening : {10.0, 25.0, 120.0}) {
        startWide(opening);
        for (const double tilt : {3.0, 10.0, 20.0, 40.0}) {
            const double expected = nearest(10, tilt, opening / 2);
            EXPECT_NEAR(rangeAt(10, tilt).range, expected, bin) << opening << " deg, pitched by " << tilt;
            EXPECT_NEAR(rangeAt(10, 0, tilt).range, expected, bin) << opening << " deg, rolled by " << tilt;
        }
    }
    // D / cos(t) would be the slant range on the axis: wrong if the beam is wider than the tilt.
    EXPECT_GT(10 / std::cos(types::radians(40)), nearest(10, 40, 60) + 10 * bin);
}

/** The range of a plane through the foot of the axis, tilted by t, is D cos(t) if that point is in the beam. */
TEST_F(AltimeterTaskTest, MeasuresTheFootOfThePerpendicularOverASlope) {
    constexpr double height = 10;
    startWide(60);
    for (const double tilt : {5.0, 15.0, 25.0}) {
        const double t = types::radians(tilt);
        const glm::vec3 u(std::cos(t), 0, std::sin(t)), v(0, 1, 0);
        types::Snapshot snapshot =
            test::makeSnapshot(makeScene({test::quad(-500.f * u - 500.f * v, 1000.f * u, 1000.f * v)}), {0, 0, height});
        snapshot.sonar.orientation = glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
        const types::Range reported = answerTo(std::make_shared<types::Snapshot>(snapshot));
        EXPECT_NEAR(reported.range, height * std::cos(t), bin) << tilt;
    }
}

TEST_F(AltimeterTaskTest, ReportsItsMinAndMaxRangeAndTime) {
    startWide(25);
    const types::Range reported = rangeAt(10);
    EXPECT_EQ(reported.time, types::Time{1'000'000});
    EXPECT_NEAR(reported.range_max, 30, 1e-6);
    EXPECT_NEAR(reported.range_min, 0.1, 1e-9);
    EXPECT_NEAR(reported.field_of_view.deg(), 25, 1e-6);
}

TEST_F(AltimeterTaskTest, TheRangeIsUnknownWithoutAReturn) {
    startWide(25);
    EXPECT_FALSE(rangeAt(40).isKnown());
    EXPECT_TRUE(rangeAt(20).isKnown());
}

/** A floor out of reach, and a tile below the sonar that is another in each scene, as over a survey: 0.5 m away in
 * every second scene, else out of reach as well. */
std::vector<types::GeometryPtr> scenesOfTiles(size_t count) {
    std::vector<types::Mesh> meshes(1, test::hills(60));
    const auto always = makeScene(std::move(meshes), -20);
    std::vector<types::GeometryPtr> scenes;
    for (size_t i = 0; i < count; ++i) {
        auto scene = std::make_shared<types::Geometry>(*always);
        scene->meshes.push_back(ground(i % 2 == 0 ? -0.5f : -90, 4));
        scene->objects.push_back({"tile", 1, glm::dmat4(1), true});
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

struct TooNearTest : AltimeterTaskTest {
    /** Starts an altimeter whose range begins at `range_min` and reaches no floor. */
    void startWith(double range_min, Visibility visibility = Visibility::Cpu) {
        AltimeterConfig config;
        config.sonar.range = 15;
        config.sonar.range_min = range_min;
        config.sonar.bin_count = 100;
        config.sonar.visibility = visibility;
        if (visibility == Visibility::Gl) config.sonar.device = "software";
        task_.stop();
        task_.cleanup();
        AltimeterTaskTest::startWith(config);
    }
    bool isTooNear(const types::GeometryPtr& scene) {
        types::Snapshot snapshot = test::makeSnapshot(scene);
        snapshot.sonar.orientation = glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
        return answerTo(std::make_shared<types::Snapshot>(snapshot)).range == types::Range::too_near;
    }
};

/** Next to pictures nobody else has the trees of its rays. */
TEST_F(TooNearTest, TheSearchKeepsTheTreesOfWhatStaysInTheScene) {
    const std::vector<types::GeometryPtr> scenes = scenesOfTiles(10);
    startWith(1, Visibility::Gl);
    size_t before = 0, after = 0;
    task_.activity().call([&] { before = StillTree::builtByThisThread(); });
    for (size_t i = 0; i < scenes.size(); ++i) EXPECT_EQ(isTooNear(scenes[i]), i % 2 == 0) << i;
    task_.activity().call([&] { after = StillTree::builtByThisThread(); });
    EXPECT_EQ(after - before, 1u);
}

/** The search is a second ping, of few samples: pings without a return take at most three times as long with it, also
 *  where each has another geometry. */
TEST_F(TooNearTest, TheSearchCostsLittle) {
    const std::vector<types::GeometryPtr> scenes = scenesOfTiles(40);
    const auto secondsWith = [&](double range_min) {
        startWith(range_min);
        for (size_t i = 0; i < 4; ++i) isTooNear(scenes[i]);
        double seconds = 0;
        task_.activity().call([&] {  // whose thread renders
            seconds = test::processorSeconds([&] {
                for (size_t i = 4; i < scenes.size(); ++i) isTooNear(scenes[i]);
            });
        });
        return seconds;
    };
    double without = secondsWith(0), with = secondsWith(1);
    for (int again = 0; again < 4; ++again) {
        without = std::min(without, secondsWith(0));
        with = std::min(with, secondsWith(1));
    }
    RecordProperty("ratio", std::to_string(with / without));
    EXPECT_LT(with, 3 * without) << 1e3 * with / 36 << " and " << 1e3 * without / 36 << " ms per ping";
}

}  // namespace
}  // namespace insonify::sonar
