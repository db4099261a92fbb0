#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "types/Angle.hpp"
#include "types/Time.hpp"

namespace insonify::types {

/** One ping, field for field Rock's base::samples::Sonar.
 *
 *  Beam-first: the echo of beam b in bin k is bins[b * bin_count + k]. Bin k covers slant ranges
 *  [k, k + 1) * bin_duration * speed_of_sound: bin_duration is one-way time.
 *
 *  The functions are those of Rock's type, with its defects mended: see each. */
struct Sonar {
    static constexpr const char* type_name = "/base/samples/Sonar";
    static constexpr bool shared = true;   ///< Travels by reference, see Carried.
    static constexpr bool counted = true;  ///< Runs are limited to so many, and their speed is told in them.

    Time time;
    std::vector<Time> timestamps;
    Time bin_duration;
    Angle beam_width;
    Angle beam_height;
    std::vector<Angle> bearings;
    float speed_of_sound = 1497.0f;
    uint32_t bin_count = 0;
    uint32_t beam_count = 0;
    std::vector<float> bins;

    /** Whether the lists are as long as the counts say: bins beams * bins, bearings beams, timestamps beams or none. */
    bool wellShaped() const;
    /** What is wrong with the lists, after "a sample"; null: nothing. */
    const char* diagnostic() const {
        return wellShaped() ? nullptr : "has other numbers of bins or bearings than it says";
    }
    /** Throws std::logic_error that tells every diagnostic: lists of another length than the counts say; bins without a
     *  duration or a speed of sound above 0; bearings outside (-pi, pi] (NaN is unknown, and may be). Rock's validate
     *  tells the first length only, multiplies the counts in 32 bits, and looks at no value. */
    void validate() const;
    /** Why the bins cannot be linear intensities, null when they can: more or fewer than the counts say, or below 0,
     *  which decibels are. */
    const char* notIntensities() const;
    /** Takes everything of `other` but its bins, for which it makes room; allocates nothing when it had this shape. */
    void copyHeader(const Sonar& other);
    /** Bins first, as in Rock. What is new is NaN (a time stamp: null), what was there stays with its beam and bin;
     *  Rock's resize leaves the values where they lay in memory, in other beams. */
    void resize(uint32_t bins_per_beam, uint32_t beams, bool per_beam_timestamps = false);
    /** Beam k looks at start + k * interval, normalised. Rock adds up the interval and the rounding with it. */
    void setRegularBearings(Angle start, Angle interval);
    /** When the acquisition of a beam began: its own stamp, or `time`. Throws std::out_of_range where Rock reads what
     *  is not there. */
    Time beamStart(size_t beam) const;
    /** Slant range at which bin k starts [m]; k = bin_count gives the far edge. */
    double binStart(double k) const { return k * bin_duration.seconds() * static_cast<double>(speed_of_sound); }

    /** Of the stamps besides `time`. */
    template <class Visit>
    void forEachStamp(Visit&& visit) {
        for (Time& stamp : timestamps) visit(stamp);
    }
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"time", "us", "when the ping was true in the world"}, self.time);
        visit(Field{"timestamps", "us", "start of each beam's acquisition; empty: `time` for all"}, self.timestamps);
        visit(Field{"bin_duration", "us", "one-way travel time through one bin"}, self.bin_duration);
        visit(Field{"beam_width", "rad", "opening of one beam across the fan"}, self.beam_width);
        visit(Field{"beam_height", "rad", "opening of one beam along the device's z axis"}, self.beam_height);
        visit(Field{"bearings", "rad", "centre of each beam, 0 ahead, positive to port"}, self.bearings);
        visit(Field{"speed_of_sound", "m/s", "speed of sound that turns time into range"}, self.speed_of_sound);
        visit(Field{"bin_count", "1", "bins per beam"}, self.bin_count);
        visit(Field{"beam_count", "1", "beams"}, self.beam_count);
        visit(Field{"bins", "1", "linear echo strength, beam-first; NaN when unknown"}, self.bins);
    }
};
using SonarPtr = std::shared_ptr<const Sonar>;

// What the bins of pings on a port are, where one must not take the place of the other.
inline constexpr const char* reaching_receiver = "intensities that reach a receiver";
inline constexpr const char* left_receiver = "what a receiver has amplified";

}  // namespace insonify::types
