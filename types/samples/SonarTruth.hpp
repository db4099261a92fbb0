#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::types {

/** The truth of the bins of a ping: the object that returned the echo of each bin, its elevation, and the grazing
 *  angle. If most of a bin's energy arrived by a mirror, these are the object seen in the mirror, and the direction of
 *  arrival. If most of it is volume reverberation, the bin has path 6, object -1, and the water's share.
 *
 *  Beam-first as the ping's bins: the values of bin k of beam b are at [b * bin_count + k]. A bin without an echo has
 *  object -1, share 0, no hits, and NaN for its angles. */
struct SonarTruth : RangeBins {
    static constexpr const char* type_name = "/insonify/SonarTruth";
    static constexpr bool shared = true;  ///< Travels by reference, see Carried.

    static constexpr int32_t no_object = -1;
    static constexpr uint8_t through_wall = 4, rung = 5, water = 6;

    Time time;
    uint32_t bin_count = 0;
    uint32_t beam_count = 0;
    std::vector<Angle> bearings;
    std::vector<std::string> objects;
    std::vector<float> elevation;
    std::vector<int32_t> object;
    std::vector<float> share;
    std::vector<uint32_t> hits;
    std::vector<float> grazing;
    std::vector<uint8_t> path;
    std::vector<uint8_t> shadow;

    std::vector<size_t> shape() const { return {beam_count, bin_count}; }
    /** Returns whether most of a bin's energy arrived by the water surface or another mirror. */
    bool isByMirror(size_t bin) const { return path[bin] != 0 && path[bin] < through_wall; }
    /** Copies the grid of a ping, and resizes the lists to its bins. Allocates nothing when the shape has not
     *  changed. */
    void copyGrid(const Sonar& ping);
    /** Returns the error of the lists, as the rest of a sentence after "a sample"; null when there is none. */
    const char* diagnostic() const;

    /** Calls `visit` for the lists with a number for each bin, with the type of the numbers in files. */
    static void forEachArray(auto& self, auto&& visit) {
        visit("elevation", self.elevation, std::type_identity<float>{});
        visit("object", self.object, std::type_identity<int32_t>{});
        visit("share", self.share, std::type_identity<float>{});
        visit("hits", self.hits, std::type_identity<uint32_t>{});
        visit("grazing", self.grazing, std::type_identity<float>{});
        visit("path", self.path, std::type_identity<uint8_t>{});
        visit("shadow", self.shadow, std::type_identity<bool>{});
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the ping was true in the world"}, self.time);
        visit({"bin_duration", "us", "one-way travel time through one bin"}, self.bin_duration);
        describeSpeed(self, visit);
        visit({"bin_count", "1", "bins per beam"}, self.bin_count);
        visit({"beam_count", "1", "beams"}, self.beam_count);
        visit({"bearings", "rad", "centre of each beam, 0 ahead, positive to port"}, self.bearings);
        visit({"objects", "", "names of all objects of the scene"}, self.objects);
        visit({"elevation", "rad", "from which the strongest object's echo comes, positive up"}, self.elevation);
        visit({"object", "1", "that returns most of the bin's energy: index into `objects`; -1: none"}, self.object);
        visit({"share", "1", "of that object, or with path 6 of the water, in the bin's energy", 0, 1}, self.share);
        visit({"hits", "1", "samples whose echo lies in the bin"}, self.hits);
        visit({"grazing", "rad", "angle between the sound and the object's surface, pi/2: square to it"}, self.grazing);
        visit({"path", "1",
               "0: direct, 1: by the surface once, 2: twice, 3: bounced, 4: through a wall, "
               "5: rung in a wall, 6: of the water itself"},
              self.path);
        visit({"shadow", "", "1: no echo of a surface, although nearer than the beam's last such echo"}, self.shadow);
    }
};
using SonarTruthPtr = std::shared_ptr<const SonarTruth>;

inline void SonarTruth::copyGrid(const Sonar& ping) {
    time = ping.time;
    static_cast<RangeBins&>(*this) = ping;
    bin_count = ping.bin_count;
    beam_count = ping.beam_count;
    bearings = ping.bearings;
    forEachArray(*this,
                 [count = size_t{beam_count} * bin_count](const char*, auto& numbers, auto) { numbers.resize(count); });
}

inline const char* SonarTruth::diagnostic() const {
    const uint64_t count = uint64_t{beam_count} * bin_count;
    bool fits = bearings.size() == beam_count;
    forEachArray(*this, [&](const char*, const auto& numbers, auto) { fits = fits && numbers.size() == count; });
    if (!fits) return "has other numbers of bins or bearings than it says";
    for (const int32_t index : object)
        if (index < no_object || index >= static_cast<int64_t>(objects.size())) return "has an object without a name";
    return nullptr;
}

}  // namespace insonify::types
