#include "components/sonar/bins/EstimateBatch.hpp"

namespace insonify::sonar {
namespace {

/** Several numbers that are processed together. */
using Bins8 = double __attribute__((vector_size(bins_at_once * sizeof(double))));

/** The same in whole quanta. */
using Counts = int64_t __attribute__((vector_size(bins_at_once * sizeof(int64_t))));

inline Bins8 min(Bins8 a, double b) { return a < b ? a : Bins8{} + b; }
inline Bins8 max(Bins8 a, double b) { return a > b ? a : Bins8{} + b; }
inline Bins8 abs(Bins8 a) { return a < 0.0 ? -a : a; }
inline Bins8 load(const double* from) {
    Bins8 bins;
    std::memcpy(&bins, from, sizeof bins);
    return bins;
}

/** Energies of footprints: as deposit.glsl with HAVE_PHYSICAL, several bins at once. */
struct PhysicalBins : Bins {
    static constexpr Features features{Feature::Physical};
    using Bins::Bins;

    void depositCell(const Footprint& cell, uint beam, double strength_range) {
        if (!(cell.near_end > cell.far_end && strength_range >= 0.0)) return;
        uint bin = binOf(cell.near_end);
        while (bin > 0u && edges[bin] < cell.near_end) --bin;
        while (edges[bin + 1u] >= cell.near_end) ++bin;
        uint64_t* of_beam = sums + beam * beam_sums;
        if (cell.limb > 0.0)
            for (; edges[bin] > cell.far_end; bin += bins_at_once) addLimbBins(cell, strength_range, bin, of_beam);
        else
            for (; edges[bin] > cell.far_end; bin += bins_at_once) addBins(cell, strength_range, bin, of_beam);
    }

private:
    using real = Bins8;
#include "shaders/trapezoid.glsl"

    void addBins(const Footprint& cell, double strength_range, uint first, uint64_t* of_beam) {
        const Bins8 above = max(min(load(edges + first), cell.near_end), cell.far_end);
        const Bins8 below = max(min(load(edges + first + 1), cell.near_end), cell.far_end);
        const Bins8 to_above = trapezoidShare(cell, above - cell.centre);
        const Bins8 share =
            (above < cell.nearest ? to_above : Bins8{} + 0.5) - trapezoidShare(cell, below - cell.centre);
        add(partEnergy(cell, strength_range, share, load(middles + first), above, below), of_beam + first);
    }

    void addLimbBins(const Footprint& cell, double strength_range, uint first, uint64_t* of_beam) {
        const Bins8 above = max(min(load(edges + first), cell.near_end), cell.far_end);
        const Bins8 below = max(min(load(edges + first + 1), cell.near_end), cell.far_end);
        const Bins8 cut_off =
            above < cell.nearest ? Bins8{} : 0.5 - trapezoidShare(cell, placeOf(cell, above) - cell.centre);
        const Bins8 share = cut_off + limbShare(cell, above) - limbShare(cell, below);
        add(limbEnergy(cell, strength_range, share, load(middles + first), above, below), of_beam + first);
    }

    static void add(Bins8 amounts, uint64_t* to) {
        Counts counts;
        std::memcpy(&counts, to, sizeof counts);
        // Signed, because there is an instruction for it.
        counts += __builtin_convertvector(min(amounts, 1048576.0) * quanta_per_unit + 0.5, Counts);
        std::memcpy(to, &counts, sizeof counts);
    }
};

INSONIFY_ESTIMATE(sumPhysical, PhysicalBins)

constexpr EstimatorEntry entries[] = {{PhysicalBins::features, sumPhysical}};

}  // namespace

std::span<const EstimatorEntry> physicalEstimators() { return entries; }

}  // namespace insonify::sonar
