#pragma once
#include <string>
#include <vector>

#include "types/Csv.hpp"

namespace insonify::acoustics {

/** A measured curve: y over ascending x, linearly interpolated. */
struct Curve {
    std::vector<double> x, y;

    /** Returns the value at `where`; outside the curve, the value of the nearer end. */
    double at(double where) const;
};

/** Reads a CSV file of two named columns, the first ascending.
 *  @throws types::ConfigError with file, line and column of every diagnostic. */
Curve readCurve(const std::string& file, const types::CsvColumn& x, const types::CsvColumn& y);

}  // namespace insonify::acoustics
