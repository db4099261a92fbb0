#pragma once
#include "types/Geometry.hpp"

namespace insonify::scene {

/** Finds for each patch of a mesh, whose clusters are complete, about a quarter as many triangles as its parts have
 * that stand for it. They reach a little into the patches about it, so that neighbours of any detail leave no gap. */
void simplifyPatches(types::Mesh& mesh);

}  // namespace insonify::scene
