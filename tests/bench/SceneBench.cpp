// Costs of a scene for sonars that share it, and for a sonar whose scene changes:
//   scene_bench mission FOLDER      prints JSON: milliseconds a ping [median, p99, max] of a mission over more than 100
//                                   tiles of a survey that it writes there, by rays of one thread: of all pings and of
//                                   those with new tiles, by the clock and of that thread's processor time.
//   scene_bench border WAY CELLS    prints JSON: milliseconds a ping [median, p99, max] at 20 Hz over a floor of
//                                   2 CELLS^2 triangles, on a `line` across the border of two cells of 512 m, or on a
//                                   `circle` of 20 m about the corner of four; megabytes after the first ping and at
//                                   most.
//   scene_bench memory SONARS CELLS prints JSON: megabytes of the scene's file in memory and of the process with
//                                   this number of sonars that have all pinged, before a floor of 2 CELLS^2 triangles.
#include <fmt/core.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <thread>

#include "components/scene/Bathymetry.hpp"
#include "components/scene/Clusters.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Shapes.hpp"

namespace insonify {
namespace {

using Clock = std::chrono::steady_clock;

sonar::SonarConfig fan() {
    sonar::SonarConfig config;
    config.visibility = sonar::Visibility::Cpu;
    config.beam_count = 256;
    config.bin_count = 500;
    config.range = 50;
    config.field_of_view_deg = 120;
    config.beam_height_deg = 40;
    config.quality.rows = 256;
    config.quality.columns_per_beam = 2;
    return config;
}

double hill(double x, double y) { return -12 + std::sin(0.31 * x) * std::cos(0.23 * y) + 0.3 * std::sin(1.7 * x + y); }

types::Snapshot at(const glm::dvec3& place, int ping) {
    types::Snapshot snapshot;
    snapshot.time.microseconds = 100'000 * ping;
    snapshot.sonar.position = place;
    snapshot.sonar.orientation = glm::angleAxis(0.4, glm::dvec3(0, 1, 0));
    return snapshot;
}

/** Posts 0.5 m apart: 4096 north of the first, 400 east of it. */
std::string survey(const std::string& folder) {
    constexpr int columns = 400, rows = 4096;
    std::vector<float> values;
    for (int row = rows - 1; row >= 0; --row)
        for (int column = 0; column < columns; ++column)
            values.push_back(static_cast<float>(hill(0.5 * column, 0.5 * row)));
    std::ofstream(folder + "/floor.hdr") << fmt::format(
        "ncols {}\nnrows {}\nxllcenter 0\nyllcenter 0\ncellsize 0.5\nbyteorder LSBFIRST\n", columns, rows);
    std::ofstream(folder + "/floor.flt")
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
    return folder + "/floor.flt";
}

std::string spread(std::vector<double> ms) {
    std::ranges::sort(ms);
    const auto share = [&](double part) { return ms[static_cast<size_t>(part * static_cast<double>(ms.size() - 1))]; };
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", share(0.5), share(0.99), ms.back());
}

/** Returns the processor time of this thread so far. */
double busyMs() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/** Measures 1900 m at 1 m a ping, each ping started when the one before has ended. */
void mission(const std::string& folder) {
    scene::BathymetryConfig config;
    config.easting = config.northing = 0;
    config.reach = 55;
    config.tile = 32;
    scene::Bathymetry floor(config, survey(folder));
    scene::Scene scene;
    scene.geometry = std::make_shared<types::Geometry>();
    scene::Bathymetry::addMaterials(scene, {});
    std::unique_ptr<sonar::SonarRenderer> renderer;
    types::GeometryPtr before;
    types::Sonar ping;
    sonar::RenderOptions one_thread;
    one_thread.threads = 1;
    std::vector<double> all, changed, all_busy, changed_busy;
    for (int i = 0; i < 1900; ++i) {
        const glm::dvec3 place(60.0 + i, -100, -4);
        types::Snapshot snapshot = at(place, i);
        const auto start = Clock::now();
        const double start_busy = busyMs();
        snapshot.geometry = floor.about(place, scene.geometry);
        snapshot.ahead = floor.ahead();
        if (!renderer) renderer = std::make_unique<sonar::SonarRenderer>(fan(), snapshot.geometry, one_thread);
        renderer->setGeometry(snapshot.geometry);
        renderer->render(snapshot, ping);
        const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        const double busy = busyMs() - start_busy;
        const bool is_changed = snapshot.geometry != std::exchange(before, snapshot.geometry);
        if (i < 20) continue;  // the first pings make the renderer
        all.push_back(ms);
        all_busy.push_back(busy);
        if (!is_changed) continue;
        changed.push_back(ms);
        changed_busy.push_back(busy);
    }
    fmt::print(
        "{{\"pings\": {}, \"changes\": {}, \"ms\": {}, \"ms_of_changes\": {}, \"busy_ms\": {}, "
        "\"busy_ms_of_changes\": {}}}\n",
        all.size(), changed.size(), spread(all), spread(changed), spread(all_busy), spread(changed_busy));
}

double megabytes() {
    size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return static_cast<double>(resident * static_cast<size_t>(sysconf(_SC_PAGESIZE))) / 1e6;
}

types::GeometryPtr field(uint32_t cells) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t row = 0; row <= cells; ++row)
        for (uint32_t column = 0; column <= cells; ++column) {
            const double x = 100.0 * row / cells, y = 100.0 * column / cells - 50;
            positions.emplace_back(x, y, hill(x, y));
        }
    for (uint32_t row = 0; row < cells; ++row)
        for (uint32_t column = 0; column < cells; ++column) {
            const uint32_t k = row * (cells + 1) + column;
            indices.insert(indices.end(), {k, k + cells + 1, k + 1, k + 1, k + cells + 1, k + cells + 2});
        }
    types::Mesh mesh = study::getMesh(positions, indices);
    scene::buildClusters(mesh);
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials.emplace_back();
    geometry->objects.emplace_back();
    geometry->meshes.push_back(std::move(mesh));
    return geometry;
}

