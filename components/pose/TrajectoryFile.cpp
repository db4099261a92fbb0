#include <cmath>

#include "components/pose/Trajectory.hpp"
#include "types/Csv.hpp"

namespace insonify::pose {
namespace {

constexpr double shortest_quaternion = 1e-6;

glm::dquat orientationOf(const std::vector<double>& row) { return {row[4], row[5], row[6], row[7]}; }

std::vector<types::CsvDiagnostic> judge(const std::vector<double>& row, const std::vector<double>* before) {
    std::vector<types::CsvDiagnostic> diagnostics;
    if (before && !(row[0] > before->front()))
        diagnostics.push_back({0, "is not after the line before; times must increase"});
    const double length = glm::length(orientationOf(row));
    if (!(length >= shortest_quaternion) || !std::isfinite(length))
        diagnostics.push_back({4, "starts a quaternion of no usable length; it must be about 1"});
    return diagnostics;
}

}  // namespace

Trajectory Trajectory::fromCsv(const std::filesystem::path& file, bool smooth) {
    static const std::vector<types::CsvColumn> columns{{"time"}, {"x"}, {"y"}, {"z"}, {"qw"}, {"qx"}, {"qy"}, {"qz"}};
    std::vector<Stamp> stamps;
    for (const std::vector<double>& row : types::readCsv(file, columns, 1, judge)) {
        const glm::dquat orientation = orientationOf(row);
        stamps.push_back({row[0], {row[1], row[2], row[3]}, orientation / glm::length(orientation)});
    }
    return Trajectory(std::move(stamps), smooth);
}

}  // namespace insonify::pose
