#pragma once

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Transmission.hpp"

namespace insonify::sonar {

/** Band and duration of a pulse. */
struct Waveform {
    double frequency_khz = types::Transmission::unknown;  ///< Centre of the band; NaN: unknown [kHz].
    double bandwidth_khz = 0;                             ///< [kHz]
    double duration = 0;                                  ///< [s]
};

/** Returns the waveform of a configured sonar. A sonar without `pulse` sends a tone as long as a bin. A chirp without
 *  `chirp_us` lasts 50 / bandwidth. */
Waveform waveformOf(const SonarConfig& config, const BinGrid& grid);
/** Returns the waveform of a transmission; missing values are taken from `own`. */
Waveform waveformOf(const types::Transmission& sent, const Waveform& own);

/** Output of a matched filter for a foreign pulse: a box in slant range (ACOUSTICS.md 5.29). */
struct Mismatch {
    double intensity = 1;  ///< Relative to the peak of the filter's own pulse of the same source level [1].
    double length = 0;     ///< In slant range [m]; 0: the pulse is the filter's own.
};

/** Returns the mismatch of a pulse.
 *  @param own  the waveform that the receiver's filter matches
 *  @param cell  integral of the own pulse's response over slant range [m]
 *  @param rejection_db  attenuation of the energy outside the receiver's band [dB] */
Mismatch mismatchOf(const Waveform& own, const Waveform& sent, double cell, double rejection_db, double speed_of_sound);

/** Reception of another sonar's transmission, independent of their places. */
struct Reception {
    double level;   ///< Intensity on the axis at 1 m, relative to the sonar's own [1].
    double length;  ///< Mismatch::length [m].
    double loss;    ///< By absorption, one way, of intensity [1/m].
    double offset;  ///< Delay between the two pulses, in slant range: c (t - t_own) / 2 [m].
};

/** Receives the transmissions of others. */
class Receiver {
public:
    /** @param plan  its configuration has `crosstalk`; outlives it */
    explicit Receiver(const RenderPlan& plan);
    /** Returns the integral over slant range of an echo in one bin after all processing: of the pulse's response, or
     *  the bin where the plan omits the pulse [m]. */
    double summedCell() const { return summed_cell_; }
    Reception receptionOf(const types::Transmission& sent, const types::Time& own_time) const;

private:
    const RenderPlan& plan_;
    Waveform own_;
    double cell_, summed_cell_;  ///< The pulse's own integral, and summedCell() [m].
    double loss_;                ///< By absorption, one way, of intensity [1/m].
};

}  // namespace insonify::sonar
