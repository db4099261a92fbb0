#pragma once
#include <cstddef>
#include <vector>

#include "components/noise/NoiseConfig.hpp"
#include "components/noise/Random.hpp"

namespace insonify::noise {

/** Half of a symmetric filter, from its middle on, with which white noise of unit power gets the correlation
 *  exp(-(lag / width)^2 / 2) of fields at whole lags, and so exp(-(lag / width)^2) of intensities. Its square sums up
 *  to 1. `width` is at most 16. */
std::vector<float> gaussianFilter(double width);

/** Variates of unit mean as a receiver gives them out: complex Gaussian noise that has passed a filter in range and one
 *  across beams, squared, and averaged over looks (ACOUSTICS.md 6.8).
 *
 *  The noise of a bin depends on the key, beam and bin alone, and not on the size of the ping. */
class FieldFilter {
public:
    explicit FieldFilter(const FilterConfig& config);

    /** Fills the variates of all beams. `key.beam` has the bits of a stream, and no beam. Allocates nothing when
     *  `variates` has had this size. */
    void draw(const BeamKey& key, size_t beam_count, size_t bin_count, std::vector<float>& variates);

private:
    void fillBeam(const BeamKey& key, size_t chunk, size_t beam);
    void addPower(size_t beam, size_t bin_count, float* variates) const;

    int looks_;
    std::vector<float> along_, across_;  ///< Halves of the two filters.
    std::vector<float> beams_;           ///< Fields of as many beams as `across_` spans, filtered in range.
};

}  // namespace insonify::noise
