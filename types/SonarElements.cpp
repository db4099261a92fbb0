#include "types/SonarElements.hpp"

namespace insonify::types {

const char* SonarElements::diagnostic() const {
    const size_t count = positions.size() * sample_count;
    if (weights.size() != positions.size()) return "has other numbers of weights than elements";
    return in_phase.size() == count && quadrature.size() == count ? nullptr
                                                                  : "has other numbers of samples than it says";
}

}  // namespace insonify::types
