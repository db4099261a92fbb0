#pragma once
#include <string>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/oracles/Truth.hpp"
#include "types/Snapshot.hpp"

namespace insonify::study {

/** A scene, the sonar that looks at it, and its expected echoes. */
struct StudyScene {
    std::string name;
    std::string doc;
    sonar::SonarConfig config;  ///< A study varies its quality.
    types::Snapshot snapshot;
    Truth truth;            ///< Empty: the reference must be computed.
    double range_from = 0;  ///< Nearer bins are not compared, because they contain the aperture's edge [m].
};

/** Makes a scene, which takes a while. */
struct SceneMaker {
    const char* name;
    StudyScene (*make)();
};

/** Returns the scenes with a closed form: flat_bottom, flat_bottom_edge (including its aperture's edge),
 *  flat_bottom_pitched, tilted_plane, pitched_bottom_pattern (a beam pattern in elevation), wall, facing_disc, sphere,
 *  sphere_lobe, two_spheres, volume_over_bottom, shadow_screen. */
const std::vector<SceneMaker>& closedFormScenes();

/** Returns the scenes without a closed form: rough_floor, bench_floor. */
const std::vector<SceneMaker>& computedScenes();

/** Returns a fractal floor (FractalFloor.hpp) of 2 (points - 1)^2 triangles, by default 522,242, seen from 3 m above
 *  it, 8 deg down: 128 beams over 90 x 20 deg, 400 bins to 40 m. */
StudyScene roughFloor(int points = 512);

/** Returns the scene of scripts/scenes/make_bench_scene.py: a rolling floor with 20 objects, seen at grazing angles, of
 * 80,000 triangles at 200 cells. Objects have the same places, with slightly different numbers of triangles. */
StudyScene benchFloor(int cells = 200);

/** Returns the energies of all bins, [beam][bin], by the scene's truth. */
std::vector<double> trueEnergies(const StudyScene& scene);

}  // namespace insonify::study
