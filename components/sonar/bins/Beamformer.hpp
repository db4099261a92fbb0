#pragma once
#include <array>
#include <complex>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"

namespace insonify::sonar {

/** Forms beams from azimuth cells: beam k is the sum over the cells of its two-way pattern there times the cell's
 *  echoes (ACOUSTICS.md 5.11). Near its bearing a beam weights each cell. Farther away, where the pattern has only
 *  sidelobes, it weights groups of cells, by the pattern's mean. */
class Beamformer {
public:
    /** Two-way power at an azimuth, of a beam at a bearing [rad], or the factor of its field; 1 on its axis. Only the
     *  factor of a field may have an imaginary part. */
    using Pattern = std::function<std::complex<double>(double azimuth, double bearing)>;

    static constexpr size_t group_cells = 8;

    /** Bins before `end` in which beams have another pattern: the pattern of an array that is not focused there. */
    struct Zone {
        size_t end;
        Pattern pattern;
        double near;
    };
    struct Rules {
        Pattern pattern;
        double near;             ///< Distance from its bearing within which a beam weights each cell [rad].
        double floor;            ///< Weights below it, positive or negative, are ignored [1].
        bool of_fields = false;  ///< Fields are summed. Groups, whose fields have any phase, use the mean of powers.
        /** Half the width about its bearing within which a beam receives, exactly: a cell that is partly outside has a
         *  smaller weight [rad]; infinite: as far as the pattern reaches. */
        double half_box = std::numeric_limits<double>::infinity();
        bool is_complex = false;        ///< Whether patterns have an imaginary part, for formQuadrature().
        std::vector<Zone> nearer = {};  ///< Zones of nearer bins, in order; `pattern` is that of the bins behind them.
    };

    /** `cells` are adjacent and of equal width. A wider cell counts as a group of its own and must be far from all
     *  beams. With a box, cells may have gaps and any width. Where the cells form a circle, the cells near a beam
     * continue across its seam. */
    Beamformer(const Fan& beams, const Fan& cells, size_t bin_count, const Rules& rules);

    size_t groupCount() const { return groups_.size() - 1; }
    /** Sums one group of cells, and finds its bins with echoes, beyond which form() reads nothing: each once per ping,
     *  before beams are formed. `echoes`: [cell][bin]. */
    void sumGroup(size_t group, std::span<const float> echoes);
    /** Fills the bins of one beam. Allocates nothing. Thread-safe. */
    void form(size_t beam, std::span<const float> echoes, std::span<float> bins) const { form(beam, 1, echoes, bins); }
    /** Fills the bins of neighbouring beams, [beam][bin], while their cells are in the processor's cache. The bins are
     *  those of each beam alone, bit for bit. Allocates nothing. Thread-safe. */
    void form(size_t first, size_t count, std::span<const float> echoes, std::span<float> bins) const {
        form(Part::Real, first, count, echoes, bins);
    }
    bool isComplex() const { return !bands_.back().of_beams[Part::Imaginary].empty(); }
    /** Fills the bins of neighbouring beams as form() does, by the imaginary part of the patterns. */
    void formQuadrature(size_t first, size_t count, std::span<const float> echoes, std::span<float> bins) const {
        form(Part::Imaginary, first, count, echoes, bins);
    }

    /** Returns the weight of each cell in beam k, as it is applied in the farthest bins [1]. */
    std::vector<double> weights(size_t beam) const;

private:
    struct Run {
        size_t first = 0;
        std::vector<float> weights;
    };
    /** Cells near a beam, in two runs where these continue across the seam, and the groups of all other cells. */
    struct Band {
        std::array<Run, 2> cells, groups;
    };
    enum Part { Real, Imaginary };
    using Bands = std::array<Band, 2>;  ///< By the parts of the pattern.
    Bands computeBands(const Beam& beam, const Fan& cells, const Rules& rules) const;
    /** Bins before `end`, and the bands of all beams there, by the parts of the pattern. */
    struct BandsTo {
        size_t end;
        std::array<std::vector<Band>, 2> of_beams;
    };
    /** Part of the bins of neighbouring beams. */
    struct Tile {
        size_t first_beam, beams, first_bin, bins;
    };
    /** Adds the rows of one run of each beam in a tile. `run(band)` returns the run. */
    void addTile(const Tile& tile, const std::vector<Band>& bands, const auto& run, const float* rows,
                 const auto& groupOf, std::span<float> bins) const;
    void form(Part part, size_t first, size_t count, std::span<const float> echoes, std::span<float> bins) const;
    size_t cellsIn(size_t group) const { return groups_[group + 1] - groups_[group]; }
    /** Bins from the first with an echo to the end of the last. */
    struct Support {
        size_t first = 0, end = 0;
    };
    Support findSupport(size_t group, std::span<const float> echoes) const;

    std::vector<size_t> groups_;    ///< First cell of each group, and the number of cells.
    std::vector<size_t> group_of_;  ///< Group of each cell.
    size_t bin_count_;
    std::vector<BandsTo> bands_;     ///< From the nearest bins.
    bool has_groups_ = false;        ///< Whether any beam weights groups.
    std::vector<float> grouped_;     ///< [group][bin].
    std::vector<Support> supports_;  ///< Of the cells of each group.
};

}  // namespace insonify::sonar
