#pragma once
#include <functional>
#include <string>
#include <vector>

#include "components/study/fit/FitChain.hpp"
#include "components/study/fit/FitLevels.hpp"
#include "components/study/fit/FitSpeckle.hpp"

namespace insonify::study {

/** The value of one property of the device or its surroundings, found from a recording. */
struct Finding {
    std::string name, unit;
    Fitted found;
    bool is_determined = false;  ///< Whether the interval is small enough to be useful, see `text`.
    std::string note = {};       ///< The method, or why the value is not determined.

    /** Returns "24.2 (23.9 to 24.6) dB", or "not determined by this recording: ...". */
    std::string text() const;
};

/** Fits the speckle of a device that averages several looks in each bin, like most side-scans. Its intensities vary
 *  less than those of one look, which fields of scatterers cannot reproduce. It is drawn for each bin before the
 *  receiver, as the mean of looks over a gamma-distributed texture (K law).
 *
 *  The statistic T = <I ln I> / <I> - <ln I> - 1 of this speckle is 1 / looks + 1 / shape - 1. For one look it is that
 *  of Blacknell and Tough 2001; for gamma-distributed factors X of shape n, <X ln X> - <ln X> = 1 / n. One number
 *  cannot determine both, so the min number of looks that leaves a shape is used. */
class AveragedSpeckle {
public:
    explicit AveragedSpeckle(FitChain& chain) : chain_(chain) {}

    /** Returns whether speckle varies too little for one look. */
    static bool isIn(const SpeckleMoments& recorded);

    /** Makes the first estimate, by theory. */
    void begin(const SpeckleMoments& recorded);
    /** Improves the estimate: moves the targets by the error of the simulated statistics. */
    void improve(const SpeckleMoments& recorded, const SpeckleMoments& simulated);
    void addTo(std::vector<Finding>& findings) const;

private:
    /** Uses the min number of looks that leaves a shape. @param both 1 / looks + 1 / shape */
    void take(double both);
    void apply();
    /** Returns whether the texture exceeds its error. */
    bool isTextured() const;

    FitChain& chain_;
    SpeckleMoments recorded_ = {};
    int looks_ = 1;
    double inverse_ = 0;  ///< 1 / shape [1].
    double bins_ = 0;     ///< Target of the filter: the sum of the correlations of the first three lags [1].
};

/** Properties of a sonar, fitted to a recording. */
struct RecordingFit {
    FitChain chain;  ///< The deployment's chain with all fitted values.
    LevelFit levels;
    std::vector<Finding> findings;
    SpeckleMoments recorded, simulated;
    std::vector<CodedPing> simulated_pings;  ///< Pings of the chain.

    const Finding* finding(const std::string& name) const;  ///< Returns null if there is none of that name.
};

/** Finds unpublished properties of a device from recorded pings of one shape and the scene of a deployment.
 *
 *  Levels over range determine gain, noise, time-varied gain and absorption (`fitLevels`). The correlation of speckle
 *  between neighbouring beams and bins determines the beam width and the pulse length; the law of its intensities
 *  determines the number of scatterers in a cell (`computeMoments`). The same statistics are then measured in simulated
 *  pings, and the properties are moved until both agree (indirect inference: Gourieroux, Monfort and Renault 1993).
 *
 *  @param rough see LevelOptions
 *  @param progress called with the current step
 *  @throws types::ConfigError for unusable recordings: without a ping, with one code throughout, with fewer than 32
 *  beams or 64 bins, or without a frequency */
RecordingFit fitRecording(const std::vector<CodedPing>& recorded, FitChain chain, bool rough,
                          const std::function<void(const std::string&)>& progress);

}  // namespace insonify::study
