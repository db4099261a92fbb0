#include "components/acoustics/Curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "types/ConfigError.hpp"

namespace insonify::acoustics {
namespace {

constexpr size_t max_diagnostics = 100;

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? text.substr(0, 0) : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/** Reads line by line and collects every fault. */
class Reader {
public:
    Reader(std::string file, const Column& x, const Column& y) : file_(std::move(file)), columns_{x, y} {}

    Curve read(std::string_view text) {
        if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
        while (!text.empty() && diagnostics_.size() < max_diagnostics) {
            const size_t end = std::min(text.find('\n'), text.size());
            ++line_number_;
            readLine(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (!has_header_)
            report(1, "", "is empty; it must start with the header " + header());
        else if (curve_.x.size() < 2 && diagnostics_.empty())
            report(1, "", fmt::format("has {} points; it needs at least two", curve_.x.size()));
        if (!diagnostics_.empty()) throw types::ConfigError(std::move(diagnostics_));
        return std::move(curve_);
    }

private:
    std::string header() const { return fmt::format("{},{}", columns_[0].name, columns_[1].name); }

    void readLine(std::string_view line) {
        if (trimmed(line).empty()) return;
        if (has_header_) return readPoint(line);
        has_header_ = true;
        if (trimmed(line) != header())
            report(1, "", fmt::format("is '{}'; the header must be {}", trimmed(line).substr(0, 80), header()));
    }

    void readPoint(std::string_view line) {
        const size_t comma = line.find(',');
        if (comma == line.npos || line.find(',', comma + 1) != line.npos)
            return report(1, "", fmt::format("is '{}'; a line has 2 fields", trimmed(line).substr(0, 80)));
        double x = 0, y = 0;
        const bool has_x = readNumber(line.substr(0, comma), 1, columns_[0], x);
        const bool has_y = readNumber(line.substr(comma + 1), static_cast<int>(comma) + 2, columns_[1], y);
        if (!has_x || !has_y) return;
        if (!curve_.x.empty() && !(x > curve_.x.back()))
            return report(1, columns_[0].name, "is not above that of the line before; it must increase");
        curve_.x.push_back(x);
        curve_.y.push_back(y);
    }

    bool readNumber(std::string_view field, int column, const Column& expected, double& value) {
        const std::string_view text = trimmed(field);
        const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_number = code == std::errc() && stop == text.data() + text.size();
        if (is_number && value >= expected.min && value <= expected.max) return true;
        report(column, expected.name,
               fmt::format("is '{}'; it must be a number from {:g} to {:g}", text.substr(0, 40), expected.min,
                           expected.max));
        return false;
    }

    void report(int column, std::string path, std::string message) {
        diagnostics_.push_back({std::move(path), std::move(message), file_, line_number_, column});
    }

    std::string file_;
    Column columns_[2];
    Curve curve_;
    std::vector<types::Diagnostic> diagnostics_;
    int line_number_ = 0;
    bool has_header_ = false;
};

}  // namespace

double Curve::at(double where) const {
    const auto above = std::upper_bound(x.begin(), x.end(), where);
    if (above == x.begin()) return y.front();
    if (above == x.end()) return y.back();
    const auto i = static_cast<size_t>(above - x.begin());
    return y[i - 1] + (y[i] - y[i - 1]) * (where - x[i - 1]) / (x[i] - x[i - 1]);
}

Curve readCurve(const std::string& file, const Column& x, const Column& y) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file))
        throw types::ConfigError(
            file, "", fmt::format("cannot be read; it must be a CSV file with header {},{}", x.name, y.name));
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return Reader(file, x, y).read(text);
}

}  // namespace insonify::acoustics
