// Labels of bins by object, compared with rays that are traced for this purpose.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <iostream>
#include <numeric>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/oracles/RayTree.hpp"
#include "tests/support/Sonars.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

using types::radians;

/** Returns a bottom, a wall behind it, and eight balls in front of and behind each other. */
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
    snapshot.geometry = makeScene(std::move(meshes), places);
    snapshot.sonar.orientation = glm::angleAxis(radians(8), glm::dvec3(0, 1, 0));
    return snapshot;
}

sonar::SonarConfig labelFan() {
    return test::getSonar({.beams = 64, .width_deg = 90, .height_deg = 40, .bins = 250, .rows = 512, .columns = 4});
}

/** Computes the energy of each object in each bin, [beam][bin][object], by the sonar equation along each of many
 *  rays. */
class RayEnergies {
public:
    RayEnergies(const types::Snapshot& scene, const sonar::SonarConfig& config)
        : tree_(scene), scene_(scene), config_(config), bins_(static_cast<size_t>(config.bin_count)) {
        energies_.resize(static_cast<size_t>(config.beam_count) * bins_ * scene.geometry->objects.size());
        for (int column = 0; column < config.beam_count * across; ++column)
            for (int row = 0; row < up; row += RayTree::packet) trace(column, row);
    }
    const std::vector<double>& energies() const { return energies_; }

private:
    static constexpr int up = 2048, across = 16;

    double computeElevation(int row) const { return radians(config_.beam_height_deg) * ((row + 0.5) / up - 0.5); }
    glm::dvec3 computeDirection(int column, int row) const {
        const double azimuth =
            radians(*config_.field_of_view_deg) * ((column + 0.5) / across / config_.beam_count - 0.5);
        const double elevation = computeElevation(row);
        return scene_.sonar.orientation * glm::dvec3(std::cos(elevation) * std::cos(azimuth),
                                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    }
    void trace(int column, int first_row) {
        RayTree::Rays rays;
        RayTree::Found found;
        for (int i = 0; i < RayTree::packet; ++i) rays.set(i, computeDirection(column, first_row + i));
        tree_.trace(glm::dvec3(0), {&rays, 1}, {&found, 1});
        for (int i = 0; i < RayTree::packet; ++i)
            if (const uint32_t hit = found[static_cast<size_t>(i)]; hit != RayTree::none)
                add(column, first_row + i, hit);
    }
    void add(int column, int row, uint32_t hit) {
        const RayTree::Triangle& triangle = tree_[hit];
        const double facing = glm::dot(triangle.normal, computeDirection(column, row)),
                     range = triangle.distance / facing;
        const auto bin = static_cast<size_t>(range / config_.range * config_.bin_count);
        if (bin >= bins_) return;
        const size_t at = static_cast<size_t>(column / across) * bins_ + bin;
        energies_[at * scene_.geometry->objects.size() + tree_.getObject(hit)] +=
            triangle.mu * std::abs(facing) / (range * range) * std::cos(computeElevation(row));
    }

    RayTree tree_;
    const types::Snapshot& scene_;
    const sonar::SonarConfig& config_;
    size_t bins_;
    std::vector<double> energies_;
};

/** Returns the fraction of all energy in bins whose label is the object that returns most there. */
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

/** Returns for each bin the object whose centre is nearest to the bin in the plane of the fan. */
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

TEST_P(LabelTest, LabelsTenObjectsAsRaysDo) {
    sonar::SonarConfig config = labelFan();
    config.visibility = GetParam();
    if (GetParam() == sonar::Visibility::Gl) config.device = "software";
    const types::Snapshot scene = tenObjects();
    sonar::SonarRenderer renderer(config, scene.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(scene, ping);
    const RayEnergies rays(scene, config);
    const std::vector<double>& energies = rays.energies();
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
