#pragma once
#include <memory>

#include "components/sonar/effects/Effect.hpp"

namespace insonify::sonar {

/** Echoes by way of mirrors, in one or both directions (ACOUSTICS.md 5.23). Rays that meet a mirror before all else
 *  are followed on. What they then meet returns an echo at half of its way out and back. Echoes of all cells are summed
 *  in whole quanta, so their order is free. The plan has Pass::Paths and outlives what is made. Null in a build without
 *  rays. */
std::unique_ptr<PingEffect> makePathEchoes(const RenderPlan& plan, const types::Geometry& geometry);

}  // namespace insonify::sonar
