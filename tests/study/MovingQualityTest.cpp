// Runs of a moving sonar that chooses its quality, each ping compared with a much finer ping of the same snapshot.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/renderer/Metrics.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/sonar/tasks/ScanningSonarTask.hpp"
#include "components/study/StudyScene.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using sonar::compare, sonar::Layout, sonar::Metrics;

using types::radians;

constexpr double target = 0.05;  ///< Default.

/** Results of a run. */
struct RecordedPings {
    std::vector<types::SonarPtr> pings;
    types::Notices notices;
    types::Plan plan;
};

template <class Task, class Config>
RecordedPings getRun(const Config& config, const std::vector<types::Snapshot>& snapshots) {
    Task task("sonar");
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> out;
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(1));
    task.ping.connectTo(out.port, framework::ConnPolicy::buffer(1));
    task.config.set(config);
    if (!task.configure() || !task.start()) throw std::runtime_error(task.lastError());
    RecordedPings run;
    for (const types::Snapshot& snapshot : snapshots) {
        in.port.write(std::make_shared<types::Snapshot>(snapshot));
        task.update();
        out.port.readNew(run.pings.emplace_back());
    }
    run.notices = task.notices();
    run.plan = *task.plan();
    return run;
}

/** Returns rel_l2_tvg of each ping; a turning head is at its ping's bearing. */
std::vector<double> movingErrors(sonar::SonarConfig config, const std::vector<types::Snapshot>& snapshots,
                                 const RecordedPings& run, int columns_per_beam) {
    config.quality = {};
    config.quality.rows = 2048;
    config.quality.columns_per_beam = columns_per_beam;
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const Layout layout{config.beams(), grid.bin_count, grid.bin_width, 0};
    sonar::SonarRenderer renderer(config, snapshots.front().geometry);
    std::vector<double> errors;
    types::Sonar finer;
    for (size_t i = 0; i < snapshots.size(); ++i) {
        types::Snapshot scene = snapshots[i];
        if (config.beams() == 1)
            scene.sonar.orientation *= glm::angleAxis(run.pings[i]->bearings[0].rad, glm::dvec3(0, 0, 1));
        renderer.render(scene, finer);
        const std::vector<double> truth(finer.bins.begin(), finer.bins.end());
        errors.push_back(compare(run.pings[i]->bins, truth, layout).rel_l2_tvg);
    }
    return errors;
}

/** Returns the 95th percentile. */
double nearlyAll(std::vector<double> errors) {
    std::ranges::sort(errors);
    return errors[errors.size() * 95 / 100];
}

std::string summary(const RecordedPings& run, const std::vector<double>& errors) {
    std::string text =
        "now " + std::to_string(run.plan.rows) + " x " + std::to_string(run.plan.columns_per_beam) + "\n";
    for (const std::string& notice : types::lines(run.notices)) text += notice + "\n";
    for (const double error : errors) text += std::to_string(error) + " ";
    return text;
}

sonar::SonarConfig movingFan() {
    sonar::SonarConfig config;
    config.range = 30;
    config.bin_count = 200;
    config.beam_count = 20;
    config.field_of_view_deg = 40;
    config.range_rounding = sonar::RangeRounding::Exact;
    config.device = "software";
    return config;
}

std::vector<types::Snapshot> makeSnapshots(const types::GeometryPtr& scene, int count, auto poseAt) {
    std::vector<types::Snapshot> snapshots;
    for (int i = 0; i < count; ++i) {
        const auto [position, yaw] = poseAt(i);
        snapshots.push_back(test::makeSnapshot(scene, position, yaw, radians(8)));
        snapshots.back().time = types::Time::fromSeconds(1 + 0.1 * i);
    }
    return snapshots;
}

struct Place {
    glm::dvec3 position;
    double yaw;
};

/** Returns a floor of small stones, 3 m below (0, 0, 0). */
types::Mesh stones(double side, double rms, uint64_t seed) {
    return getMesh(
        FractalFloor{.points = 256, .side = side, .slope = -1.7, .rms = rms, .centre_x = 0, .depth = 3, .seed = seed});
}

/** Returns snapshots that face a wall 4 m away, and then turn to the open floor by 4 deg per ping. */
std::vector<types::Snapshot> turnFromAWall(unsigned seed) {
    const auto scene = test::makeScene({stones(80, 0.3, seed), test::wall(-4)});
    return makeSnapshots(scene, 100, [](int i) {
        return Place{glm::dvec3(0), radians(180 - 4 * std::clamp(i - 20, 0, 45))};
    });
}

TEST(MovingQualityTest, AFanThatTurnsFromAWallToARoughFloorMeetsItsTarget) {
    const auto snapshots = turnFromAWall(3);
    const RecordedPings run = getRun<sonar::SonarTask>(movingFan(), snapshots);
    const std::vector<double> errors = movingErrors(movingFan(), snapshots, run, 12);
    EXPECT_LE(nearlyAll(errors), 2 * target) << summary(run, errors);
}

TEST(MovingQualityTest, APassOverARoughFloorMeetsItsTarget) {
    const auto scene = test::makeScene({stones(100, 0.4, 8)});
    const auto snapshots = makeSnapshots(scene, 100, [](int i) {
        return Place{glm::dvec3(-35 + 0.4 * i, 2, 0.5 * std::sin(0.1 * i)), 0.2 * std::sin(0.05 * i)};
    });
    const RecordedPings run = getRun<sonar::SonarTask>(movingFan(), snapshots);
    const std::vector<double> errors = movingErrors(movingFan(), snapshots, run, 12);
    EXPECT_LE(nearlyAll(errors), 2 * target) << summary(run, errors);
}

/** Returns a basin of 10 x 8 x 3 m with a ball of a tire's size on its floor. */
types::GeometryPtr pool() {
    return test::makeScene(
        {test::quad({-5, -4, -2}, {10, 0, 0}, {0, 8, 0}), test::quad({-5, -4, -2}, {10, 0, 0}, {0, 0, 3}),
         test::quad({-5, 4, -2}, {10, 0, 0}, {0, 0, 3}), test::quad({-5, -4, -2}, {0, 8, 0}, {0, 0, 3}),
         test::quad({5, -4, -2}, {0, 8, 0}, {0, 0, 3}), test::sphere(0.3, 32)},
        0, {{}, {}, {}, {}, {}, {3, -1, -1.7}});
}

TEST(MovingQualityTest, AScanningHeadInAPoolMeetsItsTarget) {
    sonar::ScanningSonarConfig config;
    config.sonar.range = 12;
    config.sonar.bin_count = 400;
    config.sonar.beam_width_deg = 2;
    config.sonar.beam_height_deg = 25;
    config.sonar.range_rounding = sonar::RangeRounding::Exact;
    config.sonar.device = "software";
    const auto snapshots = makeSnapshots(pool(), 400, [](int i) {
        return Place{glm::dvec3(-1 + 0.002 * i, 0.5, -0.8), 0.3};
    });
    const RecordedPings run = getRun<sonar::ScanningSonarTask>(config, snapshots);
    const std::vector<double> errors = movingErrors(config.beam(), snapshots, run, 64);
    EXPECT_LE(nearlyAll(errors), 2 * target) << summary(run, errors);
}

}  // namespace
}  // namespace insonify::study
