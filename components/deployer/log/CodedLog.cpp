#include "components/deployer/log/CodedLog.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "components/deployer/Pipeline.hpp"
#include "components/deployer/Tasks.hpp"
#include "components/deployer/log/LoggedTrack.hpp"
#include "components/deployer/log/StreamMeaning.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {
namespace {

bool areCodes(const types::Sonar& ping) {
    return std::ranges::all_of(ping.bins, [](float bin) { return bin >= 0 && bin <= 65535 && std::floor(bin) == bin; });
}

/** Returns the pings of a stream; none where a ping has bins that are not codes. */
std::vector<types::Sonar> codesOf(log::Reader& log, size_t stream) {
    std::vector<types::Sonar> pings;
    for (const log::SampleRef& at : log.samples()) {
        if (at.stream != stream) continue;
        log.read(at, pings.emplace_back());
        if (!areCodes(pings.back())) return {};
    }
    return pings;
}

/** Reads the code of the receiver that writes a stream from the log's own deployment. */
void readLaw(const log::Reader& log, const std::string& stream, CodedLog& coded) {
    const std::string text = log.metadatum("insonify_deployment");
    if (text.empty()) return;
    try {
        framework::Registry registry = coreTasks();
        const framework::Deployment deployment(framework::DeploymentSpec::parse(text, log.path().string()), registry);
        const auto* receiver =
            dynamic_cast<const receiver::ReceiverTask*>(deployment.task(framework::splitPort(stream).first));
        if (!receiver || !receiver->config->code) return;
        coded.code = *receiver->config->code;
        coded.law_known = text.find("law:") != std::string::npos;  // an import omits what it does not know
    } catch (const types::ConfigError&) {                          // the deployment's files or libraries are elsewhere
    }
}

/** Reads the sonar's place at each ping, as far as the log has it. */
void readPlaces(log::Reader& log, const log::Stream& pings, CodedLog& coded) {
    const LoggedTrack track(log, posesOfSonar(log), mountOf(meaningOf(log, pings)));
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
        CodedLog coded{.pings = codesOf(*log, i)};
        if (coded.pings.empty()) continue;
        readLaw(*log, stream.name, coded);
        readPlaces(*log, stream, coded);
        if (const auto at = stream.metadata.find("insonify_frequency_khz"); at != stream.metadata.end())
            std::from_chars(at->second.data(), at->second.data() + at->second.size(), coded.frequency_khz);
        return coded;
    }
    throw types::ConfigError(file.string(), "", "has no stream of pings of codes, which are whole numbers");
}

}  // namespace insonify::deployer
