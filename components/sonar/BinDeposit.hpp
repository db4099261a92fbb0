#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/EchoRules.hpp"
#include "components/sonar/SurfacePass.hpp"
#include "components/sonar/WaterView.hpp"

namespace insonify::sonar {

/** What a deposit of pictures needs to know, fixed until the quality changes. */
struct DepositSetup {
    EchoRules rules;
    std::vector<ViewFrustum> frusta;
    std::vector<ColumnShares> shares;  ///< One for each frustum.
    std::vector<std::string> defines;  ///< Of the plan, for the shader.
    uint32_t beam_count = 0;
    size_t slots = 1;         ///< Pings that may be under way.
    bool group_sums = false;  ///< On a device: work groups sum in memory of their own first.

    size_t sumCount() const { return beam_count * rules.sumCount(); }
};

/** Spreads the pixels of the frusta over beams and bins. One interface, on the graphics card or on the processor. Pings
 *  may be under way together, each in a slot of its own: all are asked for before anybody waits. */
class BinDeposit {
public:
    virtual ~BinDeposit() = default;
    /** Begins a ping, and forgets what an earlier one left in the slot that came to no end. Like take() and ask() to be
     *  called under EglContext::transferring(). */
    virtual void begin(size_t slot, const WaterView& water) = 0;
    /** Takes the picture of a frustum that is drawn. */
    virtual void take(size_t slot, size_t frustum, const SurfacePass& surface) = 0;
    /** All frusta are taken. */
    virtual void ask(size_t slot) = 0;
    /** Waits for the sums over all frusta taken, EchoRules::sumCount() for each beam, in quanta; valid until the slot
     *  begins another ping or another one's are waited for. */
    virtual std::span<const uint64_t> finish(size_t slot) = 0;
};

/** The context outlives it. */
std::unique_ptr<BinDeposit> makeGpuDeposit(const DepositSetup& setup, gpu::EglContext& context);

}  // namespace insonify::sonar
