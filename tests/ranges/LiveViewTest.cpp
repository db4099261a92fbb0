// The live view shows an echo at its range, for bins of any duration, merged or not, and for fans of any angles.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/viewer/Messages.hpp"
#include "components/viewer/PingPicture.hpp"
#include "tests/support/Draw.hpp"
#include "tests/support/Scenes.hpp"

namespace insonify::viewer {
namespace {

TEST(LiveViewTest, AWallIsWithinOneShownBinOfItsRangeAndInItsBeam) {
    const test::Seeds seeds(40);
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
        test::Draw draw(seed);
        sonar::SonarConfig config;
        config.range = std::pow(10, draw.between(-0.3, 2));
        config.range_min = 0.01 * config.range;
        config.bin_count = static_cast<int>(std::min(std::pow(10, draw.between(1.7, 4)), config.range / 1.5e-4));
        config.speed_of_sound = draw.between(1400, 1600);
        config.range_rounding = sonar::RangeRounding::Exact;
        config.bearings_deg = {-41, -20.5, -3, 0, 2.5, 31};
        config.beam_width_deg = 2;
        config.beam_height_deg = 2;
        config.quality.rows = config.quality.columns_per_beam = 32;
        config.visibility = sonar::Visibility::Cpu;
        const double distance = config.range * draw.between(0.2, 0.6);
        const types::Snapshot scene = test::makeSnapshot(test::makeScene({test::wall(static_cast<float>(distance))}));
        sonar::SonarRenderer renderer(config, scene.geometry, {.threads = 1});
        types::Sonar ping;
        renderer.render(scene, ping);
        const std::string message = PingPicture(ros::BinScale::Linear).encode(ping, {});
        uint32_t head[2];
        std::memcpy(head, message.data(), sizeof head);
        const auto json = nlohmann::json::parse(message.substr(8, head[1]));
        const size_t bins = json["bins"].get<size_t>(), beams = json["beams"].get<size_t>();
        ASSERT_EQ(beams, config.bearings_deg.size());
        for (size_t beam = 0; beam < beams; ++beam) {
            const char* levels = message.data() + 8 + head[1] + beam * bins;
            size_t first = 0;
            while (first < bins && levels[first] == 0) ++first;
            ASSERT_LT(first, bins);
            const double bearing = json["bearings"][beam].get<double>(), bin = json["bin_m"].get<double>();
            EXPECT_NEAR(types::degrees(bearing), config.bearings_deg[beam], 1e-6);
            const double nearest = distance / std::cos(std::max(0.0, std::abs(bearing) - types::radians(1)));
            EXPECT_NEAR((static_cast<double>(first) + 0.5) * bin, nearest, 1.01 * bin)
                << "seed " << seed << ", beam " << beam << ", " << config.bin_count << " bins to " << config.range;
            EXPECT_GE(bin * static_cast<double>(bins), config.range * (1 - 1e-9));
        }
    }
}

}  // namespace
}  // namespace insonify::viewer
