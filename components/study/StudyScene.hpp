#pragma once
#include <string>
#include <vector>

#include "components/sonar/SonarConfig.hpp"
#include "components/study/Truth.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** A scene, the sonar that looks at it, and what it should hear. */
struct StudyScene {
    std::string name;
    std::string doc;
    sonar::SonarConfig config;  ///< Its quality is what a study varies.
    types::Snapshot snapshot;
    Truth truth;            ///< Empty: the reference has to be computed.
    double range_from = 0;  ///< Bins that begin nearer are not compared: the aperture's edge lies there [m].
};

/** The scenes with a closed form: flat_bottom, flat_bottom_edge (its aperture's edge included), flat_bottom_pitched,
 *  tilted_plane, wall, facing_disc, sphere, two_spheres, shadow_screen. */
std::vector<StudyScene> closedFormScenes();

/** Energies of all bins, [beam][bin], by the scene's truth. */
std::vector<double> trueEnergies(const StudyScene& scene);

}  // namespace insonify::study
