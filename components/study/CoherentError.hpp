#pragma once
#include "components/study/ErrorStudy.hpp"

namespace insonify::study {

/** Pings with coherent speckle against energies: their mean over many poses, for each of at most three qualities.
 *
 *  One such ping is off by its speckle, which is no error. So the poses are parted into two halves, whose speckle has
 *  nothing in common: of their means A and B and of those of the energies, R and S, the square of the error is
 *  (A - R)(B - S) / (R S), summed over bins, to which speckle adds nothing in the mean. What it adds by chance, the
 *  root of the sum of the squared products, is told as the reference's own error; smaller errors count as that. */
void studyCoherent(const StudyScene& scene, const ErrorOptions& options, int min_rows, int base_columns,
                   ErrorResult& result);

}  // namespace insonify::study
