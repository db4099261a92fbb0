#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace insonify::sonar {

/** One beam, or one azimuth cell: its share of bearings [rad], positive to port. */
struct Beam {
    double centre, low, high;
};

/** The beams of a sonar, or the azimuth cells from which beams are formed, sorted along the arc that they cover.
 *
 *  A table of bearings may be in any order, with gaps and overlaps, and may cross +-180 degrees. Beam k of a fan is the
 *  k-th from the starboard end of the arc. Bearings ascend: beyond the seam a whole turn is added to them. `row(k)` is
 *  the beam's place in the table. Pings, truth and returns are reordered by toTableOrder() when they are complete, so
 *  everything before that counts beams along the arc. */
class Fan {
public:
    Fan() = default;
    /** Sorts the beams of a table. @throws std::invalid_argument for a beam without extent or with a bearing that is
     *  not finite. */
    explicit Fan(const std::vector<Beam>& table);
    /** Beams that are sorted already, such as the cells of a pattern that reaches all round. */
    static Fan sorted(std::vector<Beam> beams);

    size_t size() const { return beams_.size(); }
    bool empty() const { return beams_.empty(); }
    const Beam& operator[](size_t k) const { return beams_[k]; }
    const Beam& front() const { return beams_.front(); }
    const Beam& back() const { return beams_.back(); }
    auto begin() const { return beams_.begin(); }
    auto end() const { return beams_.end(); }

    double low() const { return low_; }    ///< Starboard end of the arc, beam widths included [rad].
    double high() const { return high_; }  ///< Port end of the arc [rad].
    /** Returns the direction at which the circle is cut: pi, or the middle of the widest gap of a fan that crosses pi
     *  [rad]. It is above all bearings, and at most a turn above the lowest. */
    double seam() const { return seam_; }
    /** Returns whether the arc closes to a circle. */
    bool isRound() const { return high_ - low_ >= 2 * std::numbers::pi - 1e-9; }
    /** Returns whether the first and the last of three or more beams are neighbours: the arc closes to a circle, or
     *  the step across its seam is no wider than the widest step between two other neighbours. */
    bool isRing() const;
    /** Returns whether an azimuth is between the ends of the arc, gaps between beams included [rad]. */
    bool spans(double azimuth) const;
    /** Returns the largest azimuth to either side of straight ahead that the arc reaches [rad]. */
    double farthestAside() const { return std::max(std::abs(low_), std::abs(high_)); }
    /** Returns whether each beam begins where the beam before it ends. */
    bool joins() const { return joins_; }
    /** Returns the smallest distance between the centres of two different beams; 2 pi where there are none [rad]. */
    double minSpacing() const;
    /** Returns the bearings halfway between neighbours, size() + 1 values. The outermost are equally far beyond the
     *  outermost beams, or halfway across the seam of a round fan. A single beam has its own limits [rad]. */
    std::vector<double> midpoints() const;
    /** Calls use(k) for each beam that holds an azimuth: low <= azimuth < high, turned by whole turns [rad]. */
    void eachAt(double azimuth, const auto& use) const;

    /** Returns the place of beam k in the table [1]. */
    size_t row(size_t k) const { return rows_[k]; }
    /** Returns the centre of the beam in a row of the table [rad]. */
    double tableBearing(size_t row) const { return bearings_[row]; }
    bool isTableOrder() const { return swaps_.empty(); }
    /** Puts `per_beam` values of each beam from the arc's order into that of the table. Allocates nothing. */
    template <class T>
    void toTableOrder(std::span<T> values, size_t per_beam) const;

private:
    void measure();

    std::vector<Beam> beams_;
    std::vector<double> bearings_;  ///< In the table's order [rad].
    std::vector<size_t> rows_;
    std::vector<std::pair<size_t, size_t>> swaps_;  ///< Swaps of rows, in order.
    double low_ = 0, high_ = 0, seam_ = std::numbers::pi, widest_ = 0;
    bool joins_ = true;
};

void Fan::eachAt(double azimuth, const auto& use) const {
    constexpr double turn = 2 * std::numbers::pi;
    for (const double at : {azimuth, azimuth - turn, azimuth + turn}) {
        auto beam = std::ranges::upper_bound(beams_, at - widest_, {}, &Beam::low);
        for (; beam != beams_.end() && beam->low <= at; ++beam)
            if (at < beam->high) use(static_cast<size_t>(beam - beams_.begin()));
    }
}

template <class T>
void Fan::toTableOrder(std::span<T> values, size_t per_beam) const {
    for (const auto& [a, b] : swaps_) {
        const auto first = values.subspan(a * per_beam, per_beam), second = values.subspan(b * per_beam, per_beam);
        std::ranges::swap_ranges(first, second);
    }
}

}  // namespace insonify::sonar
