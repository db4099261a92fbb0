#include "components/pocolog/Pings.hpp"

#include "components/pocolog/SampleTypes.hpp"

namespace insonify::pocolog {
namespace {

template <class T>
types::Sonar converted(Reader& log, const SampleRef& at) {
    T sample;
    log.read(at, sample);
    try {
        return toSonar(sample);
    } catch (const std::logic_error& error) {
        throw types::ConfigError(log.path(), log.streams()[at.stream].name, std::string("a sample ") + error.what());
    }
}

}  // namespace

bool holdsPings(const Stream& stream) {
    return stream.holds<types::Sonar>() || stream.holds<types::SonarBeam>() || stream.holds<types::SonarScan>();
}

void readPing(Reader& log, const SampleRef& at, types::Sonar& ping) {
    const Stream& stream = log.streams()[at.stream];
    if (stream.holds<types::SonarBeam>())
        ping = converted<types::SonarBeam>(log, at);
    else if (stream.holds<types::SonarScan>())
        ping = converted<types::SonarScan>(log, at);
    else
        log.read(at, ping);
    if (!ping.wellShaped())
        throw types::ConfigError(log.path(), stream.name, "a ping has other numbers of bins or bearings than it says");
    ping.time = sampleTime(ping, at.time);
}

}  // namespace insonify::pocolog
