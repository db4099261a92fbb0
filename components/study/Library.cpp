// The component library study: loaded by the command for `insonify study`.
#include "components/deployer/CodedLog.hpp"
#include "components/deployer/FittedDeployment.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/loader/Interface.hpp"
#include "components/study/commands/StudyCommand.hpp"

INSONIFY_COMPONENT_LIBRARY;

namespace insonify::study {
namespace {

SonarAt sonarAt(const std::string& deployment, uint64_t ping) {
    deployer::SonarAt at = deployer::sonarAt(deployment, ping);
    return {std::move(at.config), std::move(at.snapshot)};
}

PingsAt codedPingsAt(const std::string& deployment, uint64_t ping, size_t count,
                     const std::vector<std::string>& settings) {
    deployer::PingsAt at = deployer::codedPingsAt(deployment, ping, count, settings);
    return {std::move(at.pings), at.code};
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

std::string fittedText(const std::string& deployment, const std::vector<FitSetting>& settings,
                       const std::filesystem::path& folder, const std::vector<std::string>& head) {
    std::vector<deployer::CommentedSetting> all;
    for (const FitSetting& setting : settings) all.push_back({setting.path, setting.value, setting.comment});
    return deployer::deploymentWith(deployment, all, folder, head);
}

}  // namespace
}  // namespace insonify::study

extern "C" void insonify_add_command(CLI::App& app, insonify::command::Action& action) {
    insonify::study::addCommand(app, action, insonify::study::sonarAt, insonify::study::codedPingsAt,
                                insonify::study::chainAt, insonify::study::readLog);
    insonify::study::addFit(app, action, insonify::study::chainAt, insonify::study::fittedText,
                            insonify::study::readLog);
}
