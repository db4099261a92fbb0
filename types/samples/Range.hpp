#pragma once
#include <cmath>
#include <limits>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::types {

/** The range along the axis of a sonar with one beam. Rock has no type for it; the fields are those of ROS's
 *  sensor_msgs/Range. */
struct Range {
    static constexpr const char* type_name = "/insonify/Range";
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();      ///< Nothing is in range.
    static constexpr double too_near = -std::numeric_limits<double>::infinity();  ///< Nearer than range_min (REP 117).

    Time time;
    double range = none;
    double range_min = 0;
    double range_max = 0;
    Angle field_of_view;

    bool isKnown() const { return std::isfinite(range); }

    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the range was true in the world"}, self.time);
        visit({"range", "m", "to the first return; NaN: there is none; -inf: it is nearer than range_min"}, self.range);
        visit({"range_min", "m", "min range of returns"}, self.range_min);
        visit({"range_max", "m", "max range of returns"}, self.range_max);
        visit({"field_of_view", "rad", "opening of the beam"}, self.field_of_view);
    }
};

}  // namespace insonify::types
