#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "components/pose/Trajectory.hpp"
#include "types/ConfigError.hpp"

namespace insonify::pose {
namespace {

constexpr std::string_view header = "time,x,y,z,qw,qx,qy,qz";
constexpr std::array names = {"time", "x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr double shortest_quaternion = 1e-6;
constexpr size_t max_diagnostics = 100;

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? text.substr(0, 0) : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/** Reads line by line and collects every fault. */
class Reader {
public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    std::vector<Trajectory::Stamp> read(std::string_view text) {
        if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
        while (!text.empty() && diagnostics_.size() < max_diagnostics) {
            const size_t end = std::min(text.find('\n'), text.size());
            ++line_number_;
            readLine(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (!has_header_)
            report(1, "", "is empty; it must start with the header " + std::string(header));
        else if (stamps_.empty() && diagnostics_.empty())
            report(1, "", "has no line after its header; it needs at least one");
        if (!diagnostics_.empty()) throw types::ConfigError(std::move(diagnostics_));
        return std::move(stamps_);
    }

private:
    void readLine(std::string_view line) {
        if (trimmed(line).empty()) return;
        if (has_header_) return readStamp(line);
        has_header_ = true;
        if (trimmed(line) != header)
            report(1, "",
                   "is '" + std::string(trimmed(line).substr(0, 80)) + "'; the header must be " + std::string(header));
    }

    void readStamp(std::string_view line) {
        std::array<double, names.size()> values{};
        std::array<int, names.size()> columns{};
        if (!readFields(line, values, columns)) return;
        const auto [time, x, y, z, qw, qx, qy, qz] = values;
        if (has_time_ && !(time > last_time_))
            report(columns[0], "time", "is not after the line before; times must increase");
        has_time_ = true;
        last_time_ = time;
        const glm::dquat orientation(qw, qx, qy, qz);
        const double length = glm::length(orientation);
        if (!(length >= shortest_quaternion) || !std::isfinite(length))
            return report(columns[4], "qw", "starts a quaternion of no usable length; it must be about 1");
        stamps_.push_back({time, {x, y, z}, orientation / length});
    }

    bool readFields(std::string_view line, std::array<double, names.size()>& values,
                    std::array<int, names.size()>& columns) {
        const size_t faults_before = diagnostics_.size();
        size_t begin = 0;
        for (size_t i = 0; i < names.size(); ++i) {
            if (begin > line.size()) {
                report(static_cast<int>(line.size()) + 1, names[i],
                       "is missing; a line has " + std::to_string(names.size()) + " fields");
                return false;
            }
            const size_t end = std::min(line.find(',', begin), line.size());
            columns[i] = static_cast<int>(begin) + 1;
            readNumber(line.substr(begin, end - begin), columns[i], names[i], values[i]);
            begin = end + 1;
        }
        if (begin <= line.size())
            report(static_cast<int>(begin) + 1, "", "has too many fields; a line has " + std::to_string(names.size()));
        return diagnostics_.size() == faults_before;
    }

    void readNumber(std::string_view field, int column, const char* name, double& value) {
        const std::string_view text = trimmed(field);
        const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (code == std::errc() && stop == text.data() + text.size() && std::isfinite(value)) return;
        report(column, name, "is '" + std::string(text.substr(0, 40)) + "'; it must be a finite number");
    }

    void report(int column, std::string path, std::string message) {
        diagnostics_.push_back({std::move(path), std::move(message), file_, line_number_, column});
    }

    std::string file_;
    types::Diagnostics diagnostics_;
    std::vector<Trajectory::Stamp> stamps_;
    int line_number_ = 0;
    bool has_header_ = false, has_time_ = false;
    double last_time_ = 0;
};

}  // namespace

Trajectory Trajectory::fromCsv(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file))
        throw types::ConfigError(file.string(), "",
                                 "cannot be read; it must be a CSV file with header " + std::string(header));
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return Trajectory(Reader(file.string()).read(text));
}

}  // namespace insonify::pose
