#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "types/SonarTruth.hpp"

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

    int32_t rowOf(uint32_t beam) const { return rows.empty() ? static_cast<int32_t>(beam) : rows[beam]; }
};

}  // namespace insonify::sonar
