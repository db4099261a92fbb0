#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "types/Time.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/RangeBins.hpp"

namespace insonify::types {

/** One ping, field for field Rock's base::samples::Sonar.
 *
 *  Beam-first: the echo of beam b in bin k is bins[b * bin_count + k]. Bin k covers slant ranges [k, k + 1) *
 *  binWidth(), see RangeBins: bin_duration is one-way time, in whole microseconds.
 *
 *  The functions are those of Rock's type, with the corrections that are noted at each function. */
struct Sonar : RangeBins {
    static constexpr const char* type_name = "/base/samples/Sonar";
    static constexpr bool shared = true;   ///< Travels by reference, see Carried.
    static constexpr bool counted = true;  ///< Runs are limited by the number of pings, and their speed is in pings.

    Time time;
    std::vector<Time> timestamps;
    Angle beam_width;
    Angle beam_height;
    std::vector<Angle> bearings;
    uint32_t bin_count = 0;
    uint32_t beam_count = 0;
    std::vector<float> bins;

    /** Returns whether the lists match the counts: beams * bins bins, a bearing per beam, a timestamp per beam or
     *  none. */
    bool wellShaped() const;
    /** Returns the error of the lists, as the rest of a sentence after "a sample"; null when there is none. */
    const char* diagnostic() const {
        return wellShaped() ? nullptr : "has other numbers of bins or bearings than it says";
    }
    /** Throws std::logic_error with every diagnostic: lists that do not match the counts; bins without a duration or a
     *  speed of sound above 0; bearings outside (-pi, pi], except NaN, which means unknown. Rock's validate reports
     *  only the first length, multiplies the counts in 32 bits, and checks no values. */
    void validate() const;
    /** Returns why the bins cannot be linear intensities; null when they can. They do not match the counts, or are
     *  below 0, as decibels are. */
    const char* notIntensities() const;
    /** Copies everything of `other` except the values of bins, and resizes `bins`. Allocates nothing when this ping had
     *  the same shape before. */
    void copyHeader(const Sonar& other);
    /** Resizes; bins are the first argument, as in Rock. New values are NaN (time stamps: null); old values stay with
     *  their beam and bin. Rock's resize leaves values at their place in memory, which is in other beams. */
    void resize(uint32_t bins_per_beam, uint32_t beams, bool per_beam_timestamps = false);
    /** Sets the bearing of beam k to start + k * interval, normalised. Rock accumulates the interval and its
     *  rounding. */
    void setRegularBearings(Angle start, Angle interval);
    /** Returns the begin of a beam's acquisition: its own stamp, or `time`. Throws std::out_of_range where Rock reads
     *  out of bounds. */
    Time beamStart(size_t beam) const;

    /** Calls `visit` for the stamps other than `time`. */
    void forEachStamp(auto&& visit) {
        for (Time& stamp : timestamps) visit(stamp);
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the ping was true in the world"}, self.time);
        visit({"timestamps", "us", "start of each beam's acquisition; empty: `time` for all"}, self.timestamps);
        visit({"bin_duration", "us", "one-way travel time through one bin"}, self.bin_duration);
        visit({"beam_width", "rad", "opening of one beam across the fan"}, self.beam_width);
        visit({"beam_height", "rad", "opening of one beam along the device's z axis"}, self.beam_height);
        visit({"bearings", "rad", "centre of each beam, 0 ahead, positive to port"}, self.bearings);
        describeSpeed(self, visit);
        visit({"bin_count", "1", "bins per beam"}, self.bin_count);
        visit({"beam_count", "1", "beams"}, self.beam_count);
        visit({"bins", "1", "linear echo strength, beam-first; NaN when unknown"}, self.bins);
    }
};
using SonarPtr = std::shared_ptr<const Sonar>;

// Kinds of bins on ports. Ports of different kinds must not be connected.
inline constexpr const char* reaching_receiver = "intensities that reach a receiver";
inline constexpr const char* left_receiver = "what a receiver has amplified";

}  // namespace insonify::types
