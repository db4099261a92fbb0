#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "components/receiver/ReceiverConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::receiver {

/** Gain at slant range r [m] before the clamp [dB]. */
double unclampedTvgDb(const TvgConfig& tvg, double r);
/** Gain at slant range r [m], at most max_db [dB]. */
double tvgDb(const TvgConfig& tvg, double r);
/** Slant range at which the gain reaches max_db, none when it does not up to `range_max` [m]. */
std::optional<double> clampRange(const TvgConfig& tvg, double range_max);

/** Makes of the intensities that reach a receiver what it gives out: time-varied gain, gain, blanking, and a law.
 *
 *  The gain of a bin is that of its middle, on the range axis of the ping. Intensities and amplitudes have a ceiling of
 *  the largest float, levels a floor of -3000 dB, codes both their ends; no echo is 0, or the floor. NaN stays NaN, but
 *  in codes, where it is 0.
 *
 *      Receiver receiver(config);
 *      receiver.receive(intensities, ping); */
class Receiver {
public:
    explicit Receiver(const ReceiverConfig& config);

    /** Gives `received` everything of `intensities`, and the bins that the receiver makes of its bins. Allocates
     *  nothing when both had these shapes before. */
    void receive(const types::Sonar& intensities, types::Sonar& received);
    /** What leaves nothing to be seen in a ping that was received last. */
    struct Flaws {
        bool blanked = false;   ///< Every bin is silenced.
        double saturated = 0;   ///< Share of the bins heard that have the largest code [1].
        bool all_zero = false;  ///< Every code is 0, and some bin that is heard has an intensity.
        bool any() const { return blanked || all_zero || saturated > max_saturated; }
    };
    static constexpr double max_saturated = 0.1;  ///< Of the bins: more are told of [1].
    Flaws flawsOf(const types::Sonar& intensities, const types::Sonar& received) const;
    /** Of flaws: which, with numbers, and what helps. */
    std::string text(const Flaws& flaws, const types::Sonar& intensities) const;
    /** Whether every ping comes out as it came in. */
    bool isNeutral() const;
    /** What a user should know: where the gain is clamped, what is configured without use. */
    std::vector<std::string> notices() const;

private:
    /** Of a ping: what the tables depend on. */
    struct Axis {
        uint32_t bin_count = 0;
        int64_t bin_duration_us = 0;
        float speed_of_sound = 0;
        double beam_width = 0;  ///< [rad]
        bool operator==(const Axis&) const = default;
    };
    void makeTables(const types::Sonar& ping);
    /** Puts the automatic gain of a ping on top of the tables. */
    void followLevel(const types::Sonar& ping);
    /** What the tables add to a level with all gain included: the outputs' own scales [dB]. */
    double scaleDb() const;
    double saturation() const;  ///< On the scale of the tables [1].
    double gainDb(const types::Sonar& ping, double r) const;
    bool isLevel() const;
    void receiveBeam(const float* intensities, float* received) const;
    void encode(float* received) const;
    float largestCode() const { return static_cast<float>((1 << code_.bits) - 1); }
    /** Level of the loudest bin that is heard, all gain included, relative to full_scale_db [dB]. */
    double loudestDb(const types::Sonar& intensities) const;
    /** Level relative to full_scale_db from which a code is not 0 [dB]. */
    double lowestDb() const;

    ReceiverConfig config_;
    CodeConfig code_;
    Axis axis_;
    size_t silent_ = 0;                                    ///< Bins of a beam, from the first on.
    double range_max_ = 0;                                 ///< Of the last ping [m].
    std::vector<double> factor_;                           ///< Of each bin [1],
    std::vector<float> offset_db_;                         ///< or for levels [dB].
    std::vector<double> fixed_db_, means_, automatic_db_;  ///< With automatic gain: gain and levels of each bin.
};

}  // namespace insonify::receiver
