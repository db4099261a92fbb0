#pragma once
#include <vector>

#include "components/study/ErrorAnalysis.hpp"

namespace insonify::study {

/** What is promised of a sonar with `speckle: {coherent: true}` over a level bottom: it stands still with the scene, is
 *  Rayleigh's for many scatterers and K's for few, of a shape that goes as the range, is shared by neighbouring bins
 *  and beams as pulse and pattern say, and is lost as the sonar moves aside by parts of its aperture. Takes some
 *  seconds, and rays. */
std::vector<Claim> coherentClaims();

}  // namespace insonify::study
