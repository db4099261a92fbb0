#pragma once
#include <string>
#include <vector>

#include "components/study/error/ErrorAnalysis.hpp"

namespace insonify::study {

/** A received value and its expected value. */
struct EchoPoint {
    double x, received, expected;
};
struct EchoCurve {
    std::string name, title, x_label, y_label;
    std::vector<EchoPoint> points;

    double worst() const;  ///< Returns the max difference.
};

struct MultipathResult {
    std::vector<EchoCurve> curves;
    std::vector<Claim> claims;
};

/** Compares echoes by way of mirrors with the image method and with the target strengths of corner reflectors
 *  (ACOUSTICS.md 5.23, 5.25). Cases: a point target and a flat bottom under a flat surface, a target next to a wall,
 *  and turned dihedrals and trihedrals. The first echo must not change. */
MultipathResult studyMultipath();

std::string csv(const MultipathResult& result);  ///< Returns a row per point of each curve.

}  // namespace insonify::study
