#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::sonar {

/** Set in the index of an object whose echo has passed a wall. */
constexpr uint32_t behind_walls = 0x80000000;
/** Set in the index of an object whose echo has rung in its own wall. */
constexpr uint32_t rung_in_wall = 0x40000000;

/** The echo of one object in one bin. Sines are weighted by energy and counted in half quanta. */
struct ObjectEcho {
    uint64_t energy = 0;    ///< In quanta, as the sum of the bin.
    int64_t elevation = 0;  ///< Sine of the elevation, weighted.
    int64_t grazing = 0;    ///< Sine of the grazing angle, weighted.
    uint32_t object = 0;    ///< Index into Geometry::objects; with behind_walls or rung_in_wall [1].
    uint32_t hits = 0;      ///< Samples [1].

    /** Returns the echo of one cell: `energy` above 0. */
    static ObjectEcho of(uint64_t energy, double sine_elevation, double sine_grazing, uint32_t object, uint32_t hits) {
        // Half, so that a sum has the range of the bin's sum; signed, because there is an instruction for it.
        const double half = 0.5 * static_cast<double>(static_cast<int64_t>(energy));
        return {energy, static_cast<int64_t>(half * sine_elevation), static_cast<int64_t>(half * sine_grazing), object,
                hits};
    }
    void add(const ObjectEcho& other) {
        energy += other.energy;
        elevation += other.elevation;
        grazing += other.grazing;
        hits += other.hits;
    }
};

/** The objects of the echoes in the bins of some beams. All sums are of whole numbers, so that the order of the echoes
 *  is free: the table is the same for any number of threads.
 *
 *  Up to `kept_apart` objects of a bin are distinguished, with exact energies. If there are more, the objects with the
 *  lowest indices are distinguished; the others count in the bin's energy and hits. */
class TruthTable {
public:
    static constexpr size_t kept_apart = 4;

    TruthTable(size_t beams, size_t bins);

    /** Forgets all echoes. */
    void clear();
    void add(size_t beam, size_t bin, const ObjectEcho& echo) {
        const size_t at = beam * bins_ + bin;
        if (used_[at] == 0) {
            used_[at] = 1;
            first_[at] = echo;
        } else if (first_[at].object == echo.object) {
            first_[at].add(echo);
        } else {
            addToOthers(at, echo);
        }
    }
    /** Adds a beam of another table with the same number of bins. */
    void merge(size_t beam, const TruthTable& other, size_t of);
    /** Fills beam `to` of a truth that has these bins, including direct path and shadow. `water`: energy of the water
     *  in each bin, in the quanta of ObjectEcho::energy; empty: none. */
    void report(size_t beam, size_t to, types::SonarTruth& truth, std::span<const uint64_t> water = {}) const;

private:
    static constexpr uint8_t more = kept_apart + 1;  ///< In used_: there is a rest.

    size_t objectsAt(size_t at) const { return std::min<size_t>(used_[at], kept_apart); }
    /** Returns one of the objects of a bin. */
    const ObjectEcho& echo(size_t at, size_t i) const {
        return i == 0 ? first_[at] : others_[at * (kept_apart - 1) + i - 1];
    }
    ObjectEcho& echo(size_t at, size_t i) { return const_cast<ObjectEcho&>(std::as_const(*this).echo(at, i)); }
    void addToOthers(size_t at, const ObjectEcho& echo);
    void addRest(size_t at, const ObjectEcho& echo);
    /** Reports a bin with echoes of surfaces, with sines instead of angles. */
    void reportBin(size_t at, size_t to, uint64_t water, types::SonarTruth& truth) const;

    size_t bins_;
    std::vector<uint8_t> used_;       ///< Objects of each bin; or `more`.
    std::vector<ObjectEcho> first_;   ///< First object of each bin: most bins have one.
    std::vector<ObjectEcho> others_;  ///< Other objects of each bin.
    std::vector<ObjectEcho> rest_;    ///< Sum of the objects that are not distinguished, where there are any.
};

