#pragma once
#include <optional>
#include <vector>

#include "components/noise/Noise.hpp"
#include "components/receiver/Receiver.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/CodedPing.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** A simulated sonar, from its scene to its codes. */
struct FitChain {
    sonar::SonarConfig sonar;
    types::Snapshot snapshot;  ///< The scene, and the sonar's pose in it.
    noise::NoiseConfig noise;
    receiver::ReceiverConfig receiver;
    bool looks_abeam = false;             ///< Whether it is a side-scan.
    std::vector<types::Pose> lines = {};  ///< Poses of a side-scan's lines; else empty.
    double side = 0;                      ///< Side of these lines: below 0 starboard, above 0 port.

    bool isSideScan() const { return !lines.empty(); }
    receiver::CodeConfig code() const { return receiver.code.value_or(receiver::CodeConfig{}); }
};

/** Places the lines of a side-scan on a straight track ahead, with the recording's altitudes above the scene's floor,
 *  distances and pitch. Roll is omitted: recorders stamp it late, and levels do not follow it (measured in one log).
 *  The floor is at the first echo of the chain's sonar straight down.
 *  @throws types::ConfigError if there is no such echo */
void layLines(const CodedPing& recorded, FitChain& chain);

/** Gives the chain's sonar the beams, bins, speed of sound and frequency of a recording, as far as it states them, and
 *  its receiver the law of the codes. */
void copyShape(const CodedPing& recorded, FitChain& chain);

/** Returns the mean intensities of echoes over all speckle, without noise and absorption, relative to the source [1].
 *  For a side-scan the beams are a subset of its lines. */
types::Sonar meanEchoes(const FitChain& chain);

/** Returns the distance from the chain's sonar straight down to its scene, by a narrow beam [m]; none within 20 times
 *  its range. */
std::optional<double> floorBelow(const FitChain& chain);

/** Returns pings of the chain as output by an instrument, with speckle and noise. One from each of `count` places side
 *  by side, so far apart that their speckle is independent; for a side-scan one of all lines. */
std::vector<CodedPing> simulatedPings(const FitChain& chain, size_t count);

/** Returns the pose pitched down by `pitch` [rad] about the sonar's own axis and raised by `up` [m]. */
types::Pose moved(const types::Pose& pose, double pitch, double up);

}  // namespace insonify::study
