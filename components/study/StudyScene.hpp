#pragma once
#include <string>
#include <vector>

#include "components/sonar/plan/SonarConfig.hpp"
#include "components/study/oracles/Truth.hpp"
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

/** A scene that takes a while to make. */
struct SceneMaker {
    const char* name;
    StudyScene (*make)();
};

/** The scenes with a closed form: flat_bottom, flat_bottom_edge (its aperture's edge included), flat_bottom_pitched,
 *  tilted_plane, pitched_bottom_pattern (a beam pattern in elevation), wall, facing_disc, sphere, sphere_lobe,
 *  two_spheres, volume_over_bottom, shadow_screen. */
const std::vector<SceneMaker>& closedFormScenes();

/** The scenes without a closed form: rough_floor, bench_floor. */
const std::vector<SceneMaker>& computedScenes();

/** A fractal floor (FractalFloor.hpp) of 2 (points - 1)^2 triangles, 522,242 of them by default, from 3 m above it, 8
 *  deg down: 128 beams over 90 x 20 deg, 400 bins to 40 m. */
StudyScene roughFloor(int points = 512);

/** The scene that scripts/make_bench_scene.py makes, a rolling floor with 20 objects on it seen at grazing angles:
 *  80,000 triangles at 200 cells. Objects stand where they stand there, of a few triangles more or fewer. */
StudyScene benchFloor(int cells = 200);

/** Energies of all bins, [beam][bin], by the scene's truth. */
std::vector<double> trueEnergies(const StudyScene& scene);

}  // namespace insonify::study
