#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/RenderPlan.hpp"
#include "components/sonar/SurfacePass.hpp"

namespace insonify::sonar {

/** What a deposit needs to know, fixed for the life of a renderer. */
struct DepositSetup {
    std::vector<Slab> slabs;
    std::vector<ColumnShares> shares;  ///< One for each slab.
    uint32_t beam_count = 0;
    BinGrid bins;
    double attenuation = 0;  ///< Amplitude, one way, in `cerqueira2017` [Np/m].
    Features features;
    double strength_scale = 1;  ///< Strengths are deposited times this: strengthScale.

    size_t channels() const { return features.has(Feature::Cerqueira2017) ? 2 : 1; }
    size_t sumCount() const { return beam_count * static_cast<size_t>(bins.bin_count) * channels(); }
};

/** Inverse ranges of the bins' edges: [0] at the near blanking, [bin_count] at the far end [1/m]. */
std::vector<double> inverseEdges(const BinGrid& bins);

/** Sums are counted in quanta of 2^-40 of a whole pixel of unit strength: exact, so the order of summation is free. */
constexpr double quanta_per_unit = 1099511627776.0;

/** Strongest Lambert parameter of a geometry's materials [1]. */
double loudest(const types::Geometry& geometry);

/** The power of 2, at most 1, by which strengths of up to `loudest` must be scaled so that no sum of quanta overflows:
 *  1 but for materials, images or bins that are extreme together. */
double strengthScale(const SonarConfig& config, const BinGrid& bins, double loudest);

/** Spreads the pixels of the slabs over beams and bins. One interface, on the graphics card or on the processor. */
class BinDeposit {
public:
    virtual ~BinDeposit() = default;
    /** Forgets what an earlier ping left that came to no end. */
    virtual void begin() = 0;
    /** Takes the picture of a slab. Call once a ping for each slab that is drawn, under EglContext::transferring(). */
    virtual void take(size_t slab, const SurfacePass& surface) = 0;
    /** Sums over all slabs taken since the last call, [beam][bin][channel] in quanta; valid until the next take. */
    virtual std::span<const uint64_t> finish() = 0;
    /** What is compiled into it. */
    virtual Features compiled() const = 0;
};

/** The context outlives it. */
std::unique_ptr<BinDeposit> makeGpuDeposit(const DepositSetup& setup, gpu::EglContext& context);

}  // namespace insonify::sonar
