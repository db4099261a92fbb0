// What a target error chooses, against the truth: at most twice the target, and not far below it. The scenes are none
// that the estimate's factors were found on.
#include <gtest/gtest.h>

#include "components/sonar/BinGrid.hpp"
#include "components/sonar/Quality.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "components/study/Metrics.hpp"
#include "components/study/StudyScene.hpp"

namespace insonify::study {
namespace {

class QualityTest : public testing::TestWithParam<StudyScene> {};

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
    sonar::SonarConfig config = GetParam().config;
    config.quality.target_error = target;
    const sonar::Quality chosen = sonar::chooseQuality(config, GetParam().snapshot);
    const double error = achieved(GetParam(), chosen);
    std::printf("%d x %d predicted %.4f, error %.4f\n", chosen.rows, chosen.columns_per_beam, chosen.error, error);
    EXPECT_LE(chosen.error, target);
    EXPECT_LE(error, 2 * target) << chosen.rows << " x " << chosen.columns_per_beam;
    const bool is_coarsest = chosen == sonar::Quality();
    EXPECT_TRUE(is_coarsest || error >= target / 10) << chosen.rows << " x " << chosen.columns_per_beam;
}

INSTANTIATE_TEST_SUITE_P(Scenes, QualityTest, testing::ValuesIn(closedFormScenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace insonify::study
