#pragma once
#include <string>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Plan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Returns a plan in words, as `insonify plan` prints it, without the device and the predicted error. */
types::Plan report(const RenderPlan& plan, const types::Geometry& geometry);

/** Returns in words what is omitted and why. */
types::Omission describe(const Omitted& what, const BinGrid& grid);

/** Returns a notice if the sonar is outside the depths of its sound speed profile; empty otherwise. */
std::string depthNotice(const RenderPlan& plan, const types::Snapshot& snapshot);

/** Returns notices about the configuration alone: range reached, water outside a law's validity... */
std::vector<std::string> configNotices(const SonarConfig& config);

}  // namespace insonify::sonar
