// Processor time, in one thread, of the paths to 50 point targets by up to two mirrors:
//   paths_bench PINGS      prints JSON, milliseconds a ping by scene. Sonar and targets have new places in each ping.
#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "components/sonar/multipath/TargetPaths.hpp"
#include "components/study/Shapes.hpp"

namespace insonify {
namespace {

constexpr int targets = 50;
constexpr double range_max = 30;  // m

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/** Four walls and a bottom of 20 x 10 cells each, 2,000 triangles; `rough` moves their corners out of the walls [m]. */
types::Mesh tank(double rough) {
    Random random(1);
    const glm::dvec3 half(12, 9, 3);
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    const auto wall = [&](const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b) {
        const auto first = static_cast<uint32_t>(positions.size());
        for (uint32_t i = 0; i <= 20; ++i)
            for (uint32_t j = 0; j <= 10; ++j)
                positions.push_back(corner + a * (i / 20.0) + b * (j / 10.0) +
                                    glm::normalize(glm::cross(a, b)) * uniform(random, -rough, rough));
        for (uint32_t i = 0; i < 20; ++i)
            for (uint32_t j = 0; j < 10; ++j) {
                const uint32_t k = first + 11 * i + j;
                indices.insert(indices.end(), {k, k + 11, k + 1, k + 1, k + 11, k + 12});
            }
    };
    const glm::dvec3 ahead(2 * half.x, 0, 0), aside(0, 2 * half.y, 0), up(0, 0, 2 * half.z);
    wall(-half, ahead, up);
    wall(-half + aside, ahead, up);
    wall(-half, aside, up);
    wall(-half + ahead, aside, up);
    wall(-half, ahead, aside);
    return study::getMesh(positions, indices);
}

types::GeometryPtr makeMirror(types::Mesh mesh) {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.emplace_back().mirror = true;
    geometry->objects.emplace_back();
    scene::buildClusters(mesh);
    geometry->meshes.push_back(std::move(mesh));
    return geometry;
}

double processorMs() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void bench(const char* name, types::Mesh mesh, int pings) {
    const types::GeometryPtr geometry = makeMirror(std::move(mesh));
    sonar::SonarConfig config;
    config.multipath.emplace().bounces = 2;
    sonar::TargetPaths paths(config, *geometry);
    Random random(2);
    const auto place = [&] {
        return glm::dvec3(uniform(random, -2.9, 2.9), uniform(random, -2.9, 2.9), uniform(random, -2.9, 2.9));
    };
    std::vector<double> ms;
    size_t found = 0;
    for (int i = 0; i < pings; ++i) {
        types::Snapshot snapshot;
        snapshot.sonar.position = place();
        const double begin = processorMs();
        paths.place(snapshot, range_max);
        for (int target = 0; target < targets; ++target) found += paths.pathsTo(place()).size();
        ms.push_back(processorMs() - begin);
    }
    std::ranges::sort(ms);
    fmt::print(R"("{}": {{"median_ms": {:.4f}, "max_ms": {:.4f}, "paths": {:.2f}}})", name, ms[ms.size() / 2],
               ms.back(), static_cast<double>(found) / pings / targets);
}

}  // namespace
}  // namespace insonify

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const int pings = std::max(1, std::atoi(argv[1]));
    fmt::print("{{");
    insonify::bench("tank, 5 flat walls", insonify::tank(0), pings);
    fmt::print(", ");
    insonify::bench("tank, 2,000 planes", insonify::tank(0.05), pings);
    fmt::print(", ");
    insonify::bench("in a ball, 2,024 triangles", insonify::study::sphere(6, 23), pings);
    fmt::print("}}\n");
}
