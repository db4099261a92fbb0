#pragma once
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace insonify::types {

/** What a column of a CSV file is called, and what its numbers may be. */
struct CsvColumn {
    std::string name;
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
};

/** What is wrong with a row whose numbers are good, and at which of its columns. */
struct CsvDiagnostic {
    size_t column;
    std::string message;
};

/** Tells what is wrong with a row; `before` is the row of good numbers before it, null for the first. */
using CsvJudge =
    std::function<std::vector<CsvDiagnostic>(const std::vector<double>& row, const std::vector<double>* before)>;

/** The rows of a CSV file of numbers, in order. Its first line that is not blank has the names of all columns. A byte
 *  order mark, carriage returns, spaces about numbers and blank lines are passed over.
 *  @throws ConfigError with file, line and column of everything that is wrong, up to a hundred: another header, fields
 *  that are missing, too many, or no numbers from min to max, what `judge` tells, fewer than `least` rows */
std::vector<std::vector<double>> readCsv(const std::filesystem::path& file, const std::vector<CsvColumn>& columns,
                                         size_t least, const CsvJudge& judge = {});

}  // namespace insonify::types
