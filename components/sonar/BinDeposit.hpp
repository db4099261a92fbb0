#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/EchoRules.hpp"
#include "components/sonar/SurfacePass.hpp"

namespace insonify::sonar {

/** What a deposit of pictures needs to know, fixed until the quality changes. */
struct DepositSetup {
    EchoRules rules;
    std::vector<ViewFrustum> frusta;
    std::vector<ColumnShares> shares;  ///< One for each frustum.
    uint32_t beam_count = 0;

    size_t sumCount() const { return beam_count * rules.sumCount(); }
};

/** Spreads the pixels of the frusta over beams and bins. One interface, on the graphics card or on the processor. */
class BinDeposit {
public:
    virtual ~BinDeposit() = default;
    /** Forgets what an earlier ping left that came to no end. */
    virtual void begin() = 0;
    /** Takes the picture of a frustum. Call once a ping for each frustum that is drawn, under
     * EglContext::transferring(). */
    virtual void take(size_t frustum, const SurfacePass& surface) = 0;
    /** Sums over all frusta taken since the last call, EchoRules::sumCount() for each beam, in quanta; valid until the
     *  next take. */
    virtual std::span<const uint64_t> finish() = 0;
    /** What is compiled into it. */
    virtual Features compiled() const = 0;
};

/** The context outlives it. */
std::unique_ptr<BinDeposit> makeGpuDeposit(const DepositSetup& setup, gpu::EglContext& context);

}  // namespace insonify::sonar
