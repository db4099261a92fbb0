#pragma once
#include <cstddef>
#include <cstdint>

namespace insonify::sonar {

/** Distribution of a pixel's echo over the bins. All but the first are for comparison, in studies of the error. */
enum class Estimator {
    Footprint,      ///< Spread over the ranges that the pixel covers.
    Nearest,        ///< All in the bin of its centre.
    NearestJitter,  ///< All in the bin of a point drawn at random in it.
};

class Effect;

/** The part of a cell's echo in one bin. */
struct EchoPart {
    static constexpr uint32_t no_triangle = 0xffffffff;

    uint32_t object;            ///< Index into Geometry::objects [1].
    uint32_t triangle;          ///< Of the object's mesh; no_triangle for paths by mirrors [1].
    uint8_t path;               ///< As types::SonarTruth::path.
    uint32_t cell, bin;         ///< Azimuth cell, and bin of its sums [1].
    uint64_t energy;            ///< [quanta]
    double elevation, grazing;  ///< Sines of the elevation at the sonar and of the grazing angle [1].
};

/** Chooses the echoes that pings receive, while their truth is recorded: to explain a bin. Surfaces without echo still
 *  cast shadows, transmit and reflect. */
class EchoSelection {
public:
    virtual ~EchoSelection() = default;
    /** Returns whether an echo of a surface is received. Several threads call it. */
    virtual bool keeps(const EchoPart& part) = 0;
    /** Returns whether an effect adds echoes of its own; called once per ping. */
    virtual bool adds(const Effect& effect) = 0;
};

/** Options of rendering that no property sets: studies compare them with the defaults. */
struct RenderOptions {
    Estimator estimator = Estimator::Footprint;  ///< Others than the first: `physical` only.
    bool one_frustum = false;                    ///< One wide image and rounded columns, as `published`.
    int samples_per_pixel = 1;                   ///< 1, or 4 on a rotated grid, for edges along the rows [1].
    int min_frusta = 1;                          ///< Minimum number of images [1].
    int threads = 0;                             ///< 0: the number of cores [1].
    EchoSelection* selection = nullptr;          ///< Null: all echoes are received.

    /** Returns whether the options require images, regardless of the configuration. */
    bool needImages() const { return one_frustum || samples_per_pixel > 1 || estimator != Estimator::Footprint; }
};

}  // namespace insonify::sonar
