#pragma once
#include "components/sonar/DepositRow.hpp"
#include "components/sonar/ThreadPool.hpp"

namespace insonify::sonar {

/** The deposit on the processor: reads the pictures back; each thread owns a run of beams, so none waits for another.
 */
class CpuDeposit final : public BinDeposit {
public:
    /** All outlive it. */
    CpuDeposit(DepositSetup setup, const SurfacePass& surface, const gpu::EglContext& context, ThreadPool& threads);
    void begin(size_t slot, const WaterView& water) override;
    void take(size_t slot, size_t frustum, const SurfacePass& surface) override;
    void ask(size_t) override {}
    std::span<const uint64_t> finish(size_t slot) override;
    Features compiled() const override;

    /** Makes ready to tell of which objects the echoes are: to those beams of a table (as beamsOfCells). */
    void prepareTruth(std::vector<int32_t> beams);
    /** What is begun from now on tells it to a table; null: no more. */
    void setTruth(TruthTable* truth) { truth_ = truth; }

private:
    TakenPicture& picture(size_t slot, size_t frustum) { return pictures_[slot * setup_.frusta.size() + frustum]; }
    void waitForPictures(size_t slot);
    void depositPart(size_t slot, size_t part);
    void touchColumns();
    /** Where a thread's run of beams begins. */
    uint32_t firstBeam(size_t part) const;

    DepositSetup setup_;
    const gpu::EglContext& context_;
    ThreadPool& threads_;
    const std::vector<PlaneRecord>& planes_;
    std::vector<std::vector<std::array<int, 2>>> columns_;  ///< Of each thread and frustum: from, to.
    std::vector<TakenPicture> pictures_;                    ///< Slot after slot, of each frustum.
    std::vector<uint64_t> sums_;
    TruthTable* truth_ = nullptr;
    std::vector<int32_t> truth_beams_;
    std::vector<std::vector<uint64_t>> one_beam_;  ///< Of each thread, for TruthSink.
};

}  // namespace insonify::sonar
