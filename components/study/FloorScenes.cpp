// Scenes without a closed form: sea floors.
#include <array>
#include <cmath>
#include <numbers>

#include "components/scene/Acoustics.hpp"
#include "components/study/FractalFloor.hpp"
#include "components/study/Probe.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/StudyScene.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

/** Of the rolling floor [m]. */
double rollingHeight(double x, double y) {
    return -3 + 0.15 * std::sin(0.7 * x + 0.3 * y) + 0.1 * std::sin(0.4 * x - 1.1 * y);
}

/** 60 x 60 m about a point 20 m ahead. */
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
    return meshOf(std::move(positions), std::move(indices));
}

/** A prism of `sides` between two heights, about the z axis; its ends are closed [m]. */
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
    return meshOf(std::move(positions), std::move(indices));
}

}  // namespace

StudyScene roughFloor(int points) {
    FractalFloor floor;
    floor.points = points;
    const types::Mesh mesh = meshOf(floor);
    return {"rough_floor",
            "a fractal floor 3 m below, the power spectrum of its profiles as wavenumber^-2.7, 0.35 m rms",
            fan(90, 20, 128, 40),
            lookingAt(sceneOf({mesh}), {}, 0, radians(8)),
            {}};
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
    const auto geometry = copyOf(sceneOf(std::move(meshes), std::move(positions)));
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
                                                   {"bench_floor", [] { return benchFloor(); }}};
    return scenes;
}

}  // namespace insonify::study
