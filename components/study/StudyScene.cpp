#include "components/study/StudyScene.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/BeamPattern.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

using Complex = std::complex<double>;

/** Fourier-transforms every `stride`-th of n values in place, n a power of two (Cooley and Tukey, 1965). */
void transform(Complex* values, size_t n, size_t stride) {
    for (size_t i = 1, j = 0; i < n; ++i) {
        size_t bit = n / 2;
        for (; j & bit; bit /= 2) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i * stride], values[j * stride]);
    }
    for (size_t length = 2; length <= n; length *= 2)
        for (size_t k = 0; k < length / 2; ++k) {
            const Complex turn =
                std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
            for (size_t i = k; i < n; i += length) {
                Complex &a = values[i * stride], &b = values[(i + length / 2) * stride];
                const Complex turned = b * turn;
                b = a - turned;
                a += turned;
            }
        }
}

/** Returns a standard complex Gaussian number (Box and Muller, 1958). */
Complex gaussian(uint64_t seed, uint64_t a, uint64_t b) {
    const uint64_t word = types::hashed(seed, a, b);
    return std::polar(std::sqrt(-2 * std::log(types::unit(word >> 32))),
                      2 * std::numbers::pi * types::unit(word & 0xffffffffu));
}

types::Mesh makePatch(const FractalFloor& floor, const std::vector<double>& heights, int from_x, int to_x, int from_y,
                      int to_y) {
    const double step = floor.side / (floor.points - 1);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const auto across = static_cast<uint32_t>(to_y - from_y + 1);
    for (int i = from_x; i <= to_x; ++i)
        for (int j = from_y; j <= to_y; ++j)
            positions.push_back(glm::dvec3(floor.centre_x + i * step - floor.side / 2, j * step - floor.side / 2,
                                           heights[static_cast<size_t>(i * floor.points + j)] - floor.depth));
    for (uint32_t i = 0; i < static_cast<uint32_t>(to_x - from_x); ++i)
        for (uint32_t j = 0; j + 1 < across; ++j) {
            const uint32_t a = i * across + j, b = a + across;
            indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    return getMesh(std::move(positions), std::move(indices));
}

using types::radians;

types::Snapshot makeSnapshot(types::GeometryPtr geometry, double pitch = 0, double roll = 0) {
    types::Snapshot snapshot;
    snapshot.geometry = std::move(geometry);
    snapshot.sonar.orientation = glm::angleAxis(pitch, glm::dvec3(0, 1, 0)) * glm::angleAxis(roll, glm::dvec3(1, 0, 0));
    return snapshot;
}

/** Returns down, in the axes of a sonar that is pitched down and then rolled to starboard. */
glm::dvec3 computeDown(const types::Snapshot& snapshot) {
    return glm::conjugate(snapshot.sonar.orientation) * glm::dvec3(0, 0, -1);
}

StudyScene flatBottom(const std::string& name, const std::string& doc, double range_from, double pitch, double roll) {
    StudyScene scene{name, doc,       fan(130, 40, 64, 50), makeSnapshot(makeScene({levelGround(-5)}), pitch, roll),
                     {},   range_from};
    scene.truth = planeTruth(computeDown(scene.snapshot), 5);
    return scene;
}

/** The pattern is included down to 60 dB below its axis. */
StudyScene patternedBottom() {
    const double width_deg = 20, reach_deg = width_deg / 2 * std::sqrt(60 / (2 * 10 * std::log10(2.0)));
    StudyScene scene{"pitched_bottom_pattern",
                     "a flat bottom 5 m below, the sonar pitched down by 20 deg, with a Gaussian beam of 20 deg in "
                     "elevation, two-way",
                     fan(60, 2 * reach_deg, 32, 50),
                     makeSnapshot(makeScene({levelGround(-5)}), radians(20)),
                     {}};
    acoustics::BeamLaw law;
    law.weighting = acoustics::Weighting::Gaussian;
    law.width_deg = width_deg;
    sonar::BeamPatternConfig& pattern = scene.config.beam_pattern.emplace();
    pattern.transmit.elevation = pattern.receive.elevation = law;
    const acoustics::BeamPattern beam(law);
    scene.truth = planeTruth(computeDown(scene.snapshot), 5, {},
                             [beam](double elevation) { return std::pow(beam.power(elevation), 2); });
    return scene;
}

StudyScene wallAhead() {
    return {"wall", "a wall 10 m ahead, 60 x 40 deg", fan(60, 40, 32, 15), makeSnapshot(makeScene({facingWall(10)})),
            planeTruth({1, 0, 0}, 10)};
}

StudyScene facingDisc() {
    return {"facing_disc", "a disc of 2.9 m radius, 10 m ahead, in one beam", fan(40, 40, 1, 12),
            makeSnapshot(makeScene({disc(10, 2.9, 2048)})), discTruth(10, 2.9)};
}

StudyScene oneSphere() {
    return {"sphere", "a sphere of 1 m radius, 10 m ahead, in one beam", fan(16, 16, 1, 12),
            makeSnapshot(makeScene({sphere(1, 256)}, {{10, 0, 0}})), sphereTruth(1, 10)};
}

StudyScene twoSpheres() {
    const double up = radians(10), x = 10 * std::cos(up), z = 10 * std::sin(up);
    return {"two_spheres", "two spheres of 1 m radius at 10 m, one above the other, in one beam", fan(16, 36, 1, 12),
            makeSnapshot(makeScene({sphere(1, 256), sphere(1, 256)}, {{x, 0, z}, {x, 0, -z}})),
            sum({sphereTruth(1, 10), sphereTruth(1, 10)})};
}

StudyScene shinySphere() {
    const double slope = 0.3;
    const auto geometry = makeCopy(makeScene({sphere(1, 256)}, {{10, 0, 0}}));
    geometry->materials[0].lambert_db = -9.23f;
    geometry->materials[0].reflection = 1;
    geometry->materials[0].roughness_slope = static_cast<float>(slope);
    const auto section = [=](double cosine) { return acoustics::objectSection(-9.23, 1, slope * slope, cosine); };
    return {"sphere_lobe", "the sphere with a specular lobe of 0.3 rms slope", fan(16, 16, 1, 12),
            makeSnapshot(geometry), sphereTruth(1, 10, section)};
}

/** Loud water, so that it dominates at long range. */
StudyScene waterOverBottom() {
    StudyScene scene = flatBottom("volume_over_bottom", "the flat bottom in water of -45 dB re 1/m", 15, 0, 0);
    const auto geometry = makeCopy(scene.snapshot.geometry);
    geometry->materials[0].lambert_db = -30;
    scene.snapshot.geometry = geometry;
    scene.config.volume.push_back({{}, {}, -45});
    const auto bottom = [truth = scene.truth](const BeamLimits& beam, double r1, double r2) {
        return 1e-3 * truth(beam, r1, r2);
    };
    scene.truth = sum({bottom, waterTruth(std::pow(10, -4.5), 5)});
    return scene;
}

/** A screen 2 m high on the bottom 15 m ahead hides what is behind it. */
StudyScene shadowScreen() {
    const double height = 5, top = 2, ahead = 15;
    const auto elevation = [=](double azimuth, double z) { return std::atan2(z - height, ahead / std::cos(azimuth)); };
    const Window screen = [=](double azimuth) { return Elevations{elevation(azimuth, 0), elevation(azimuth, top)}; };
    const Window before = [=](double azimuth) { return Elevations{-std::numbers::pi / 2, elevation(azimuth, 0)}; };
    const Window behind = [=](double azimuth) { return Elevations{elevation(azimuth, top), std::numbers::pi / 2}; };
    const auto geometry = makeScene({levelGround(-5), quad({15, -200, -5}, {0, 400, 0}, {0, 0, 2})});
    return {"shadow_screen", "a screen 2 m high on a flat bottom 5 m below, 15 m ahead: echo and shadow",
            fan(60, 60, 32, 50), makeSnapshot(geometry),
            sum({planeTruth({0, 0, -1}, height, before), planeTruth({1, 0, 0}, ahead, screen),
                 planeTruth({0, 0, -1}, height, behind)})};
}

/** Returns the height of the rolling floor [m]. */
double rollingHeight(double x, double y) {
    return -3 + 0.15 * std::sin(0.7 * x + 0.3 * y) + 0.1 * std::sin(0.4 * x - 1.1 * y);
}

/** Returns 60 x 60 m about a point 20 m ahead. */
types::Mesh rollingFloor(int cells) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const auto across = static_cast<uint32_t>(cells + 1);
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {
            const double x = 60.0 * i / cells - 10, y = 60.0 * j / cells - 30;
            positions.push_back(glm::dvec3(x, y, rollingHeight(x, y)));
        }
    for (uint32_t a = 0; a + across < positions.size(); ++a)
        if (a % across + 1 < across)
            indices.insert(indices.end(), {a, a + across, a + across + 1, a, a + across + 1, a + 1});
    return getMesh(std::move(positions), std::move(indices));
}

