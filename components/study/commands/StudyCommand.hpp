#pragma once
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "components/command/Action.hpp"
#include "components/command/Json.hpp"
#include "components/receiver/ReceiverConfig.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/ErrorAnalysis.hpp"
#include "components/study/FitChain.hpp"
#include "components/study/FitReport.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::study {

/** A configured sonar with its chosen quality, and the snapshot of one ping. */
struct SonarAt {
    sonar::SonarConfig config;
    types::Snapshot snapshot;
};
/** Returns the first sonar of a deployment at its ping number `ping`, from 1. Throws types::ConfigError if there is
 *  none. */
using FindSonar = std::function<SonarAt(const std::string& deployment, uint64_t ping)>;

/** Pings that a receiver output as codes, and their law. */
struct PingsAt {
    std::vector<types::Sonar> pings;
    receiver::CodeConfig code;
};
/** Returns at most `count` pings from number `ping`, from 1, of the first receiver of a deployment that outputs codes,
 *  with all noise. Throws types::ConfigError if there is none. @param settings properties that replace the
 *  deployment's, "task.property=value" */
using FindPings = std::function<PingsAt(const std::string& deployment, uint64_t ping, size_t count,
                                        const std::vector<std::string>& settings)>;

/** The chain of a deployment's pings, and the names of its tasks. */
struct ChainAt {
    FitChain chain;
    FitTasks tasks;
};
/** Returns the chain of a deployment at its ping number `ping`, from 1. Throws types::ConfigError if it is
 *  incomplete. @param settings see FindPings */
using FindChain =
    std::function<ChainAt(const std::string& deployment, uint64_t ping, const std::vector<std::string>& settings)>;
/** Returns the text of a deployment with these settings, for a file in `folder`, with lines at its head. */
using WriteDeployment =
    std::function<std::string(const std::string& deployment, const std::vector<FitSetting>& settings,
                              const std::filesystem::path& folder, const std::vector<std::string>& head)>;

/** Adds the command `study` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, command::Action& action, const FindSonar& sonarAt, const FindPings& pingsAt,
                const FindChain& chainAt, const ReadLog& readLog);

/** Adds the command `fit`. */
void addFit(CLI::App& app, command::Action& action, const FindChain& chainAt, const WriteDeployment& write,
            const ReadLog& readLog);

/** Options of the studies that compare simulated with recorded pings. */
struct RecordingOptions {
    std::string deployment, out;
    std::vector<std::string> real;
    uint64_t ping = 1;

    /** Adds the options to a command. @param deployment_help purpose of the deployment
     *  @return the option --real */
    CLI::Option* addTo(CLI::App& command, const std::string& deployment_help);
};

/** Returns {claim, measured, bound, verdict} of each claim. */
command::Json verdictsOf(const std::vector<Claim>& claims);

// Each function adds one study to the command `study`.
void addErrorStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addLikenessStudy(CLI::App& study, command::Action& action, const FindPings& pingsAt, const FindChain& chainAt,
                      const ReadLog& readLog);
void addMultipathStudy(CLI::App& study, command::Action& action);
void addOmissionStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addRaysStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt);
void addSpeckleStudy(CLI::App& study, command::Action& action, const FindSonar& sonarAt, const ReadLog& readLog);
void addStabilityStudy(CLI::App& study, command::Action& action);

}  // namespace insonify::study
