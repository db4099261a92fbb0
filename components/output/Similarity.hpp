#pragma once
#include "components/output/PictureConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** Mean structural similarity (SSIM of Wang et al. 2004: a Gaussian window of 11 x 11 with a deviation of 1.5,
 *  constants 0.01 and 0.03) of two pings of the same shape as they are shown: their log-compressed levels of 8 bits,
 *  beams by bins, before they are bent into a fan, so that each echo counts once. 1 for the same, 0 for nothing in
 *  common.
 *  @param display its range and scale; without a reference level that of the first ping serves both. */
double structuralSimilarity(const types::Sonar& reference, const types::Sonar& other, DisplayConfig display);

/** The level that LevelScale takes for the brightest of a ping [dB]. */
double referenceLevel(const types::Sonar& ping, const DisplayConfig& display);

}  // namespace insonify::output
