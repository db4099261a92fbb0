#pragma once
#include "components/study/FractalFloor.hpp"

namespace insonify::test {

/** A level floor of `size` x `size` about (0, 0, z), rough by `rms`, of 2 (points - 1)^2 triangles; its power spectrum
 *  falls with the wavenumber to the power -2.7, as that of sand and rock does [m]. */
inline types::Mesh roughFloor(double z, double size, int points, double rms, unsigned seed) {
    return study::meshOf(study::FractalFloor{
        .points = points, .side = size, .slope = -1.7, .rms = rms, .centre_x = 0, .depth = -z, .seed = seed});
}

}  // namespace insonify::test
