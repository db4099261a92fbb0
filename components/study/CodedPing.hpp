#pragma once
#include <string>
#include <vector>

#include "components/device/OculusPing.hpp"
#include "components/receiver/ReceiverConfig.hpp"
#include "types/Sonar.hpp"

namespace insonify::study {

/** A ping as an instrument gives it out, recorded or simulated. */
struct CodedPing {
    std::string name;
    size_t beam_count = 0, bin_count = 0;
    std::vector<double> bearings = {};  ///< Of each beam's middle, 0 ahead, positive to port [rad].
    std::vector<float> codes = {};      ///< Beam-first, as shares of the largest code [1].
    int bits = 8;                       ///< Of a code.
    receiver::CodeConfig law = {};      ///< How codes go with intensity: `law`, `gamma`, `dynamic_range_db`.
    std::string file = {};              ///< Of a recording.

    float code(size_t beam, size_t bin) const { return codes[beam * bin_count + bin]; }
    /** Level of a code below that of the largest; of code 0 that of half a code [dB]. */
    double levelDb(float code) const;
};

/** A recorded ping. Where rows have gains of their own, these are taken off: codes by sqrt(gain), by what open drivers
 *  do. */
CodedPing codedPing(const device::OculusPing& ping, std::string name);

/** A ping that a receiver gave out as codes, by what it was configured to. */
CodedPing codedPing(const types::Sonar& ping, const receiver::CodeConfig& code, std::string name);

/** The pings of Oculus recordings, files or folders of them, each once, named by its number: "recorded_5".
 *  @throws types::ConfigError where a file holds none, or a folder no file */
std::vector<CodedPing> recordedPings(const std::vector<std::string>& names);

}  // namespace insonify::study