/** Destination of the truth of one thread's deposit. */
struct TruthSink {
    TruthTable& table;
    std::span<const int32_t> rows;  ///< Beam of the table for each beam of the sums, -1: none; empty: the same.
    std::span<uint64_t> one_beam;   ///< Buffer of the thread: EchoRules::sumCount() zeros, zeroed again after use.

    int32_t getRow(uint32_t beam) const { return rows.empty() ? static_cast<int32_t>(beam) : rows[beam]; }
};

/** Returns for each azimuth cell of a plan the beam that shows it. A beam shows the cells up to halfway to its
 *  neighbours. -1 for a cell in sidelobes only. Empty where cells are beams. */
std::vector<int32_t> beamsOfCells(const RenderPlan& plan);

/** The echoes of the water in the beams of a ping, from effects' own sums. A beam has those of the cells that it shows.
 *  All sums are of whole quanta, so that the order of the cells is free. */
class WaterTruth {
public:
    /** `sum_count`: bins of the sums, a multiple of the plan's. `threads`: max number of calls of take() at a time. */
    WaterTruth(const RenderPlan& plan, size_t sum_count, int threads);

    void begin();
    /** Takes all sums of a cell, for samples of `solid_angle` [sr]. Thread-safe. */
    void take(const EchoRules& rules, const uint64_t* sums, size_t cell, double solid_angle, size_t thread);
    /** Returns the energies of a beam's bins, in the quanta of ObjectEcho::energy. */
    std::span<const uint64_t> beam(size_t beam) const { return {&energies_[beam * bin_count_], bin_count_}; }
    /** Returns the intensity of a bin [1/m^2]. `quantum`: of the sums [sr]. */
    double intensity(size_t beam, size_t bin, double quantum) const {
        return static_cast<double>(energies_[beam * bin_count_ + bin]) * quantum * levels_.factor(bin);
    }

private:
    std::vector<int32_t> beams_of_cells_;          ///< Empty: cells are beams.
    size_t bin_count_, per_bin_;                   ///< Bins of a beam; sums of a bin.
    BinLevels levels_;                             ///< Intensities of the beams' bins.
    std::vector<uint64_t> energies_;               ///< [beam][bin], in quanta.
    std::vector<std::vector<float>> intensities_;  ///< Buffer of each thread.
};

/** Transfers the truth of azimuth cells to the truth of a ping's beams: each beam gets that of the cells next to its
 *  bearing. */
class TruthGrid {
public:
    /** `rules`: of the sums. `whole`: each cell is taken once per ping. `threads`: max number of calls at a time. */
    TruthGrid(const RenderPlan& plan, const EchoRules& rules, bool whole, int threads);

    void begin();
    /** Returns the truth of the water, which takes a cell before the grid takes the last part of the cell; null where
     *  no effect has own sums. */
    WaterTruth* water() { return water_ ? &*water_ : nullptr; }
    /** Takes all or a part of the truth of a cell. Thread-safe. */
    void take(size_t cell, const TruthTable& echoes, size_t of, types::SonarTruth& truth);
    /** Completes the truth once all cells are taken. */
    void finish(types::SonarTruth& truth, ThreadPool& threads) const;

private:
    std::span<const uint64_t> getWater(size_t beam) const {
        return water_ ? water_->beam(beam) : std::span<const uint64_t>();
    }

    std::vector<int32_t> beams_of_cells_;
    size_t beam_count_;
    std::optional<WaterTruth> water_;
    std::optional<TruthTable> gathered_;  ///< Used where the truth of a beam has several parts.
    std::deque<std::mutex> alone_;        ///< One for each such beam.
};

/** The kind of path that contributes most to a bin, and the object of its echo. Sums the cells' energies by kind of
 *  path, for the beams that show the cells. */
class PathTruth {
public:
    /** Values of types::SonarTruth::path, from 1. */
    enum Path { SurfaceOnce = 1, SurfaceTwice, Bounced };

