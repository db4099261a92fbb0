#pragma once
// The groups of ACOUSTICS.md 11, a file each.
#include <vector>

#include "components/study/StabilityStudy.hpp"

namespace insonify::study {

std::vector<StabilityCase> precisionCases();  ///< Ranges, world offsets, grazing: 1 to 4, 7, 13 to 16, 60.
std::vector<StabilityCase> geometryCases();   ///< Odd geometry: 5, 6, 12, 17, 56.
std::vector<StabilityCase> sensorCases();     ///< Fans and beams: 21, 23, 30.
std::vector<StabilityCase> rangeCases();      ///< Range bins: 24, 25, 27.
std::vector<StabilityCase> levelCases();      ///< Dynamic range: 32, 33, 35, 36, 39, 40.
std::vector<StabilityCase> sumCases();        ///< Sums, devices, sizes: 41, 44, 55, 58.
std::vector<StabilityCase> noiseCases();      ///< Seeds and shapes of speckle: 47, 48.
std::vector<StabilityCase> patternCases();    ///< Beam patterns and pulses: 31, 59.
std::vector<StabilityCase> lobeCases();       ///< Specular lobes: 38, 39.

}  // namespace insonify::study
