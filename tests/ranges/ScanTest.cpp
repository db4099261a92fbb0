// Scans of simulated sonars begin at the range_min of the sonar or of its receiver, whatever follows the sonar.
#include <gmock/gmock.h>

#include <cmath>

#include "components/framework/Graph.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/ros/Clouds.hpp"
#include "components/ros/Pings.hpp"
#include "components/sonar/tasks/PingTask.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify {
namespace {

using test::Draw;

/** A sonar and what follows it, in front of a wall. */
struct Chain {
    sonar::SonarTask sonar{"sonar"};
    noise::NoiseTask noise{"noise"};
    receiver::ReceiverTask receiver{"receiver"};
    test::Writer<types::SnapshotPtr> in;
    test::Reader<types::SonarPtr> out;
    bool has_receiver;

    explicit Chain(bool with_receiver) : has_receiver(with_receiver) {
        in.port.connectTo(sonar.snapshot, {});
        sonar.ping.connectTo(noise.clean, {});
        noise.noisy.connectTo(has_receiver ? static_cast<framework::InputPortBase&>(receiver.intensity) : out.port, {});
        if (has_receiver) receiver.ping.connectTo(out.port, {});
    }
    void set(framework::TaskContext& task, const std::map<std::string, std::string>& values) {
        task.properties().front()->setAll(values);
        ASSERT_TRUE(task.configure() && task.start()) << task.lastError();
    }
    types::SonarPtr makePing(double wall) {
        const auto scene = test::makeScene({test::wall(static_cast<float>(wall))}, -20);
        in.port.write(std::make_shared<const types::Snapshot>(test::makeSnapshot(scene)));
        for (framework::TaskContext* task :
             {static_cast<framework::TaskContext*>(&sonar), static_cast<framework::TaskContext*>(&noise),
              static_cast<framework::TaskContext*>(&receiver)})
            if (task != &receiver || has_receiver) task->update();
        types::SonarPtr ping;
        out.port.readNew(ping);
        return ping;
    }
};

TEST(ScanTest, NoRangeIsNearerThanTheScansRangeMinAndTheWallIsThere) {
    const char* const ringing = "{duration_us: 50, ring_down: {level_db: -20, decay_db_per_m: 30}}";
    const test::Seeds seeds(40);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        Draw draw(seed);
        const double near = draw.between(0.05, 6), blanked = draw.between(0.05, 6), range = draw.between(12, 40);
        Chain chain(draw.once(2));
        const int bins = 30 + draw.upTo(300);
        SCOPED_TRACE(
            fmt::format("seed {}: {} bins to {} m, range_min {}, blanking {}", seed, bins, range, near, blanked));
        chain.set(chain.sonar, {{"range", fmt::format("{}", range)},
                                {"bin_count", fmt::format("{}", bins)},
                                {"range_min", fmt::format("{}", near)},
                                {"range_rounding", draw.once(2) ? "exact" : "sample"},
                                {"beam_count", "5"},
                                {"field_of_view_deg", "20"},
                                {"beam_height_deg", "3"},
                                {"frequency_khz", "300"},
                                {"visibility", "cpu"},
                                {"quality", "{rows: 16, columns_per_beam: 16}"},
                                {"pulse", chain.has_receiver ? "{duration_us: 50}" : ringing}});
        chain.set(chain.noise, {{"speckle", "{law: gamma, looks: 50}"}});
        if (chain.has_receiver)
            chain.set(chain.receiver,
                      {{"blanking", fmt::format("{{range_min: {}}}", blanked)}, {"tvg", "{log_coefficient: 20}"}});
        ros::SonarOptions options;
        options.returns = framework::upstreamReturnRules(chain.out.port, types::left_receiver);
        const double least = chain.has_receiver ? std::max(near, blanked) : near;
        EXPECT_EQ(options.returns.range_min, least);
        for (int i = 0; i < 3; ++i) {
            const double heard = std::max(least + 2 * range / bins, 1.5);  // above the ring-down
            const double wall = i == 0   ? draw.between(0.2, 0.95) * least
                                : i == 1 ? draw.between(1.001 * least, least + range / bins)  // in the first bin
                                         : draw.between(heard, 11);
            const types::SonarPtr ping = chain.makePing(wall);
            ASSERT_TRUE(ping);
            ros::LaserScan scan;
            convert(*ping, options, scan);
            EXPECT_NEAR(scan.range_min, least, 1e-6);
            ASSERT_EQ(scan.ranges.size(), 5u);
            for (const float got : scan.ranges) {
                if (std::isfinite(got)) {
                    EXPECT_GE(got, scan.range_min) << "wall at " << wall;
                }
                if (i == 2) {
                    EXPECT_NEAR(got, wall, 1.5 * ping->binWidth() + 0.02 * wall) << "wall";
                } else if (i == 0 && wall < least - 2 * ping->binWidth()) {
                    EXPECT_FALSE(std::isfinite(got)) << "wall at " << wall << " is nearer than " << least;
                }
            }
        }
    }
}

/** A device finds a return in the bin that its range_min divides at the bin's middle. */
TEST(ScanTest, ARangeMessageIsNoNearerThanItsMinRange) {
    for (const double found : {0.93, 1.0, 1.2}) {
        types::Range range;
        range.range = found;
        range.range_min = 1;
        range.range_max = 50;
        ros::Range message;
        ros::convert(range, "sonar", message);
        EXPECT_EQ(message.range, static_cast<float>(std::max(found, 1.0)));
    }
}

}  // namespace
}  // namespace insonify
