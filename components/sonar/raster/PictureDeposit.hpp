#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/bins/CellDeposit.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "components/sonar/raster/SurfacePass.hpp"

namespace insonify::sonar {

/** A frustum's picture in memory, and the meaning of its numbers. */
struct PictureView {
    const uint32_t* pixels = nullptr;  ///< `channels` words per pixel, row by row from below.
    size_t channels = 2;               ///< Words of a pixel [1].
    std::vector<PlacedRun> ranges;     ///< Run of each draw, its triangles rotated into sonar axes.
    std::vector<uint32_t> objects;     ///< Object of each draw.
};

/** The part of one frustum that one thread deposits: the beams [first, last). */
struct PicturePart {
    const EchoRules& rules;
    const ViewFrustum& frustum;
    const ColumnShares& shares;
    const PictureView& picture;
    WaterView water;
    uint32_t first, last;        ///< Beams [1].
    std::array<int, 2> columns;  ///< First and end of the columns that these beams touch [1].
};

/** Adds the echoes of a part of a picture to sums: each beam's share of a pixel is a cell. */
void depositPicture(const PicturePart& part, const EchoSums& to);

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
