#include "components/study/CoherentError.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "types/Hash.hpp"

namespace insonify::study {
namespace {

constexpr int max_levels = 3;
constexpr int finer = 8;   ///< Factor of rows and columns of the energies over those of the coarsest ping [1].
constexpr double far = 1;  ///< Max offset of poses from the scene's along x and y [m].

/** Mean of one half of the poses. */
using Half = std::vector<double>;
using Halves = std::array<Half, 2>;

types::Snapshot at(const StudyScene& scene, int pose) {
    types::Snapshot snapshot = scene.snapshot;
    const auto drawn = [&](uint64_t axis) {
        return far * (2 * types::unit(types::hashed(1, static_cast<uint64_t>(pose), axis) >> 32) - 1);
    };
    snapshot.sonar.position.x += drawn(0);
    snapshot.sonar.position.y += drawn(1);
    return snapshot;
}

/** Averages the poses alternately into two halves; adds the times of all poses except the first [ms]. */
Halves meansOf(const StudyScene& scene, const sonar::SonarConfig& config, int poses, std::vector<double>* times,
               std::string& device) {
    sonar::SonarRenderer renderer(config, scene.snapshot.geometry);
    device = renderer.device();
    Halves halves;
    types::Sonar ping;
    for (int pose = 0; pose < poses; ++pose) {
        const types::Snapshot snapshot = at(scene, pose);
        const auto start = std::chrono::steady_clock::now();
        renderer.render(snapshot, ping);
        if (times && pose > 0)
            times->push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        Half& half = halves[static_cast<size_t>(pose % 2)];
        half.resize(ping.bins.size());
        for (size_t i = 0; i < ping.bins.size(); ++i) half[i] += 2.0 * double{ping.bins[i]} / poses;
    }
    return halves;
}

}  // namespace

void studyCoherent(const StudyScene& scene, const ErrorOptions& options, int min_rows, int base_columns,
                   ErrorResult& result) {
    const int poses = std::max(2, options.coherent_poses / 2 * 2);
    const auto configOf = [&](int rows, int columns) {
        sonar::SonarConfig config = scene.config;
        config.quality = {};
        config.quality.rows = rows;
        config.quality.columns_per_beam = columns;
        return config;
    };
    options.progress(scene.name + " energies");
    sonar::SonarConfig energies = configOf(min_rows * finer, base_columns * finer);
    energies.speckle.reset();
    const Halves expected = meansOf(scene, energies, poses, nullptr, result.device);
    double chance = 0;
    for (int level = 0; level < std::min(options.levels, max_levels); ++level) {
        Measurement point{scene.name, Method::Footprint, min_rows << level, base_columns << level, 1, {}, 0, 0, 0, 0};
        options.progress(fmt::format("{} footprint {} x {}", scene.name, point.rows, point.columns_per_beam));
        std::vector<double> times;
        const Halves received =
            meansOf(scene, configOf(point.rows, point.columns_per_beam), poses, &times, result.device);
        double square = 0, scale = 0, spread = 0, got = 0, all = 0;
        for (size_t i = 0; i < received[0].size(); ++i) {
            const double product = (received[0][i] - expected[0][i]) * (received[1][i] - expected[1][i]);
            square += product, spread += product * product, scale += expected[0][i] * expected[1][i];
            got += received[0][i] + received[1][i], all += expected[0][i] + expected[1][i];
        }
        const double by_chance = std::sqrt(std::sqrt(spread) / scale);
        chance = std::max(chance, by_chance);
        point.metrics.rel_l2 = std::max(by_chance, std::sqrt(std::max(0.0, square / scale)));
        point.metrics.energy_bias = got / all - 1;
        std::ranges::sort(times);
        point.median_ms = times[times.size() / 2];
        point.p99_ms = times.back();
        result.measurements.push_back(point);
    }
    result.references.push_back(
        {scene.name, fmt::format("energies of {} poses, {} rows", poses, min_rows * finer), chance, 0, 0});
}

}  // namespace insonify::study