/** Returns a closed prism of `sides` between two heights, about the z axis [m]. */
types::Mesh prism(double radius, double low, double high, uint32_t sides, double turn = 0) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < sides; ++i)
        for (const double z : {low, high}) {
            const double angle = turn + 2 * std::numbers::pi * i / sides;
            positions.push_back(glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z));
        }
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        if (i > 0 && i + 1 < sides) indices.insert(indices.end(), {0, b, a, 1, a + 1, b + 1});
    }
    return getMesh(std::move(positions), std::move(indices));
}

}  // namespace

std::vector<double> computeHeights(const FractalFloor& floor) {
    const auto n = static_cast<size_t>(floor.points);
    std::vector<Complex> amplitudes(n * n);
    const auto wavenumber = [n](size_t i) { return static_cast<double>(i <= n / 2 ? i : n - i); };
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j)
            if (i + j > 0)
                amplitudes[i * n + j] = gaussian(floor.seed, i, j) *
                                        std::pow(std::hypot(wavenumber(i), wavenumber(j)), (floor.slope - 1) / 2);
    for (size_t i = 0; i < n; ++i) transform(&amplitudes[i * n], n, 1);
    for (size_t j = 0; j < n; ++j) transform(&amplitudes[j], n, n);
    std::vector<double> heights;
    double squares = 0;
    for (const Complex& value : amplitudes) {
        heights.push_back(value.real());
        squares += value.real() * value.real();
    }
    const double scale = floor.rms / std::sqrt(squares / static_cast<double>(n * n));
    for (double& height : heights) height *= scale;
    return heights;
}

