#include "components/sonar/RingDown.hpp"

namespace insonify::sonar {

RingDown::RingDown(const RenderPlan& plan) {
    for (int k = 0; k < plan.grid.bin_count; ++k) {
        const double heard = plan.config.pulse->ring_down->mean(plan.grid.edge(k), plan.grid.edge(k + 1));
        if (static_cast<float>(heard) == 0) return;
        bins_.push_back(static_cast<float>(heard));
    }
}

void RingDown::add(types::Sonar& ping) const {
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        for (size_t k = 0; k < bins_.size(); ++k) ping.bins[beam * ping.bin_count + k] += bins_[k];
}

}  // namespace insonify::sonar
