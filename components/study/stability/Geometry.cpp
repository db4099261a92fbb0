// Odd geometry: the sonar inside, on and above surfaces; faces doubled, hidden, mirrored.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/TargetShapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using Shape = std::function<Target(const Encounter&)>;

constexpr int samples = 512;
constexpr double tolerance = 0.5;       ///< [dB]
constexpr double tilted_tolerance = 1;  ///< For means over sidelobes, which are smeared for bodies of finite range [dB]

/** Returns the max error over facets around and frequencies; `numbers` are Fresnel numbers of a flat length [m];
 *  without it, at ranges of 5 and 100 m. */
Outcome computeError(const Shape& shape, double length, std::initializer_list<double> numbers,
                     double allowed = tolerance) {
    double worst = 0;
    std::string where;
    Probe received;
    for (const double frequency : {100., 300., 1000., 3000.})
        for (const int around : {32, 256, 2048})
            for (const double number : numbers) {
                Encounter encounter{frequency, number, around, 0.3};
                if (length > 0) encounter.range = length * length / (encounter.wavelength() * number);
                const Target target = shape(encounter);
                const double error = targetError(encounter, target, targetSonar(encounter, target, samples));
                if (!(std::abs(error) <= worst)) {
                    worst = std::abs(error);
                    where = fmt::format("{:.2f} dB at {} kHz, {} facets around, {:.0f} m", error, frequency, around,
                                        encounter.range);
                }
            }
    received.ping.bins = {1};
    return within(allowed, worst, "at most " + where, received);
}

Outcome far(const Shape& shape, double length) { return computeError(shape, length, {0.05, 0.1}); }
Outcome near(const Shape& shape, double length) { return computeError(shape, length, {8, 20}); }

Target cylinder(const Encounter& encounter, double tilt_deg) {
    return cylinderTarget(encounter, 0.1, 0.5, types::radians(tilt_deg));
}

using types::radians;

const glm::dvec3 ball_at(9, 1, -0.5);
sonar::SonarConfig smallFan() { return fan(60, 40, 16, 15); }
types::GeometryPtr wallAndBall() { return makeScene({facingWall(12), sphere(1.5, 48)}, {{0, 0, 0}, ball_at}); }

/** Passes if a changed scene has the echoes of wall and ball, to `allowed`. */
Outcome sounds(double allowed, const types::GeometryPtr& changed, const std::string& got) {
    const Probe received = probe(smallFan(), lookingAt(changed)), plain = probe(smallFan(), lookingAt(wallAndBall()));
    const double deviation = difference(received.ping, plain.ping);
    return within(allowed, deviation, got + (deviation == 0 ? ": bit-identical" : ""), received);
}

/** Returns wall and ball with `change` applied to the scene. */
types::GeometryPtr changed(const auto& change) {
    const auto geometry = makeCopy(wallAndBall());
    change(*geometry);
    return geometry;
}

Outcome insideAClosedMesh() {
    const sonar::SonarConfig config = fan(60, 40, 8, 8);
    const types::Snapshot snapshot = lookingAt(makeScene({sphere(5.05, 256)}));
    const Probe received = probe(config, snapshot), again = probe(config, snapshot);
    const double truth = radians(60) * 2 * std::sin(radians(20)) / (5.05 * 5.05);
    const double deviation = received.ping.bins == again.ping.bins ? off(received.energy(), truth) : INFINITY;
    return within(1e-3, deviation, "a sphere seen from its centre, both sides reflect; bit-identical again", received);
}

Outcome exactlyOnASurface() {
    const double lean = radians(30);
    const types::Mesh through = quad(glm::vec3(-20 * std::sin(lean), -20, -20 * std::cos(lean)), {0, 40, 0},
                                     glm::vec3(40 * std::sin(lean), 0, 40 * std::cos(lean)));
    const Probe alone = probe(smallFan(), lookingAt(makeScene({facingWall(12)})));
    double worst = 0;
    Probe received;
    for (const types::Mesh& own : {levelGround(0), through, quad({0, 0, 0}, {0, 3, 0}, {0, 0, 3}), facingWall(0)}) {
        received = probe(smallFan(), lookingAt(makeScene({facingWall(12), own})));
        worst = std::max(worst, received.isSound() ? difference(received.ping, alone.ping) : INFINITY);
    }
    return within(1e-3, worst,
                  "the sonar in a level, a leaning and a facing plane and at a corner; the wall behind as without",
                  received);
}

Outcome duplicatedFaces() {
    return sounds(1e-6, changed([](types::Geometry& g) {
                      for (types::Mesh& mesh : g.meshes) {
                          const std::vector<uint32_t> once = mesh.indices;
                          mesh.indices.insert(mesh.indices.end(), once.rbegin(), once.rend());
                          mesh.clusters[0].index_count = static_cast<uint32_t>(mesh.indices.size());
                      }
                      g.objects.push_back(g.objects[0]);
                      g.objects.push_back(g.objects[1]);
                  }),
                  "every face four times, twice of them wound the other way");
}