types::Mesh getMesh(const FractalFloor& floor) {
    return makePatch(floor, computeHeights(floor), 0, floor.points - 1, 0, floor.points - 1);
}

std::vector<types::Mesh> makeTiles(const FractalFloor& floor, int tiles) {
    const std::vector<double> heights = computeHeights(floor);
    const auto edge = [&](int tile) { return (floor.points - 1) * tile / tiles; };
    std::vector<types::Mesh> meshes;
    for (int i = 0; i < tiles; ++i)
        for (int j = 0; j < tiles; ++j)
            meshes.push_back(makePatch(floor, heights, edge(i), edge(i + 1), edge(j), edge(j + 1)));
    return meshes;
}

const std::vector<SceneMaker>& closedFormScenes() {
    static const std::vector<SceneMaker> scenes = {
        {"flat_bottom",
         [] {
             return flatBottom("flat_bottom", "a flat bottom 5 m below a level fan, 130 x 40 deg, from 15 m on", 15, 0,
                               0);
         }},
        {"flat_bottom_edge",
         [] { return flatBottom("flat_bottom_edge", "the same with the bins of the aperture's edge", 0, 0, 0); }},
        {"flat_bottom_pitched",
         [] {
             return flatBottom("flat_bottom_pitched", "the same bottom, the sonar pitched down by 15 deg", 0,
                               radians(15), 0);
         }},
        {"tilted_plane",
         [] {
             return flatBottom("tilted_plane", "the same bottom, pitched by 20 and rolled by 25 deg", 0, radians(20),
                               radians(25));
         }},
        {"pitched_bottom_pattern", patternedBottom},
        {"wall", wallAhead},
        {"facing_disc", facingDisc},
        {"sphere", oneSphere},
        {"sphere_lobe", shinySphere},
        {"two_spheres", twoSpheres},
        {"volume_over_bottom", waterOverBottom},
        {"shadow_screen", shadowScreen}};
    return scenes;
}

std::vector<double> trueEnergies(const StudyScene& scene) {
    const sonar::BinGrid grid = sonar::makeBinGrid(scene.config);
    const double half_height = radians(scene.config.beam_height_deg) / 2;
    std::vector<double> energies;
    for (const sonar::Beam& beam : sonar::makeBeams(scene.config))
        for (int k = 0; k < grid.bin_count; ++k)
            energies.push_back(grid.edge(k + 1) <= grid.range_min
                                   ? 0
                                   : scene.truth({beam.low, beam.high, half_height},
                                                 std::max(grid.edge(k), grid.range_min), grid.edge(k + 1)));
    return energies;
}

