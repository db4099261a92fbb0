#pragma once
#include <optional>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Plan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** Returns a plan in words, as `insonify plan` prints it, without the device and the predicted error. */
types::Plan report(const RenderPlan& plan, const types::Geometry& geometry);

/** Returns in words what is omitted and why. */
types::Omission describe(const Omitted& what, const BinGrid& grid);

/** Returns a warning if the sonar is outside the depths of its sound speed profile. */
std::optional<types::Notice> depthNotice(const RenderPlan& plan, const types::Snapshot& snapshot);

/** Returns notices about the configuration alone: range reached, water outside a law's validity... */
types::Notices configNotices(const SonarConfig& config);

}  // namespace insonify::sonar
