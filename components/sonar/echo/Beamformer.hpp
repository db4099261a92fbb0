#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "components/sonar/fan/BeamFan.hpp"

namespace insonify::sonar {

/** Forms beams from azimuth cells: beam k hears the sum over the cells of its two-way pattern there times what comes
 *  from the cell (ACOUSTICS.md 5.11). Near its bearing a beam weighs each cell; farther off, where the pattern is all
 *  sidelobes, so many cells together, by the pattern's mean. */
class Beamformer {
public:
    /** Two-way power at an azimuth, of a beam of a bearing [rad], or what its field is multiplied by; 1 on its axis. */
    using Pattern = std::function<double(double azimuth, double bearing)>;

    static constexpr size_t group_cells = 8;

    /** Bins before `end` in which beams have another pattern: those of an array that is not focused there. */
    struct Zone {
        size_t end;
        Pattern pattern;
        double near;
    };
    struct Rules {
        Pattern pattern;
        double near;             ///< How far from its bearing a beam weighs each cell [rad].
        double floor;            ///< What is below it, to either side of 0, is not heard [1].
        bool of_fields = false;  ///< Fields are summed; of groups, whose fields have any phase, the mean is of powers.
        std::vector<Zone> nearer = {};  ///< Zones of nearer bins, in order; `pattern` is that of the bins behind them.
    };

    /** `cells` are side by side and equal. Cells that are wider count as a group each; they must be far from all beams.
     *  Where the cells form a circle, what is near a beam continues across its seam. */
    Beamformer(const Fan& beams, const Fan& cells, size_t bin_count, const Rules& rules);

    size_t groupCount() const { return groups_.size() - 1; }
    /** Sums one group of cells: each once a ping, before beams are formed. `echoes`: [cell][bin]. */
    void sumGroup(size_t group, std::span<const float> echoes);
    /** Fills the bins of one beam. Allocates nothing, and any threads may form beams at once. */
    void form(size_t beam, std::span<const float> echoes, std::span<float> bins) const;

    /** Of beam k: its weight of each cell as it is applied, in the farthest bins [1]. */
    std::vector<double> weights(size_t beam) const;

private:
    struct Run {
        size_t first;
        std::vector<float> weights;
    };
    /** Cells near a beam, in two runs where these continue across the seam, and the groups of all other cells. */
    struct Band {
        std::array<Run, 2> cells, groups;
    };
    Band bandOf(const Beam& beam, const Fan& cells, const Rules& rules) const;
    /** Bins, from the first to before `end`, and the bands of all beams there. */
    struct BandsTo {
        size_t end;
        std::vector<Band> of_beams;
    };
    size_t cellsIn(size_t group) const { return groups_[group + 1] - groups_[group]; }

    std::vector<size_t> groups_;  ///< The first cell of each, and the number of all.
    size_t bin_count_;
    std::vector<BandsTo> bands_;  ///< From the nearest bins on.
    std::vector<float> grouped_;  ///< [group][bin].
};

}  // namespace insonify::sonar