    /** `bin_count`: bins of the sums, a multiple of the plan's. */
    PathTruth(const RenderPlan& plan, size_t bin_count);

    void begin();
    /** Returns the sums of energies via a path: [cell][bin], in quanta. */
    uint64_t* sums(Path path) { return sums_[path - 1].data(); }
    bool keeps(const EchoPart& echo) const { return !selection_ || selection_->keeps(echo); }
    /** Adds an echo via any of the paths, in bin `bin` of the sums of a cell. Thread-safe. */
    void show(size_t cell, size_t bin, const ObjectEcho& echo);
    /** Takes the energies of a cell once all are summed, before they are added to the cell. `direct`: the cell's direct
     *  echoes, empty where their energies are unknown. `quantum`: of the sums [sr]. */
    void take(size_t cell, std::span<const float> direct, const BinLevels& levels, double quantum);
    /** Completes the truth once all cells are taken and the rest of the truth is recorded. A bin shows the truth of its
     *  strongest path. `water`: null: none. `quantum`: of the sums [sr]. */
    void report(types::SonarTruth& truth, const WaterTruth* water, double quantum);

private:
    double sumPathEnergy(size_t at) const { return energies_[1][at] + energies_[2][at] + energies_[3][at]; }
    /** Returns the path that contributes more to a bin than direct echoes and the water; 0: none. */
    uint8_t loudest(const types::SonarTruth& truth, size_t at, double water) const;
    /** Takes the labels of the mirrors into a bin whose path is reported, and their energies into its share. */
    void completeBin(types::SonarTruth& truth, size_t at, double water) const;

    std::vector<int32_t> beams_of_cells_;  ///< Empty: cells are beams.
    EchoSelection* selection_;             ///< RenderOptions::selection.
    size_t sum_count_, bin_count_;         ///< Bins of a cell; of a beam.
    bool knows_direct_ = false;
    std::array<std::vector<uint64_t>, 3> sums_;
    std::array<std::vector<double>, 4> energies_;  ///< Direct, and via each path: [beam][bin].
    TruthTable shown_;                             ///< Echoes via all paths except the direct one.
    std::deque<std::mutex> alone_;                 ///< One for each beam.
    types::SonarTruth shown_truth_;
};

/** The truth of a grid of beams, column by column: for each azimuth the sum over its elevations, and for each beam of
 *  the grid what its return shows.
 *
 *  The truth of a beam has one object and path per bin, the strongest. So the shares of an azimuth count only the
 *  strongest object of each beam. Elevations are those of the beams, within half their spacing. */
class GridTruth {
public:
    /** Allocates the azimuths, with the grid of `ping`, and the beams of the grid in `returns`, one bin each: row by
     *  row from the top, each from port to starboard. */
    static void shape(const types::Sonar& ping, size_t rows, types::SonarTruth& azimuths, types::SonarTruth& returns);
    /** Adds the truth of one azimuth to beam `column` of the azimuths. The beams of `fan` are its elevations from the
     *  lowest to the highest [rad]. */
    void addTo(const types::Sonar& fan, const types::SonarTruth& truth, size_t column, types::SonarTruth& azimuths);
    /** Copies bin `bin` of beam `beam` of an azimuth's truth to index `cell` of `returns`. */
    static void copyReturn(const types::SonarTruth& truth, size_t beam, size_t bin, size_t cell,
                           types::SonarTruth& returns);
    /** Clears a bin: it has no echo. */
    static void forget(size_t at, types::SonarTruth& truth);

private:
    /** The echo of one object in a bin via one path. */
    struct Echo {
        int32_t object;
        uint8_t path;
        double energy, elevation, grazing;  ///< Angles weighted by energy [rad].
    };
    void fillBin(size_t at, double energy, uint32_t hits, types::SonarTruth& azimuths) const;

    std::vector<Echo> echoes_;  ///< Echoes in one bin.
};

}  // namespace insonify::sonar
