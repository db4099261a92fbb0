#pragma once
#include <cstdint>
#include <vector>

#include "components/acoustics/SoundProfile.hpp"
#include "components/sonar/fan/BinGrid.hpp"

namespace insonify::sonar {

/** How rays are bent by a profile of the speed of sound: where sound is that has left the sonar at an elevation, once
 *  its travel time makes a slant range at the sonar's own speed of sound. Made for a depth of the sonar, and again
 *  where it has gone so far up or down that a hundredth of a bin may be missed (ACOUSTICS.md 5.19). */
class RayTable {
public:
    static constexpr int max_corners = 512;  ///< [1]
    static constexpr double beyond = 1.02;   ///< So far beyond the last bin rays go on, for cells at its edge [1].

    /** Where a ray is about the sonar: `spread` times the cosine of its elevation away from it, `rise` above it [m];
     *  and by how much both grow with the range [1]. In water of one speed, which is the sonar's, spread is the range.
     */
    struct Place {
        double spread, rise, spread_rate, rise_rate;
    };

    RayTable(const acoustics::SoundProfile& profile, const BinGrid& grid);

    /** For a sonar at that depth [m]; true where the table had to be made. Allocates only the first time. */
    bool place(double depth);
    /** At an elevation in the world [rad] and a range [m], from 0 to a little beyond the grid's range_max. */
    Place at(double elevation, double range) const;
    /** How many equal parts of the way from 0 to `beyond` the range are each nearly straight [1]. */
    size_t corners() const { return ranges_.size() - 1; }
    /** Between neighbouring rays of the table [rad]. */
    double elevationStep() const { return elevation_step_; }

private:
    void trace(size_t ray, double depth);
    void findTears();
    /** Of one ray between two of its corners: Hermite's cubic. */
    Place between(size_t ray, size_t corner, double share) const;

    acoustics::SoundProfile profile_;
    double nominal_;         ///< Speed of sound of the sonar [m/s].
    double range_step_;      ///< [m]
    double elevation_step_;  ///< [rad]
    double good_for_;        ///< How far the sonar may go up or down [m].
    double depth_ = 0;       ///< For which the table is [m].
    size_t rays_;
    std::vector<double> ranges_, times_;  ///< [m], [s]
    std::vector<acoustics::RayPoint> points_;
    std::vector<Place> places_;  ///< Of each ray, from straight down to straight up, at each corner.
    /** Whether each ray and the next have been torn apart there, as where one turns back from a layer that the other
     *  goes through: between them is a shadow. */
    std::vector<uint8_t> torn_;
};

}  // namespace insonify::sonar
