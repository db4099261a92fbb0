#pragma once
#include "components/deployer/Commands.hpp"

namespace insonify::deployer {

// Each adds one study to the command `study`.
void addErrorStudy(CLI::App& study, Action& action);
void addOmissionStudy(CLI::App& study, Action& action);
void addRaysStudy(CLI::App& study, Action& action);
void addStabilityStudy(CLI::App& study, Action& action);

}  // namespace insonify::deployer
