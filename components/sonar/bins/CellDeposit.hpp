#pragma once
#include <span>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/bins/Cells.hpp"
#include "components/sonar/bins/Truth.hpp"

namespace insonify::sonar {

/** Destination of the echoes of cells. */
struct EchoSums {
    int first_beam;  ///< First beam of the sums [1].
    uint64_t* sums;  ///< EchoRules::sumCount() for each beam from the first: [bin][channel] in quanta.
    const TruthSink* truth = nullptr;  ///< Receives the truth of the sums; null: no truth.
    bool behind_walls = false;  ///< The cells are behind walls; effects have added the water in front of the walls.
};

/** Adds the echoes of a batch to sums; one function for each estimator of a bin's contents. */
struct EstimatorEntry {
    Features features;
    void (*sum)(const EchoRules& rules, const Cells& cells, const Covered& covered, const EchoSums& to);
};

/** The only path from samples to bins on the processor. Rays (TileCells.hpp) or pictures (PictureDeposit.hpp) fill a
 *  batch of cells. The echoes of the cells, and what effects add to them, are added to the sums. */
class CellDeposit {
public:
    /** `water` is for effects; `bent`: cells have a focus. */
    CellDeposit(const EchoRules& rules, const WaterView& water, bool bent, const EchoSums& to);

    const EchoRules& rules() const { return rules_; }
    const EchoSums& to() const { return to_; }

    /** Adds the echoes of all cells of the batch, and empties it. */
    void flush();
    /** The two parts of flush(), for a custom estimator in between: covers the cells, and empties the batch. */
    void cover();
    void finish();

    Cells cells;
    Covered covered;

private:
    /** Covers the cells near the limb of a smooth body as a curved surface; they have been covered as planes. */
    void bendCells(double near_edge, double far_edge);
    /** Returns the curvature of the body along the ray of a cell, which hits it at a cosine [1/m]. */
    double curvature(const Cells::OfBody& of_body, double cosine) const;
    void bendCell(int i, double curvature, double near_edge, double far_edge);
    void applyLaws();

    const EchoRules& rules_;
    WaterView water_;
    bool bent_;
    EchoSums to_;
    const EstimatorEntry& estimator_;
};

/** Returns the estimators: `physical`, one bin for each sample, means of `cerqueira2017`. */
std::span<const EstimatorEntry> estimators();

}  // namespace insonify::sonar
