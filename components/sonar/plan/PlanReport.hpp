#pragma once
#include <string>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Plan.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** A plan in words, as `insonify plan` tells it; device and predicted error are not known to it. */
types::Plan report(const RenderPlan& plan, const types::Geometry& geometry);

/** What is left out and why, in words. */
types::Omission describe(const LeftOut& what, const BinGrid& grid);

/** That a sonar is deeper or less deep than its profile of the speed of sound tells; empty where it is not. */
std::string depthNotice(const RenderPlan& plan, const types::Snapshot& snapshot);

/** What a user should know of the configuration alone: range reached, water outside a law's validity... */
std::vector<std::string> configNotices(const SonarConfig& config);

}  // namespace insonify::sonar
