#pragma once
#include <vector>

#include "components/study/fit/RecordingFit.hpp"

namespace insonify::study {

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

}  // namespace insonify::study
