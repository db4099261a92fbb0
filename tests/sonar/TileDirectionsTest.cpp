// Tables of directions, compared with the view that they are made from, for random fans and strips.
#include <gtest/gtest.h>

#include <random>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/rays/TileCells.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"

namespace insonify::sonar {

TEST(TileDirectionsTest, EachSampleOfEachTileLooksAtItsCell) {
    std::mt19937 random(3);
    const auto upTo = [&](int max) { return std::uniform_int_distribution<int>(1, max)(random); };
    for (int run = 0; run < 40; ++run) {
        SonarConfig config = test::getSonar(
            {.beams = upTo(9), .width_deg = 5.0 * upTo(20), .bins = 50, .rows = 63 + upTo(20), .columns = upTo(9)});
        config.beam_geometry = run % 2 == 0 ? BeamGeometry::Planar : BeamGeometry::Conical;
        const RenderPlan plan = makeRenderPlan(config, *test::makeScene({test::ground(-4, 200)}));
        TracedView view{makeAngularView(plan), {}};
        const int together = upTo(view.cells.beams), strip = together * view.cells.beam_columns;
        view.shape = TileShape(view.cells, plan.grid, together);
        const TileDirections directions(view, strip);
        for (int begin = 0; begin < view.cells.columns(); begin += strip) {
            const int end = std::min(begin + strip, view.cells.columns());
            for (int column = begin; column < end; column += view.shape.all.columns)
                for (int row = 0; row < view.cells.rows; row += view.shape.all.rows) {
                    const TileRays rays = directions.rays(view.cells, column, row);
                    for (int i = 0; i < tile_samples; ++i) {
                        const int x = column + view.shape.at[i].columns, y = row + view.shape.at[i].rows;
                        ASSERT_EQ(rays.active >> i & 1, x < end && y < view.cells.rows) << x << ' ' << y;
                        if (!(rays.active >> i & 1)) continue;
                        const glm::vec3 expected(view.cells.direction(x, y));
                        ASSERT_EQ(glm::vec3(rays.x[i], rays.y[i], rays.z[i]), expected) << x << ' ' << y;
                    }
                }
        }
    }
}

}  // namespace insonify::sonar
