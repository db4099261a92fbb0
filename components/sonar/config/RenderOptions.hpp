#pragma once
#include <cstddef>

namespace insonify::sonar {

/** Distribution of a pixel's echo over the bins. All but the first are for comparison, in studies of the error. */
enum class Estimator {
    Footprint,      ///< Spread over the ranges that the pixel covers.
    Nearest,        ///< All in the bin of its centre.
    NearestJitter,  ///< All in the bin of a point drawn at random in it.
};

/** Options of rendering that no property sets: studies compare them with the defaults. */
struct RenderOptions {
    Estimator estimator = Estimator::Footprint;  ///< Others than the first: `physical` only.
    bool one_frustum = false;                    ///< One wide image and rounded columns, as `published`.
    int samples_per_pixel = 1;                   ///< 1, or 4 on a rotated grid, for edges along the rows [1].
    int min_frusta = 1;                          ///< Minimum number of images [1].
    int threads = 0;                             ///< 0: the number of cores [1].

    /** Returns whether the options require images, regardless of the configuration. */
    bool needImages() const { return one_frustum || samples_per_pixel > 1 || estimator != Estimator::Footprint; }
};

}  // namespace insonify::sonar
