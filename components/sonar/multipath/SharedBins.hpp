#pragma once
#include <atomic>

#include "components/sonar/bins/Estimators.hpp"
#include "components/sonar/bins/Truth.hpp"

namespace insonify::sonar {
namespace {

/** Adds energies to bins that all threads share. */
#define HAVE_PHYSICAL
struct SharedBins : Bins {
    using Bins::Bins;
    void addToBin(uint cell, uint bin, double amount, double) const {
        if (!(amount > 0)) return;
        if (truth && !truth->keeps({object, EchoPart::no_triangle, path, cell, bin, quanta(amount), sine_elevation,
                                    sine_grazing}))
            return;
        std::atomic_ref(sums[size_t{cell} * bin_count + bin]).fetch_add(quanta(amount), relaxed);
        if (by_way) std::atomic_ref(by_way[size_t{cell} * bin_count + bin]).fetch_add(quanta(amount), relaxed);
        if (truth) truth->show(cell, bin, ObjectEcho::of(quanta(amount), sine_elevation, sine_grazing, object, 1));
    }
    PathTruth* truth = nullptr;  ///< Receives each echo's truth, with the next four values; null: none.
    uint32_t object = 0;
    uint8_t path = 0;  ///< As types::SonarTruth::path.
    double sine_elevation = 0,
           sine_grazing = 0;     ///< Sines of the elevation at the sonar and of the grazing angle at the object [1].
    uint64_t* by_way = nullptr;  ///< Additional sums, of the current kind of path; null: none.
    static constexpr std::memory_order relaxed = std::memory_order_relaxed;
#include "shaders/deposit.glsl"
};
#undef HAVE_PHYSICAL

/** Returns a quantum of the sums [sr]. */
double quantumOf(const TracedPing& ping) {
    return ping.view.cells.cell() / (quanta_per_unit * ping.rules.strength_scale);
}

}  // namespace
}  // namespace insonify::sonar
