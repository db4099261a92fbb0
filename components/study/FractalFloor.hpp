#pragma once
#include <cstdint>
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::study {

/** A rough, isotropic sea floor: Gaussian heights whose power spectrum is a power of the wavenumber. */
struct FractalFloor {
    int points = 512;      ///< Number of heights along a side, a power of two; triangles: 2 (points - 1)^2 [1].
    double side = 60;      ///< Side of the square between the outermost points [m].
    double slope = -2.7;   ///< Exponent of the power spectrum of a profile; that of the surface is one less [1].
    double rms = 0.35;     ///< rms height about the mean [m].
    double centre_x = 25;  ///< Centre of the square; the other coordinate is 0 [m].
    double depth = 3;      ///< Mean height is -depth [m].
    uint64_t seed = 1;
};

/** Returns the heights about their mean, [x][y] [m]: complex Gaussian amplitudes, scaled by the root of the spectrum
 *  and Fourier-transformed; they are periodic at the edges. */
std::vector<double> heightsOf(const FractalFloor& floor);

/** Returns the floor as one mesh, with two triangles between four points. */
types::Mesh meshOf(const FractalFloor& floor);

/** Returns the same triangles as tiles x tiles meshes. */
std::vector<types::Mesh> tilesOf(const FractalFloor& floor, int tiles);

}  // namespace insonify::study
