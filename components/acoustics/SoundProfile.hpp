#pragma once
#include <span>
#include <string>

#include "components/acoustics/Curve.hpp"

namespace insonify::acoustics {

/** A profile of the speed of sound over depth, linear between the measured depths and constant beyond them. Rays are
 *  arcs of circles in each layer of constant gradient. ACOUSTICS.md 2.6. */
class SoundProfile {
public:
    /** @param speeds speed of sound [m/s] over at least two ascending depths [m] */
    explicit SoundProfile(Curve speeds) : speeds_(std::move(speeds)) {}
    /** Reads a CSV file with header depth_m,sound_speed_m_s.
     *  @throws types::ConfigError with file, line and column of every diagnostic. */
    static SoundProfile read(const std::string& file);

    double speed(double depth) const { return speeds_.at(depth); }  ///< [m/s]
    double top() const { return speeds_.x.front(); }                ///< Min measured depth [m].
    double bottom() const { return speeds_.x.back(); }              ///< Max measured depth [m].
    double slowest() const;                                         ///< [m/s]
    double fastest() const;                                         ///< [m/s]
    double steepest() const;                                        ///< Max magnitude of the gradient [1/s].
    const Curve& curve() const { return speeds_; }

private:
    Curve speeds_;
};

/** A point on a ray with the direction of the ray. */
struct RayPoint {
    double across = 0;     ///< Horizontal distance from the ray's beginning [m].
    double depth = 0;      ///< [m]
    double elevation = 0;  ///< Direction of the ray, positive up [rad].
    double speed = 0;      ///< Speed of sound at this point [m/s].
};

/** Fills `points` with the place of the sound at ascending `times` [s], by exact arcs through the layers of a profile.
 *  The ray starts at a depth [m] with an elevation, positive up [rad], at most 89.99 degrees to either side. Source:
 *  Jensen et al. 2011. */
void traceRay(const SoundProfile& profile, double depth, double elevation, std::span<const double> times,
              std::span<RayPoint> points);

}  // namespace insonify::acoustics
