#pragma once
#include "components/nav/ErrorModel.hpp"
#include "components/nav/PressureConfig.hpp"
#include "types/Pose.hpp"
#include "types/Pressure.hpp"

namespace insonify::nav {

/** Deepest that pressures are told of: deeper ones are taken as this [m]. */
constexpr double deepest = 12000;

/** Depth of a pressure above that of the air [Pa] at a latitude, in the standard ocean of 0 degC and 35 psu [m]: N.
 *  Fofonoff and R. Millard, "Algorithms for computation of fundamental properties of seawater", UNESCO technical papers
 *  in marine science 44, 1983, after Saunders and Fofonoff (1976); to 0.1 m down to 10000 dbar. */
double depthOfOcean(double pascal, double latitude_deg);

/** Absolute pressure at a depth below the surface [Pa]: that of the air and the water above. In water of one density
 *  density x normal gravity x depth; else the one that depthOfOcean has there. Above the surface, where depth is
 *  negative, that of an air of one temperature, 288 K. */
double pressureAt(double depth, const PressureConfig& config);
/** The depth of a pressure in the same water, 0 above the surface [m]. */
double depthAt(double pascal, const PressureConfig& config);

/** A pressure gauge with its errors. */
class PressureGauge {
public:
    explicit PressureGauge(const PressureConfig& config);
    /** At the place of a pose of the gauge; never below 0. */
    types::Pressure measure(const types::Pose& gauge);

private:
    PressureConfig config_;
    WanderingBias drift_;
};

/** The depth that a reading has in the same water, as Rock's depth gauges tell it: z of frame "pressure" in "world"
 * [m], with the variance that noise, drift and resolution give it [m^2]; the rest unknown. */
types::Pose depthSample(const types::Pressure& reading, const PressureConfig& config);

}  // namespace insonify::nav
