// insonify study error|likeness|multipath|omission|speckle|stability
#include "components/study/commands/StudyCommand.hpp"

#include "components/deployer/FittedDeployment.hpp"
#include "components/deployer/log/CodedLog.hpp"

namespace insonify::study {

ChainAt chainAt(const std::string& deployment, uint64_t ping, const std::vector<std::string>& settings) {
    deployer::ChainAt at = deployer::chainAt(deployment, ping, settings);
    return {.chain = {.sonar = std::move(at.sonar),
                      .snapshot = std::move(at.snapshot),
                      .noise = std::move(at.noise),
                      .receiver = std::move(at.receiver),
                      .looks_abeam = at.looks_abeam},
            .tasks = {.vehicle = at.vehicle_task,
                      .scene = at.scene_task,
                      .sonar = at.sonar_task,
                      .noise = at.noise_task,
                      .receiver = at.receiver_task,
                      .period = at.period,
                      .mount = at.mount}};
}

std::optional<LoggedPings> readLog(const std::filesystem::path& file) {
    std::optional<deployer::CodedLog> log = deployer::codedLog(file);
    if (!log) return std::nullopt;
    return LoggedPings{.pings = std::move(log->pings),
                       .code = log->code,
                       .law_known = log->law_known,
                       .frequency_khz = log->frequency_khz,
                       .sonars = std::move(log->sonars),
                       .altitudes = std::move(log->altitudes)};
}

void addCommand(CLI::App& app, console::Action& action) {
    CLI::App* study = app.add_subcommand("study", "Measures the simulator itself");
    study->require_subcommand(1);
    addErrorStudy(*study, action);
    addRaysStudy(*study, action);
    addMultipathStudy(*study, action);
    addLikenessStudy(*study, action);
    addOmissionStudy(*study, action);
    addSpeckleStudy(*study, action);
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

console::Json verdictsOf(const std::vector<Claim>& claims) {
    console::Json verdicts = console::Json::array();
    for (const Claim& claim : claims)
        verdicts.push_back({{"claim", claim.text},
                            {"measured", claim.measured},
                            {"bound", claim.bound},
                            {"verdict", claim.verdict()}});
    return verdicts;
}

}  // namespace insonify::study
