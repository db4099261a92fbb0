#pragma once
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace insonify::types {

/** Name and bounds of a column of a CSV file. */
struct CsvColumn {
    std::string name;
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
};

/** An error in a row of valid numbers, and its column. */
struct CsvDiagnostic {
    size_t column;
    std::string message;
};

/** Returns the errors of a row; `before` is the previous row of valid numbers, null for the first. */
using CsvValidator =
    std::function<std::vector<CsvDiagnostic>(const std::vector<double>& row, const std::vector<double>* before)>;

/** Returns the rows of a CSV file of numbers, in order. The first line that is not blank has the names of all columns.
 *  A byte order mark, carriage returns, spaces around numbers and blank lines are ignored.
 *  @throws ConfigError with file, line and column of up to a hundred errors: a wrong header, missing or superfluous
 *  fields, fields that are no numbers from min to max, errors from `validate`, fewer than `least` rows */
std::vector<std::vector<double>> readCsv(const std::filesystem::path& file, const std::vector<CsvColumn>& columns,
                                         size_t minimum, const CsvValidator& validate = {});

}  // namespace insonify::types
