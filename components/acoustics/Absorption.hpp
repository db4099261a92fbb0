#pragma once
#include <string>

#include "components/acoustics/Water.hpp"

namespace insonify::acoustics {

/** Formulas for absorption: ACOUSTICS.md 2.2 to 2.5. */
enum class AbsorptionLaw { FrancoisGarrison, AinslieMccolm, FisherSimmons, Thorp };

/** One-way absorption [dB/m] at `frequency_khz` after Francois and Garrison (1982): to 5 % for 0.2..1000 kHz. */
double francoisGarrison(double frequency_khz, const Water& water);
/** After Ainslie and McColm (1998): within 10 % of Francois and Garrison for 0.1..1000 kHz [dB/m]. */
double ainslieMccolm(double frequency_khz, const Water& water);
/** After Fisher and Simmons (1977), for 35 psu and pH 8 whatever the water has: 10..400 kHz, to 500 atm [dB/m]. */
double fisherSimmons(double frequency_khz, const Water& water);
/** After Thorp (1967) as in Jensen et al. (2011), for 4 degC and some 1000 m whatever the water has: to 50 kHz [dB/m].
 */
double thorp(double frequency_khz);

double absorptionDbPerM(AbsorptionLaw law, double frequency_khz, const Water& water);  ///< One-way [dB/m].
/** What lies outside the law's stated validity: "1500 kHz (0.2 to 1000)"; empty when nothing does. */
std::string outsideValidity(AbsorptionLaw law, double frequency_khz, const Water& water);

/** One-way absorption, and what follows from it. */
struct Absorption {
    double db_per_m = 0;

    /** Of the sound pressure, one way [Np/m]. */
    double amplitudeNepersPerMetre() const;
    /** beta: the received intensity falls as exp(-beta r) with slant range r [1/m]. */
    double intensityPerMetre() const { return 4 * amplitudeNepersPerMetre(); }
};

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::AbsorptionLaw> {
    static constexpr std::string_view names[] = {"francois_garrison", "ainslie_mccolm", "fisher_simmons", "thorp"};
};
