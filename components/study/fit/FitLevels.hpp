#pragma once
#include <functional>
#include <optional>

#include "components/study/fit/FitChain.hpp"
#include "components/study/fit/LevelBlocks.hpp"

namespace insonify::study {

constexpr double z_95 = 1.96;  ///< Standard deviations of a normal law on either side of the 95 % interval.

/** A fitted value and its interval of 95 %. */
struct Fitted {
    double value = 0, low = 0, high = 0;

    double half() const { return 0.5 * (high - low); }
};

/** The relation of level and range: all parameters that change only levels. */
struct LevelFit {
    Fitted full_scale_db = {};            ///< Level of the max code, including all gain [dB].
    Fitted noise_db = {};                 ///< Mean intensity of noise in a bin, relative to the source [dB].
    Fitted log_coefficient = {};          ///< Time-varied gain, per decade of range [dB].
    Fitted db_per_m = {};                 ///< Time-varied gain, one way [dB/m].
    Fitted absorption_db_per_m = {};      ///< Absorption in the water, one way [dB/m].
    Fitted tvg_span_db = {};              ///< Gain at the end of the range minus that at a tenth of the range [dB].
    std::optional<Fitted> water_db = {};  ///< Volume backscattering strength, side-scans only [dB re 1/m].
    /** The sonar's attitude over a rough scene, and its beam; a side-scan has no height. */
    std::optional<Fitted> pitch_deg = {}, height_m = {}, elevation_deg = {};
    LevelBlocks modelled = {};  ///< Modelled levels of the codes of each block with these values.
    double rms_db = 0;          ///< Residuals of levels, root mean square [dB].

    /** Returns the chain with these values. */
    FitChain applied(const FitChain& chain) const;
    /** Returns the fraction of echoes in the mean intensity of a bin of this level (relative to the max code) at this
     *  range [1]. */
    double echoShare(double level_db, double range) const;
};

/** How far the scene of a fit can be trusted. */
struct LevelOptions {
    /** The scene is only approximate: a floor or walls of the right kind. Medians over the beams are compared. For a
     *  side-scan, whose altitudes are known, each block of lines is compared, and the water's strength if the sonar has
     *  water. */
    bool rough = false;
    /** Levels to compare in the water before the floor of a side-scan; none: the recorded levels. */
    std::optional<LevelBlocks> water = {};
    bool fits_scene = false;  ///< Whether pitch, height and elevation width of a rough scene are fitted too.
};

/** Fits levels by least squares with Huber's weights (Huber 1964), by the downhill simplex of Nelder and Mead (1965).
 *  Intervals follow from the residuals and the derivatives at the minimum. The chain's values are weak priors (30 dB,
 *  and 60 dB over the range), so that undetermined values stay there.
 *
 *  @param recorded blocks of the recording
 *  @param law of its codes
 *  @param progress called now and then */
LevelFit fitLevels(const LevelBlocks& recorded, const CodedPing& law, const FitChain& chain,
                   const LevelOptions& options, const std::function<void()>& progress);

}  // namespace insonify::study
