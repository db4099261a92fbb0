// Odd geometry: the sonar inside, on and above surfaces; faces doubled, hidden, mirrored.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

const glm::dvec3 ball_at(9, 1, -0.5);
sonar::SonarConfig smallFan() { return fan(60, 40, 16, 15); }
types::GeometryPtr wallAndBall() { return sceneOf({facingWall(12), sphere(1.5, 48)}, {{0, 0, 0}, ball_at}); }

/** Passes if a changed scene has the echoes of wall and ball, to `tolerance`. */
Outcome sounds(double tolerance, const types::GeometryPtr& changed, const std::string& got) {
    const Probe received = probe(smallFan(), lookingAt(changed)), plain = probe(smallFan(), lookingAt(wallAndBall()));
    const double deviation = difference(received.ping, plain.ping);
    return within(tolerance, deviation, got + (deviation == 0 ? ": bit-identical" : ""), received);
}

/** Returns wall and ball with `change` applied to the scene. */
types::GeometryPtr changed(const auto& change) {
    const auto geometry = copyOf(wallAndBall());
    change(*geometry);
    return geometry;
}

Outcome insideAClosedMesh() {
    const sonar::SonarConfig config = fan(60, 40, 8, 8);
    const types::Snapshot snapshot = lookingAt(sceneOf({sphere(5.05, 256)}));
    const Probe received = probe(config, snapshot), again = probe(config, snapshot);
    const double truth = radians(60) * 2 * std::sin(radians(20)) / (5.05 * 5.05);
    const double deviation = received.ping.bins == again.ping.bins ? off(received.energy(), truth) : INFINITY;
    return within(1e-3, deviation, "a sphere seen from its centre, both sides reflect; bit-identical again", received);
}

Outcome exactlyOnASurface() {
    const double lean = radians(30);
    const types::Mesh through = quad(glm::vec3(-20 * std::sin(lean), -20, -20 * std::cos(lean)), {0, 40, 0},
                                     glm::vec3(40 * std::sin(lean), 0, 40 * std::cos(lean)));
    const Probe alone = probe(smallFan(), lookingAt(sceneOf({facingWall(12)})));
    double worst = 0;
    Probe received;
    for (const types::Mesh& own : {levelGround(0), through, quad({0, 0, 0}, {0, 3, 0}, {0, 0, 3}), facingWall(0)}) {
        received = probe(smallFan(), lookingAt(sceneOf({facingWall(12), own})));
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
    const auto geometry = copyOf(sceneOf({facingWall(12), ball}));
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
    const Probe received = probe(config, lookingAt(sceneOf({levelGround(-5.05f)}), {}, 0.7, radians(90)));
    return within(1e-3, worstBeam(received, config, planeTruth({1, 0, 0}, 5.05)),
                  "a level bottom below a sonar that looks straight down", received);
}

}  // namespace

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
