#include "components/sonar/ways/WallSights.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {

WallSights::WallSights(const RenderPlan& plan) : plan_(plan) {
    constexpr size_t usual = 64;
    if (!plan.has(Pass::Walls)) return;
    for (const WallLaw& wall : plan.laws.walls) are_walls_.push_back(wall.letsThrough() && !wall.fill);
    met_.reserve(usual);
}

double WallSights::passed(const Sightlines& sightlines, const glm::dvec3& from, const glm::dvec3& to, int& walls,
                          EchoTrain* train) {
    if (are_walls_.empty()) return sightlines.isOpen(from, to) ? 1 : 0;
    if (!sightlines.findWalls(from, to, are_walls_, met_)) return 0;
    double power = 1, behind = 0;
    for (const Sightlines::WallMet& met : met_) {
        if (met.range < behind) continue;  // another triangle of the same wall
        behind = met.range * (1 + same_wall) + nearest_wall;
        power *= std::sqrt(plan_.laws.walls[met.material].passedAt(met.cosine));
        if (++walls > plan_.config.max_walls || !(power >= min_passed)) return 0;
        if (train) ring(met, *train);
    }
    return power;
}

void WallSights::ring(const Sightlines::WallMet& met, EchoTrain& train) const {
    const WallLaw& wall = plan_.laws.walls[met.material];
    if (!wall.rings()) return;
    const double spacing = wall.spacing(std::sqrt(std::max(1 - met.cosine * met.cosine, 0.0)));
    train = train.then(wall.behind, spacing, plan_.grid.bin_width / 2);
    if (spacing > 0) train.moveAway(spacing - wall.thickness * met.cosine);
}

}  // namespace insonify::sonar
