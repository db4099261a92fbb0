#include "components/sonar/PingDiagnostics.hpp"

#include <algorithm>

#include "components/sonar/Silence.hpp"

namespace insonify::sonar {
namespace {

/** S of what gives nothing back, and its rounding, in `cerqueira2017` (ACOUSTICS.md 8.1) [1]. */
constexpr float least_mean = 6.2e-6f;

bool isLoud(Model model, const types::Sonar& ping) {
    const float least = model == Model::Cerqueira2017 ? least_mean : 0;
    return std::ranges::any_of(ping.bins, [least](float bin) { return bin > least; });
}

}  // namespace

std::string PingDiagnostics::follow(bool heard, Model model, const types::Snapshot& scene, const types::Sonar& ping,
                                    const std::function<RenderPlan()>& coverage) {
    if (pings_++ % between_looks == 0) {
        sightlines_.place(scene);
        const auto around = sightlines_.enclosing();
        inside_ = around.has_value();
        if (enclosure_.isDue(inside_)) return enclosureText(scene, *around);
    }
    const bool hears = heard && isLoud(model, ping);
    silent_ = hears ? 0 : silent_ + 1;
    if (!hears && silent_ < turn_) return {};
    return silence_.isDue(!hears && !inside_) ? silenceText(coverage(), turn_ > 1, scene) : "";
}

}  // namespace insonify::sonar
