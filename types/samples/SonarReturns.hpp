#pragma once
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::types {

/** The first and the strongest return of each beam of a ping. NaN for a beam without a return. */
struct SonarReturns {
    static constexpr const char* type_name = "/insonify/SonarReturns";
    static constexpr bool shared = true;  ///< Travels by reference, see Carried.

    Time time;
    std::vector<Angle> bearings;
    std::vector<float> first_range;
    std::vector<float> first_level;
    std::vector<float> first_elevation;
    std::vector<float> strongest_range;
    std::vector<float> strongest_level;
    std::vector<float> strongest_elevation;

    /** Fills the returns from a ping and its truth, which have the same shape. The first return is the nearest bin that
     *  shows an object. If the strongest return is from a sidelobe, its elevation is NaN. Ranges are those of the bin's
     *  middle; levels are 10 log10 of the bin. Allocates nothing when the number of beams has not changed.
     *  @param strongest number of the strongest bin of each beam; bin_count: none */
    void take(const Sonar& ping, const SonarTruth& truth, const std::vector<uint32_t>& strongest);

    std::vector<size_t> shape() const { return {bearings.size()}; }
    /** Returns the error of the lists, as the rest of a sentence after "a sample"; null when there is none. */
    const char* diagnostic() const;

    /** Calls `visit` for the lists with a number for each beam, with the type of the numbers in files. */
    static void forEachArray(auto& self, auto&& visit) {
        constexpr std::type_identity<float> number;
        visit("first_range", self.first_range, number);
        visit("first_level", self.first_level, number);
        visit("first_elevation", self.first_elevation, number);
        visit("strongest_range", self.strongest_range, number);
        visit("strongest_level", self.strongest_level, number);
        visit("strongest_elevation", self.strongest_elevation, number);
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the ping was true in the world"}, self.time);
        visit({"bearings", "rad", "centre of each beam, 0 ahead, positive to port"}, self.bearings);
        visit({"first_range", "m", "slant range of the nearest bin that shows an object"}, self.first_range);
        visit({"first_level", "dB", "10 log10 of that bin"}, self.first_level);
        visit({"first_elevation", "rad", "from which its echo comes, positive up"}, self.first_elevation);
        visit({"strongest_range", "m", "slant range of the strongest return, without spreading, ring-down and water"},
              self.strongest_range);
        visit({"strongest_level", "dB", "10 log10 of that bin"}, self.strongest_level);
        visit({"strongest_elevation", "rad", "from which its echo comes; NaN: of no object in the beam"},
              self.strongest_elevation);
    }
};
using SonarReturnsPtr = std::shared_ptr<const SonarReturns>;

}  // namespace insonify::types
