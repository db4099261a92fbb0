#pragma once
#include <optional>
#include <vector>

#include "components/noise/NoiseConfig.hpp"
#include "components/receiver/ReceiverConfig.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/CodedPing.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** A simulated sonar from its scene to its codes. */
struct FitChain {
    sonar::SonarConfig sonar;
    types::Snapshot snapshot;  ///< Where the sonar is in which scene.
    noise::NoiseConfig noise;
    receiver::ReceiverConfig receiver;
    bool looks_abeam = false;             ///< It is a side-scan.
    std::vector<types::Pose> lines = {};  ///< Of a side-scan: its places, one for each line; else empty.
    double side = 0;                      ///< Of these lines: below 0 starboard, above 0 port.

    bool isSideScan() const { return !lines.empty(); }
    receiver::CodeConfig code() const { return receiver.code.value_or(receiver::CodeConfig{}); }
};

/** Lays the lines of a side-scan on a straight way ahead: as high above the scene's floor as the recording states its
 *  altitude, as far apart, and pitched as there. Its roll is left out: recorders stamp it late, and levels do not
 *  follow it (measured in one log). The floor is where the chain's sonar has its first echo straight down.
 *  @throws types::ConfigError where it has none */
void layLines(const CodedPing& recorded, FitChain& chain);

/** Gives the chain's sonar the beams, bins, speed of sound and frequency of a recording, as far as it states them, and
 *  its receiver the law of the codes. */
void takeShape(const CodedPing& recorded, FitChain& chain);

/** Mean intensities of echoes over all speckle, without noise and absorption, relative to the source [1]. Of a
 * side-scan the beams are some of its lines. */
types::Sonar meanEchoes(const FitChain& chain);

/** Distance from the chain's sonar to its scene straight down, by a narrow beam [m]; none within 20 times its range. */
std::optional<double> floorBelow(const FitChain& chain);

/** Pings of the chain as an instrument gives them out, speckle and noise included: one from each of `count` places
 *  side by side, so far apart that they share no speckle; of a side-scan one of all lines. */
std::vector<CodedPing> simulatedPings(const FitChain& chain, size_t count);

/** The pose after a turn that looks down by `pitch` [rad] about the sonar's own axis and a rise of `up` [m]. */
types::Pose moved(const types::Pose& pose, double pitch, double up);

}  // namespace insonify::study
