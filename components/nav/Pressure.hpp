#pragma once
#include "components/nav/ErrorModel.hpp"
#include "components/nav/PressureConfig.hpp"
#include "types/Pose.hpp"
#include "types/Pressure.hpp"

namespace insonify::nav {

/** Max depth; larger depths count as this [m]. */
constexpr double deepest = 12000;

/** Returns the depth [m] of a gauge pressure [Pa] at a latitude, in the standard ocean of 0 degC and 35 psu, accurate
 *  to 0.1 m down to 10000 dbar: N. Fofonoff and R. Millard, "Algorithms for computation of fundamental properties of
 *  seawater", UNESCO technical papers in marine science 44, 1983, after Saunders and Fofonoff (1976). */
double depthOfOcean(double pascal, double latitude_deg);

/** Returns the absolute pressure at a depth below the surface [Pa]: that of the air plus that of the water above. In
 *  water of constant density the latter is density x normal gravity x depth; otherwise it is the inverse of
 *  depthOfOcean(). Above the surface, at negative depths, the pressure is that of air of constant temperature, 288
 *  K. */
double pressureAt(double depth, const PressureConfig& config);
/** Returns the depth of an absolute pressure in the same water [m]; 0 above the surface. */
double depthAt(double pascal, const PressureConfig& config);

/** A pressure gauge with its errors. */
class PressureGauge {
public:
    explicit PressureGauge(const PressureConfig& config);
    /** Returns the reading at a pose of the gauge; never below 0. */
    types::Pressure measure(const types::Pose& gauge);

private:
    PressureConfig config_;
    WanderingBias drift_;
};

/** Returns the depth of a reading in the same water, as Rock's depth gauges report it: z of frame "pressure" in "world"
 *  [m] with the variance from noise, drift and resolution [m^2]; other fields are unknown. */
types::Pose depthSample(const types::Pressure& reading, const PressureConfig& config);

}  // namespace insonify::nav
