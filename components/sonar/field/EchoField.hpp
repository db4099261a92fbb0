#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/ThreadPool.hpp"
#include "components/sonar/echo/Beamformer.hpp"
#include "components/sonar/echo/BinLevels.hpp"
#include "components/sonar/echo/EchoRules.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** What the pulse leaves of a field in range: of range cells, at each sample of the field (ACOUSTICS.md 5.21). */
class FieldResponse {
public:
    explicit FieldResponse(const RenderPlan& plan);

    size_t samples() const { return samples_; }          ///< Of a beam [1].
    size_t cells() const { return samples_ * stride_; }  ///< Range cells of a beam [1].
    /** Numbers that `sorted` has in spread(). */
    size_t sortedSize() const { return stride_ * runLength(); }
    /** Where in them the real part of a range cell's field belongs; the imaginary part follows. */
    size_t place(size_t cell) const { return cell % stride_ * runLength() + 2 * (cell / stride_ + margin_); }
    /** `fields`: samples() times real, imaginary. Allocates nothing. */
    void spread(std::span<const float> sorted, std::span<float> fields) const;
    /** At a sample, of an echo at a slant range [1, m]. */
    double amplitude(size_t sample, double range) const;
    /** Beyond it nothing is left of an echo [m]. */
    double reach() const { return reach_; }
    double sampleWidth() const { return sample_width_; }  ///< [m]

private:
    struct Tap {
        size_t run;       ///< Range cells that lie alike about their samples.
        ptrdiff_t shift;  ///< [samples]
        float weight;
    };
    size_t runLength() const { return 2 * (samples_ + 2 * margin_); }

    size_t samples_, stride_, margin_ = 0;
    double sample_width_, reach_ = 0;
    std::optional<acoustics::Pulse> pulse_;
    std::vector<Tap> taps_;
};

/** The fields of a coherent sonar on their way from azimuth cells to the bins of a ping: the pulse spreads them in
 *  range, beams are formed of the cells, points are added, and their squares are what the bins hold.
 *
 *  The ray-tracer owns it instead of a PingEffect, because it replaces the sums themselves, which all other effects add
 *  to. */
class EchoField {
public:
    /** `plan` outlives it. `threads`: of the pool that fills it. */
    EchoField(const RenderPlan& plan, int threads);

    /** Once a ping: where the water lies that scatters. */
    void begin(const types::Snapshot& snapshot) { sonar_ = snapshot.sonar; }
    /** Fills a cell from its sums; each is filled once a ping, by one of the threads. Whether it has any echo of a
     *  surface. Allocates nothing. */
    bool fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread);
    /** Adds energies to a cell that is filled: as a field that the water's scattering is like, which belongs to places
     *  of the world. `intensities`: of each range cell [1/m^2]. Allocates nothing. */
    void addEnergies(size_t cell, std::span<const float> intensities, size_t thread);
    /** Of one of the threads: room for an intensity for each range cell, 0 each. */
    std::span<float> energies(size_t thread);
    /** Once all cells are filled: their beams. */
    void form(ThreadPool& threads);
    /** Adds an echo to a beam: of a field at its own range, times what the beam makes of it [1/m, m]. */
    void add(size_t beam, double range, std::complex<double> field);
    /** Fills the bins with the beams' intensities. */
    void detect(types::Sonar& ping) const;

    /** Fields of an azimuth cell, FieldResponse::samples() times real, imaginary [1/m]. */
    std::span<const float> cell(size_t cell) const { return {&cells_[cell * numbers()], numbers()}; }
    std::span<const float> beam(size_t beam) const { return {&beams()[beam * numbers()], numbers()}; }
    const FieldResponse& response() const { return response_; }

private:
    /** What one thread works with. */
    struct Scratch {
        std::vector<float> sorted, energies, real, imaginary, spread;
    };
    size_t numbers() const { return 2 * response_.samples(); }
    const std::vector<float>& beams() const { return beamformer_ ? beams_ : cells_; }
    std::vector<float>& beams() { return beamformer_ ? beams_ : cells_; }
    /** Adds a random field of intensities to what is sorted; fields of different seeds have nothing in common. */
    void scatter(size_t cell, std::span<const float> intensities, uint32_t seed, Scratch& scratch) const;

    const RenderPlan& plan_;
    FieldResponse response_;
    std::vector<double> amplitudes_;  ///< Spreading and absorption of the field in each range cell [1/m].
    std::optional<Beamformer> beamformer_;
    std::optional<Beamformer> turner_;  ///< Imaginary part of patterns with phases; none where they have signs alone.
    std::vector<float> cells_;          ///< [cell][sample][real, imaginary].
    std::vector<float> beams_;          ///< [beam][sample][real, imaginary]; none where cells are beams.
    std::vector<float> turned_;         ///< Beams of `turner_`.
    std::vector<Scratch> scratch_;
    types::Pose sonar_;
};

}  // namespace insonify::sonar
