#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/study/oracles/Truth.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/geometry/Snapshot.hpp"

namespace insonify::study {

/** A rough, isotropic sea floor: Gaussian heights whose power spectrum is a power of the wavenumber. */
struct FractalFloor {
    int points = 512;      ///< Number of heights along a side, a power of two; triangles: 2 (points - 1)^2 [1].
    double side = 60;      ///< Side of the square between the outermost points [m].
    double slope = -2.7;   ///< Exponent of the power spectrum of a profile; that of the surface is one less [1].
    double rms = 0.35;     ///< rms height about the mean [m].
    double centre_x = 25;  ///< Centre of the square; the other coordinate is 0 [m].
    double depth = 3;      ///< Mean height is -depth [m].
    uint64_t seed = 1;
};

/** Returns the heights about their mean, [x][y] [m]: complex Gaussian amplitudes, scaled by the root of the spectrum
 *  and Fourier-transformed; they are periodic at the edges. */
std::vector<double> computeHeights(const FractalFloor& floor);

/** Returns the floor as one mesh, with two triangles between four points. */
types::Mesh getMesh(const FractalFloor& floor);

/** Returns the same triangles as tiles x tiles meshes. */
std::vector<types::Mesh> makeTiles(const FractalFloor& floor, int tiles);

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

/** Returns the scenes without a closed form: rough_floor, rippled_floor (a fractal floor with a normal map),
 *  bench_floor. */
const std::vector<SceneMaker>& computedScenes();

/** Returns a fractal floor (FractalFloor.hpp) of 2 (points - 1)^2 triangles, by default 522,242, seen from 3 m above
 *  it, 8 deg down: 128 beams over 90 x 20 deg, 400 bins to 40 m. */
StudyScene roughFloor(int points = 512);

/** Returns the same floor, of 130,050 triangles by default, with sand ripples of 0.1 m as a normal map. */
StudyScene rippledFloor(int points = 256);

/** Returns the scene of scripts/scenes/make_bench_scene.py: a rolling floor with 20 objects, seen at grazing angles, of
 * 80,000 triangles at 200 cells. Objects have the same places, with slightly different numbers of triangles. */
StudyScene benchFloor(int cells = 200);

/** Returns the energies of all bins, [beam][bin], by the scene's truth. */
std::vector<double> trueEnergies(const StudyScene& scene);

}  // namespace insonify::study
