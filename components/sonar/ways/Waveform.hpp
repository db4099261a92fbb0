#pragma once
#include <optional>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Transmission.hpp"

namespace insonify::sonar {

/** Band and duration of a pulse. */
struct Waveform {
    double frequency_khz = types::Transmission::unknown;  ///< Centre of the band; NaN: unknown [kHz].
    double bandwidth_khz = 0;                             ///< [kHz]
    double duration = 0;                                  ///< [s]
};

/** The waveform of a configured sonar. A sonar without `pulse` sends a tone as long as a bin; a chirp without
 *  `chirp_us` lasts 50 / bandwidth. */
Waveform waveformOf(const SonarConfig& config, const BinGrid& grid);
/** The waveform of a transmission; values that it lacks are those of `own`. */
Waveform waveformOf(const types::Transmission& sent, const Waveform& own);

/** What a matched filter makes of a pulse that it is not made for: a box in slant range (ACOUSTICS.md 5.29). */
struct Mismatch {
    double intensity = 1;  ///< Relative to the peak of the filter's own pulse of the same source level [1].
    double length = 0;     ///< In slant range [m]; 0: the pulse is the filter's own.
};

/** @param own  the waveform that the receiver's filter matches
 *  @param cell  integral of the own pulse's response over slant range [m]
 *  @param rejection_db  weakens the part of the energy that is outside the receiver's band [dB] */
Mismatch mismatchOf(const Waveform& own, const Waveform& sent, double cell, double rejection_db, double speed_of_sound);

/** How a sonar receives a transmission of another sonar, but for where both are. */
struct Reception {
    double level;   ///< Intensity on the axis at 1 m, relative to the sonar's own [1].
    double length;  ///< Mismatch::length [m].
    double loss;    ///< By absorption, one way, of intensity [1/m].
    double offset;  ///< Slant range that the delay between the two pulses amounts to: c (t - t_own) / 2 [m].
};

/** Receives the transmissions of others. */
class Receiver {
public:
    /** @param plan  one whose configuration has `crosstalk`; outlives it */
    explicit Receiver(const RenderPlan& plan);
    /** Integral over slant range of what later becomes of an echo in one bin: of the pulse's response, or the bin where
     *  the plan leaves the pulse out [m]. */
    double summedCell() const { return summed_cell_; }
    Reception receptionOf(const types::Transmission& sent, const types::Time& own_time) const;

private:
    const RenderPlan& plan_;
    Waveform own_;
    double cell_, summed_cell_;  ///< The pulse's own integral, and summedCell() [m].
    double loss_;                ///< By absorption, one way, of intensity [1/m].
};

}  // namespace insonify::sonar
