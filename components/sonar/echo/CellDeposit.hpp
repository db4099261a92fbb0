#pragma once
#include <span>

#include "components/sonar/echo/Cells.hpp"
#include "components/sonar/echo/TruthTable.hpp"
#include "components/sonar/plan/WaterView.hpp"

namespace insonify::sonar {

/** Where the echoes of cells go. */
struct EchoSums {
    int first_beam;  ///< Of the sums [1].
    uint64_t* sums;  ///< EchoRules::sumCount() for each beam from the first on: [bin][channel] in quanta.
    const TruthSink* truth = nullptr;  ///< Where the truth of the sums is reported; null: nowhere.
    bool behind_walls = false;         ///< The cells are behind walls; effects have added the water before these.
};

/** Adds the echoes of a batch to sums; one function for each estimator of what a bin holds. */
struct EstimatorEntry {
    Features features;
    void (*sum)(const EchoRules& rules, const Cells& cells, const Covered& covered, const EchoSums& to);
};

/** The one way from samples to bins on the processor. A source, rays (TileCells.hpp) or pictures (PictureCells.hpp),
 *  fills a batch of cells; their echoes, and what effects make of them, are added to the sums. */
class CellDeposit {
public:
    /** `water` is for effects; `bent`: cells have a focus. */
    CellDeposit(const EchoRules& rules, const WaterView& water, bool bent, const EchoSums& to);

    const EchoRules& rules() const { return rules_; }
    const EchoSums& to() const { return to_; }

    /** Adds the echoes of all cells of the batch, and empties it. */
    void flush();
    /** The two ends of flush(), for an estimator of its own in between: covers the cells, and empties the batch. */
    void cover();
    void finish();

    Cells cells;
    Covered covered;

private:
    /** Covers the cells near the limb of a smooth body, which are covered as planes, as what bends away there. */
    void bendCells(double near_edge, double far_edge);
    /** The curvature of the body along the ray of a cell that meets it at a cosine [1/m]. */
    double curvature(const Cells::OfBody& of_body, double cosine) const;
    void bendCell(int i, double curvature, double near_edge, double far_edge);
    void applyLaws();
    /** How the lobe of cell i is seen; zeros where its material has none. */
    LobeSlopes lobeSlopes(int i) const;

    const EchoRules& rules_;
    WaterView water_;
    bool bent_;
    EchoSums to_;
    const EstimatorEntry& estimator_;
};

/** Estimators by file: `physical`, one bin for each sample, means of `cerqueira2017`. */
std::span<const EstimatorEntry> physicalEstimators();
std::span<const EstimatorEntry> nearestEstimators();
std::span<const EstimatorEntry> meanEstimators();

}  // namespace insonify::sonar
