#include "types/Csv.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "types/ConfigError.hpp"
#include "types/DidYouMean.hpp"

namespace insonify::types {
namespace {

constexpr size_t max_diagnostics = 100;

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? text.substr(0, 0) : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string headerOf(const std::vector<CsvColumn>& columns) {
    std::string header;
    for (const CsvColumn& column : columns) header += (header.empty() ? "" : ",") + column.name;
    return header;
}

/** Returns "a finite number", or a text such as "a number from 0 to 90". */
std::string wantedOf(const CsvColumn& column) {
    if (std::isinf(column.min) && std::isinf(column.max)) return "a finite number";
    char text[80];
    std::snprintf(text, sizeof text, "a number from %g to %g", column.min, column.max);
    return text;
}

/** Reads line by line and collects all errors. */
class Reader {
public:
    Reader(std::string file, const std::vector<CsvColumn>& columns, const CsvValidator& validate)
        : file_(std::move(file)), columns_(columns), validate_(validate) {}

    std::vector<std::vector<double>> read(std::string_view text, size_t minimum) {
        if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
        while (!text.empty() && diagnostics_.size() < max_diagnostics) {
            const size_t end = std::min(text.find('\n'), text.size());
            ++line_number_;
            readLine(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (!has_header_)
            report(1, "", "is empty; it must start with the header " + headerOf(columns_));
        else if (rows_.size() < minimum && diagnostics_.empty())
            report(1, "",
                   "has " + std::to_string(rows_.size()) + " lines after its header; it needs at least " +
                       std::to_string(minimum));
        if (!diagnostics_.empty()) throw ConfigError(std::move(diagnostics_));
        return std::move(rows_);
    }

private:
    void readLine(std::string_view line) {
        if (trimmed(line).empty()) return;
        if (has_header_) return readRow(line);
        has_header_ = true;
        if (trimmed(line) == headerOf(columns_)) return;
        report(1, "",
               "is '" + std::string(trimmed(line).substr(0, 80)) + "'; the header must be " + headerOf(columns_));
        throw ConfigError(std::move(diagnostics_));  // the lines have other columns: their errors would be consequences
    }

    void readRow(std::string_view line) {
        std::vector<double> values(columns_.size());
        std::vector<int> places(columns_.size());
        if (!readFields(line, values, places)) return;
        if (validate_)
            for (const CsvDiagnostic& diagnostic : validate_(values, rows_.empty() ? nullptr : &rows_.back()))
                report(places[diagnostic.column], columns_[diagnostic.column].name, diagnostic.message);
        rows_.push_back(std::move(values));
    }

    bool readFields(std::string_view line, std::vector<double>& values, std::vector<int>& places) {
        const size_t before = diagnostics_.size();
        const std::string count = "a line has " + std::to_string(columns_.size());
        size_t begin = 0;
        for (size_t i = 0; i < columns_.size(); ++i) {
            if (begin > line.size()) {
                report(static_cast<int>(line.size()) + 1, columns_[i].name, "is missing; " + count + " fields");
                return false;
            }
            const size_t end = std::min(line.find(',', begin), line.size());
            places[i] = static_cast<int>(begin) + 1;
            readNumber(line.substr(begin, end - begin), places[i], columns_[i], values[i]);
            begin = end + 1;
        }
        if (begin <= line.size()) report(static_cast<int>(begin) + 1, "", "has too many fields; " + count);
        return diagnostics_.size() == before;
    }

    void readNumber(std::string_view field, int place, const CsvColumn& column, double& value) {
        const std::string_view text = trimmed(field);
        const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_number = code == std::errc() && stop == text.data() + text.size() && std::isfinite(value);
        if (is_number && value >= column.min && value <= column.max) return;
        report(place, column.name, "is '" + std::string(text.substr(0, 40)) + "'; it must be " + wantedOf(column));
    }

    void report(int place, std::string path, std::string message) {
        diagnostics_.push_back({std::move(path), std::move(message), file_, line_number_, place});
    }

    std::string file_;
    const std::vector<CsvColumn>& columns_;
    const CsvValidator& validate_;
    std::vector<std::vector<double>> rows_;  ///< Rows of valid numbers, with or without errors from `validate_`.
    Diagnostics diagnostics_;
    int line_number_ = 0;
    bool has_header_ = false;
};

/** Returns the names of the CSV files in a file's folder, in order. */
std::vector<std::string> csvFilesNextTo(const std::filesystem::path& file) {
    std::vector<std::string> names;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(
             file.has_parent_path() ? file.parent_path() : std::filesystem::path("."), unreadable))
        if (entry.path().extension() == ".csv") names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

}  // namespace

std::vector<std::vector<double>> readCsv(const std::filesystem::path& file, const std::vector<CsvColumn>& columns,
                                         size_t minimum, const CsvValidator& validate) {
    std::ifstream stream(file, std::ios::binary);
    if (std::error_code error; !stream && !std::filesystem::exists(file, error))
        throw ConfigError(file.string(), "",
                          "does not exist; " + didYouMean(file.filename().string(), csvFilesNextTo(file)) +
                              "must be a CSV file with header " + headerOf(columns));
    if (!stream || std::filesystem::is_directory(file))
        throw ConfigError(
            file.string(), "",
            "cannot be read" + permissionReason(errno) + "; it must be a CSV file with header " + headerOf(columns));
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return Reader(file.string(), columns, validate).read(text, minimum);
}

}  // namespace insonify::types
