#include "components/sonar/BentTargets.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace insonify::sonar {

BentTargets::BentTargets(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), paths_(plan, geometry), motion_(geometry, 0.1 * plan.grid.speed_of_sound) {}

void BentTargets::place(const types::Snapshot& snapshot) {
    paths_.place(snapshot);
    motion_.follow(snapshot);
    sonar_ = snapshot.sonar;
}

std::span<const TargetWay> BentTargets::wayTo(const types::PointTarget& target, size_t index) {
    constexpr int steps = 100;
    const glm::dquat sonar_from_world = glm::conjugate(sonar_.orientation);
    const glm::dvec3 place = sonar_from_world * (target.position - sonar_.position);
    Drift drift;
    drift.constant = sonar_from_world * motion_.targetVelocity(index);
    glm::dvec3 heard = place, missed(0);  // what is heard as from `heard` is `missed` away from the target
    for (int i = 0; i < steps; ++i) {
        missed = place - paths_.at(glm::normalize(heard), glm::length(heard), &drift);
        if (glm::length(missed) < 1e-6 * glm::length(place)) break;
        heard += missed;
    }
    if (!(glm::length(missed) < 0.1 * plan_.grid.bin_width)) return {};
    way_ = {};
    way_.length = glm::length(heard);
    way_.direction = heard / way_.length;
    way_.power =
        paths_.apparent(way_.direction, glm::dot(way_.direction, place), way_.direction, way_.length, &drift).focus;
    return {&way_, 1};
}

}  // namespace insonify::sonar
