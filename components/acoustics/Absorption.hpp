#pragma once
#include <string>

#include "components/acoustics/Water.hpp"

namespace insonify::acoustics {

/** Formulas for the absorption of sound in sea water: ACOUSTICS.md 2.2 to 2.5. */
enum class AbsorptionLaw { FrancoisGarrison, AinslieMccolm, FisherSimmons, Thorp };

/** Returns the one-way absorption [dB/m] after Francois and Garrison (1982), accurate to 5 % for 0.2..1000 kHz. */
double francoisGarrison(double frequency_khz, const Water& water);
/** Returns the absorption [dB/m] after Ainslie and McColm (1998): within 10 % of Francois and Garrison for 0.1..1000
 *  kHz. */
double ainslieMccolm(double frequency_khz, const Water& water);
/** Returns the absorption [dB/m] after Fisher and Simmons (1977), valid for 10..400 kHz and up to 500 atm. Ignores the
 *  water's salinity and pH: the formula is for 35 psu and pH 8. */
double fisherSimmons(double frequency_khz, const Water& water);
/** Returns the absorption [dB/m] after Thorp (1967) as in Jensen et al. (2011), valid to 50 kHz. The formula is for 4
 *  degC at about 1000 m depth. */
double thorp(double frequency_khz);

double absorptionDbPerM(AbsorptionLaw law, double frequency_khz, const Water& water);  ///< One-way [dB/m].
/** Returns the inputs outside the law's stated validity, such as "1500 kHz (0.2 to 1000)"; empty when all are
 *  inside. */
std::string outsideValidity(AbsorptionLaw law, double frequency_khz, const Water& water);

/** One-way absorption in decibels, and its conversions. */
struct Absorption {
    double db_per_m = 0;

    /** Returns the one-way absorption of the sound pressure [Np/m]. */
    double amplitudeNepersPerMetre() const;
    /** Returns beta: the received intensity falls as exp(-beta r) with slant range r [1/m]. */
    double intensityPerMetre() const { return 4 * amplitudeNepersPerMetre(); }
};

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::AbsorptionLaw> {
    static constexpr std::string_view names[] = {"francois_garrison", "ainslie_mccolm", "fisher_simmons", "thorp"};
};
