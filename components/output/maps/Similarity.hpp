#pragma once
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

/** Returns the mean structural similarity of two pings of the same shape: SSIM of Wang et al. 2004, a Gaussian window
 *  of 11 x 11 with a deviation of 1.5, constants 0.01 and 0.03. Compares their log-compressed levels of 8 bits, beams
 *  by bins, not bent into a fan, so that each echo counts once. 1: equal, 0: nothing in common.
 *  @param display range and scale; without a reference level both use that of the first ping */
double structuralSimilarity(const types::Sonar& reference, const types::Sonar& other, DisplayConfig display);

/** Returns a ping's level of the brightest colour, as in LevelScale [dB]. */
double referenceLevel(const types::Sonar& ping, const DisplayConfig& display);

}  // namespace insonify::output
