#include "components/sonar/Troubles.hpp"

#include "components/sonar/Silence.hpp"

namespace insonify::sonar {

std::string Troubles::follow(const SonarRenderer& renderer, const types::Snapshot& scene) {
    sightlines_.place(scene);
    const auto around = sightlines_.enclosing();
    if (enclosure_.isDue(around.has_value())) return enclosureText(scene, *around);
    const bool hears = renderer.hasEchoes() || renderer.targetsHeard() > 0;
    silent_ = hears ? 0 : silent_ + 1;
    if (!hears && silent_ < turn_) return {};
    return silence_.isDue(!hears && !around) ? silenceText(renderer.renderPlan(), turn_ > 1, scene) : "";
}

}  // namespace insonify::sonar
