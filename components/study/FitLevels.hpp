#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/study/FitChain.hpp"
#include "components/study/LevelBlocks.hpp"

namespace insonify::study {

constexpr double z_95 = 1.96;  ///< Deviations of a normal law to either side of 95 %.

/** A value that was found, and its interval of 95 %. */
struct Fitted {
    double value = 0, low = 0, high = 0;

    double half() const { return 0.5 * (high - low); }
};

/** Which level belongs to which range: everything that changes levels alone. */
struct LevelFit {
    Fitted full_scale_db = {};            ///< Level of the largest code, all gain included [dB].
    Fitted noise_db = {};                 ///< Mean intensity of noise in a bin, relative to the source [dB].
    Fitted log_coefficient = {};          ///< Time-varied gain, for each decade of range [dB].
    Fitted db_per_m = {};                 ///< Time-varied gain, one way [dB/m].
    Fitted absorption_db_per_m = {};      ///< In the water, one way [dB/m].
    Fitted tvg_span_db = {};              ///< Gain at the end of the range above that at its tenth [dB].
    std::optional<Fitted> water_db = {};  ///< Volume backscattering strength, side-scans only [dB re 1/m].
    /** The sonar over a rough scene, and its beam; a side-scan has no height. */
    std::optional<Fitted> pitch_deg = {}, height_m = {}, elevation_deg = {};
    LevelBlocks modelled = {};  ///< What the codes of each block state by these values.
    double rms_db = 0;          ///< Levels left unexplained, root mean square [dB].

    /** The chain with these values. */
    FitChain applied(const FitChain& chain) const;
    /** Share of echoes in the mean intensity of a bin of this level (relative to the largest code) at this range [1].
     */
    double echoShare(double level_db, double range) const;
};

/** How far the scene of a fit is to be trusted. */
struct LevelOptions {
    /** It is no more than a floor or walls of about the right kind. Medians over the beams count; of a side-scan, whose
     *  lines know how high they are, each block of lines, and the strength of the water where the sonar has one. */
    bool rough = false;
    /** Levels that count in the water before the floor of a side-scan; none: the recorded ones. */
    std::optional<LevelBlocks> water = {};
    bool fits_scene = false;  ///< Pitch, height and the beam in elevation are fitted as well; of a rough one.
};

/** Fits levels by least squares with Huber's weights (Huber 1964), by the downhill simplex of Nelder and Mead (1965).
 *  Intervals follow from the residuals and the derivatives at the minimum. Values are held loosely by the chain's own
 *  (by 30 dB, and 60 dB over the range), so that what the recording does not determine stays there.
 *
 *  @param recorded blocks of the recording @param law of its codes @param progress is called now and then */
LevelFit fitLevels(const LevelBlocks& recorded, const CodedPing& law, const FitChain& chain,
                   const LevelOptions& options, const std::function<void()>& progress);

}  // namespace insonify::study
