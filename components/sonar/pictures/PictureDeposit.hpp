#pragma once
#include "components/gpu/ReadBack.hpp"
#include "components/sonar/ThreadPool.hpp"
#include "components/sonar/pictures/BinDeposit.hpp"
#include "components/sonar/pictures/PictureCells.hpp"

namespace insonify::sonar {

/** The deposit of pictures on the processor: reads them back; each thread owns a run of beams, so none waits for
 * another.
 */
class PictureDeposit final : public BinDeposit {
public:
    /** All outlive it. */
    PictureDeposit(DepositSetup setup, const SurfacePass& surface, const gpu::EglContext& context, ThreadPool& threads);
    void begin(const WaterView& water) override;
    void take(size_t frustum, const SurfacePass& surface) override;
    std::span<const uint64_t> finish() override;

    /** Prepares for the truth of the sums, in those beams of a table (as beamsOfCells). */
    void prepareTruth(std::vector<int32_t> beams);
    /** Pings begun from now on report their truth to a table; null: no more. */
    void setTruth(TruthTable* truth) { truth_ = truth; }

private:
    struct Taken {
        gpu::ReadBack words;
        PictureView view;
        bool taken = false;
    };
    void depositPart(size_t part);
    void touchColumns();
    /** First beam of a thread's run. */
    uint32_t firstBeam(size_t part) const;

    DepositSetup setup_;
    const gpu::EglContext& context_;
    ThreadPool& threads_;
    const std::vector<PlaneRecord>& planes_;
    const std::vector<FacetRecord>& facets_;
    std::vector<std::vector<std::array<int, 2>>> columns_;  ///< Of each thread and frustum: from, to.
    std::vector<Taken> pictures_;                           ///< Of each frustum.
    WaterView water_;                                       ///< Of the ping that is taken.
    std::vector<uint64_t> sums_;
    TruthTable* truth_ = nullptr;
    std::vector<int32_t> truth_beams_;
    std::vector<std::vector<uint64_t>> one_beam_;  ///< Of each thread, for TruthSink.
};

}  // namespace insonify::sonar
