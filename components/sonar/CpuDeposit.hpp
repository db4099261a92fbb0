#pragma once
#include "components/sonar/BinDeposit.hpp"
#include "components/sonar/ThreadPool.hpp"

namespace insonify::sonar {

/** The deposit on the processor: reads the pictures back; each thread owns a run of beams, so none waits for another.
 */
class CpuDeposit final : public BinDeposit {
public:
    CpuDeposit(DepositSetup setup, ThreadPool& threads);
    void take(size_t slab, const gpu::Texture& picture) override;
    std::span<const uint64_t> finish() override;

private:
    void depositBeams(uint32_t first, uint32_t last);
    void depositSlab(size_t slab, uint32_t first, uint32_t last);

    DepositSetup setup_;
    ThreadPool& threads_;
    std::vector<double> edges_;
    std::vector<std::vector<float>> pictures_;  ///< RGBA of each slab.
    std::vector<bool> taken_;
    std::vector<uint64_t> sums_;
};

}  // namespace insonify::sonar
