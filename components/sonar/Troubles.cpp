#include "components/sonar/Troubles.hpp"

#include <algorithm>

#include "components/sonar/Silence.hpp"

namespace insonify::sonar {

std::string Troubles::follow(const SonarRenderer& renderer, const types::Snapshot& scene, const types::Sonar& ping) {
    if (pings_++ % between_looks == 0) {
        sightlines_.place(scene);
        const auto around = sightlines_.enclosing();
        inside_ = around.has_value();
        if (enclosure_.isDue(inside_)) return enclosureText(scene, *around);
    }
    const bool echoes = renderer.hasEchoes() && std::ranges::any_of(ping.bins, [](float bin) { return bin > 0; });
    const bool hears = echoes || renderer.targetsHeard() > 0;
    silent_ = hears ? 0 : silent_ + 1;
    if (!hears && silent_ < turn_) return {};
    return silence_.isDue(!hears && !inside_) ? silenceText(renderer.renderPlan(), turn_ > 1, scene) : "";
}

}  // namespace insonify::sonar
