#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "components/acoustics/Taper.hpp"

namespace insonify::acoustics {

/** Weights of equal elements, side by side, whose far field is `taper`: its Fourier series, of which the coefficients
 *  are the far field at whole u (Woodward 1946), as far as the elements can resolve and there are directions. They sum
 *  up to 1. `aperture`: length of the array [wavelengths]. */
std::vector<double> elementWeights(size_t count, double aperture, const Taper& taper);

/** Place of the middle of an element, from -1/2 to 1/2 of the array's length [1]. */
double elementPlace(size_t element, size_t count);

/** The far field of elements, sum over m of part_m exp(2 pi i u place_m), by a table over u of 16 values in each unit
 *  and cubics between them: within 1e-4 of the sum of the magnitudes of the parts. */
class ElementField {
public:
    /** No elements: 0 everywhere. */
    ElementField() = default;
    explicit ElementField(std::span<const std::complex<double>> parts);

    bool empty() const { return table_.empty(); }
    /** At u = length / wavelength (sin(angle) - sin(axis)), any number [1]. */
    std::complex<double> at(double u) const;

private:
    std::complex<double> entry(long place) const;

    long period_ = 0;  ///< Places of the table until the field is the same, or its negative.
    double sign_ = 1;  ///< By which a period multiplies the field.
    std::vector<std::complex<double>> table_;
};

}  // namespace insonify::acoustics
