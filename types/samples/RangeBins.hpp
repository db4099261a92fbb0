#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "types/Time.hpp"
#include "types/text/Describe.hpp"

namespace insonify::types {

/** The range bins of a ping, or of its truth: bin k covers slant ranges [k, k + 1) * binWidth().
 *
 *  Rock's `bin_duration` is one-way time in whole microseconds, so few bins are bin_duration * speed_of_sound wide.
 *  `bin_width` is exact, beside Rock's fields, and only in memory. Instead of the speed of sound, a sample of Rock's
 *  layout contains writtenSpeed(), which gives its readers the same ranges. All ranges and times of bins are computed
 *  by these functions. */
struct RangeBins {
    Time bin_duration;
    float speed_of_sound = 1497.0f;  ///< In the water [m/s].
    double bin_width = 0;            ///< Exact [m]; 0: unknown, bin_duration * speed_of_sound.

    /** Returns the slant range at which bin k starts [m]; k = bin_count gives the far edge. */
    double binStart(double k) const {
        if (bin_width > 0) return k * bin_width;
        return k * bin_duration.seconds() * static_cast<double>(speed_of_sound);
    }
    /** Returns the slant range from the start of a bin to its end [m]. */
    double binWidth() const { return binStart(1); }
    /** Returns the one-way travel time through a bin [s]. An echo needs twice this time to pass it. */
    double binSeconds() const {
        return bin_width > 0 ? bin_width / static_cast<double>(speed_of_sound) : bin_duration.seconds();
    }
    /** Sets bins of this width [m] in water with this speed of sound [m/s]; both must be above 0. The duration is the
     *  nearest whole number of microseconds, at least 1. If that gives the width within 1e-6, the error of ranges in
     *  float, no width is set. */
    void setBins(double width, double speed) {
        speed_of_sound = static_cast<float>(speed);
        const double us = 1e6 * width / static_cast<double>(speed_of_sound);
        bin_duration = {us < 1e15 ? std::max<int64_t>(1, std::llround(us)) : 1};
        bin_width = std::abs(static_cast<double>(bin_duration.microseconds) / us - 1) < 1e-6 ? 0 : width;
    }
    /** Returns the speed of sound that makes bin_duration the exact width, within a float's rounding of 6e-8 [m/s]. */
    float writtenSpeed() const {
        if (!(bin_width > 0) || bin_duration.microseconds <= 0) return speed_of_sound;
        return static_cast<float>(bin_width / bin_duration.seconds());
    }
    /** Restores the width and the speed of sound of a sample that was read with its writtenSpeed(). Ignored if the
     *  sample has bins of another width. */
    void restore(double width, float speed) {
        if (!(std::abs(binWidth() / width - 1) < 1e-6)) return;
        if (!(bin_width > 0)) speed_of_sound = speed;
        bin_width = width;
    }
    bool sameBins(const RangeBins& other) const {
        return bin_duration == other.bin_duration && speed_of_sound == other.speed_of_sound &&
               bin_width == other.bin_width;
    }

protected:
    /** Describes the speed of sound as in Rock's layout: writes writtenSpeed(), and reads bins of unknown width. */
    static void describeSpeed(auto& self, auto& visit) {
        const Field field{"speed_of_sound", "m/s", "speed of sound that turns time into range"};
        if constexpr (std::is_const_v<std::remove_reference_t<decltype(self)>>) {
            const float written = self.writtenSpeed();
            visit(field, written);
        } else {
            self.bin_width = 0;
            visit(field, self.speed_of_sound);
        }
    }
};

}  // namespace insonify::types
