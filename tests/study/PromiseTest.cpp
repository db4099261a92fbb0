// Errors that a sonar predicts in scenes drawn at random, compared with the true error of the pings that it writes.
// scripts/error_promise does the same over worlds, harbour, tank and bathymetry.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/renderer/Metrics.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "components/study/StudyScene.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::study {
namespace {

constexpr int pings = 6;

/** A sonar and the still scene before it. */
struct Drawn {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};

class Draw {
public:
    explicit Draw(unsigned number) : number_(number), random_(number) {}

    Drawn scene() {
        sonar::SonarConfig config;
        config.range = uniform(15, 30);
        config.bin_count = static_cast<int>(uniform(80, 200));
        config.beam_count = static_cast<int>(uniform(12, 32));
        config.field_of_view_deg = uniform(30, 100);
        config.beam_height_deg = uniform(8, 40);
        config.range_rounding = sonar::RangeRounding::Exact;
        config.device = "software";
        if (uniform(0, 1) < 0.3) config.pulse.emplace().bandwidth_khz = 10;
        const double yaw = uniform(-3, 3);
        const double pitch = uniform(0.05, 0.3);
        const glm::dvec3 around(10 - 12 * std::cos(yaw), -12 * std::sin(yaw), -1);
        const glm::dvec3 within(uniform(-8, 8), uniform(-6, 6), uniform(-0.8, 0.8));
        if (number_ % 3 == 0) return {config, test::makeSnapshot(floor(), {}, yaw, pitch)};
        if (number_ % 3 == 1) return {config, test::makeSnapshot(test::surfaces(), around, yaw, 0.1)};
        return {config, test::makeSnapshot(tank(), within, yaw, pitch - 0.2)};
    }

private:
    double uniform(double from, double to) { return from + (to - from) * random_() / std::mt19937::max(); }

    types::GeometryPtr floor() {
        return test::makeScene({getMesh(FractalFloor{.points = 64 << number_ % 2,
                                                     .side = 60,
                                                     .slope = -1.7,
                                                     .rms = uniform(0.05, 0.3),
                                                     .centre_x = 0,
                                                     .depth = 3,
                                                     .seed = number_})});
    }

    /** Returns a floor between four walls, with a ball on it. */
    static types::GeometryPtr tank() {
        const glm::vec3 along(26, 0, 0), across(0, 18, 0), up(0, 0, 2.4), corner(-13, -9, -1.2);
        return test::makeScene(
            {test::quad(corner, along, across), test::quad(corner, along, up), test::quad(corner + across, along, up),
             test::quad(corner, across, up), test::quad(corner + along, across, up), test::sphere(0.3, 16)},
            0, {{}, {}, {}, {}, {}, {3, -1, -0.9}});
    }

    unsigned number_;
    std::mt19937 random_;
};

/** The pings of a task with its default quality, and its plan at the end. */
struct Written {
    std::vector<types::SonarPtr> pings;
    types::Plan plan;
};

Written written(const Drawn& drawn) {
    sonar::SonarTask task("sonar");
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> out;
    in.port.connectTo(task.snapshot, framework::ConnPolicy::buffer(1));
    task.ping.connectTo(out.port, framework::ConnPolicy::buffer(1));
    task.config.set(drawn.config);
    if (!task.configure() || !task.start()) throw std::runtime_error(task.lastError());
    Written all;
    types::Snapshot snapshot = drawn.snapshot;
    for (int i = 0; i < pings; ++i) {
        snapshot.time = types::Time::fromSeconds(1 + 0.1 * i);
        in.port.write(std::make_shared<types::Snapshot>(snapshot));
        task.update();
        out.port.readNew(all.pings.emplace_back());
    }
    all.plan = *task.plan();
    return all;
}

/** Returns rel_l2_tvg of a ping. */
double trueError(const Drawn& drawn, const types::Sonar& ping) {
    sonar::SonarConfig config = drawn.config;
    config.quality.rows = 2048;
    config.quality.columns_per_beam = 24;
    types::Sonar finer;
    sonar::SonarRenderer(config, drawn.snapshot.geometry).render(drawn.snapshot, finer);
    const std::vector<double> truth(finer.bins.begin(), finer.bins.end());
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    return sonar::compare(ping.bins, truth, {config.beams(), grid.bin_count, grid.bin_width, 0}).rel_l2_tvg;
}

TEST(PromiseTest, PingsOfStillScenesAreTheSameAndHaveAtMostTheirPredictedError) {
    int kept = 0, all = 0;
    std::string reported;
    for (unsigned number = 1; number <= 10; ++number) {
        const Drawn drawn = Draw(number).scene();
        const Written run = written(drawn);
        if (!(run.plan.predicted_error > 0)) continue;  // no echo
        for (const types::SonarPtr& ping : run.pings)
            EXPECT_EQ(ping->bins, run.pings[0]->bins) << number << ": flickers";
        const double error = trueError(drawn, *run.pings.back());
        EXPECT_LE(error, 1.5 * run.plan.predicted_error) << number;
        reported += fmt::format("{}: {} x {}, predicted {:.4f}, true {:.4f}\n", number, run.plan.rows,
                                run.plan.columns_per_beam, run.plan.predicted_error, error);
        kept += error <= run.plan.predicted_error;
        ++all;
    }
    EXPECT_GE(all, 8) << reported;
    EXPECT_GE(kept, 0.95 * all) << reported;
    std::cout << reported;
}

}  // namespace
}  // namespace insonify::study
