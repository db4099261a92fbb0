#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "components/acoustics/Taper.hpp"

namespace insonify::acoustics {

/** Returns the weights of adjacent equal elements whose far field is `taper`. They are its Fourier series with the far
 *  field at whole u as coefficients (Woodward 1946), up to what the elements resolve and to directions that exist. They
 *  sum up to 1. `aperture`: length of the array [wavelengths]. */
std::vector<double> elementWeights(size_t count, double aperture, const Taper& taper);

/** Returns the place of an element's middle, from -1/2 to 1/2 of the array's length [1]. */
double elementPlace(size_t element, size_t count);

/** The far field of elements, sum over m of part_m exp(2 pi i u place_m), from a table over u. The table has 16 values
 *  per unit, interpolated by cubics: the error is at most 1e-4 of the sum of the magnitudes of the parts. */
class ElementField {
public:
    /** Makes a field without elements: 0 everywhere. */
    ElementField() = default;
    explicit ElementField(std::span<const std::complex<double>> parts);

    bool empty() const { return table_.empty(); }
    /** Returns the field at u = length / wavelength (sin(angle) - sin(axis)), any number [1]. */
    std::complex<double> at(double u) const;

private:
    std::complex<double> entry(long place) const;

    long period_ = 0;  ///< Entries of the table after which the field, or its negative, repeats.
    double sign_ = 1;  ///< Factor of the field from one period to the next, 1 or -1.
    std::vector<std::complex<double>> table_;
};

}  // namespace insonify::acoustics
