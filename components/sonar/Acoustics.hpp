#pragma once
#include <string>

#include "components/sonar/SonarConfig.hpp"

namespace insonify::sonar {

/** Speed of sound in sea water [m/s] after Mackenzie (1981): -2..30 degC, 25..40 psu, down to 8000 m. */
double mackenzieSpeed(const WaterConfig& water);
/** After Medwin (1975): 0..35 degC, up to 45 psu, down to 1000 m [m/s]. */
double medwinSpeed(const WaterConfig& water);
/** After Leroy, Robinson and Goldsmith (2008) at 45 deg of latitude: all oceans, fresh water to 42 psu [m/s]. */
double leroySpeed(const WaterConfig& water);

/** One-way absorption [dB/m] at `frequency_khz` after Francois and Garrison (1982): to 5 % for 0.2..1000 kHz. */
double francoisGarrison(double frequency_khz, const WaterConfig& water);
/** After Ainslie and McColm (1998): within 10 % of Francois and Garrison for 0.1..1000 kHz [dB/m]. */
double ainslieMccolm(double frequency_khz, const WaterConfig& water);
/** What lies outside the law's stated validity: "1500 kHz (0.2 to 1000)"; empty when nothing does. */
std::string outsideValidity(AbsorptionLaw law, double frequency_khz, const WaterConfig& water);

/** One-way absorption, and what follows from it. */
struct Absorption {
    double db_per_m = 0;

    /** Of the sound pressure, one way [Np/m]. */
    double amplitudeNepersPerMetre() const;
    /** beta: the received intensity falls as exp(-beta r) with slant range r [1/m]. */
    double intensityPerMetre() const { return 4 * amplitudeNepersPerMetre(); }
};

/** The configured absorption; none when the block is absent. A law needs `water`. */
Absorption makeAbsorption(const SonarConfig& config);

}  // namespace insonify::sonar
