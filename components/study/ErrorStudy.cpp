#include "components/study/ErrorStudy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <stdexcept>

#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/Quality.hpp"
#include "components/sonar/SonarRenderer.hpp"
#include "components/study/EmbreeCaster.hpp"

namespace insonify::study {
namespace {

constexpr int least_rows = 64;
constexpr int most_levels_computed = 4;  ///< Without a closed form: the reference costs 64 times the finest point.
constexpr int reference_refinement = 8;  ///< Of the finest point measured, in rows and columns each.

double wallMs() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processorMs() {
    timespec spent{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) * 1e3 + static_cast<double>(spent.tv_nsec) * 1e-6;
}

/** What makes one ping, whatever the method. */
using Ping = std::function<void(std::vector<float>& energies)>;

void time(const Ping& ping, int pings, std::vector<float>& energies, Measurement& point) {
    for (int warm_up = 0; warm_up < 2; ++warm_up) ping(energies);
    std::vector<double> times;
    const double processor = processorMs();
    for (int i = 0; i < pings; ++i) {
        const double start = wallMs();
        ping(energies);
        times.push_back(wallMs() - start);
    }
    point.cpu_ms = (processorMs() - processor) / pings;
    std::ranges::sort(times);
    point.median_ms = times[times.size() / 2];
    point.p99_ms =
        times[std::min(times.size() - 1, static_cast<size_t>(std::ceil(0.99 * static_cast<double>(times.size()))) - 1)];
}

sonar::SonarConfig configOf(const StudyScene& scene, const Measurement& point) {
    sonar::SonarConfig config = scene.config;
    config.quality.rows = point.rows;
    config.quality.columns_per_beam = point.columns_per_beam;
    config.least_slabs = point.slabs;
    config.samples_per_pixel = point.samples_per_pixel;
    if (point.method == Method::Nearest || point.method == Method::Published)
        config.estimator = sonar::Estimator::Nearest;
    if (point.method == Method::NearestJitter) config.estimator = sonar::Estimator::NearestJitter;
    config.one_frustum = point.method == Method::Published;
    return config;
}

/** One scene under study: its reference, and what measures a point of it. */
class SceneStudy {
public:
    SceneStudy(const StudyScene& scene, const ErrorOptions& options, ErrorResult& result)
        : scene_(scene), options_(options), result_(result), caster_(scene.snapshot) {
        const sonar::BinGrid grid = sonar::makeBinGrid(scene.config);
        layout_ = {scene.config.beam_count, grid.bin_count, grid.bin_width, scene.range_from};
        base_columns_ = std::max(1, least_rows / scene.config.beam_count);
        makeReference();
    }

    void run() {
        const int slabs = static_cast<int>(sonar::makeSlabs(scene_.config, sonar::makeBeams(scene_.config)).size());
        for (const Method method : methods)
            if (method != Method::Published || fitsOneFrustum())
                for (int level = 0; level < levels(); ++level)
                    measure(method, least_rows << level, base_columns_ << level,
                            method == Method::Published ? 1 : slabs);
        for (int level = 0; level < levels(); ++level)
            if (base_columns_ << level != 2) measure(Method::Footprint, least_rows << level, 2, slabs);
        for (const int more : {2 * slabs, 4 * slabs})
            measure(Method::Footprint, 4 * least_rows, 4 * base_columns_, more);
        for (int level = 0; level + 1 < levels(); ++level)
            measure(Method::Footprint, least_rows << level, base_columns_ << level, slabs, 4);
        predict();
        if (!scene_.truth) result_.references.back().error = halving_ / (convergence() - 1);
    }

private:
    int levels() const { return scene_.truth ? options_.levels : std::min(options_.levels, most_levels_computed); }

    /** What doubling rows and columns divides the error of rays by, where it divides least. */
    double convergence() const {
        std::vector<double> errors;
        for (const Measurement& m : result_.measurements)
            if (m.scene == scene_.name && m.method == Method::Embree) errors.push_back(m.metrics.rel_l2);
        double least = 4;  // of smooth surfaces
        for (size_t i = 1; i < errors.size(); ++i) least = std::min(least, errors[i - 1] / errors[i]);
        return std::max(least, 1.5);
    }

    /** Whether one perspective image can hold the fan, at all levels. */
    bool fitsOneFrustum() const {
        const int64_t columns = int64_t{base_columns_} << (levels() - 1);
        return scene_.config.field_of_view_deg < 175 && columns * scene_.config.beam_count <= sonar::most_image_size;
    }

