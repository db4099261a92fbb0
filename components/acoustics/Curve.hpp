#pragma once
#include <string>
#include <vector>

namespace insonify::acoustics {

/** A measured curve: y over ascending x, with straight lines between its points. */
struct Curve {
    std::vector<double> x, y;

    /** That of the nearer end outside. */
    double at(double where) const;
};

/** What a column of a file is called, and what its numbers may be. */
struct Column {
    const char* name;
    double min, max;
};

/** Reads a CSV file of two columns under their names, the first ascending.
 *  @throws types::ConfigError with file, line and column of every fault. */
Curve readCurve(const std::string& file, const Column& x, const Column& y);

}  // namespace insonify::acoustics
