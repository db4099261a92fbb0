#include "types/text/Csv.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numeric>
#include <string_view>
#include <system_error>
#include <utility>

#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::types {
namespace {

constexpr size_t max_diagnostics = 100;

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? text.substr(0, 0) : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string makeHeader(const std::vector<CsvColumn>& columns) {
    std::string header;
    for (const CsvColumn& column : columns) header += (header.empty() ? "" : ",") + column.name;
    return header;
}

/** Returns "a finite number", or a text such as "a number from 0 to 90". */
std::string describeWanted(const CsvColumn& column) {
    if (std::isinf(column.min) && std::isinf(column.max)) return "a finite number";
    char text[80];
    std::snprintf(text, sizeof text, "a number from %g to %g", column.min, column.max);
    return text;
}

/** Reads line by line and collects all errors. */
class Reader {
public:
    Reader(std::string file, const TableForm& form, const CsvValidator& validate)
        : file_(std::move(file)),
          form_(form),
          columns_(form.columns),
          validate_(validate),
          fields_(columns_.size()),
          order_(fields_) {
        has_header_ = form.header == TableForm::Header::None;
        std::iota(order_.begin(), order_.end(), size_t{0});
    }

    std::vector<std::vector<double>> read(std::string_view text, size_t minimum) {
        while (!text.empty() && diagnostics_.size() < max_diagnostics) {
            const size_t end = std::min(text.find('\n'), text.size());
            ++line_number_;
            readLine(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (!has_header_)
            report(1, "", "is empty; it must start with the header " + makeHeader(columns_));
        else if (rows_.size() < minimum && diagnostics_.empty())
            report(1, "",
                   "has " + std::to_string(rows_.size()) +
                       (form_.header == TableForm::Header::None ? " lines of numbers" : " lines after its header") +
                       "; it needs at least " + std::to_string(minimum));
        if (!diagnostics_.empty()) throw ConfigError(std::move(diagnostics_));
        return std::move(rows_);
    }

private:
    void readLine(std::string_view line) {
        if (trimmed(line).empty()) return;
        const bool is_commented = form_.header != TableForm::Header::Line;
        if (has_header_ && is_commented && trimmed(line).front() == '#') return;
        if (has_header_) return readRow(line);
        has_header_ = true;
        const std::vector<std::string> names = namesIn(line, is_commented);
        fields_ = names.size();
        for (size_t i = 0; i < columns_.size(); ++i) {
            const auto found = std::ranges::find(names, columns_[i].name);
            if (found == names.end() || std::find(found + 1, names.end(), *found) != names.end()) return refuse(line);
            order_[i] = static_cast<size_t>(found - names.begin());
        }
        if (is_commented && trimmed(line).front() != '#') refuse(line);
    }

    void refuse(std::string_view header) {
        report(1, "",
               "is '" + std::string(trimmed(header).substr(0, 80)) + "'; the header must " +
                   (form_.header == TableForm::Header::Line ? "have " : "begin with #") + makeHeader(columns_));
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
        const std::string count = "a line has " + std::to_string(fields_);
        std::vector<std::pair<size_t, size_t>> fields;  // where each begins and ends
        for (size_t begin = skipped(line, 0); begin <= line.size(); begin = skipped(line, fields.back().second + 1))
            fields.emplace_back(begin, std::min(line.find_first_of(separators(), begin), line.size()));
        for (size_t i = 0; i < columns_.size(); ++i) {
            if (order_[i] >= fields.size()) {
                report(static_cast<int>(line.size()) + 1, columns_[i].name, "is missing; " + count + " fields");
                return false;
            }
            const auto [begin, end] = fields[order_[i]];
            places[i] = static_cast<int>(begin) + 1;
            readNumber(line.substr(begin, end - begin), places[i], columns_[i], values[i]);
        }
        if (fields.size() > fields_ && form_.header != TableForm::Header::Comment)
            report(static_cast<int>(fields[fields_].first) + 1, "", "has too many fields; " + count);
        return diagnostics_.size() == before;
    }

    const char* separators() const { return form_.separator == ' ' ? " \t\r" : ","; }

    /** Returns where the next field begins; behind the line: there is none. */
    size_t skipped(std::string_view line, size_t begin) const {
        if (form_.separator != ' ' || begin > line.size()) return begin;
        const size_t next = line.find_first_not_of(separators(), begin);
        return next == line.npos ? line.size() + 1 : next;
    }

    /** Returns the names of a header without spaces and quotes; of a commented one without its mark and the units in
     *  brackets, which are those of its format. */
    static std::vector<std::string> namesIn(std::string_view line, bool is_commented) {
        std::vector<std::string> names(1);
        bool is_unit = false;
        for (const char c : trimmed(line)) {
            is_unit |= is_commented && c == '[';
            if (c == ',' && !is_unit)
                names.emplace_back();
            else if (!is_unit &&
                     std::string_view(is_commented ? " \t\r\"#" : " \t\r\"").find(c) == std::string_view::npos)
                names.back() += c;
            is_unit &= c != ']';
        }
        return names;
    }

    void readNumber(std::string_view field, int place, const CsvColumn& column, double& value) {
        std::string_view text = trimmed(field);
        if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
        const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_number = code == std::errc() && stop == text.data() + text.size() && std::isfinite(value);
        if (is_number && value >= column.min && value <= column.max) return;
        report(place, column.name,
               "is '" + std::string(text.substr(0, 40)) + "'; it must be " + describeWanted(column));
    }

    void report(int place, std::string path, std::string message) {
        diagnostics_.push_back({std::move(path), std::move(message), file_, line_number_, place});
    }

    std::string file_;
    const TableForm& form_;
    const std::vector<CsvColumn>& columns_;
    const CsvValidator& validate_;
    size_t fields_;                          ///< Of a line.
    std::vector<size_t> order_;              ///< The field of each column.
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

std::vector<std::vector<double>> readTable(const std::filesystem::path& file,
                                           const std::function<TableForm(std::string_view)>& form, size_t minimum,
                                           const CsvValidator& validate) {
    const auto wanted = [&] { return "must be a CSV file with header " + makeHeader(form("").columns); };
    std::ifstream stream(file, std::ios::binary);
    if (std::error_code error; !stream && !std::filesystem::exists(file, error))
        throw ConfigError(file.string(), "",
                          "does not exist; " + offerCurrentFolder(file) +
                              didYouMean(file.filename().string(), csvFilesNextTo(file)) + wanted());
    if (!stream || std::filesystem::is_directory(file))
        throw ConfigError(file.string(), "", "cannot be read" + permissionReason(errno) + "; it " + wanted());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (isUtf16(text)) throw ConfigError(file.string(), "", utf16_refusal);
    const std::string_view content = std::string_view(text).substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
    const TableForm written = form(content);
    return Reader(file.string(), written, validate).read(content, minimum);
}

std::vector<std::vector<double>> readCsv(const std::filesystem::path& file, const std::vector<CsvColumn>& columns,
                                         size_t minimum, const CsvValidator& validate) {
    return readTable(
        file, [&](std::string_view) { return TableForm{columns}; }, minimum, validate);
}

}  // namespace insonify::types
