#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/receiver/Receiver.hpp"
#include "types/Notice.hpp"
#include "types/Sonar.hpp"

namespace insonify::receiver {

/** Computes the gain along a ping that brings its level to a target (ACOUSTICS.md 7.5). The gain starts anew with each
 *  ping, so a replayed ping gets the same gain.
 *
 *  @param means mean intensity of each bin over the beams, other gain included [1]
 *  @param first bins before this, and bins of NaN, are skipped
 *  @param target level of the means with the gain [dB]
 *  @param bin_ms time in which the echoes of a bin are received: two-way [ms]
 *  @param gains_db output, gain of each bin [dB] */
void followLevel(const AutomaticGainConfig& config, std::span<const double> means, size_t first, double target,
                 double bin_ms, std::span<double> gains_db);

/** Returns the gain at slant range r [m] before the clamp [dB]. */
double unclampedTvgDb(const TvgConfig& tvg, double r);
/** Returns the gain at slant range r [m], at most max_db [dB]. */
double tvgDb(const TvgConfig& tvg, double r);
/** Returns the slant range at which the gain reaches max_db; none when that is beyond `range_max` [m]. */
std::optional<double> clampRange(const TvgConfig& tvg, double range_max);

/** Turns the intensities that reach a receiver into its output: time-varied gain, gain, blanking, and an output law.
 *
 *  The gain of a bin is that of the bin's middle, on the range axis of the ping. Intensities and amplitudes are clamped
 *  at the max float, levels at -3000 dB below, codes at both ends. A bin without an echo is 0, or -3000 dB. NaN stays
 *  NaN, except in codes, where it becomes 0.
 *
 *      Receiver receiver(config);
 *      receiver.receive(intensities, ping); */
class Receiver {
public:
    explicit Receiver(const ReceiverConfig& config);

    /** Copies `intensities` to `received` with the bins as the receiver outputs them. Allocates nothing when both had
     *  these shapes before. */
    void receive(const types::Sonar& intensities, types::Sonar& received);
    /** Returns why it cannot receive a ping; null when it can. A brightness of the physical model needs beams of known
     *  width. */
    const char* diagnosticOf(const types::Sonar& intensities) const;
    /** The reasons why a received ping shows nothing. */
    struct Flaws {
        bool blanked = false;   ///< Every bin is blanked.
        double saturated = 0;   ///< Share of the bins after blanking that have the max code [1].
        bool all_zero = false;  ///< Every code is 0, although some bin after blanking has an intensity.
        bool any() const { return blanked || all_zero || saturated > max_saturated; }
    };
    static constexpr double max_saturated = 0.1;  ///< Share of saturated bins above which a warning is due [1].
    /** Returns the flaws of the ping that was received last. */
    Flaws flawsOf(const types::Sonar& intensities, const types::Sonar& received) const;
    /** Returns the most important flaw as a message, with numbers and a remedy. */
    std::string text(const Flaws& flaws, const types::Sonar& intensities) const;
    /** Returns whether the receiver leaves every ping unchanged. */
    bool isNeutral() const;
    /** Returns notices for the user: the range of the gain's clamp, and configuration without effect. */
    types::Notices notices() const;

private:
    /** The properties of a ping that the tables depend on. */
    struct Axis {
        uint32_t bin_count = 0;
        double bin_width = 0;   ///< [m]
        double bin_s = 0;       ///< One-way travel time through a bin.
        double beam_width = 0;  ///< [rad]
        bool operator==(const Axis&) const = default;
    };
    void makeTables(const types::Sonar& ping);
    /** Adds the automatic gain of a ping to the tables. */
    void followLevel(const types::Sonar& ping);
    /** Returns the offset of the output's own scale, which the tables add to a level with all gain included [dB]. */
    double scaleDb() const;
    double saturation() const;  ///< Max intensity on the scale of the tables [1].
    double gainDb(const types::Sonar& ping, double r) const;
    bool isLevel() const;
    void receiveBeam(const float* intensities, float* received) const;
    void encode(float* received) const;
    float maxCode() const { return static_cast<float>((1 << code_.bits) - 1); }
    /** Returns the level of the loudest bin after blanking, all gain included, relative to full_scale_db [dB]. */
    double loudestDb(const types::Sonar& intensities) const;
    /** Returns the level relative to full_scale_db above which codes are not 0 [dB]. */
    double lowestDb() const;

    ReceiverConfig config_;
    CodeConfig code_;
    Axis axis_;
    size_t silent_ = 0;                                    ///< Number of blanked bins at the start of each beam.
    double range_max_ = 0;                                 ///< Range of the last ping [m].
    std::vector<double> factor_;                           ///< Gain of each bin as a factor [1].
    std::vector<float> offset_db_;                         ///< Gain of each bin as a level [dB].
    std::vector<double> fixed_db_, means_, automatic_db_;  ///< With automatic gain: gain and mean of each bin.
};

}  // namespace insonify::receiver
