#pragma once
#include <string>

#include "components/sonar/SonarConfig.hpp"
#include "types/Snapshot.hpp"

namespace insonify::sonar {

/** How far it has listened, and over which azimuth. */
struct Coverage {
    double range_max;    ///< Far edge of the last bin [m].
    double covered_deg;  ///< From edge to edge [deg].
};

/** Why a sonar may hear nothing, for who set it up: where it is, which way it looks, where the scene lies and how far
 *  its nearest point is, and which of range, aperture and fan that point is out of. Takes time in proportion to the
 *  triangles of the scene.
 */
std::string silenceText(const SonarConfig& config, const Coverage& reach, const types::Snapshot& scene);

}  // namespace insonify::sonar
