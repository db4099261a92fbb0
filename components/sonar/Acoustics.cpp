#include "components/sonar/Acoustics.hpp"

namespace insonify::sonar {

acoustics::Absorption makeAbsorption(const SonarConfig& config) {
    if (!config.absorption) return {};
    const AbsorptionConfig& absorption = *config.absorption;
    if (absorption.db_per_m) return {*absorption.db_per_m};
    return {acoustics::absorptionDbPerM(absorption.law, config.absorbedKhz().value(), config.water.value())};
}

}  // namespace insonify::sonar
