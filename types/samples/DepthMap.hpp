#pragma once
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "types/Time.hpp"

namespace insonify::types {

/** Values are Rock's. */
enum class Projection : int32_t { Polar = 0, Planar = 1 };

/** Distances by direction, field for field Rock's base::samples::DepthMap.
 *
 *  Rows are from top to bottom, columns from left to right. Polar: `vertical_interval` contains the angle of each row
 *  about y, positive down, and `horizontal_interval` the angle of each column about z, positive to port. `bin_width`
 *  is beside Rock's fields, and only in memory. */
struct DepthMap {
    static constexpr const char* type_name = "/base/samples/DepthMap";
    static constexpr bool shared = true;
    static constexpr float too_far = std::numeric_limits<float>::infinity();  ///< Rock's value for nothing in range.

    Time time;
    std::vector<Time> timestamps;
    Projection vertical_projection = Projection::Polar;
    Projection horizontal_projection = Projection::Polar;
    std::vector<double> vertical_interval;
    std::vector<double> horizontal_interval;
    uint32_t vertical_size = 0;
    uint32_t horizontal_size = 0;
    std::vector<float> distances;
    std::vector<float> remissions;
    double bin_width = 0;  ///< Of the sonar's bins, in whose middles distances are [m]; 0: unknown.

    /** Returns the unit vector of a cell of a polar map with one angle for each row and column, x ahead, y to port, z
     *  up. */
    glm::dvec3 direction(size_t row, size_t column) const {
        const double v = vertical_interval[row], h = horizontal_interval[column];
        return {std::cos(v) * std::cos(h), std::cos(v) * std::sin(h), -std::sin(v)};
    }
    const char* diagnostic() const {
        const uint64_t cells = uint64_t{vertical_size} * horizontal_size;
        if (distances.size() != cells) return "has other numbers of distances than it says";
        return remissions.empty() || remissions.size() == cells ? nullptr
                                                                : "has other numbers of remissions than of distances";
    }
    void forEachStamp(auto&& visit) {
        for (Time& stamp : timestamps) visit(stamp);
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the map was true in the world"}, self.time);
        visit({"timestamps", "us", "of rows, columns or cells; empty: `time` for all"}, self.timestamps);
        visit({"vertical_projection", "1", "0 polar, 1 planar"}, self.vertical_projection);
        visit({"horizontal_projection", "1", "0 polar, 1 planar"}, self.horizontal_projection);
        visit({"vertical_interval", "rad", "of each row or of the outermost two, positive down"},
              self.vertical_interval);
        visit({"horizontal_interval", "rad", "of each column or of the outermost two, positive to port"},
              self.horizontal_interval);
        visit({"vertical_size", "1", "rows"}, self.vertical_size);
        visit({"horizontal_size", "1", "columns"}, self.horizontal_size);
        visit({"distances", "m", "row by row; infinite: nothing in range"}, self.distances);
        visit({"remissions", "1", "strength of each return, or none"}, self.remissions);
    }
};
using DepthMapPtr = std::shared_ptr<const DepthMap>;

template <>
struct EnumTable<Projection> {
    static constexpr const char* name = "/base/samples/DepthMap/PROJECTION_TYPE";
    static constexpr EnumSymbol symbols[] = {{"POLAR", 0}, {"PLANAR", 1}};
};

}  // namespace insonify::types
