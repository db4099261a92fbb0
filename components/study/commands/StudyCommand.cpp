// insonify study error|likeness|multipath|omission|speckle|stability
#include "components/study/commands/StudyCommand.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/FittedDeployment.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/deployer/log/Export.hpp"
#include "components/deployer/log/LoggedTrack.hpp"
#include "components/log/Reader.hpp"
#include "components/receiver/Receiver.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::deployer {

/** The pings of a log, imported or recorded from a run, whose receiver output codes. */
struct CodedLog {
    std::vector<types::Sonar> pings;
    std::vector<types::Pose> sonars = {};  ///< Poses of the sonar at the pings; an unusable pose is unknown.
    std::vector<double> altitudes = {};    ///< Above the bottom at each ping [m]; 0: unknown.
    receiver::CodeConfig code = {};        ///< As far as the log records it.
    bool law_known = false;                ///< Whether the log records the law of the codes.
    double frequency_khz = 0;              ///< 0: unknown.
};

/** Reads the first stream of a log whose bins are all codes, that is whole numbers from 0 to 65535, with the poses and
 *  altitudes at its pings (LoggedTrack.hpp). Returns none if the file name is not that of a log. Throws
 *  types::ConfigError for a log that cannot be read or has no such stream. */
std::optional<CodedLog> codedLog(const std::filesystem::path& file);

namespace {

bool areCodes(const types::Sonar& ping) {
    return std::ranges::all_of(ping.bins, [](float bin) { return bin >= 0 && bin <= 65535 && std::floor(bin) == bin; });
}

/** Returns the pings of a stream; none where a ping has bins that are not codes. */
std::vector<types::Sonar> readCodes(log::Reader& log, size_t stream) {
    std::vector<types::Sonar> pings;
    for (const log::SampleRef& at : log.samples()) {
        if (at.stream != stream) continue;
        log.read(at, pings.emplace_back());
        if (!areCodes(pings.back())) return {};
    }
    return pings;
}

/** Reads the code of the receiver that writes a stream from the log's own deployment, whose other files are not needed.
 */
void readLaw(const log::Reader& log, const log::Stream& stream, CodedLog& coded) {
    const Json code = readMeaning(log, stream)["code"];
    receiver::CodeConfig found;
    framework::ConfigReader reader("");
    if (!code.is_object() || !reader.read(YAML::Load(code.dump()), "", found) || !reader.diagnostics().empty()) return;
    coded.code = found;
    coded.law_known = code.contains("law");  // an import omits what it does not know
}

/** Reads the sonar's place at each ping, as far as the log has it. */
void readPlaces(log::Reader& log, const log::Stream& pings, CodedLog& coded) {
    const LoggedTrack track(log, posesOfSonar(log), findMount(readMeaning(log, pings)));
    const LoggedAltitudes altitudes(log);
    for (const types::Sonar& ping : coded.pings) {
        coded.sonars.push_back(track.at(ping.time));
        coded.altitudes.push_back(altitudes.at(ping.time));
    }
}

}  // namespace

std::optional<CodedLog> codedLog(const std::filesystem::path& file) {
    if (!log::findLogFormat(file)) return std::nullopt;
    const auto log = log::openWholeLog(file).log;
    for (size_t i = 0; i < log->streams().size(); ++i) {
        const log::Stream& stream = log->streams()[i];
        if (!stream.holds<types::Sonar>()) continue;
        dropDamaged(*log, stream.name);
        CodedLog coded{.pings = readCodes(*log, i)};
        if (coded.pings.empty()) continue;
        readLaw(*log, stream, coded);
        readPlaces(*log, stream, coded);
        if (const auto at = stream.metadata.find("insonify_frequency_khz"); at != stream.metadata.end())
            std::from_chars(at->second.data(), at->second.data() + at->second.size(), coded.frequency_khz);
        return coded;
    }
    throw types::ConfigError(file.string(), "", "has no stream of pings of codes, which are whole numbers");
}

}  // namespace insonify::deployer

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

console::Json getVerdicts(const std::vector<Claim>& claims) {
    console::Json verdicts = console::Json::array();
    for (const Claim& claim : claims)
        verdicts.push_back({{"claim", claim.text},
                            {"measured", claim.measured},
                            {"bound", claim.bound},
                            {"verdict", claim.verdict()}});
    return verdicts;
}

}  // namespace insonify::study
