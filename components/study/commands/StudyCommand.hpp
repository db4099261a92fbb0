#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/console/Action.hpp"
#include "components/console/Json.hpp"
#include "components/study/error/ErrorAnalysis.hpp"
#include "components/study/fit/FitChain.hpp"
#include "components/study/fit/FitReport.hpp"

namespace insonify::study {

/** The chain of a deployment's pings, and the names of its tasks. */
struct ChainAt {
    FitChain chain;
    FitTasks tasks;
};
/** Returns the chain of a deployment at its ping number `ping`, from 1, as deployer::chainAt() finds it. */
ChainAt chainAt(const std::string& deployment, uint64_t ping, const std::vector<std::string>& settings);

/** Returns the pings of a log as deployer::codedLog() reads them; none if the file is not a log. */
std::optional<LoggedPings> readLog(const std::filesystem::path& file);

/** Adds the command `study` with its options to `app`; parsing it sets `action`. */
void addCommand(CLI::App& app, console::Action& action);

/** Adds the command `fit`. */
void addFit(CLI::App& app, console::Action& action);

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
console::Json getVerdicts(const std::vector<Claim>& claims);

// Each function adds one study to the command `study`.
void addErrorStudy(CLI::App& study, console::Action& action);
void addLikenessStudy(CLI::App& study, console::Action& action);
void addMultipathStudy(CLI::App& study, console::Action& action);
void addOmissionStudy(CLI::App& study, console::Action& action);
void addRaysStudy(CLI::App& study, console::Action& action);
void addSpeckleStudy(CLI::App& study, console::Action& action);
void addStabilityStudy(CLI::App& study, console::Action& action);

}  // namespace insonify::study
