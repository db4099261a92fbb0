#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "types/SonarTruth.hpp"

namespace insonify::sonar {

/** Set in the index of an object whose echo has come through a wall. */
constexpr uint32_t behind_walls = 0x80000000;
/** The same where its echo has rung in its own wall. */
constexpr uint32_t rung_in_wall = 0x40000000;

/** What one object has sent back to one bin. Weighted by energy, sines are counted in half quanta. */
struct ObjectEcho {
    uint64_t energy = 0;    ///< In quanta, as the bin's own sum.
    int64_t elevation = 0;  ///< Sine of the elevation, weighted.
    int64_t grazing = 0;    ///< Sine of the grazing angle, weighted.
    uint32_t object = 0;    ///< Index into Geometry::objects; with behind_walls or rung_in_wall [1].
    uint32_t hits = 0;      ///< Samples [1].

    /** Of one cell: `energy` above 0. */
    static ObjectEcho of(uint64_t energy, double sine_elevation, double sine_grazing, uint32_t object, uint32_t hits) {
        // Half, so that a sum holds what the bin's own holds; signed, for there is an instruction for that.
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

/** Of which objects the echoes in the bins of some beams are. All sums are of whole numbers, so that the order in which
 *  echoes come is free: the same table on any number of threads.
 *
 *  Up to `told_apart` objects of a bin are told apart, and all energies exact. Of more than that, those of the lowest
 *  index are; what the others send back counts in the bin's energy and hits. */
class TruthTable {
public:
    static constexpr size_t told_apart = 4;

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
    /** Adds a beam of another table with as many bins. */
    void merge(size_t beam, const TruthTable& other, size_t of);
    /** Fills beam `to` of a truth that has these bins, direct path and shadow included. */
    void report(size_t beam, size_t to, types::SonarTruth& truth) const;

private:
    static constexpr uint8_t more = told_apart + 1;  ///< In used_: there is a rest.

    size_t objectsAt(size_t at) const { return std::min<size_t>(used_[at], told_apart); }
    /** Of one bin, one of its objects. */
    const ObjectEcho& echo(size_t at, size_t i) const {
        return i == 0 ? first_[at] : others_[at * (told_apart - 1) + i - 1];
    }
    ObjectEcho& echo(size_t at, size_t i) { return const_cast<ObjectEcho&>(std::as_const(*this).echo(at, i)); }
    void addToOthers(size_t at, const ObjectEcho& echo);
    void addRest(size_t at, const ObjectEcho& echo);
    /** Sines for angles. */
    void reportBin(size_t at, size_t to, types::SonarTruth& truth) const;

    size_t bins_;
    std::vector<uint8_t> used_;       ///< Objects of each bin; or `more`.
    std::vector<ObjectEcho> first_;   ///< Of each bin, the object that came first: most bins have one.
    std::vector<ObjectEcho> others_;  ///< Of each bin, the others.
    std::vector<ObjectEcho> rest_;    ///< Of objects that are not told apart, where there is one.
};

/** Where one thread's deposit tells the truth of what it deposits. */
struct TruthSink {
    TruthTable& table;
    std::span<const int32_t> rows;  ///< Beam of the table for each beam of the sums, -1: none; empty: the same.
    std::span<uint64_t> one_beam;   ///< The thread's own, EchoRules::sumCount() zeros, which it leaves behind.

    int32_t rowOf(uint32_t beam) const { return rows.empty() ? static_cast<int32_t>(beam) : rows[beam]; }
};

}  // namespace insonify::sonar
