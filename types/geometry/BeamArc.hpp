#pragma once
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "types/samples/Sonar.hpp"

namespace insonify::types {

/** The order of directions along the smallest arc that holds them all. */
struct ArcOrder {
    std::vector<size_t> order;  ///< Indices of the directions, from one end of the arc to the other.
    size_t turned = 0;  ///< Number of the last in `order` that are beyond the seam; they have a whole turn added [1].
};

/** Sorts directions within one whole `turn` (360, or 2 pi). The arc crosses the seam at half a turn only where the
 *  widest gap between neighbours is elsewhere. Equal directions keep their order. */
ArcOrder alongArc(std::span<const double> directions, double turn);

/** The beams of a ping from starboard to port along the arc that they cover. The ping may list its beams in any order,
 *  with gaps and overlaps, and across +-180 degrees: the arc excludes the widest gap between two beams.
 *
 *  Beams of unknown bearing are omitted. Neighbours join when they are at most two widths apart, or when the ping does
 *  not state the width. Joined beams meet half way between their centres. Other neighbours have a gap between them. */
struct BeamArc {
    std::vector<uint32_t> beams;   ///< Indices into the ping's beams.
    std::vector<double> bearings;  ///< Centres of these beams, ascending; across +-180 degrees they exceed pi [rad].
    double width = 0;              ///< Opening of one beam; when the ping does not state it, the mean spacing [rad].
    double right = 0, left = 0;    ///< Outer edges, half a width beyond the outermost centres [rad].

    static constexpr double usual_width = std::numbers::pi / 180;

    BeamArc() = default;
    explicit BeamArc(const Sonar& ping, double lone_width = usual_width) { take(ping, lone_width); }
    /** @param lone_width the width of a single beam when the ping does not state it [rad] */
    void take(const Sonar& ping, double lone_width = usual_width);
    /** Allocates nothing when the arc had this number of beams before. */
    void take(std::span<const Angle> table, Angle beam_width, double lone_width = usual_width);

    bool fullCircle() const { return left - right > 2 * std::numbers::pi - 1e-6; }
    /** Returns whether the last and the first of three or more beams are neighbours: the beams cover a full circle, or
     *  the step from the last to the first is no wider than the widest other step. */
    bool isRing() const;
    /** Returns whether the beam at a place in `beams` joins the next beam to port. */
    bool joins(size_t place) const;
    /** Returns the place in `beams` at a bearing; none when there is no beam. Between the centres of two joined beams
     *  it is a fraction, which rounds to the nearest beam. In a full circle a place behind the last beam is between
     * that and the first, which counts as place beams.size() too. */
    std::optional<double> placeAt(double bearing) const;
    /** Returns the index into the ping's beams of the beam whose centre is nearest to a bearing; none when there is no
     *  beam. */
    std::optional<uint32_t> beamAt(double bearing) const;
    /** Returns the same direction as `bearing`, within half a turn of the arc's middle [rad]. */
    double turned(double bearing) const;

    /** A part of the arc, from its starboard to its port edge [rad]. */
    struct Sector {
        double right, left;
    };
    /** Returns the sector of each beam. An outermost beam reaches the same distance outwards as towards its joined
     *  neighbour. */
    std::vector<Sector> sectors() const;
    /** The reach of a beam from its centre to either side [rad]. */
    struct Reach {
        double right, left;
    };
    /** Returns the reach of the beam at a place: `half_width`, but at most half way to the next beam. */
    Reach within(size_t place, double half_width) const;

private:
    double stepAcross() const { return bearings.front() + 2 * std::numbers::pi - bearings.back(); }
    double opposite() const { return (bearings.front() + bearings.back()) / 2 - std::numbers::pi; }

    bool width_known_ = false;
};

/** Returns the first beam of a ping on a side, +1 for port, -1 for starboard; none if there is none. */
inline std::optional<uint32_t> firstBeamOn(const Sonar& ping, int side) {
    for (uint32_t beam = 0; beam < ping.beam_count; ++beam)
        if (ping.bearings[beam].rad * side > 0) return beam;
    return {};
}

}  // namespace insonify::types
