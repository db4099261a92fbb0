#pragma once
#include <initializer_list>
#include <span>
#include <string>

#include "components/acoustics/Curve.hpp"
#include "components/acoustics/Water.hpp"

namespace insonify::acoustics {

/** Returns the speed of sound in water [m/s] after Leroy, Robinson and Goldsmith (2008), accurate to 0.2 m/s: all
 *  oceans, -1..30 degC, fresh water to 42 psu, down to 12,000 m. */
double leroySpeed(const Water& water);
/** Returns the speed [m/s] after Mackenzie (1981), accurate to 0.07 m/s: -2..30 degC, 25..40 psu, down to 8000 m. */
double mackenzieSpeed(const Water& water);
/** Returns the speed [m/s] after Medwin (1975): 0..35 degC, up to 45 psu, down to 1000 m. Accurate to 0.2 m/s near 35
 *  psu. */
double medwinSpeed(const Water& water);
/** Returns the speed [m/s] after Coppens (1981), accurate to 0.1 m/s: 0..35 degC, up to 45 psu, down to 4000 m. */
double coppensSpeed(const Water& water);

/** Returns the speed [m/s] by UNESCO's equation after Chen and Millero (1977), in Fofonoff and Millard (1983):
 *  temperature 0..40 degC of IPTS-68, salinity 0..40 psu, gauge pressure 0..1000 bar. */
double chenMilleroSpeed(double celsius_68, double psu, double bar);
double chenMilleroSpeed(const Water& water);  ///< At the pressure of the water's depth [m/s].
/** Returns the speed [m/s] after Del Grosso (1974), accurate to 0.05 m/s: 0..30 degC of IPTS-68, 30..40 psu, gauge
 *  pressure 0..1000 kg/cm^2. */
double delGrossoSpeed(double celsius_68, double psu, double kg_per_cm2);
double delGrossoSpeed(const Water& water);  ///< At the pressure of the water's depth [m/s].

double soundSpeed(SoundSpeedLaw law, const Water& water);  ///< [m/s].
double soundSpeed(const Water& water);                     ///< By the water's sound_speed_law [m/s].
/** Returns the inputs outside the law's stated validity, such as "45 psu (25 to 40)"; empty when all are inside. */
std::string outsideValidity(SoundSpeedLaw law, const Water& water);

/** Returns the gauge pressure [bar] at a depth [m] and latitude [deg] after Leroy and Parthiot (1998), with their
 *  correction for the common oceans. */
double gaugePressureBar(double depth, double latitude_deg);
/** Converts a temperature of ITS-90 to IPTS-68, the scale of the older equations [degC]. */
double celsius68(double celsius_90);

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

/** An input of a formula and the range for which the formula was made, ends included; all in `unit`. */
struct Limit {
    const char* unit;
    double value, min, max;
};

/** Returns the values outside their ranges, such as "1500 kHz (0.2 to 1000), 5 psu (30 to 35)"; empty when all are
 *  inside. */
std::string outside(std::initializer_list<Limit> limits);

}  // namespace insonify::acoustics