/** Measures 2 m/s, each ping 50 ms after the one before. */
void border(std::string_view way, uint32_t cells) {
    auto geometry = std::make_shared<types::Geometry>(*field(cells));
    const glm::dvec3 middle = way == "circle" ? glm::dvec3(256, 256, -4) : glm::dvec3(256, 400, -4);
    geometry->objects.front().world_from_object[3] = {middle.x - 50, middle.y, 0, 1};
    sonar::RenderOptions one_thread;
    one_thread.threads = 1;
    sonar::SonarRenderer renderer(fan(), geometry, one_thread);
    types::Sonar ping;
    std::vector<double> all, busy;
    double first_mb = 0, max_mb = 0;
    for (int i = 0; i < 1300; ++i) {
        const auto start = Clock::now();
        const double angle = 0.005 * i;
        const glm::dvec3 place = middle + (way == "circle" ? 20.0 * glm::dvec3(std::cos(angle), std::sin(angle), 0)
                                                           : glm::dvec3(0.1 * i - 46, 0, 0));
        types::Snapshot snapshot = at(place, i);
        snapshot.geometry = geometry;
        const double start_busy = busyMs();
        renderer.render(snapshot, ping);
        max_mb = std::max(max_mb, megabytes());
        if (i == 0) first_mb = max_mb;
        if (i > 0) {
            all.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
            busy.push_back(busyMs() - start_busy);
        }
        std::this_thread::sleep_until(start + std::chrono::milliseconds(50));
    }
    fmt::print(
        "{{\"way\": \"{}\", \"triangles\": {}, \"ms\": {}, \"busy_ms\": {}, \"mb_first\": {:.1f}, "
        "\"mb\": {:.1f}}}\n",
        way, geometry->triangleCount(), spread(all), spread(busy), first_mb, max_mb);
}

void memory(int count, uint32_t cells) {
    const types::GeometryPtr geometry = field(cells);
    const double loaded = megabytes();
    sonar::RenderOptions one_thread;
    one_thread.threads = 1;
    std::vector<std::unique_ptr<sonar::SonarRenderer>> sonars;
    for (int i = 0; i < count; ++i) {
        types::Snapshot snapshot = at({5 + 0.1 * i, 0, -4}, i);
        snapshot.geometry = geometry;
        sonars.push_back(std::make_unique<sonar::SonarRenderer>(fan(), geometry, one_thread));
        types::Sonar ping;
        sonars.back()->render(snapshot, ping);
    }
    fmt::print("{{\"sonars\": {}, \"triangles\": {}, \"mb_scene\": {:.1f}, \"mb\": {:.1f}}}\n", count,
               geometry->triangleCount(), loaded, megabytes());
}

int run(int argc, char** argv) {
    const std::string_view what = argc > 1 ? argv[1] : "";
    if (what == "mission" && argc == 3) return mission(argv[2]), 0;
    if (what == "border" && argc == 4) return border(argv[2], static_cast<uint32_t>(std::atoi(argv[3]))), 0;
    if (what == "memory" && argc == 4) return memory(std::atoi(argv[2]), static_cast<uint32_t>(std::atoi(argv[3]))), 0;
    fmt::print(stderr, "usage: scene_bench mission FOLDER | border WAY CELLS | memory SONARS CELLS\n");
    return 2;
}

}  // namespace
}  // namespace insonify

int main(int argc, char** argv) { return insonify::run(argc, argv); }
