#pragma once
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <string>
#include <vector>

#include "components/command/Action.hpp"
#include "components/command/Json.hpp"
#include "components/receiver/ReceiverConfig.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/ErrorAnalysis.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::study {

/** A sonar as it is configured, of the quality that it has chosen, and what it renders in one ping. */
struct SonarAt {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};
/** The first sonar of a deployment at its ping number `ping`, from 1. Throws types::ConfigError where there is none. */
using FindSonar = std::function<SonarAt(const std::string& deployment, uint64_t ping)>;

/** A ping that a receiver gave out as codes, and by what law. */
struct PingAt {
    types::Sonar ping;
    receiver::CodeConfig code;
};
/** The ping number `ping`, from 1, of the first receiver of a deployment that gives out codes, all noise included.
 *  Throws types::ConfigError where there is none. */
using FindPing = std::function<PingAt(const std::string& deployment, uint64_t ping)>;

/** Adds the command `study` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, command::Action& action, const FindSonar& sonarAt, const FindPing& pingAt);

/** Options of the studies that set simulated pings beside recorded ones. */
struct RecordingOptions {
    std::string deployment, out;
    std::vector<std::string> real;
    uint64_t ping = 1;

    /** Adds them to a command. @param deployment_help what the deployment is studied for
     *  @return the option --real */
    CLI::Option* addTo(CLI::App& command, const std::string& deployment_help);
};

/** {claim, measured, bound, verdict} of each. */
command::Json verdictsOf(const std::vector<Claim>& claims);

// Each adds one study to the command `study`.
void addErrorStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addLikenessStudy(CLI::App& study, command::Action& action, const FindPing& pingAt);
void addMultipathStudy(CLI::App& study, command::Action& action);
void addOmissionStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addRaysStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addSpeckleStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addStabilityStudy(CLI::App& study, command::Action& action);

}  // namespace insonify::study
