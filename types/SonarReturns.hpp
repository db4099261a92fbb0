#pragma once
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "types/Angle.hpp"
#include "types/SonarTruth.hpp"
#include "types/Time.hpp"

namespace insonify::types {

/** Where each beam of a ping is met: its first return and its strongest. NaN where a beam has none. */
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

    /** Fills it from a ping and its truth, which has its shape. The first return is the nearest bin that shows an
     *  object, the strongest the one with the greatest echo, which may be a sidelobe's or the water's: then its
     *  elevation is NaN. A range is the bin's middle; levels are 10 log10 of the bin. Allocates nothing when it had as
     *  many beams. */
    void take(const Sonar& ping, const SonarTruth& truth);

    std::vector<size_t> shape() const { return {bearings.size()}; }
    /** What is wrong with the lists, after "a sample"; null: nothing. */
    const char* diagnostic() const;

    /** The lists of numbers that have a place for each beam, with what arrays hold of them. */
    template <class Self, class Visit>
    static void forEachArray(Self& self, Visit&& visit) {
        constexpr std::type_identity<float> number;
        visit("first_range", self.first_range, number);
        visit("first_level", self.first_level, number);
        visit("first_elevation", self.first_elevation, number);
        visit("strongest_range", self.strongest_range, number);
        visit("strongest_level", self.strongest_level, number);
        visit("strongest_elevation", self.strongest_elevation, number);
    }
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"time", "us", "when the ping was true in the world"}, self.time);
        visit(Field{"bearings", "rad", "centre of each beam, 0 ahead, positive to port"}, self.bearings);
        visit(Field{"first_range", "m", "slant range of the nearest bin that shows an object"}, self.first_range);
        visit(Field{"first_level", "dB", "10 log10 of that bin"}, self.first_level);
        visit(Field{"first_elevation", "rad", "from which its echo comes, positive up"}, self.first_elevation);
        visit(Field{"strongest_range", "m", "slant range of the bin with the greatest echo"}, self.strongest_range);
        visit(Field{"strongest_level", "dB", "10 log10 of that bin"}, self.strongest_level);
        visit(Field{"strongest_elevation", "rad", "from which its echo comes; NaN: of no object in the beam"},
              self.strongest_elevation);
    }
};
using SonarReturnsPtr = std::shared_ptr<const SonarReturns>;

}  // namespace insonify::types
