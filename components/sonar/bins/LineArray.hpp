#pragma once
#include <complex>
#include <span>
#include <vector>

#include "components/acoustics/BeamPattern.hpp"
#include "components/sonar/bins/EchoField.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/samples/SonarElements.hpp"

namespace insonify::sonar {

/** Rows of complex samples of equal length: one per azimuth cell, element or beam. */
struct ComplexRows {
    ComplexRows() = default;
    ComplexRows(size_t rows, size_t samples) : sample_count(samples), values(rows * samples) {}

    size_t rowCount() const { return sample_count == 0 ? 0 : values.size() / sample_count; }
    std::span<std::complex<float>> row(size_t i) { return {values.data() + i * sample_count, sample_count}; }
    std::span<const std::complex<float>> row(size_t i) const {
        return {values.data() + i * sample_count, sample_count};
    }

    size_t sample_count = 0;
    std::vector<std::complex<float>> values;
};

/** Directions about an array, between two sines, positive to port. */
struct Cone {
    double low, high;
    double middle() const { return 0.5 * (low + high); }
};

/** A straight array of elements across the sonar, and the weights by which its beams are formed (ACOUSTICS.md 5.22).
 *  Directions are cones about the array: their sines, positive to port. */
class LineArray {
public:
    /** `spacing` of neighbouring elements and `wavelength` [m]. `taper` is the far field that the weights make; its
     *  aperture is count * spacing long. A Gaussian has no finite aperture and is made wider than given. */
    LineArray(size_t count, double spacing, double wavelength, const acoustics::Taper& taper);

    size_t count() const { return weights_.size(); }
    double spacing() const { return spacing_; }
    double wavelength() const { return wavelength_; }
    /** Returns the place of an element from the array's middle, positive to port [m]. */
    double position(size_t element) const;
    /** Returns the weight of each element; their sum is 1. */
    const std::vector<double>& weights() const { return weights_; }

    /** Returns the signals of the elements for echoes from cones. A signal is the sum over the cells of field times the
     *  mean of exp(i k position sine) over the cell's sines, k the wavenumber. The field's phase is that of the path to
     *  the array's middle and back. One row per cell. @throws std::invalid_argument when the numbers of rows and cells
     *  differ */
    ComplexRows elementSignals(const ComplexRows& field, std::span<const Cone> cells) const;

    /** Returns beams that look along cones: the sum over the elements of weight * signal * exp(-i k position sine),
     *  within 0.5 %. Uses a Fourier transform over the elements, padded to at least 16 times the array's length, and
     *  linear interpolation between its directions. Elements more than half a wavelength apart make some directions
     *  ambiguous. @throws std::invalid_argument when the numbers of rows and elements differ */
    ComplexRows form(const ComplexRows& element_rows, std::span<const double> sines) const;

private:
    double spacing_, wavelength_;
    std::vector<double> weights_;
};

/** Returns the array of a sonar with `elements`, with the aperture of its receiver's law in azimuth. */
LineArray lineArray(const SonarConfig& config);

/** Returns the beams of a plan as cones about the array. */
std::vector<Cone> makeCones(const Fan& beams);

/** Fills `signals`, except its time, with the elements' signals for a field whose cells are filled. Allocates. */
void computeSignals(const RenderPlan& plan, const EchoField& field, const LineArray& array,
                    types::SonarElements& signals);

}  // namespace insonify::sonar
