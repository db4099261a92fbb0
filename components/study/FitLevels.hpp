#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/study/FitChain.hpp"

namespace insonify::study {

/** What a code says in the mean of an intensity, over the exponential law of speckle: codes are cut off at both ends
 *  and rounded. */
class CodeResponse {
public:
    /** @param law with which intensities, relative to that of the largest code, become codes and levels again */
    explicit CodeResponse(const CodedPing& law);

    /** Mean of the intensity that codes state, for a mean intensity of `level_db`, both relative to the largest code's
     *  [dB]. */
    double operator()(double level_db) const;

private:
    std::vector<double> stated_db_;  ///< By steps of a quarter of a decibel.
};

/** Mean levels of blocks of a ping, by beams and by range. */
struct LevelBlocks {
    size_t beam_blocks = 0, slices = 0;
    std::vector<double> ranges = {};  ///< Middle of each slice [m].
    std::vector<double> level = {};   ///< By beam block, then slice: 10 log10 of the mean intensity [dB].

    double at(size_t block, size_t slice) const { return level[block * slices + slice]; }
};

/** Mean levels of what the codes of a ping state, relative to the largest code, and of intensities relative to the
 *  source. A block without intensity has the level -400 dB. */
LevelBlocks blocksOf(const CodedPing& ping);
LevelBlocks blocksOf(const types::Sonar& intensities);
/** The mean of several pings, as intensities. */
LevelBlocks meanOf(const std::vector<LevelBlocks>& all);
/** The least of several pings. */
LevelBlocks leastOf(const std::vector<LevelBlocks>& all);

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
    Fitted log_coefficient = {};          ///< Of the time-varied gain [dB].
    Fitted db_per_m = {};                 ///< Of the time-varied gain, one way [dB/m].
    Fitted absorption_db_per_m = {};      ///< Of the water, one way [dB/m].
    Fitted tvg_span_db = {};              ///< Gain at the end of the range above that at its tenth [dB].
    std::optional<Fitted> water_db = {};  ///< Of a side-scan: volume backscattering strength [dB re 1/m].
    std::optional<Fitted> pitch_deg = {}, height_m = {},
                          elevation_deg =
                              {};  ///< Of a rough scene: the sonar over it, its beam; of a side-scan no height.
    LevelBlocks modelled = {};     ///< What the codes of each block state by these values.
    double rms_db = 0;             ///< Of the levels that are left unexplained [dB].

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
