#include "components/study/error/ErrorStudy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>
#include <stdexcept>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/rays/AngularView.hpp"
#include "components/sonar/renderer/Quality.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Probe.hpp"
#include "components/study/oracles/EmbreeTracer.hpp"
#include "components/study/oracles/PointTracer.hpp"
#include "types/text/Hash.hpp"

namespace insonify::study {
namespace {

constexpr double frequency_khz = 100;  ///< The max frequency of TR 9407.

acoustics::BeamLaw getBeam(acoustics::Weighting weighting, double width_deg) {
    acoustics::BeamLaw law;
    law.weighting = weighting;
    law.width_deg = width_deg;
    return law;
}

void addPattern(sonar::SonarConfig& config) {
    const double fan_deg = config.fieldOfViewDeg(), beam_deg = fan_deg / config.beam_count;
    sonar::BeamPatternConfig& pattern = config.beam_pattern.emplace();
    pattern.transmit.azimuth = getBeam(acoustics::Weighting::Gaussian, std::min(1.08 * fan_deg, 180.0));
    pattern.transmit.elevation = getBeam(acoustics::Weighting::Uniform, config.beam_height_deg);
    pattern.receive.azimuth = getBeam(acoustics::Weighting::Taylor, 4 * beam_deg);
    pattern.receive.azimuth->sidelobe_db = -25;
    pattern.receive.elevation = getBeam(acoustics::Weighting::Uniform, 1.25 * config.beam_height_deg);
}

void addPulse(sonar::SonarConfig& config) {
    acoustics::PulseConfig& pulse = config.pulse.emplace();
    pulse.bandwidth_khz = 1e-3 * config.speedOfSound() / (2 * 0.6 * sonar::makeBinGrid(config).bin_width);
    pulse.window = acoustics::PulseWindow::Hann;
}

void addSeabed(StudyScene& scene) {
    scene.config.frequency_khz = frequency_khz;
    const auto geometry = makeCopy(scene.snapshot.geometry);
    if (std::ranges::all_of(geometry->materials, [](const types::Material& m) { return m.seabed.empty(); }))
        for (types::Material& material : geometry->materials) material.seabed = "medium_sand";
    scene.snapshot.geometry = geometry;
}

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
Halves means(const StudyScene& scene, const sonar::SonarConfig& config, int poses, std::vector<double>* times,
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

constexpr int min_rows = 64;
constexpr int default_levels = 5,
              default_computed_levels = 4;  ///< With a closed form; with a reference that takes long.

double wallMs() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processorMs() {
    timespec spent{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) * 1e3 + static_cast<double>(spent.tv_nsec) * 1e-6;
}

/** Makes one ping, by any method. */
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

sonar::SonarConfig getConfig(const StudyScene& scene, const Measurement& point) {
    sonar::SonarConfig config = scene.config;
    config.quality.rows = point.rows;
    config.quality.columns_per_beam = point.columns_per_beam;
    return config;
}

sonar::RenderOptions getOptions(const Measurement& point) {
    sonar::RenderOptions options;
    if (point.method == Method::Nearest || point.method == Method::Published)
        options.estimator = sonar::Estimator::Nearest;
    if (point.method == Method::NearestJitter) options.estimator = sonar::Estimator::NearestJitter;
    options.one_frustum = point.method == Method::Published;
    return options;
}

/** Returns the max number of samples of one plane that rays merge to one cell; 1 if no rays are traced [1]. */
int mergedBy(const sonar::RenderPlan& plan) {
    if (!plan.traces_rays) return 1;
    const sonar::AngularView view = sonar::makeAngularView(plan);
    return sonar::TileShape(view, plan.grid, view.beams).max_merged;
}

/** Traces `up` x `across` tiles in each beam with a seed; adds to the number of rays [1]. */
using ReferenceTrace = std::function<std::vector<double>(int up, int across, uint64_t seed, double& rays)>;

template <class Tracer>
ReferenceTrace traceBy(const StudyScene& scene) {
    return
        [&scene, tracer = std::make_shared<Tracer>(scene.snapshot)](int up, int across, uint64_t seed, double& rays) {
            auto energies = tracer->render(scene.snapshot.sonar, scene.config, up, across, seed);
            rays += tracer->rays();
            return energies;
        };
}

ReferenceTrace reference(const StudyScene& scene) {
    return scene.config.multipath ? traceBy<PathTracer>(scene) : traceBy<PointTracer>(scene);
}

/** One scene under study: measures points, and makes the reference. */
class SceneStudy {
public:
    SceneStudy(const StudyScene& scene, const ErrorOptions& options, ErrorResult& result)
        : scene_(scene), options_(options), result_(result), tracer_(scene.snapshot) {
        const sonar::BinGrid grid = sonar::makeBinGrid(scene.config);
        layout_ = {scene.config.beam_count, grid.bin_count, grid.bin_width, scene.range_from};
        base_columns_ = std::max(1, min_rows / scene.config.beam_count);
    }

    void run() {
        if (scene_.config.isCoherent()) return studyCoherent(scene_, options_, min_rows, base_columns_, result_);
        makeReference();
        measureAll();
        predict();
        if (!scene_.truth) refineReference();
        for (const Received& received : received_) {
            result_.measurements.push_back(received.point);
            result_.measurements.back().metrics = compare(received.energies, energies_, layout_);
        }
        prediction_.error = compare(predicted_, energies_, layout_).rel_l2_tvg;
        result_.predictions.push_back(prediction_);
        result_.references.push_back(reference_);
    }

private:
    struct Received {
        Measurement point;
        std::vector<float> energies;
    };

    int levels() const { return options_.levels.value_or(scene_.truth ? default_levels : default_computed_levels); }

    /** Returns whether one perspective image can cover the fan. */
    bool fitsOneFrustum(int level) const {
        const int64_t columns = int64_t{base_columns_} << level;
        return scene_.config.fieldOfViewDeg() < 175 && columns * scene_.config.beam_count <= sonar::max_image_size;
    }

    /** Other methods than the sonar's own handle only surfaces; the ray tracer also a pattern in elevation. */
    bool canRun(Method method, int level) const {
        const sonar::SonarConfig& config = scene_.config;
        if (method == Method::Footprint) return true;
        if (!config.volume.empty() || config.pulse || config.multipath || config.isCoherent()) return false;
        if (config.beam_pattern && config.beam_pattern->hasAzimuth()) return false;
        return method != Method::Published || fitsOneFrustum(level);
    }

    void measureAll() {
        for (const Method method : methods)
            for (int level = 0; level < levels(); ++level)
                if (canRun(method, level)) measure(method, min_rows << level, base_columns_ << level);
        for (int level = 0; level < levels(); ++level)
            if (base_columns_ << level != 2) measure(Method::Footprint, min_rows << level, 2);
    }

    void measure(Method method, int rows, int columns) {
        Received received{{scene_.name, method, rows, columns, 1, {}, 0, 0, 0, 0}, {}};
        options_.progress(fmt::format("{} {} {} x {}", scene_.name, getName(method), rows, columns));
        const sonar::SonarConfig config = getConfig(scene_, received.point);
        if (method == Method::Embree) {
            tracer_.prepare(config);
            const auto ping = [&](auto& energies) { tracer_.render(scene_.snapshot.sonar, energies); };
            time(ping, options_.pings, received.energies, received.point);
        } else {
            timeRenderer(config, received);
        }
        if (method == Method::Embree) received.point.kappa_max = tracer_.kappaMax();
        received_.push_back(std::move(received));
    }

    void timeRenderer(const sonar::SonarConfig& config, Received& received) {
        sonar::SonarRenderer renderer(config, scene_.snapshot.geometry, getOptions(received.point));
        types::Sonar ping;
        time([&](auto&) { renderer.render(scene_.snapshot, ping); }, options_.pings, received.energies, received.point);
        received.energies = ping.bins;
        received.point.merged = mergedBy(renderer.renderPlan());
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
        predicted_ = ping.bins;
        prediction_ = {scene_.name, chosen.rows, chosen.columns_per_beam, target, chosen.error, 0};
    }

    /** Without a closed form, makes a coarse reference, which shows whether there is any echo. */
    void makeReference() {
        reference_ = {scene_.name, "closed form", 0, 0, 0};
        if (scene_.truth) {
            energies_ = trueEnergies(scene_);
            return;
        }
        trace_ = reference(scene_);
        traceReference(1);
        if (std::ranges::none_of(energies_, [](double energy) { return energy > 0; }))
            throw std::runtime_error(scene_.name +
                                     ": the sonar receives no echo in this ping; choose another ping with --ping");
    }

    void refineReference() {
        int refinement = 1;
        while (reference_.error * reference_margin > minError() && 4 * reference_.rays <= options_.reference_rays)
            traceReference(refinement *= 2);  // at most 4 times the rays
    }

    double minError() const {
        double minimum = std::numeric_limits<double>::infinity();
        for (const Received& received : received_)
            minimum = std::min(minimum, compare(received.energies, energies_, layout_).rel_l2);
        return minimum;
    }

    /** Computes the mean of two halves. The distance of each half from it is an estimate of its own error. */
    void traceReference(int refinement) {
        const int up = min_rows / 4 * refinement, across = std::max(1, base_columns_ / 4) * refinement;
        double rays = 0;
        const auto half = [&](uint64_t seed) {
            options_.progress(fmt::format("{} reference, {} x {} tiles", scene_.name, up, across));
            return trace_(up, across, seed, rays);
        };
        energies_ = half(2 * static_cast<uint64_t>(refinement));
        const std::vector<float> first(energies_.begin(), energies_.end());
        const std::vector<double> second = half(2 * static_cast<uint64_t>(refinement) + 1);
        for (size_t i = 0; i < second.size(); ++i) energies_[i] = (energies_[i] + second[i]) / 2;
        const Metrics apart = compare(first, energies_, layout_);
        reference_ = {scene_.name,
                      fmt::format("brute force, two halves of {} x {} tiles a beam, {:.2g} rays", up, across, rays),
                      apart.rel_l2, apart.rel_l2_tvg, rays};
    }

    const StudyScene& scene_;
    const ErrorOptions& options_;
    ErrorResult& result_;
    EmbreeTracer tracer_;
    ReferenceTrace trace_;
    Layout layout_{};
    int base_columns_ = 1;
    std::vector<Received> received_;
    Prediction prediction_{};
    std::vector<float> predicted_;
    Reference reference_;
    std::vector<double> energies_;  ///< Energies of the reference.
};

}  // namespace

StudyScene withEffect(const StudyScene& plain, Effect effect) {
    StudyScene scene = plain;
    scene.truth = nullptr;
    switch (effect) {
        case Effect::PatternAndPulse:
            scene.name += "_pattern_and_pulse";
            addPattern(scene.config);
            addPulse(scene.config);
            break;
        case Effect::Seabed:
            scene.name += "_seabed";
            addSeabed(scene);
            break;
        case Effect::Volume:
            scene.name += "_volume";
            scene.config.volume = {{{}, {}, -50}};
            break;
        case Effect::Multipath:
            scene.name += "_multipath";
            scene.config.multipath.emplace().surface.emplace();
            if (!scene.snapshot.water_surface) scene.snapshot.water_surface = scene.snapshot.sonar.position.z + 3;
            break;
        case Effect::Coherent:
            scene.name += "_coherent";
            scene.config.frequency_khz = frequency_khz;
            scene.config.speckle.emplace().coherent = true;
            break;
    }
    return scene;
}

void studyCoherent(const StudyScene& scene, const ErrorOptions& options, int min_rows, int base_columns,
                   ErrorResult& result) {
    const int poses = std::max(2, options.coherent_poses / 2 * 2);
    const auto getConfig = [&](int rows, int columns) {
        sonar::SonarConfig config = scene.config;
        config.quality = {};
        config.quality.rows = rows;
        config.quality.columns_per_beam = columns;
        return config;
    };
    options.progress(scene.name + " energies");
    sonar::SonarConfig energies = getConfig(min_rows * finer, base_columns * finer);
    energies.speckle.reset();
    const Halves expected = means(scene, energies, poses, nullptr, result.device);
    double chance = 0;
    for (int level = 0; level < std::min(options.levels.value_or(max_levels), max_levels); ++level) {
        Measurement point{scene.name, Method::Footprint, min_rows << level, base_columns << level, 1, {}, 0, 0, 0, 0};
        options.progress(fmt::format("{} footprint {} x {}", scene.name, point.rows, point.columns_per_beam));
        std::vector<double> times;
        const Halves received =
            means(scene, getConfig(point.rows, point.columns_per_beam), poses, &times, result.device);
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

const char* getName(Method method) {
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
