#pragma once
#include "components/scene/Surface.hpp"

namespace insonify::scene {

/** Gives every triangle its own three vertices with the normal of its plane. */
void makeFlatNormals(Surface& surface);

/** Tangents along growing u from positions, normals and uvs; w says that -dP/dv is w cross(normal, tangent), as glTF
 *  means it. A vertex between triangles whose uvs are mirrored is doubled. */
void makeTangents(Surface& surface);

}  // namespace insonify::scene
