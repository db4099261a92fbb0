#pragma once
#include <cstddef>
#include <vector>

#include "components/noise/NoiseConfig.hpp"
#include "components/noise/Random.hpp"

namespace insonify::noise {

/** Returns half of a symmetric filter, from its middle on. Filtered white noise of unit power has the correlation
 *  exp(-(lag / width)^2 / 2) of fields at whole lags, and so exp(-(lag / width)^2) of intensities. The squares of the
 *  whole filter sum up to 1. `width` is at most 16 lags. */
std::vector<float> gaussianFilter(double width);

/** Variates of unit mean with a receiver's correlation: complex Gaussian noise that is filtered in range and across
 *  beams, squared, and averaged over looks (ACOUSTICS.md 6.8).
 *
 *  The noise of a bin depends only on the key, beam and bin, not on the size of the ping. */
class FieldFilter {
public:
    explicit FieldFilter(const FilterConfig& config);

    /** Fills the variates of all beams. `key.beam` contains only the bits of a stream. Allocates nothing when
     *  `variates` has had this size before. */
    void draw(const BeamKey& key, size_t beam_count, size_t bin_count, std::vector<float>& variates);

private:
    void fillBeam(const BeamKey& key, size_t chunk, size_t beam);
    void addPower(size_t beam, size_t bin_count, float* variates) const;

    int looks_;
    std::vector<float> along_, across_;  ///< Halves of the filters in range and across beams.
    std::vector<float> beams_;           ///< Fields of the beams that `across_` spans, filtered in range.
};

}  // namespace insonify::noise
