#pragma once
#include <array>
#include <optional>

#include "components/nav/ErrorModel.hpp"
#include "types/geometry/Datum.hpp"
#include "types/samples/Fix.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::nav {

/** Errors of positions by satellites, about the axes of the world. */
struct FixErrors {
    double horizontal = 0, vertical = 0;
    double wander_horizontal = 0, wander_vertical = 0;
    double wander_time = 300;

    static void describe(auto& self, auto& visit) {
        visit({"horizontal", "m", "deviation to the north, and to the west, from fix to fix", 0, 1e4}, self.horizontal);
        visit({"vertical", "m", "deviation of the height, from fix to fix", 0, 1e4}, self.vertical);
        visit({"wander_horizontal", "m", "deviation of an error to the north, and to the west, that wanders about 0", 0,
               1e4},
              self.wander_horizontal);
        visit({"wander_vertical", "m", "deviation of an error of the height that wanders about 0", 0, 1e4},
              self.wander_vertical);
        visit({"wander_time", "s", "correlation time of the errors that wander", 1e-3, 1e9}, self.wander_time);
    }
};

struct FixConfig {
    SensorConfig sensor{};
    std::optional<types::Datum> datum{};
    double water_surface = 0;
    FixErrors errors{};

    static void describe(auto& self, auto& visit) {
        SensorConfig::describe(self.sensor, visit, "of the antenna in the body", "between fixes; 0: a fix per pose");
        visit({"datum", "", "the world's origin on the earth; absent: the deployment's"}, self.datum);
        visit({"water_surface", "m", "its height in the world; below it the antenna receives nothing", -1e5, 1e5},
              self.water_surface);
        visit({"errors", "", "of the positions; absent: none"}, self.errors);
    }
};

/** A receiver of satellites with its errors. */
class FixReceiver {
public:
    explicit FixReceiver(const FixConfig& config);
    /** Returns the measured position of the antenna in the world, x north, y west, z up [m], of frame "fix" in "world",
     *  with its variance from all errors [m^2]. Position and variance are unknown below the water surface. */
    types::Pose measure(const types::Pose& antenna);

private:
    FixConfig config_;
    std::array<WanderingBias, 3> wander_;
};

/** Returns a measured position on the earth; without a solution where the position is unknown. */
types::Fix makeFix(const types::Pose& measured, const types::Datum& datum);

}  // namespace insonify::nav
