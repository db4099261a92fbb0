#pragma once
#include <string>
#include <vector>

#include "types/Csv.hpp"

namespace insonify::acoustics {

/** A measured curve: y over ascending x, with straight lines between its points. */
struct Curve {
    std::vector<double> x, y;

    /** That of the nearer end outside. */
    double at(double where) const;
};

/** Reads a CSV file of two columns under their names, the first ascending.
 *  @throws types::ConfigError with file, line and column of all that is wrong. */
Curve readCurve(const std::string& file, const types::CsvColumn& x, const types::CsvColumn& y);

}  // namespace insonify::acoustics
