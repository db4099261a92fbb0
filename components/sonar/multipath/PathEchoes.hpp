#pragma once
#include <memory>

#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {

/** Makes the effect of echoes via mirrors, in one or both directions (ACOUSTICS.md 5.23). Rays that first hit a mirror
 *  are followed further. Their next hit returns an echo at half of its two-way path. Echoes of all cells are summed in
 *  whole quanta, so their order is free. The plan has Pass::Paths and outlives the effect. Null in a build without
 *  rays. */
std::unique_ptr<PingEffect> makePathEchoes(const RenderPlan& plan, const types::Geometry& geometry);

}  // namespace insonify::sonar
