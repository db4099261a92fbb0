#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/bins/Beamformer.hpp"
#include "components/sonar/bins/BinLevels.hpp"
#include "components/sonar/plan/EchoRules.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** The pulse's response in range: contribution of each range cell to each sample of the field (ACOUSTICS.md 5.21). */
class FieldResponse {
public:
    explicit FieldResponse(const RenderPlan& plan);

    size_t samples() const { return samples_; }          ///< Samples of a beam [1].
    size_t cells() const { return samples_ * stride_; }  ///< Range cells of a beam [1].
    /** Returns the number of values of `sorted` in spread(). */
    size_t sortedSize() const { return stride_ * runLength(); }
    /** Returns the index in `sorted` of the real part of a range cell's field; the imaginary part follows. */
    size_t place(size_t cell) const { return cell % stride_ * runLength() + 2 * (cell / stride_ + margin_); }
    /** Spreads range cells into `fields`: samples() times real, imaginary. Allocates nothing. */
    void spread(std::span<const float> sorted, std::span<float> fields) const;
    /** Returns the amplitude at a sample, of an echo at a slant range [1, m]. */
    double amplitude(size_t sample, double range) const;
    /** Returns the distance beyond which an echo has no amplitude [m]. */
    double reach() const { return reach_; }
    double sampleWidth() const { return sample_width_; }  ///< [m]

private:
    struct Tap {
        size_t run;       ///< Index of the range cells with the same offset from their samples.
        ptrdiff_t shift;  ///< [samples]
        float weight;
    };
    size_t runLength() const { return 2 * (samples_ + 2 * margin_); }

    size_t samples_, stride_, margin_ = 0;
    double sample_width_, reach_ = 0;
    std::optional<acoustics::Pulse> pulse_;
    std::vector<Tap> taps_;
};

/** The fields of a coherent sonar, from azimuth cells to the bins of a ping. The pulse spreads them in range, beams are
 *  formed of the cells, and points are added; the bins are the squares of the beams' fields.
 *
 *  The ray-tracer owns it instead of a PingEffect, because it replaces the sums that all other effects add to. */
class EchoField {
public:
    /** `plan` outlives it. `threads`: size of the pool that fills it. */
    EchoField(const RenderPlan& plan, int threads);

    /** Begins a ping: sets the sonar's pose, for the scattering of the water. */
    void begin(const types::Snapshot& snapshot) { sonar_ = snapshot.sonar; }
    /** Fills a cell from its sums; each cell is filled once per ping, by one of the threads. Returns whether it has any
     *  echo of a surface. Allocates nothing. */
    bool fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread);
    /** Adds energies to a filled cell, as a random field that belongs to places in the world, like the scattering of
     *  the water. `intensities`: of each range cell [1/m^2]. Allocates nothing. */
    void addEnergies(size_t cell, std::span<const float> intensities, size_t thread);
    /** Returns a thread's buffer with an intensity for each range cell, all 0. */
    std::span<float> energies(size_t thread);
    /** Forms the beams, once all cells are filled. */
    void form(ThreadPool& threads);
    /** Adds an echo to a beam: its field at its own range, times the beam's response to it [1/m, m]. */
    void add(size_t beam, double range, std::complex<double> field);
    /** Fills the bins with the beams' intensities. */
    void detect(types::Sonar& ping) const;

    /** Returns the fields of an azimuth cell, FieldResponse::samples() times real, imaginary [1/m]. */
    std::span<const float> cell(size_t cell) const { return {&cells_[cell * numbers()], numbers()}; }
    std::span<const float> beam(size_t beam) const { return {&beams()[beam * numbers()], numbers()}; }
    const FieldResponse& response() const { return response_; }

private:
    /** Buffers of one thread. */
    struct Scratch {
        std::vector<float> sorted, energies, real, imaginary, spread;
    };
    size_t numbers() const { return 2 * response_.samples(); }
    const std::vector<float>& beams() const { return beamformer_ ? beams_ : cells_; }
    std::vector<float>& beams() { return beamformer_ ? beams_ : cells_; }
    /** Adds a random field of intensities to `scratch.sorted`; fields of different seeds are independent. */
    void scatter(size_t cell, std::span<const float> intensities, uint32_t seed, Scratch& scratch) const;

    const RenderPlan& plan_;
    FieldResponse response_;
    std::vector<double> amplitudes_;  ///< Spreading and absorption of the field in each range cell [1/m].
    std::optional<Beamformer> beamformer_;
    std::optional<Beamformer> turner_;  ///< Imaginary part of patterns with phases; none where they have signs only.
    std::vector<float> cells_;          ///< [cell][sample][real, imaginary].
    std::vector<float> beams_;          ///< [beam][sample][real, imaginary]; none where cells are beams.
    std::vector<float> turned_;         ///< Beams of `turner_`.
    std::vector<Scratch> scratch_;
    types::Pose sonar_;
};

}  // namespace insonify::sonar
