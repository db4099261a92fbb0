#pragma once
#include "components/deployer/Json.hpp"
#include "components/framework/Registry.hpp"

namespace insonify::deployer {

/** The JSON schema (draft 2020-12) of deployments with these tasks, made from what they describe of themselves: keys,
 *  types, bounds, defaults, names of enums and documentation, which ends in the unit. Numbers may be texts with a unit,
 *  "20.deg". Where a task has aliases, copies or switches, its properties may have other names; where a deployment has
 *  libraries, other types. What depends on several keys together is checked by `insonify check` alone. */
Json deploymentSchema(const framework::Registry& registry);

}  // namespace insonify::deployer
