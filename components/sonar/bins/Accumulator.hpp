#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::sonar {

/** Converts the sum of a bin into the intensity that reaches the receiver.
 *
 *  For `physical`, A_j = sum of mu cos(theta) dOmega (r_j/r)^2 over the samples of bin j, r_j being its centre, and 10
 *  log10(E_j/S0) = 10 log10 A_j - 20 log10 r_j - 2 alpha r_j. For `cerqueira2017`, A_j is the mean of S and is not
 *  changed. */
class BinLevels {
public:
    BinLevels(const SonarConfig& config, const BinGrid& grid);

    /** Returns the intensity of bin j [1/m^2, relative to the source's at 1 m], at most the largest float. An A_j that
     *  is not positive is no echo. */
    float intensity(size_t j, double accumulated) const {
        constexpr double maximum = static_cast<double>(std::numeric_limits<float>::max());
        return accumulated > 0 ? static_cast<float>(std::min(accumulated * factor_[j], maximum)) : 0.0f;
    }

    /** Returns spreading and absorption of bin j, of intensity [1/m^2]. */
    double factor(size_t j) const { return factor_[j]; }

    /** Returns the loss of energy in the water, one way [Np/m]. */
    double lossOfWater() const { return loss_; }

    /** Fills one beam's bins from its sums in quanta, EchoRules::sumCount() of them, for cells of `solid_angle` [sr].
     *  Returns whether there is any echo. Allocates nothing. */
    bool fill(const EchoRules& rules, const uint64_t* sums, double solid_angle, std::span<float> bins) const;

private:
    double loss_ = 0;             ///< lossOfWater() [Np/m].
    std::vector<double> factor_;  ///< Spreading and absorption of each bin [1].
};

class EchoField;

/** What turns the echoes of azimuth cells into the bins of a ping: as energies, which add up (EchoGrid), or as fields,
 *  which interfere (EchoField). In each ping begin() comes first; then every cell is filled once, from any thread of
 * the pool, and may get more energies; finish() forms the beams; effects add echoes to them; detect() completes the
 * bins. Nothing in a ping allocates. */
class Accumulator {
public:
    virtual ~Accumulator() = default;

    /** Switches to the same plan with other azimuth cells. Allocates. */
    virtual void setQuality(const RenderPlan& plan) = 0;
    /** Begins a ping, which outlives it until detect(); its bins have their size. */
    virtual void begin(const types::Snapshot& snapshot, types::Sonar& ping) = 0;
    /** Fills a cell from its sums in quanta, for samples of `solid_angle` [sr]; `thread`: number of the thread in its
     *  pool. Returns whether the cell has any echo of a surface. */
    virtual bool fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread) = 0;
    /** Returns intensities of a filled cell's range cells, to which a caller may add [1/m^2]; addEnergies() follows
     *  where it did. Where fields are summed, they are 0 before. */
    virtual std::span<float> energies(size_t cell, size_t thread) = 0;
    virtual void addEnergies(size_t /*cell*/, size_t /*thread*/) {}
    /** Forms the beams, once all cells are filled. */
    virtual void finish(ThreadPool& threads) = 0;
    /** Completes the bins of the ping, once effects have added their echoes. */
    virtual void detect(types::Sonar& /*ping*/) const {}
    /** Returns the fields that detect() squares into the bins; null where energies are summed. */
    virtual EchoField* field() { return nullptr; }

    /** Returns spreading and absorption of the range cells. */
    const BinLevels& levels() const { return levels_; }

protected:
    explicit Accumulator(const RenderPlan& plan);

private:
    BinLevels levels_;
};

/** Makes what a plan needs. `plan` outlives it. `threads`: size of the pool that fills it. */
std::unique_ptr<Accumulator> makeAccumulator(const RenderPlan& plan, int threads);

}  // namespace insonify::sonar
