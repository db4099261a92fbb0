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

/** The beams of a ping as neighbours of each other. */
struct BeamOrder {
    std::vector<uint32_t> beams;  ///< Indices into the ping's beams, each once: neighbours follow each other.
    bool is_ring = false;         ///< Whether the last and the first are neighbours.
};

/** Variates of unit mean with a receiver's correlation: complex Gaussian noise that is filtered in range and across
 *  beams, squared, and averaged over looks (ACOUSTICS.md 6.8).
 *
 *  The noise of a bin depends only on the key, the beam's place in the order and the bin, not on the size of the ping;
 *  in a ring also on the number of beams. */
class FieldFilter {
public:
    explicit FieldFilter(const FilterConfig& config);

    /** Fills the variates of all beams. `key.beam` contains only the bits of a stream. Allocates nothing when
     *  `variates` has had this size before. */
    void draw(const BeamKey& key, const BeamOrder& order, size_t bin_count, std::vector<float>& variates);

    bool isAcross() const { return across_.size() > 1; }  ///< Whether it correlates beams.

private:
    /** Fills white noise, filtered in range, of the beam of a number into a slot. */
    void fillBeam(const BeamKey& key, size_t chunk, size_t number, size_t slot);
    void addPower(size_t first_slot, float scale, size_t bin_count, float* variates) const;
    /** Returns the mean power of the fields of a ring, whose beams the filter may meet several times [1]. */
    double powerInRing(size_t beam_count) const;

    int looks_;
    std::vector<float> along_, across_;  ///< Halves of the filters in range and across beams.
    std::vector<float> beams_;           ///< Fields of the beams that `across_` spans, filtered in range.
};

}  // namespace insonify::noise
