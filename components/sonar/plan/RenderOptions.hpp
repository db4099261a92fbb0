#pragma once
#include <cstddef>

namespace insonify::sonar {

/** How a pixel's echo finds its bins. All but the first are for comparison, in studies of the error. */
enum class Estimator {
    Footprint,      ///< Spread over the ranges that the pixel covers.
    Nearest,        ///< All in the bin of its centre.
    NearestJitter,  ///< All in the bin of a point drawn at random in it.
};

/** Ways to render that no property asks for: studies compare them with the usual one. */
struct RenderOptions {
    Estimator estimator = Estimator::Footprint;  ///< Others than the first: `physical` only.
    bool one_frustum = false;                    ///< One wide image and rounded columns, as `published`.
    int samples_per_pixel = 1;                   ///< 1, or 4 on a rotated grid, for edges along the rows [1].
    int min_frusta = 1;                          ///< At least so many images [1].
    int threads = 0;                             ///< 0: as many as there are cores [1].

    /** Whether only an image shows what is asked for, whatever the configuration says. */
    bool needImages() const { return one_frustum || samples_per_pixel > 1 || estimator != Estimator::Footprint; }
};

}  // namespace insonify::sonar
