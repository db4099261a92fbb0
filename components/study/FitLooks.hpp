#pragma once
#include <vector>

#include "components/study/RecordingFit.hpp"

namespace insonify::study {

/** Speckle of a device that averages several looks in each bin, as many side-scans do: its intensities vary less than
 *  those of one look, which fields of scatterers cannot. It is drawn for each bin, as the mean of looks over a gamma
 *  distributed texture (K law), before the receiver.
 *
 *  The statistic T = <I ln I> / <I> - <ln I> - 1 of such speckle is 1 / looks + 1 / shape - 1 (for one look that of
 *  Blacknell and Tough 2001; for gamma distributed factors X of shape n, <X ln X> - <ln X> = 1 / n). One number states
 *  not both: the fewest looks that leave a shape are taken. */
class AveragedSpeckle {
public:
    explicit AveragedSpeckle(FitChain& chain) : chain_(chain) {}

    /** Whether speckle varies so little that one look cannot be. */
    static bool isIn(const SpeckleMoments& recorded);

    /** The first estimate, by theory. */
    void begin(const SpeckleMoments& recorded);
    /** A better one: targets move by what simulated statistics are off. */
    void improve(const SpeckleMoments& recorded, const SpeckleMoments& simulated);
    void addTo(std::vector<Finding>& findings) const;

private:
    /** Takes the fewest looks that leave a shape. @param both 1 / looks + 1 / shape */
    void take(double both);
    void apply();
    /** Whether the texture is more than its error. */
    bool isTextured() const;

    FitChain& chain_;
    SpeckleMoments recorded_ = {};
    int looks_ = 1;
    double inverse_ = 0;  ///< 1 / shape [1].
    double bins_ = 0;     ///< Sum of the correlations of the first three lags that the filter is to have [1].
};

}  // namespace insonify::study
