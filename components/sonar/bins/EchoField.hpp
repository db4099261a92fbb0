#pragma once
#include <complex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "components/acoustics/Pulse.hpp"
#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/bins/Beamformer.hpp"

namespace insonify::sonar {

/** The pulse's response in range: contribution of each range cell to each sample of the field (ACOUSTICS.md 5.21). A
 *  filter in phases: each phase has the range cells with the same offset from their samples, side by side. */
class FieldResponse {
public:
    explicit FieldResponse(const RenderPlan& plan);

    size_t samples() const { return samples_; }          ///< Samples of a beam [1].
    size_t cells() const { return samples_ * stride_; }  ///< Range cells of a beam [1].
    static constexpr size_t block = 64;                  ///< Numbers of fields that are summed in registers [1].
    /** Returns the number of values of the range cells in phases, with margins of 0, as spread() reads them. */
    size_t phasesSize() const { return stride_ * phaseLength() + block; }
    /** Returns the index in the phases of the real part of a range cell's field; the imaginary part follows. */
    size_t place(size_t cell) const { return cell % stride_ * phaseLength() + 2 * (cell / stride_ + margin_); }
    /** Samples outside of which all values are 0. */
    struct Support {
        size_t first, end;
    };
    /** Spreads range cells into `fields`: samples() times real, imaginary. Allocates nothing. */
    void spread(std::span<const float> phases, Support support, std::span<float> fields) const;
    double sampleWidth() const { return sample_width_; }  ///< [m]
    /** Returns the amplitude at a sample, of an echo at a slant range [1, m]. */
    double amplitude(size_t sample, double range) const;
    /** Adds an echo at a slant range to samples() fields, times the pulse's amplitude [1/m, m]. */
    void addEcho(double range, std::complex<double> field, std::span<float> fields) const;

    struct Tap {
        size_t phase;
        ptrdiff_t shift;       ///< [samples]
        float weight;          ///< [1]
        ptrdiff_t offset = 0;  ///< In the phases, of the value for the first sample.
    };

private:
    size_t phaseLength() const { return 2 * (samples_ + 2 * margin_); }

    size_t samples_, stride_, margin_ = 0;
    double sample_width_, reach_ = 0;  ///< Distance beyond which an echo has no amplitude [m].
    std::optional<acoustics::Pulse> pulse_;
    std::vector<Tap> taps_;  ///< By shift. Each four are added to a sample together.
};

/** The fields of a plan's beams, formed of those of its azimuth cells; the cells themselves in a plan that forms none.
 */
class FieldBeams {
public:
    /** `numbers`: of a cell's or beam's fields, samples times real, imaginary. */
    FieldBeams(const RenderPlan& plan, size_t numbers);

    std::span<float> cell(size_t cell) { return {&cells_[cell * numbers_], numbers_}; }
    std::span<const float> cell(size_t cell) const { return {&cells_[cell * numbers_], numbers_}; }
    std::span<float> beam(size_t beam) { return {&beams()[beam * numbers_], numbers_}; }
    /** Returns [beam][sample][real, imaginary]. */
    std::span<const float> all() const { return beamformer_ ? beams_ : cells_; }
    /** Forms the beams of the cells. */
    void form(ThreadPool& threads);

private:
    std::vector<float>& beams() { return beamformer_ ? beams_ : cells_; }

    size_t numbers_, beam_count_;
    std::optional<Beamformer> beamformer_;
    std::vector<float> cells_;        ///< [cell][sample][real, imaginary].
    std::vector<float> beams_;        ///< The same of the beams; empty where cells are beams.
    std::vector<float> quadratures_;  ///< Beams by the imaginary part of patterns; empty where they have signs only.
};

/** Random fields of given energies, which belong to places in the world: the scattering of the water. */
class WaterField {
public:
    /** `cells`: range cells of a beam. */
    WaterField(const RenderPlan& plan, size_t cells);

    /** Fills the field of the range cells of an azimuth cell; fields of different seeds are independent.
     *  @param intensities  of each range cell [1/m^2] */
    void fill(const types::Pose& sonar, const Beam& azimuth, std::span<const float> intensities, uint32_t seed,
              std::span<float> real, std::span<float> imaginary) const;

private:
    size_t cells_;
    double width_;  ///< Of a range cell [m].
};

/** The fields of a coherent sonar, from azimuth cells to the bins of a ping. The pulse spreads them in range, beams are
 *  formed of the cells, and points are added; the bins are the squares of the beams' fields. */
class EchoField final : public Accumulator {
public:
    EchoField(const RenderPlan& plan, int threads);
    void setQuality(const RenderPlan& plan) override { beams_ = FieldBeams(plan, numbers()); }
    void begin(const types::Snapshot& snapshot, types::Sonar& /*ping*/) override { sonar_ = snapshot.sonar; }
    bool fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread) override;
    std::span<float> energies(size_t cell, size_t thread) override;
    /** Adds a thread's energies() to a filled cell, as a random field like the scattering of the water. */
    void addEnergies(size_t cell, size_t thread) override;
    void finish(ThreadPool& threads) override { beams_.form(threads); }
    void detect(types::Sonar& ping) const override;
    EchoField* field() override { return this; }

    /** Adds an echo to a beam: its field at its own range, times the beam's response to it [1/m, m]. */
    void add(size_t beam, double range, std::complex<double> field);
    /** Returns the fields of an azimuth cell, FieldResponse::samples() times real, imaginary [1/m]. */
    std::span<const float> cell(size_t cell) const { return beams_.cell(cell); }
    const FieldResponse& response() const { return response_; }

private:
    /** Buffers of one thread. */
    struct Scratch {
        std::vector<float> phases, energies, real, imaginary, spread;
    };
    size_t numbers() const { return 2 * response_.samples(); }
    /** Adds a random field of the thread's energies to its range cells. */
    void scatter(size_t cell, uint32_t seed, Scratch& scratch) const;

    const RenderPlan& plan_;
    FieldResponse response_;
    WaterField water_;
    FieldBeams beams_;
    std::vector<double> amplitudes_;  ///< Spreading and absorption of the field in each range cell [1/m].
    std::vector<Scratch> scratch_;
    types::Pose sonar_;
};

}  // namespace insonify::sonar
