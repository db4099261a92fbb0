#include <fmt/format.h>

#include <cmath>

#include "components/console/Json.hpp"
#include "components/deployer/log/Export.hpp"
#include "components/device/OculusPing.hpp"
#include "components/device/OculusRecording.hpp"
#include "components/device/commands/DeviceCommand.hpp"
#include "components/log/Reader.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using console::Json;
using deployer::getFrequency, deployer::readMeaning, deployer::getPings;
namespace fs = std::filesystem;

[[noreturn]] void refuse(const log::Reader& log, const std::string& stream, const std::string& why) {
    throw types::ConfigError(log.path(), stream, why);
}

/** How the codes of a stream were made. */
struct Codes {
    int bits = 8;
    double gamma = 1;
};

Codes readCodes(const log::Reader& log, const std::string& stream, const Json& meaning) {
    const char* const what =
        "an Oculus' recording takes codes of amplitude: of a receiver with output: code and "
        "code: {law: sqrt}";
    if (meaning.value("output", Json()) != "code")
        refuse(log, stream, fmt::format("holds {}; {}", meaning.value("output", "bins"), what));
    const Json code = meaning["code"].is_object() ? meaning["code"] : Json::object();
    if (code.value("law", "log") != "sqrt")
        refuse(log, stream, fmt::format("holds codes of law {}; {}", code.value("law", "log"), what));
    const Codes codes{code.value("bits", 8), code.value("gamma", 1.0)};
    if (codes.gamma < 1.0 / 255 || codes.gamma > 1)
        refuse(log, stream, fmt::format("holds codes of gamma {:g}; an Oculus has 0.004 to 1", codes.gamma));
    return codes;
}

/** Returns what is common to all pings of a recording. */
OculusResult getSettings(const Codes& codes, double frequency_khz) {
    OculusResult result;
    result.fire.header.version = 2;
    if (codes.bits > 8) result.fire.flags |= OculusFire::wide_16;  // a code is scaled to the sent width
    result.frequency_hz = 1e3 * frequency_khz;
    return result;
}

void setPing(const types::Sonar& ping, double since_first, OculusResult& result) {
    result.speed_of_sound = static_cast<double>(ping.speed_of_sound);
    result.fire.speed_of_sound = result.speed_of_sound;
    result.fire.range = ping.binStart(ping.bin_count);
    result.range_resolution = ping.binStart(1);
    result.start_s = since_first;
    if (ping.beam_count > 256) result.fire.flags |= OculusFire::beams_512;
}

}  // namespace

void exportOculus(log::Reader& log, const std::string& stream, const fs::path& to) {
    const log::Stream& pings = getPings(log, stream, "an Oculus' recording takes pings");
    const Json meaning = readMeaning(log, pings);
    const Codes codes = readCodes(log, pings.name, meaning);
    OculusEncoder encoder(codes.bits);
    OculusResult result = getSettings(codes, getFrequency(meaning));
    OculusRecorder recorder(to, {.time = pings.first.seconds()});
    types::Sonar ping;
    log.forEachRef(stream, [&](const log::SampleRef& at) {
        readPing(log, at, ping);
        if (ping.bin_count > 65535 || ping.beam_count > 65535)
            refuse(log, pings.name, "holds pings of more than 65535 beams or bins");
        setPing(ping, (ping.time - pings.first).seconds(), result);
        result.fire.gamma = 0xFF;  // gamma is applied to the codes already
        encoder.encode(ping, result);
        result.fire.gamma = static_cast<uint8_t>(std::lround(255 * codes.gamma));
        result.settle();
        recorder.write(ping.time.seconds(), toBytes(result));
        ++result.number;
    });
}

}  // namespace insonify::device
