#pragma once
#include <cstdint>
#include <optional>

#include "components/sonar/config/SonarConfig.hpp"

namespace insonify::sonar {

/** Motion of a mechanically scanning head; bearings are positive to port. */
struct HeadConfig {
    double left_deg = 180;
    double right_deg = -180;
    double step_deg = 1.8;
    std::optional<bool> continuous;
    std::optional<double> speed_deg_per_s;
    bool sweeps = false;
    double error_deg = 0;

    double sectorDeg() const { return left_deg - right_deg; }
    /** Returns whether the head turns on and on, rather than back at its limits. */
    bool turnsOn() const { return continuous.value_or(sectorDeg() == 360); }

    static void describe(auto& self, auto& visit) {
        visit({"left_deg", "deg", "where a scan starts", -360, 360}, self.left_deg);
        visit({"right_deg", "deg", "where a sector scan turns back", -360, 360}, self.right_deg);
        visit({"step_deg", "deg", "turn between two pings", 0.001, 360}, self.step_deg);
        visit({"continuous", "",
               "turns on and on from left_deg, ignoring right_deg; absent: if the two are 360 deg apart"},
              self.continuous);
        visit({"speed_deg_per_s", "deg/s", "of the head; absent: unlimited", 0.001, 1e6}, self.speed_deg_per_s);
        visit({"sweeps", "", "turns evenly during each ping, needs motion_in_ping; false: stops at each step"},
              self.sweeps);
        visit({"error_deg", "deg",
               "standard deviation of where the head stands about the bearing that it states, the same at each visit; "
               "0: none",
               0, 90},
              self.error_deg);
    }
    void check(types::Diagnostics& diagnostics) const;
    friend bool operator==(const HeadConfig&, const HeadConfig&) = default;
};

/** Returns the bearing at which a head stands that states `bearing_deg` [deg]: an error of its motor's steps, drawn
 * from the normal law by the stated bearing. */
double findStandingDeg(const HeadConfig& config, double bearing_deg);

/** A sonar of one beam on a turning head. */
struct ScanningSonarConfig {
    SonarConfig sonar;
    HeadConfig head;

    ScanningSonarConfig() {
        sonar.beam_width_deg = 3;
        sonar.beam_height_deg = 35;
    }
    /** Returns the sonar with its one beam straight ahead of the head. */
    SonarConfig beam() const;

    static void describe(auto& self, auto& visit) {
        SonarConfig::describeBeam(self.sonar, visit);
        visit({"head", "", "how the head turns; absent: all round, 1.8 deg a ping"}, self.head);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Look directions of a scanning sonar's head, ping by ping. A sector scan turns from left to right and back, without a
 *  repeated ping at its ends; a continuous scan turns on to starboard. Bearings are computed from the number of steps,
 *  so they do not drift. */
class HeadScan {
public:
    explicit HeadScan(const HeadConfig& config);
    /** Returns the bearing of the current ping [deg], positive to port; in [left - 360, left] when continuous. */
    double bearingDeg() const;
    void advance();
    /** Returns the pings until the look direction and the direction of turn repeat [1]. */
    int pingsPerTurn() const;
    const HeadConfig& config() const { return config_; }
    void restart() { ping_ = 0; }

private:
    HeadConfig config_;
    int64_t steps_;     ///< From the left limit to the last position before the right limit [1].
    int64_t ping_ = 0;  ///< Pings since the start.
};

/** Returns the shortest time in which the head makes a step [s]; 0 when its speed is not limited. */
double stepDuration(const HeadConfig& config);

}  // namespace insonify::sonar