Outcome nonManifold() {
    return sounds(1e-6, changed([](types::Geometry& g) {  // fins behind the wall, on an edge that already has two faces
                      types::Mesh& wall = g.meshes[0];
                      wall.positions.push_back({20, 0, 0});
                      wall.positions.push_back({25, 3, 9});
                      wall.indices.insert(wall.indices.end(), {0, 2, 4, 2, 0, 5});
                      wall.clusters[0] = {0, static_cast<uint32_t>(wall.indices.size()), 0, {16, 0, 0}, glm::vec3(300)};
                  }),
                  "four faces on one edge, two of them behind the wall");
}

/** Returns an object's place with `transform` before the sphere's translation. */
types::GeometryPtr placedBall(const types::Mesh& ball, const glm::dmat4& transform) {
    const auto geometry = makeCopy(makeScene({facingWall(12), ball}));
    geometry->objects[1].world_from_object = glm::translate(glm::dmat4(1), ball_at) * transform;
    return geometry;
}

Outcome mirrored() {
    return sounds(1e-5, placedBall(sphere(1.5, 48), glm::scale(glm::dmat4(1), {1, -1, 1})),
                  "a ball of scale (1, -1, 1)");
}

Outcome stretched() {
    types::Mesh egg = sphere(1, 48);
    for (glm::vec3& p : egg.positions) p *= glm::vec3(0.5, -2, 1.25);
    egg.clusters[0].half = glm::vec3(2.1f);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.6, glm::dvec3(1, 2, 3));
    const Probe received =
                    probe(smallFan(),
                          lookingAt(placedBall(sphere(1, 48), turn * glm::scale(glm::dmat4(1), {0.5, -2, 1.25})))),
                plain = probe(smallFan(), lookingAt(placedBall(egg, turn)));
    return within(1e-5, difference(received.ping, plain.ping),
                  "a turned ball of scale (0.5, -2, 1.25) against a mesh of that shape", received);
}

Outcome straightDown() {
    sonar::SonarConfig config = fan(40, 40, 1, 12);
    setSamples(config, 256, 64);
    const Probe received = probe(config, lookingAt(makeScene({levelGround(-5.05f)}), {}, 0.7, radians(90)));
    return within(1e-3, worstBeam(received, config, planeTruth({1, 0, 0}, 5.05)),
                  "a level bottom below a sonar that looks straight down", received);
}

}  // namespace

std::vector<StabilityCase> targetCases() {
    const std::string expected = "to 0.5 dB with 32 to 2048 facets around, 100 kHz to 3 MHz";
    const auto sphere = [](const Encounter& encounter) { return ellipsoidTarget(encounter, 0.1, 0.1, 0.1); };
    const auto egg = [](const Encounter& encounter) { return ellipsoidTarget(encounter, 1, 0.6, 0.4); };
    const auto plate = [](const Encounter& encounter) { return plateTarget(encounter, 0.5, 0.3); };
    const auto pipe = [](const Encounter& encounter) { return cylinder(encounter, 0); };
    const auto cone = [](const Encounter& encounter) { return coneTarget(encounter, 0.15, 0.5); };
    const auto hull = [](const Encounter& encounter) { return hullTarget(encounter, 0.1, 1); };
    std::vector<StabilityCase> cases = {
        {61, "Sphere", expected,
         [=] {
             return computeError(sphere, 0, {5, 100});
         }},
        {61, "Ellipsoid", expected,
         [=] {
             return computeError(egg, 0, {5, 100});
         }},
        {61, "Plate, far", expected, [=] { return far(plate, 0.5); }},
        {61, "Plate, near", expected, [=] { return near(plate, 0.3); }},
        {61, "Cylinder broadside, far", expected, [=] { return far(pipe, 0.5); }},
        {61, "Cylinder broadside, near", expected, [=] { return near(pipe, 0.5); }},
        {61, "Cone square to its side, far", expected, [=] { return far(cone, std::hypot(0.15, 0.5)); }},
        {61, "Cone square to its side, near", expected, [=] { return near(cone, std::hypot(0.15, 0.5)); }},
        {61, "Hull of a torpedo broadside, far", expected, [=] { return far(hull, 1); }},
        {61, "Hull of a torpedo broadside, near", expected, [=] { return near(hull, 1); }}};
    for (const double tilt : {1., 3., 10.})
        cases.push_back({61, fmt::format("Cylinder {:.0f} deg off broadside", tilt),
                         "to 1 dB with 32 to 2048 facets around, 100 kHz to 3 MHz; means of sidelobes", [=] {
                             return computeError([=](const Encounter& encounter) { return cylinder(encounter, tilt); },
                                                 0, {50, 200}, tilted_tolerance);
                         }});
    return cases;
}

std::vector<StabilityCase> geometryCases() {
    return {{5, "Sonar inside a closed mesh", "deterministic; both sides reflect, to 1e-3 of the closed form",
             insideAClosedMesh},
            {6, "Sonar exactly on a surface", "no inf; other echoes unchanged, to 1e-3", exactlyOnASurface},
            {12, "Duplicated coplanar faces", "one return, to 1e-6", duplicatedFaces},
            {12, "Non-manifold edges", "hidden faces have no echo, to 1e-6", nonManifold},
            {17, "Mirrored node", "as the shape that it makes, to 1e-5", mirrored},
            {17, "Node with unequal scales, mirrored and turned", "as a mesh of that shape, to 1e-5", stretched},
            {56, "Sonar that looks straight down", "to 1e-3 of the closed form of a facing plane", straightDown}};
}

}  // namespace insonify::study
