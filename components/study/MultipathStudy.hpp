#pragma once
#include <string>
#include <vector>

#include "components/study/ErrorAnalysis.hpp"

namespace insonify::study {

/** What a sonar hears beside what it should. */
struct HeardPoint {
    double x, heard, expected;
};
struct HeardCurve {
    std::string name, title, x_label, y_label;
    std::vector<HeardPoint> points;

    double worst() const;  ///< Largest difference.
};

struct MultipathResult {
    std::vector<HeardCurve> curves;
    std::vector<Claim> claims;
};

/** Echoes by way of mirrors against the image method and the target strengths of corner reflectors (ACOUSTICS.md 5.23,
 *  5.25): a point target and a flat bottom under a flat surface, a target beside a wall, a dihedral and trihedrals that
 *  are turned; and what none of it may change, the first echo. */
MultipathResult studyMultipath();

std::string csvOf(const MultipathResult& result);  ///< curve,x,heard,expected.

}  // namespace insonify::study
