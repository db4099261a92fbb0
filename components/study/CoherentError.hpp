#pragma once
#include "components/study/ErrorStudy.hpp"

namespace insonify::study {

/** Measures the error of pings with coherent speckle against energies: of their mean over many poses, for each of at
 *  most three qualities.
 *
 *  A single ping differs by its speckle, which is not an error. So the poses are divided into two halves with
 *  independent speckle. Their means are A and B, those of the energies R and S. The squared error is (A - R)(B - S) /
 *  (R S), summed over bins; the mean contribution of speckle to it is zero. Its random contribution, the root of the
 *  sum of the squared products, is reported as the reference's own error. Smaller errors are reported as that. */
void studyCoherent(const StudyScene& scene, const ErrorOptions& options, int min_rows, int base_columns,
                   ErrorResult& result);

}  // namespace insonify::study
