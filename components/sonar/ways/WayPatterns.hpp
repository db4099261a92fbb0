#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** Power of a sonar's beam pattern on the way out and on the way back (ACOUSTICS.md 5.9), and the cells that receive
 * it. */
class WayPatterns {
public:
    explicit WayPatterns(const RenderPlan& plan);

    /** A direction in sonar axes. */
    struct Way {
        double azimuth = 0;  ///< As cells have it: of cones their bearing [rad].
        double sine = 0;     ///< Sine of the elevation [1].
        bool heard = false;  ///< Not behind a straight array.
    };
    Way wayOf(const glm::dvec3& direction) const;
    /** Power that is sent along one way and heard along another, over what the cell that hears it makes of it in
     *  azimuth [1]. */
    double power(const Way& sent, const Way& heard) const;
    /** Power with which sound from elsewhere is heard along a way, over what the cell that hears it makes of it in
     *  azimuth [1]. */
    double heard(const Way& way) const;
    /** Whether both are within one beam. */
    bool inOneBeam(const Way& a, const Way& b) const;
    /** Calls use(cell) for each azimuth cell that a way lies in. */
    template <class Use>
    void eachCell(const Way& way, const Use& use) const {
        plan_.cells.eachAt(way.azimuth, use);
    }

private:
    double elevation(const std::vector<double>& table, double sine) const;
    double sentAzimuth(double azimuth) const;

    const RenderPlan& plan_;
    bool conical_, has_azimuth_;
    double reach_, beam_width_;
    std::vector<double> sent_, heard_;  ///< Powers in elevation, over its sine from -reach_ on [1].
    std::vector<double> azimuths_;      ///< Power that is sent, over azimuths from -pi on [1].
};

}  // namespace insonify::sonar
