#pragma once
#include <glm/vec3.hpp>

#include "components/acoustics/Curve.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** Power of a sonar's beam pattern on the path out and on the path back (ACOUSTICS.md 5.9), and the cells that receive
 *  it. */
class PathPatterns {
public:
    explicit PathPatterns(const RenderPlan& plan);

    /** A direction in sonar axes. */
    struct Direction {
        double azimuth = 0;     ///< As in cells: of cones their bearing [rad].
        double sine = 0;        ///< Sine of the elevation [1].
        bool received = false;  ///< Whether it is received: not behind a straight array.
    };
    Direction toDirection(const glm::dvec3& direction) const;
    /** Returns the power sent along one path and received along another, relative to the azimuth response of the cell
     *  that receives it [1]. */
    double power(const Direction& sent, const Direction& received) const;
    /** Returns the receive power along a path, relative to the azimuth response of the cell that receives it [1]. */
    double received(const Direction& direction) const;
    /** Returns whether both are within one beam. */
    bool inOneBeam(const Direction& a, const Direction& b) const;
    /** Calls use(cell) for each azimuth cell that contains a path's direction. */
    void eachCell(const Direction& direction, const auto& use) const { plan_.cells.eachAt(direction.azimuth, use); }

private:
    double elevation(const acoustics::AdaptiveTable& table, double sine) const;
    double sentAzimuth(double azimuth) const;

    const RenderPlan& plan_;
    bool conical_, has_azimuth_;
    double reach_, beam_width_;
    /** Powers within 0.05 dB, or 1e-5: in elevation over its sine from -reach_ to reach_, empty for 1 everywhere; of
     * the transmitter over azimuths from -pi to pi [1]. */
    acoustics::AdaptiveTable sent_, received_, azimuths_;
};

}  // namespace insonify::sonar
