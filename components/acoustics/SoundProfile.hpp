#pragma once
#include <span>
#include <string>
#include <vector>

#include "components/acoustics/Curve.hpp"

namespace insonify::acoustics {

/** Speed of sound over depth, with straight lines between what was measured and the nearer end's beyond it: layers of
 *  constant gradient, in each of which rays are arcs of circles. ACOUSTICS.md 2.6. */
class SoundProfile {
public:
    /** Speeds [m/s] over ascending depths [m], at least two. */
    explicit SoundProfile(Curve speeds) : speeds_(std::move(speeds)) {}
    /** From a CSV file with header depth_m,sound_speed_m_s.
     *  @throws types::ConfigError with file, line and column of every diagnostic. */
    static SoundProfile read(const std::string& file);

    double speed(double depth) const { return speeds_.at(depth); }  ///< [m/s]
    double top() const { return speeds_.x.front(); }                ///< Least depth that was measured [m].
    double bottom() const { return speeds_.x.back(); }              ///< Greatest [m].
    double slowest() const;                                         ///< [m/s]
    double fastest() const;                                         ///< [m/s]
    double steepest() const;                                        ///< Greatest change with depth, either sign [1/s].
    const Curve& curve() const { return speeds_; }

private:
    Curve speeds_;
};

/** A place on a ray, and where the ray goes from there. */
struct RayPoint {
    double across = 0;     ///< Horizontal distance from the ray's beginning [m].
    double depth = 0;      ///< [m]
    double elevation = 0;  ///< Of the ray, positive up [rad].
    double speed = 0;      ///< Of sound there [m/s].
};

/** Where sound is at ascending times [s], which has left a depth [m] at an elevation, positive up [rad], at most
 *  89.99 degrees to either side: exact arcs through the layers of a profile. Source: Jensen et al. 2011. */
void traceRay(const SoundProfile& profile, double depth, double elevation, std::span<const double> times,
              std::span<RayPoint> points);

}  // namespace insonify::acoustics
