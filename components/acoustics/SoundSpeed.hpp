#pragma once
#include <string>

#include "components/acoustics/Water.hpp"

namespace insonify::acoustics {

/** Speed of sound in water [m/s] after Leroy, Robinson and Goldsmith (2008): all oceans, -1..30 degC, fresh water to 42
 *  psu, down to 12,000 m; to 0.2 m/s. */
double leroySpeed(const Water& water);
/** After Mackenzie (1981): -2..30 degC, 25..40 psu, down to 8000 m; to 0.07 m/s [m/s]. */
double mackenzieSpeed(const Water& water);
/** After Medwin (1975): 0..35 degC, up to 45 psu, down to 1000 m; to 0.2 m/s near 35 psu [m/s]. */
double medwinSpeed(const Water& water);
/** After Coppens (1981): 0..35 degC, up to 45 psu, down to 4000 m; to 0.1 m/s [m/s]. */
double coppensSpeed(const Water& water);

/** UNESCO's equation after Chen and Millero (1977), in Fofonoff and Millard (1983) [m/s]: temperature 0..40 degC of
 *  IPTS-68, salinity 0..40 psu, pressure above that of the air 0..1000 bar. */
double chenMilleroSpeed(double celsius_68, double psu, double bar);
double chenMilleroSpeed(const Water& water);  ///< At the pressure of its depth [m/s].
/** After Del Grosso (1974) [m/s]: 0..30 degC of IPTS-68, 30..40 psu, pressure above that of the air 0..1000 kg/cm^2;
 *  to 0.05 m/s. */
double delGrossoSpeed(double celsius_68, double psu, double kg_per_cm2);
double delGrossoSpeed(const Water& water);  ///< At the pressure of its depth [m/s].

double soundSpeed(SoundSpeedLaw law, const Water& water);  ///< [m/s].
double soundSpeed(const Water& water);                     ///< By its own law [m/s].
/** What lies outside the law's stated validity: "45 psu (25 to 40)"; empty when nothing does. */
std::string outsideValidity(SoundSpeedLaw law, const Water& water);

/** Pressure above that of the air at a depth [m] and latitude [deg]: Leroy and Parthiot (1998), with their correction
 *  for the common oceans [bar]. */
double gaugePressureBar(double depth, double latitude_deg);
/** A temperature of ITS-90 on the scale of 1968, which the older equations are in [degC]. */
double celsius68(double celsius_90);

}  // namespace insonify::acoustics
