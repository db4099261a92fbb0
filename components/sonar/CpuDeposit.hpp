#pragma once
#include "components/sonar/DepositRow.hpp"
#include "components/sonar/ThreadPool.hpp"

namespace insonify::sonar {

/** The deposit on the processor: reads the pictures back; each thread owns a run of beams, so none waits for another.
 */
class CpuDeposit final : public BinDeposit {
public:
    CpuDeposit(DepositSetup setup, const SurfacePass& surface, ThreadPool& threads);
    void begin() override;
    void take(size_t frustum, const SurfacePass& surface) override;
    std::span<const uint64_t> finish() override;
    Features compiled() const override;

private:
    void depositPart(size_t part);
    /** Where a thread's run of beams begins. */
    uint32_t firstBeam(size_t part) const;

    DepositSetup setup_;
    ThreadPool& threads_;
    const std::vector<PlaneRecord>& planes_;
    std::vector<std::vector<std::array<int, 2>>> columns_;  ///< Of each thread and frustum: from, to.
    std::vector<TakenPicture> pictures_;
    std::vector<uint64_t> sums_;
};

}  // namespace insonify::sonar
