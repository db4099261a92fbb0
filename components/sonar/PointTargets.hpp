#pragma once
#include <optional>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/RenderPlan.hpp"
#include "components/sonar/Sightlines.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** What a pulse leaves of an echo in a bin, quickly: the mean of h over it, by an integral that is made once. */
class PulseMeans {
public:
    explicit PulseMeans(const acoustics::Pulse& pulse);

    /** Mean of h between two distances from the echo [m]. */
    double mean(double low, double high) const;
    double reach() const { return reach_; }  ///< Beyond it nothing is left [m].

private:
    double integralTo(double distance) const;

    std::optional<acoustics::Pulse> tone_;  ///< A box, which no table holds.
    double reach_, step_ = 0;               ///< [m]
    std::vector<double> response_;          ///< h at steps from 0 on [1].
    std::vector<double> integral_;          ///< From 0 to there, of straight lines between the steps [m].
};

/** Adds the point targets of a scene to pings: the active sonar equation at each target's own place, with the pattern
 *  of each beam there and the pulse about its own range (ACOUSTICS.md 5.14). What stands before a target hides it. */
class PointTargets {
public:
    /** Of a plan for model `physical`; plan and geometry must outlive it. */
    PointTargets(const RenderPlan& plan, const types::Geometry& geometry);

    /** Once the bins are filled; how many targets any of them hears. Allocates nothing. */
    size_t add(const types::Snapshot& snapshot, types::Sonar& ping);

private:
    /** Where a target is about the sonar. */
    struct Place {
        double range, azimuth, elevation;  ///< Azimuth as beams have it: of cones their bearing [m, rad].
    };
    std::optional<Place> placeOf(const types::Pose& sonar, const glm::dvec3& position) const;
    double powerIn(const Beam& beam, const Place& place) const;
    /** Fills means_ for bins from `first` on; whether there is any. */
    bool spread(double range);
    bool addTo(types::Sonar& ping, const Place& place, double intensity) const;

    const RenderPlan& plan_;
    Sightlines sightlines_;
    double absorption_;  ///< Two-way, of intensity [1/m].
    std::optional<PulseMeans> pulse_;
    std::vector<double> means_;  ///< Of h, for bins from first_bin_ on [1].
    size_t first_bin_ = 0;
};

}  // namespace insonify::sonar
