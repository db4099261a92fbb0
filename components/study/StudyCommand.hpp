#pragma once
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <string>

#include "components/command/Action.hpp"
#include "components/sonar/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** A sonar as it is configured, of the quality that it has chosen, and what it renders in one ping. */
struct SonarAt {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};
/** The first sonar of a deployment at its ping number `ping`, from 1. Throws types::ConfigError where there is none. */
using FindSonar = std::function<SonarAt(const std::string& deployment, uint64_t ping)>;

/** Adds the command `study` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, command::Action& action, const FindSonar& sonarAt);

// Each adds one study to the command `study`.
void addErrorStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addOmissionStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addRaysStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addStabilityStudy(CLI::App& study, command::Action& action);

}  // namespace insonify::study
