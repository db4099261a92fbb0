#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
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

/** How a table of numbers is written. */
struct TableForm {
    std::vector<CsvColumn> columns;
    /** Where the names of the columns are: in the first line, in the first line as a comment, as "#time, x [m]", or
     *  nowhere. They may be in any order and with names of other columns, which are not used; a comment's names may
     * have units. Lines that begin with # are comments, except in the first. */
    enum class Header : uint8_t { Line, Comment, None } header = Header::Line;
    char separator = ',';  ///< A space: fields are separated by spaces and tabs.
};

/** Returns the rows of a file of numbers, in order, of the columns of the form that is chosen from its text. A byte
 * order mark, carriage returns, spaces around names and numbers and blank lines are ignored. Lines may have more fields
 * than a commented header.
 *  @throws ConfigError with file, line and column of up to a hundred errors: a wrong header, missing or superfluous
 *  fields, fields that are no numbers from min to max, errors from `validate`, fewer than `least` rows */
std::vector<std::vector<double>> readTable(const std::filesystem::path& file,
                                           const std::function<TableForm(std::string_view text)>& form, size_t minimum,
                                           const CsvValidator& validate = {});

/** Returns the rows of a CSV file, as readTable(). The first line that is not blank has the names of the columns. */
std::vector<std::vector<double>> readCsv(const std::filesystem::path& file, const std::vector<CsvColumn>& columns,
                                         size_t minimum, const CsvValidator& validate = {});

}  // namespace insonify::types
