#pragma once
#include <cstdint>
#include <vector>

#include "components/acoustics/SoundProfile.hpp"
#include "components/sonar/beams/BinGrid.hpp"

namespace insonify::sonar {

/** A table of rays that a sound speed profile bends. It maps the elevation at which sound leaves the sonar, and its
 *  travel time, to a place. The time is given as slant range at the sonar's own speed of sound. The table is made for a
 *  depth of the sonar, and again where a change of depth could cause an error of a hundredth of a bin
 *  (ACOUSTICS.md 5.19). */
class RayTable {
public:
    static constexpr int max_corners = 512;  ///< [1]
    static constexpr double beyond = 1.02;   ///< Rays extend to this share of the range, for cells at its edge [1].

    /** Place of a ray about the sonar, `spread` times the cosine of its elevation away and `rise` above it [m], and the
     *  rates of both with range [1]. In water with one speed, that of the sonar, `spread` is the range. */
    struct Place {
        double spread, rise, spread_rate, rise_rate;
    };

    RayTable(const acoustics::SoundProfile& profile, const BinGrid& grid);

    /** Sets the sonar's depth [m]. Returns whether the table was made again. Allocates only the first time. */
    bool place(double depth);
    /** Returns the place at an elevation in the world [rad] and a range [m], from 0 to slightly beyond the grid's
     *  range_max. */
    Place at(double elevation, double range) const;
    /** Returns the number of equal parts of the range from 0 to `beyond` in which rays are nearly straight [1]. */
    size_t corners() const { return ranges_.size() - 1; }
    /** Returns the angle between neighbouring rays of the table [rad]. */
    double elevationStep() const { return elevation_step_; }

private:
    void trace(size_t ray, double depth);
    void findTears();
    /** Interpolates one ray between two of its corners, by Hermite's cubic. */
    Place between(size_t ray, size_t corner, double share) const;

    acoustics::SoundProfile profile_;
    double nominal_;         ///< Speed of sound of the sonar [m/s].
    double range_step_;      ///< [m]
    double elevation_step_;  ///< [rad]
    double good_for_;        ///< Change of depth for which the table is valid [m].
    double depth_ = 0;       ///< Depth of the table [m].
    size_t rays_;
    std::vector<double> ranges_, times_;  ///< [m], [s]
    std::vector<acoustics::RayPoint> points_;
    std::vector<Place> places_;  ///< For each ray, from straight down to straight up, at each corner.
    /** Whether each ray and the next diverge there, as where one turns back from a layer that the other passes: between
     *  them is a shadow. */
    std::vector<uint8_t> torn_;
};

}  // namespace insonify::sonar
