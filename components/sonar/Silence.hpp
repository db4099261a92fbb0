#pragma once
#include <string>

#include "components/sonar/RenderPlan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Why a sonar may hear nothing, for who set it up: where it is, which way it looks, where the scene lies and how far
 *  its nearest point and its nearest point target are, and what keeps it from hearing these: range, aperture, fan, or a
 *  material that gives nothing back. Sidelobes count as far as the plan hears them. `all_round`: its head has turned.
 *  Takes time in proportion to the triangles of the scene. */
std::string silenceText(const RenderPlan& plan, bool all_round, const types::Snapshot& scene);

/** That the sonar is inside of an object, with where it is and how far the object's nearest point. */
std::string enclosureText(const types::Snapshot& scene, uint32_t object);

}  // namespace insonify::sonar
