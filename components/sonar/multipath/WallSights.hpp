#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/surfaces/EchoTrain.hpp"
#include "components/sonar/surfaces/Sightlines.hpp"

namespace insonify::sonar {

/** Arrivals of sound through walls that ring, on a way out and back or one way. */
struct WallArrivals {
    EchoTrain both, once;
    double ringing = 1;  ///< Energy out and back relative to the square of that one way: resonances [1].

    bool areDelayed() const { return both.isDelayed() || once.isDelayed(); }
};

/** Sound on straight lines through thin walls with water behind them (ACOUSTICS.md 5.26). */
class WallSights {
public:
    static constexpr double min_passed = 1e-3;    ///< One way: 60 dB two-way [1].
    static constexpr double nearest_wall = 1e-4;  ///< Between two walls, with `same_wall` of their range [m].
    static constexpr double same_wall = 1e-5;     ///< [1]

    /** `plan` must outlive it. Without the pass of walls all surfaces hide. */
    explicit WallSights(const RenderPlan& plan);

    /** Returns the one-way share of the energy that passes from one point to another [1]; 0: hidden. `walls` counts the
     *  walls of the whole way, of which at most max_walls pass sound. `arrivals` continues with those of this line. */
    double passed(const Sightlines& sightlines, const glm::dvec3& from, const glm::dvec3& to, int& walls,
                  WallArrivals& arrivals);

private:
    double pass(const Sightlines::WallMet& met, WallArrivals& arrivals) const;

    const RenderPlan& plan_;
    std::vector<bool> are_walls_;  ///< One for each material; empty: none is a wall.
    std::vector<Sightlines::WallMet> met_;
};

}  // namespace insonify::sonar
