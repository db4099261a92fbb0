// How fast fans of 512 x 1000 are drawn one by one and with several pings under way, and what each way to cull and to
// sum takes:
//   pipeline_bench SCENE PINGS      prints JSON. The ways take turns, a fifth of the pings at a time.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "components/scene/Scene.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "types/Angle.hpp"

namespace insonify {
namespace {

using CullOn = sonar::RenderOptions::CullOn;
using SumIn = sonar::RenderOptions::SumIn;

constexpr int rounds = 5;

struct Way {
    const char* name;
    sonar::Deposit deposit;
    sonar::RenderOptions options;
    std::vector<double> ms;  ///< A ping, of each round.
};

sonar::SonarConfig fan(sonar::Deposit deposit) {
    sonar::SonarConfig config;
    config.visibility = sonar::Visibility::Gl;
    config.deposit = deposit;
    config.beam_count = 512;
    config.bin_count = 1000;
    config.field_of_view_deg = 120;
    config.beam_height_deg = 20;
    config.range = 30;
    config.quality.rows = 256;
    config.quality.columns_per_beam = 2;
    return config;
}

/** A slow turn, the sonar looking down by 10 deg. */
types::SnapshotPtr look(const types::GeometryPtr& geometry, int ping) {
    const double yaw = 0.01 * ping, pitch = types::radians(10);
    auto snapshot = std::make_shared<types::Snapshot>();
    snapshot->geometry = geometry;
    snapshot->sonar.orientation = glm::angleAxis(yaw, glm::dvec3(0, 0, 1)) * glm::angleAxis(pitch, glm::dvec3(0, 1, 0));
    return snapshot;
}

/** Seconds for `count` pings, as many under way as the renderer takes. */
double secondsFor(sonar::SonarRenderer& renderer, const types::GeometryPtr& geometry, int count) {
    types::Sonar ping;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
        if (i >= static_cast<int>(renderer.ringSize())) renderer.collect(ping);
        renderer.submit(look(geometry, i));
    }
    for (size_t i = 0; i < std::min(renderer.ringSize(), static_cast<size_t>(count)); ++i) renderer.collect(ping);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void bench(const char* file, int pings) {
    using sonar::Deposit;
    std::vector<Way> ways = {
        {"as it chooses, one by one", Deposit::Auto, {.ring = 1}, {}},
        {"as it chooses, three under way", Deposit::Auto, {.ring = 3}, {}},
        {"sums in memory", Deposit::Gpu, {.ring = 3, .cull_on = CullOn::Processor, .sum_in = SumIn::Memory}, {}},
        {"sums in work groups", Deposit::Gpu, {.ring = 3, .cull_on = CullOn::Processor, .sum_in = SumIn::Groups}, {}},
        {"culled there as well", Deposit::Gpu, {.ring = 3, .cull_on = CullOn::Device, .sum_in = SumIn::Groups}, {}}};
    const types::GeometryPtr geometry = scene::loadScene(file);
    std::string device;
    for (int round = 0; round < rounds; ++round)
        for (Way& way : ways) {
            sonar::SonarRenderer renderer(fan(way.deposit), geometry, way.options);
            device = renderer.device();
            secondsFor(renderer, geometry, 3);  // the first are slow
            const int count = std::max(1, pings / rounds);
            way.ms.push_back(1e3 * secondsFor(renderer, geometry, count) / count);
        }
    fmt::print(R"({{"device": "{}", "pings": {}, "ms": {{)", device, pings);
    for (const Way& way : ways) fmt::print(R"({}"{}": {:.3f})", &way == &ways[0] ? "" : ", ", way.name, median(way.ms));
    fmt::print("}}}}\n");
}

}  // namespace
}  // namespace insonify

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: pipeline_bench SCENE PINGS\n");
        return 2;
    }
    try {
        insonify::bench(argv[1], std::atoi(argv[2]));
    } catch (const std::exception& failed) {
        fmt::print(stderr, "{}\n", failed.what());
        return 1;
    }
}
