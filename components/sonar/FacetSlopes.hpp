#pragma once
#include <vector>

#include "types/Geometry.hpp"

namespace insonify::sonar {

/** What each facet of a mesh adds to the mean square slope of a lobe (ACOUSTICS.md 3.6) [1]: half the square of the
 *  step to its neighbours' normals, so that the lobes of a curved surface's facets join, and lambda^2 / (4 pi A) of the
 *  flat part of area A that it belongs to. Steeper than 60 deg an edge is an edge, and no curve. `scale`: metres of the
 *  world to a unit of the mesh; `wavelength` [m], 0: none is known. */
std::vector<float> facetSlopes(const types::Mesh& mesh, double scale, double wavelength);

}  // namespace insonify::sonar
