#pragma once
#include "components/gpu/ReadBack.hpp"
#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/raster/BinDeposit.hpp"
#include "components/sonar/raster/PictureCells.hpp"

namespace insonify::sonar {

/** Deposits pictures on the processor, after reading them back. Each thread owns a run of beams, so that threads do not
 *  wait for each other. */
class PictureDeposit final : public BinDeposit {
public:
    /** All arguments outlive it. */
    PictureDeposit(DepositSetup setup, const SurfacePass& surface, const gpu::EglContext& context, ThreadPool& threads);
    void begin(const WaterView& water) override;
    void take(size_t frustum, const SurfacePass& surface) override;
    std::span<const uint64_t> finish() override;

    /** Prepares the truth of the sums, in the beams of a table (as beamsOfCells). */
    void prepareTruth(std::vector<int32_t> beams);
    /** Makes later pings report their truth to a table; null: no more. */
    void setTruth(TruthTable* truth) { truth_ = truth; }

private:
    struct Taken {
        gpu::ReadBack words;
        PictureView view;
        bool taken = false;
    };
    void depositPart(size_t part);
    void touchColumns();
    /** Returns the first beam of a thread's run. */
    uint32_t firstBeam(size_t part) const;

    DepositSetup setup_;
    const gpu::EglContext& context_;
    ThreadPool& threads_;
    const std::vector<PlaneRecord>& planes_;
    const std::vector<FacetRecord>& facets_;
    std::vector<std::vector<std::array<int, 2>>> columns_;  ///< First and end column of each thread and frustum.
    std::vector<Taken> pictures_;                           ///< Picture of each frustum.
    WaterView water_;                                       ///< View of the current ping.
    std::vector<uint64_t> sums_;
    TruthTable* truth_ = nullptr;
    std::vector<int32_t> truth_beams_;
    std::vector<std::vector<uint64_t>> one_beam_;  ///< One per thread, for TruthSink.
};

}  // namespace insonify::sonar
