#pragma once
#include "components/sonar/EchoField.hpp"
#include "components/sonar/LineArray.hpp"
#include "components/sonar/RenderPlan.hpp"
#include "types/SonarElements.hpp"

namespace insonify::sonar {

/** The array of a sonar with `elements`, whose aperture is that of its receiver's law in azimuth. */
LineArray lineArrayOf(const SonarConfig& config);

/** The beams of a plan as cones about the array. */
std::vector<Cone> conesOf(const std::vector<Beam>& beams);

/** What the elements hear of a field whose cells are filled, into all of `signals` but its time. Allocates. */
void takeSignals(const RenderPlan& plan, const EchoField& field, const LineArray& array, types::SonarElements& signals);

}  // namespace insonify::sonar
