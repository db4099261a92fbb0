#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/WaterView.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/raster/SurfacePass.hpp"

namespace insonify::sonar {

/** Setup of a deposit of pictures, fixed until the quality changes. */
struct DepositSetup {
    EchoRules rules;
    std::vector<ViewFrustum> frusta;
    std::vector<ColumnShares> shares;  ///< One for each frustum.
    std::vector<std::string> defines;  ///< Defines of the plan, for the shader.
    uint32_t beam_count = 0;

    size_t sumCount() const { return beam_count * rules.sumCount(); }
};

/** Spreads the pixels of the frusta over beams and bins, on the graphics card or on the processor. */
class BinDeposit {
public:
    virtual ~BinDeposit() = default;
    /** Begins a ping, and discards the last one. Call it and take() under EglContext::transferring(). */
    virtual void begin(const WaterView& water) = 0;
    /** Takes the picture of a frustum that has been rasterised. */
    virtual void take(size_t frustum, const SurfacePass& surface) = 0;
    /** Waits for the sums over all frusta taken and returns them: EchoRules::sumCount() for each beam, in quanta; valid
     *  until the next ping. */
    virtual std::span<const uint64_t> finish() = 0;
};

/** The context outlives it. */
std::unique_ptr<BinDeposit> makeGpuDeposit(const DepositSetup& setup, gpu::EglContext& context);

}  // namespace insonify::sonar
