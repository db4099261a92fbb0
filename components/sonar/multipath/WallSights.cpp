#include "components/sonar/multipath/WallSights.hpp"

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
                          WallArrivals& arrivals) {
    if (are_walls_.empty()) return sightlines.isOpen(from, to) ? 1 : 0;
    if (!sightlines.findWalls(from, to, are_walls_, met_)) return 0;
    double once = 1, both = 1, behind = 0;
    for (const Sightlines::WallMet& met : met_) {
        if (met.range < behind) continue;  // another triangle of the same wall
        behind = met.range * (1 + same_wall) + nearest_wall;
        once *= pass(met, arrivals);
        both *= plan_.laws.walls[met.material].exactly(met.cosine);
        if (++walls > plan_.config.max_walls || !(both >= min_passed * min_passed)) return 0;
    }
    arrivals.ringing *= both / (once * once);
    return once;
}

double WallSights::pass(const Sightlines::WallMet& met, WallArrivals& arrivals) const {
    const WallLaw& wall = plan_.laws.walls[met.material];
    const double sine = std::sqrt(std::max(1 - met.cosine * met.cosine, 0.0)), resolution = plan_.grid.bin_width / 2;
    if (wall.rings()) {
        arrivals.both = arrivals.both.then(wall.behind, wall.spacing(sine), resolution);
        arrivals.both.moveAway(wall.delay(sine));
    }
    arrivals.once.passOnce(wall, sine, resolution);
    return wall.exactly_once(met.cosine);
}

}  // namespace insonify::sonar
