// Which object a bin shows, against rays that are cast for this alone.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <iostream>
#include <numeric>

#include "components/sonar/SonarRenderer.hpp"
#include "components/study/RayTree.hpp"
#include "components/study/Shapes.hpp"
#include "types/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

/** A bottom, a wall behind it, and eight balls before and behind one another. */
types::Snapshot tenObjects() {
    std::vector<types::Mesh> meshes = {quad({-50, -50, -4}, {100, 0, 0}, {0, 100, 0}),
                                       quad({22, -50, -10}, {0, 100, 0}, {0, 0, 20})};
    std::vector<glm::dvec3> places(2);
    const glm::dvec3 balls[] = {{8, 0, -3}, {10, 1, -3}, {12, -4, -2}, {12.5, -4.5, 0},
                                {6, 3, -2}, {15, 6, -3}, {16, -1, -1}, {18, 9, 0}};
    for (const glm::dvec3& ball : balls) {
        meshes.push_back(sphere(0.4 + 0.05 * ball.x, 24));
        places.push_back(ball);
    }
    types::Snapshot snapshot;
    snapshot.geometry = sceneOf(std::move(meshes), places);
    snapshot.sonar.orientation = glm::angleAxis(radians(8), glm::dvec3(0, 1, 0));
    return snapshot;
}

sonar::SonarConfig fan() {
    sonar::SonarConfig config;
    config.speed_of_sound = 1000;
    config.range = 25;
    config.bin_count = 250;
    config.beam_count = 64;
    config.field_of_view_deg = 90;
    config.beam_height_deg = 40;
    config.quality.rows = 512;
    config.quality.columns_per_beam = 4;
    return config;
}

/** Energy of each object in each bin, [beam][bin][object], by the sonar equation along each of many rays. */
std::vector<double> energiesByRays(const types::Snapshot& scene, const sonar::SonarConfig& config) {
    constexpr int up = 2048, across = 16;
    const RayTree tree(scene);
    const size_t objects = scene.geometry->objects.size();
    const auto bins = static_cast<size_t>(config.bin_count);
    const double width = radians(config.field_of_view_deg) / config.beam_count,
                 height = radians(config.beam_height_deg);
    std::vector<double> energies(static_cast<size_t>(config.beam_count) * bins * objects);
    for (int column = 0; column < config.beam_count * across; ++column) {
        const double azimuth = radians(-config.field_of_view_deg / 2) + (column + 0.5) * width / across;
        for (int row = 0; row < up; row += RayTree::packet) {
            RayTree::Rays rays;
            RayTree::Found found;
            glm::dvec3 directions[RayTree::packet];
            for (int i = 0; i < RayTree::packet; ++i) {
                const double elevation = -height / 2 + (row + i + 0.5) * height / up;
                directions[i] =
                    scene.sonar.orientation * glm::dvec3(std::cos(elevation) * std::cos(azimuth),
                                                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
                rays.set(i, directions[i]);
            }
            tree.cast(glm::dvec3(0), {&rays, 1}, {&found, 1});
            for (int i = 0; i < RayTree::packet; ++i) {
                if (found[static_cast<size_t>(i)] == RayTree::none) continue;
                const uint32_t hit = found[static_cast<size_t>(i)];
                const double facing = glm::dot(tree[hit].normal, directions[i]), range = tree[hit].distance / facing;
                const auto bin = static_cast<size_t>(range / config.range * config.bin_count);
                if (bin >= bins) continue;
                const size_t at = static_cast<size_t>(column / across) * bins + bin;
                energies[at * objects + tree.objectOf(hit)] += tree[hit].mu * std::abs(facing) / (range * range) *
                                                               std::cos(-height / 2 + (row + i + 0.5) * height / up);
            }
        }
    }
    return energies;
}

/** Share of all energy that lies in bins whose label is the object that returns most there. */
double agreement(const std::vector<double>& energies, size_t objects, const std::vector<int32_t>& labels) {
    double agreed = 0, all = 0;
    for (size_t at = 0; at < labels.size(); ++at) {
        const auto begin = energies.begin() + static_cast<ptrdiff_t>(at * objects),
                   end = begin + static_cast<ptrdiff_t>(objects);
        const double energy = std::accumulate(begin, end, 0.0);
        all += energy;
        if (std::max_element(begin, end) - begin == labels[at]) agreed += energy;
    }
    return agreed / all;
}

/** Of each bin the object whose centre is nearest to where the bin lies in the plane of the fan. */
std::vector<int32_t> labelsByNearestObject(const types::Snapshot& scene, const types::SonarTruth& truth) {
    std::vector<int32_t> labels;
    for (const types::Angle& bearing : truth.bearings)
        for (uint32_t bin = 0; bin < truth.bin_count; ++bin) {
            const glm::dvec3 place =
                scene.sonar.orientation *
                (truth.binStart(bin + 0.5) * glm::dvec3(std::cos(bearing.rad), std::sin(bearing.rad), 0));
            const auto distance = [&](const types::Object& object) {
                return glm::distance(glm::dvec3(object.world_from_object[3]), place);
            };
            const auto& objects = scene.geometry->objects;
            labels.push_back(static_cast<int32_t>(std::ranges::min_element(objects, {}, distance) - objects.begin()));
        }
    return labels;
}

class LabelTest : public testing::TestWithParam<sonar::Visibility> {};

TEST_P(LabelTest, TenObjectsAreToldApartAsByRays) {
    sonar::SonarConfig config = fan();
    config.visibility = GetParam();
    if (GetParam() == sonar::Visibility::Gl) config.device = "software";
    const types::Snapshot scene = tenObjects();
    sonar::SonarRenderer renderer(config, scene.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(scene, ping);
    const std::vector<double> energies = energiesByRays(scene, config);
    const double agreed = agreement(energies, 10, truth.object);
    const double wrong = agreement(energies, 10, labelsByNearestObject(scene, truth));
    std::cout << "agreement " << agreed << ", by the nearest object " << wrong << std::endl;
    EXPECT_GE(agreed, 0.995);
    EXPECT_LT(wrong, 0.9) << "a wrong form must not pass";
    for (int object = 0; object < 10; ++object) EXPECT_THAT(truth.object, testing::Contains(object));
}

INSTANTIATE_TEST_SUITE_P(Ways, LabelTest, testing::Values(sonar::Visibility::Cpu, sonar::Visibility::Gl),
                         [](const auto& way) { return way.param == sonar::Visibility::Cpu ? "Rays" : "Drawn"; });

}  // namespace
}  // namespace insonify::study