    void measure(Method method, int rows, int columns, int slabs, int samples = 1) {
        Measurement point{scene_.name, method, rows, columns, samples, slabs, {}, 0, 0, 0, 0};
        options_.progress(fmt::format("{} {} {} x {}", scene_.name, nameOf(method), rows, columns));
        const sonar::SonarConfig config = configOf(scene_, point);
        std::vector<float> energies;
        if (method == Method::Embree)
            time([&](auto& e) { caster_.render(scene_.snapshot.sonar, config, e); }, options_.pings, energies, point);
        else
            timeRenderer(config, energies, point);
        if (method != Method::Published) point.kappa_max = kappa(config);
        point.metrics = compare(energies, reference_, layout_);
        result_.measurements.push_back(point);
    }

    void timeRenderer(const sonar::SonarConfig& config, std::vector<float>& energies, Measurement& point) {
        sonar::SonarRenderer renderer(config, scene_.snapshot.geometry);
        types::Sonar ping;
        time([&](auto&) { renderer.render(scene_.snapshot, ping); }, options_.pings, energies, point);
        energies = ping.bins;
        result_.device = renderer.device();
    }

    void predict() {
        options_.progress(scene_.name + " target_error");
        constexpr double target = 0.02;
        sonar::SonarConfig config = scene_.config;
        config.quality = {};
        config.quality.target_error = target;
        const sonar::Quality chosen = sonar::chooseQuality(config, scene_.snapshot);
        config.quality = {};
        config.quality.rows = chosen.rows;
        config.quality.columns_per_beam = chosen.columns_per_beam;
        types::Sonar ping;
        sonar::SonarRenderer(config, scene_.snapshot.geometry).render(scene_.snapshot, ping);
        result_.predictions.push_back({scene_.name, chosen.rows, chosen.columns_per_beam, target, chosen.error,
                                       compare(ping.bins, reference_, layout_).rel_l2_tvg});
    }

    double kappa(const sonar::SonarConfig& config) {
        std::vector<float> unused;
        caster_.render(scene_.snapshot.sonar, config, unused);
        return caster_.kappaMax();
    }

    void makeReference() {
        if (scene_.truth) {
            reference_ = trueEnergies(scene_);
            result_.references.push_back({scene_.name, "closed form", 0});
            return;
        }
        const int finest = reference_refinement << (levels() - 1);
        const std::vector<float> half = cast(finest / 2), whole = cast(finest);
        reference_.assign(whole.begin(), whole.end());
        if (std::ranges::none_of(reference_, [](double energy) { return energy > 0; }))
            throw std::runtime_error(scene_.name +
                                     ": the sonar hears nothing in this ping; choose another one with --ping");
        halving_ = compare(half, reference_, layout_).rel_l2;
        result_.references.push_back({scene_.name,
                                      fmt::format("the same estimate by rays (Embree), {} rows, {} columns per beam",
                                                  least_rows * finest, base_columns_ * finest),
                                      0});
    }

    std::vector<float> cast(int refinement) {
        options_.progress(fmt::format("{} reference, {} rows", scene_.name, least_rows * refinement));
        sonar::SonarConfig config = scene_.config;
        config.quality.rows = least_rows * refinement;
        config.quality.columns_per_beam = base_columns_ * refinement;
        std::vector<float> energies;
        caster_.render(scene_.snapshot.sonar, config, energies);
        return energies;
    }

    const StudyScene& scene_;
    const ErrorOptions& options_;
    ErrorResult& result_;
    EmbreeCaster caster_;
    Layout layout_{};
    int base_columns_ = 1;
    std::vector<double> reference_;
    double halving_ = 0;  ///< What half the rows and columns change of a computed reference [1].
};

}  // namespace

const char* nameOf(Method method) {
    switch (method) {
        case Method::Footprint: return "footprint";
        case Method::Nearest: return "nearest";
        case Method::NearestJitter: return "nearest_jitter";
        case Method::Published: return "published";
        case Method::Embree: return "embree";
    }
    return "";
}

ErrorResult studyError(const std::vector<StudyScene>& scenes, const ErrorOptions& options) {
    ErrorResult result;
    for (const StudyScene& scene : scenes) SceneStudy(scene, options, result).run();
    return result;
}

}  // namespace insonify::study
