#pragma once
#include "components/sonar/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** How long rays take (EmbreeCaster) of the number that a sonar's quality asks for: what a renderer is measured by. */
struct RayTimes {
    size_t rays = 0, met = 0;                      ///< Cast in a ping, and those that met something [1].
    double alone_median_ms = 0, alone_p99_ms = 0;  ///< Primary rays and nothing else [ms].
    double ping_median_ms = 0, ping_p99_ms = 0;    ///< With their energies in bins [ms].
};

/** Times so many pings of each kind after a first one, the tree not counted. `config` as for EmbreeCaster. */
RayTimes timeRays(const sonar::SonarConfig& config, const types::Snapshot& scene, int pings);

}  // namespace insonify::study
