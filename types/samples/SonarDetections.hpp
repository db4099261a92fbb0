#pragma once
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::types {

/** The return that a multibeam sonar detects in each of its beams, in its own frame. NaN for a beam without one.
 *
 *  Beam k looks along (cos e cos b, cos e sin b, sin e) of the sonar frame (x ahead, y to port, z up), by its bearing b
 *  and its elevation e. */
struct SonarDetections {
    static constexpr const char* type_name = "/insonify/SonarDetections";
    static constexpr bool shared = true;  ///< Travels by reference, see Carried.

    Time time;
    float speed_of_sound = 0;
    Angle beam_width;   ///< NaN: unknown.
    Angle beam_height;  ///< NaN: unknown.
    std::vector<Angle> bearings;
    std::vector<float> elevations;
    std::vector<float> travel_times;
    std::vector<float> intensities;

    static constexpr double no_return = std::numeric_limits<double>::infinity();  ///< As the range of a beam.

    /** Sets what the detections of a ping have in common, without beams. */
    void copyPing(const Sonar& ping) {
        clear();
        time = ping.time;
        speed_of_sound = ping.speed_of_sound;
        beam_width = ping.beam_width;
        beam_height = ping.beam_height;
    }
    void clear() { bearings.clear(), elevations.clear(), travel_times.clear(), intensities.clear(); }
    void reserve(size_t beams) {
        bearings.reserve(beams), elevations.reserve(beams), travel_times.reserve(beams), intensities.reserve(beams);
    }
    /** Adds a beam. @param range slant range of its return; not finite: it has none [m] */
    void add(Angle bearing, Angle elevation, double range, float intensity) {
        const bool is_found = std::isfinite(range);
        bearings.push_back(bearing);
        elevations.push_back(static_cast<float>(elevation.rad));
        travel_times.push_back(is_found ? static_cast<float>(2 * range / static_cast<double>(speed_of_sound))
                                        : std::numeric_limits<float>::quiet_NaN());
        intensities.push_back(is_found ? intensity : 0);
    }

    std::vector<size_t> shape() const { return {bearings.size()}; }
    /** Returns the error of the lists, as the rest of a sentence after "a sample"; null when there is none. */
    const char* diagnostic() const {
        const size_t beams = bearings.size();
        return elevations.size() == beams && travel_times.size() == beams && intensities.size() == beams
                   ? nullptr
                   : "has other numbers of detections than bearings";
    }
    /** Calls `visit` for the lists with a number for each beam, with the type of the numbers in files. */
    static void forEachArray(auto& self, auto&& visit) {
        visit("elevation", self.elevations, std::type_identity<float>{});
        visit("travel_time", self.travel_times, std::type_identity<float>{});
        visit("intensity", self.intensities, std::type_identity<float>{});
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the ping was true in the world"}, self.time);
        visit({"speed_of_sound", "m/s", "by which travel times are ranges: range = travel_time * speed_of_sound / 2"},
              self.speed_of_sound);
        visit({"beam_width", "rad", "in azimuth, half power; NaN: unknown"}, self.beam_width);
        visit({"beam_height", "rad", "in elevation, half power; NaN: unknown"}, self.beam_height);
        visit({"bearings", "rad", "centre of each beam, 0 ahead, positive to port"}, self.bearings);
        visit({"elevations", "rad", "centre of each beam, positive up"}, self.elevations);
        visit({"travel_times", "s", "two-way, of each beam's return; NaN: there is none"}, self.travel_times);
        visit({"intensities", "1", "strongest bin of each beam's return; 0: there is none"}, self.intensities);
    }
};
using SonarDetectionsPtr = std::shared_ptr<const SonarDetections>;

}  // namespace insonify::types