StudyScene roughFloor(int points) {
    FractalFloor floor;
    floor.points = points;
    const types::Mesh mesh = getMesh(floor);
    return {"rough_floor",
            "a fractal floor 3 m below, the power spectrum of its profiles as wavenumber^-2.7, 0.35 m rms",
            fan(90, 20, 128, 40),
            lookingAt(makeScene({mesh}), {}, 0, radians(8)),
            {}};
}

/** Returns the normals of sand ripples of 0.1 m along x, which meander, at 256 x 256 places of a square of 0.8 m. */
types::NormalMap rippleMap() {
    constexpr int size = 256, crests = 8;
    types::NormalMap map{size, size, {}, true, true};
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double u = 2 * std::numbers::pi * column / size, v = 2 * std::numbers::pi * row / size;
            const double slope = 0.35 * std::sin(crests * u + std::sin(v)) + 0.15 * std::sin(3 * u - 2 * v);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(slope, 0.1 * std::cos(v) * slope, 1));
            for (int axis = 0; axis < 3; ++axis)
                map.rgb.push_back(static_cast<uint8_t>(std::lround((normal[axis] + 1) / 2 * 255)));
        }
    return map;
}

/** Gives a mesh of heights over x and y smooth normals, and coordinates on a map of `side` metres. */
void layMap(types::Mesh& mesh, float side) {
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto at = [&](size_t k) { return mesh.positions[mesh.indices[i + k]]; };
        const glm::vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        for (size_t k = 0; k < 3; ++k) mesh.normals[mesh.indices[i + k]] += normal;
    }
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 normal = mesh.normals[i] = glm::normalize(mesh.normals[i]);
        mesh.tangents.emplace_back(glm::normalize(glm::vec3(1, 0, 0) - normal.x * normal), 1.0f);
        mesh.uvs.push_back(glm::vec2(mesh.positions[i]) / side);
    }
}

StudyScene rippledFloor(int points) {
    StudyScene scene = roughFloor(points);
    scene.name = "rippled_floor";
    scene.doc = "a fractal floor 3 m below with sand ripples of 0.1 m as a normal map";
    const auto geometry = makeCopy(scene.snapshot.geometry);
    types::Mesh mesh = geometry->meshes[0];
    layMap(mesh, 0.8f);
    geometry->meshes = {mesh};
    geometry->normal_maps = {rippleMap()};
    geometry->materials[0].normal_map = 0;
    scene.snapshot.geometry = geometry;
    return scene;
}

StudyScene benchFloor(int cells) {
    const double square = 0.5 * std::numbers::sqrt2;  // circumradius of a square of 1 m
    const std::array kinds = {sphere(1, 9), prism(square, -0.5, 0.5, 4, std::numbers::pi / 4), prism(0.3, -1, 2, 16)};
    std::vector<types::Mesh> meshes = {rollingFloor(cells)};
    std::vector<glm::dvec3> positions = {{}};
    for (int n = 0; n < 20; ++n) {
        const double bearing = radians(-57 + 6 * n), distance = 6 + n * 7 % 20;
        const double x = distance * std::cos(bearing), y = distance * std::sin(bearing);
        meshes.push_back(kinds[static_cast<size_t>(n % 3)]);
        positions.push_back({x, y, rollingHeight(x, y) + 0.3});
    }
    for (size_t i = 1; i < meshes.size(); ++i) meshes[i].clusters[0].material = 1;
    const auto geometry = makeCopy(makeScene(std::move(meshes), std::move(positions)));
    geometry->materials.resize(2);
    geometry->materials[0].lambert_db = static_cast<float>(scene::lambertDb(scene::Sediment::MediumSand));
    geometry->materials[1].lambert_db = static_cast<float>(scene::lambertDb(scene::Matter::CarbonSteel));
    sonar::SonarConfig config = fan(120, 20, 256, 30);
    config.bin_count = 500;
    return {"bench_floor",
            "a rolling floor 3 m below with 20 objects on it, seen at grazing angles",
            config,
            lookingAt(geometry, {}, 0, radians(10)),
            {}};
}

const std::vector<SceneMaker>& computedScenes() {
    static const std::vector<SceneMaker> scenes = {{"rough_floor", [] { return roughFloor(); }},
                                                   {"rippled_floor", [] { return rippledFloor(); }},
                                                   {"bench_floor", [] { return benchFloor(); }}};
    return scenes;
}

}  // namespace insonify::study
