// What `quality: {target_error: x}` chooses, against the truth: at most twice the target, and not far below it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/Quality.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "components/study/Metrics.hpp"
#include "components/study/StudyScene.hpp"

namespace insonify::study {
namespace {

class QualityTest : public testing::TestWithParam<SceneMaker> {};

double achieved(const StudyScene& scene, const sonar::Quality& quality) {
    sonar::SonarConfig config = scene.config;
    config.quality.rows = quality.rows;
    config.quality.columns_per_beam = quality.columns_per_beam;
    sonar::SonarRenderer renderer(config, scene.snapshot.geometry);
    types::Sonar ping;
    renderer.render(scene.snapshot, ping);
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    return compare(ping.bins, trueEnergies(scene),
                   {config.beam_count, grid.bin_count, grid.bin_width, scene.range_from})
        .rel_l2_tvg;
}

TEST_P(QualityTest, TheTargetIsReachedAndNotWastefully) {
    const double target = 0.02;
    const StudyScene scene = GetParam().make();
    const auto ladder =
        sonar::tryQualities(scene.config, scene.snapshot, target, std::numeric_limits<double>::infinity());
    const double error = achieved(scene, ladder.back());
    EXPECT_LE(ladder.back().error, target);
    EXPECT_LE(error, 2 * target) << ladder.back().rows << " x " << ladder.back().columns_per_beam;
    EXPECT_GE(error, target / 10) << ladder.back().rows << " x " << ladder.back().columns_per_beam;
}

INSTANTIATE_TEST_SUITE_P(Scenes, QualityTest, testing::ValuesIn(closedFormScenes()),
                         [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
}  // namespace insonify::study
