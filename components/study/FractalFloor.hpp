#pragma once
#include <cstdint>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::study {

/** A rough sea floor, the same in all directions: Gaussian heights whose power spectrum is a power of the wavenumber.
 */
struct FractalFloor {
    int points = 512;      ///< Heights along a side, a power of two; triangles: 2 (points - 1)^2 [1].
    double side = 60;      ///< Of the square between the outermost points [m].
    double slope = -2.7;   ///< Exponent of the power spectrum of a profile; of the surface's it is one less [1].
    double rms = 0.35;     ///< Of the heights about their mean, 0 [m].
    double centre_x = 25;  ///< Of the square; the other coordinate is 0 [m].
    double depth = 3;      ///< Mean height is -depth [m].
    uint64_t seed = 1;
};

/** Heights about their mean, [x][y] [m]: complex Gaussian amplitudes, scaled by the root of the spectrum, through a
 *  Fourier transform; they carry on periodically at the edges. */
std::vector<double> heightsOf(const FractalFloor& floor);

/** The floor as one mesh, two triangles between four points. */
types::Mesh meshOf(const FractalFloor& floor);

/** The same triangles in tiles by tiles meshes. */
std::vector<types::Mesh> tilesOf(const FractalFloor& floor, int tiles);

}  // namespace insonify::study
