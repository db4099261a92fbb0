// insonify study error|likeness|multipath|omission|speckle|stability
#include "components/study/commands/StudyCommand.hpp"

namespace insonify::study {

void addCommand(CLI::App& app, command::Action& action, const FindSonar& sonarAt, const FindPings& pingsAt,
                const FindChain& chainAt, const ReadLog& readLog) {
    CLI::App* study = app.add_subcommand("study", "Measures the simulator itself");
    study->require_subcommand(1);
#ifdef INSONIFY_EMBREE
    addErrorStudy(*study, action, sonarAt);
    addRaysStudy(*study, action, sonarAt);
    addMultipathStudy(*study, action);
#endif
    addLikenessStudy(*study, action, pingsAt, chainAt, readLog);
    addOmissionStudy(*study, action, sonarAt);
    addSpeckleStudy(*study, action, sonarAt, readLog);
    addStabilityStudy(*study, action);
}

CLI::Option* RecordingOptions::addTo(CLI::App& command, const std::string& deployment_help) {
    command.add_option("DEPLOYMENT", deployment, deployment_help);
    CLI::Option* recordings =
        command.add_option("--real", real, "recordings of a device, or logs: files, or folders of them");
    command.add_option("--out", out, "folder of the report");
    command.add_option("--ping", ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    return recordings;
}

command::Json verdictsOf(const std::vector<Claim>& claims) {
    command::Json verdicts = command::Json::array();
    for (const Claim& claim : claims)
        verdicts.push_back({{"claim", claim.text},
                            {"measured", claim.measured},
                            {"bound", claim.bound},
                            {"verdict", claim.verdict()}});
    return verdicts;
}

}  // namespace insonify::study
