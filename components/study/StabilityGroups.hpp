#pragma once
// The groups of ACOUSTICS.md 11, a file each.
#include <vector>

#include "components/study/StabilityStudy.hpp"

namespace insonify::study {

std::vector<StabilityCase> precisionCases();  ///< Ranges, world offsets, grazing, huge triangles: 1 to 7, 13 to 16.
std::vector<StabilityCase> geometryCases();   ///< Damaged and odd geometry: 5, 6, 8, 10 to 12, 17, 19.
std::vector<StabilityCase> sceneFileCases();  ///< What a file may hold: 9, 10, 18, 20, 36.
std::vector<StabilityCase> sensorCases();     ///< Fans and beams: 21 to 24, 30, 52.
std::vector<StabilityCase> rangeCases();      ///< Range bins and water: 24 to 29.
std::vector<StabilityCase> levelCases();      ///< Dynamic range: 32 to 40.
std::vector<StabilityCase> sumCases();        ///< Sums, order, buffers, devices: 41 to 44, 53 to 55.
std::vector<StabilityCase> noiseCases();      ///< Seeds and shapes of speckle: 47, 48.
std::vector<StabilityCase> laterCases();      ///< What waits for effects: 31, 38.

}  // namespace insonify::study
