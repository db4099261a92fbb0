#include "components/sonar/SonarRenderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BinLevels.hpp"
#include "components/sonar/CpuDeposit.hpp"
#include "components/sonar/Plan.hpp"
#include "components/sonar/SurfacePass.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

std::vector<std::string> defines(const types::Plan& plan) {
    std::vector<std::string> result;
    for (std::string feature : plan.features) {
        std::transform(feature.begin(), feature.end(), feature.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        result.push_back("HAVE_" + feature);
    }
    return result;
}

/** Slant range before which nothing is drawn [m]. What is nearer than the blanking is: it casts its shadow. */
constexpr double nearest_drawn = 1e-3;

/** Distance of the image plane that is nowhere farther than `nearest_drawn`, even in the picture's corners. */
double nearPlane(const Slab& slab) {
    const double corner = std::sqrt(1 + slab.extent_u * slab.extent_u + slab.extent_v * slab.extent_v);
    return nearest_drawn / corner;
}

CullRules cullRules(const SonarConfig& config, const BinGrid& bins) {
    const double detail = config.published ? 0 : config.detail;
    return {nearest_drawn, bins.range_max, detail, 0.5 * bins.bin_width, config.draw_all};
}

/** Strongest Lambert parameter [1]. */
double loudest(const types::Geometry& geometry) {
    double strongest = 0;
    for (const types::Material& material : geometry.materials)
        strongest = std::max(strongest, std::pow(10.0, material.lambert_db / 10.0));
    return strongest;
}

DepositSetup depositSetup(const SonarConfig& config, const std::vector<Beam>& beams, const std::vector<Slab>& slabs,
                          const BinGrid& bins) {
    DepositSetup setup;
    setup.slabs = slabs;
    for (const Slab& slab : slabs) setup.shares.push_back(makeShares(config, beams, slab));
    setup.beam_count = static_cast<uint32_t>(beams.size());
    setup.bins = bins;
    setup.attenuation = config.model == Model::Cerqueira2017 ? makeAbsorption(config).amplitudeNepersPerMetre() : 0;
    setup.model = config.model;
    setup.published = config.published && config.model == Model::Cerqueira2017;
    setup.estimator = config.estimator;
    return setup;
}

}  // namespace

struct SonarRenderer::Parts {
    Parts(const SonarConfig& config, types::GeometryPtr scene);
    void makeDeposit();
    void drawSlabs(const types::Snapshot& snapshot);
    void fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const;
    void fillBins(types::Sonar& ping);
    void fillBeam(size_t beam, double* values, types::Sonar& ping) const;
    /** Seconds since the last call, put down for a stage. */
    void lap(size_t stage);

    SonarConfig config;
    types::GeometryPtr geometry;
    types::Plan plan;
    gpu::EglContext context;
    std::vector<Beam> beams;
    std::vector<Slab> slabs;
    BinGrid bins;
    BinLevels levels;
    Culler culler;
    ThreadPool threads;
    SurfacePass surface;
    std::unique_ptr<BinDeposit> deposit;
    double strength_scale = 1;
    std::span<const uint64_t> sums;  ///< Of the last ping.
    std::vector<double> scratch;
    std::array<Stage, 5> stages{{{"cull", 0}, {"draw", 0}, {"read", 0}, {"deposit", 0}, {"beams", 0}}};
    std::chrono::steady_clock::time_point last;
};

SonarRenderer::Parts::Parts(const SonarConfig& c, types::GeometryPtr scene)
    : config(c),
      geometry(std::move(scene)),
      plan(makePlan(config, *geometry)),
      context(config.device),
      beams(makeBeams(config)),
      slabs(makeSlabs(config, beams)),
      bins(makeBinGrid(config)),
      levels(config, bins),
      culler(*geometry, cullRules(config, bins)),
      threads(config.threads),
      surface(context, {*geometry, slabs, defines(plan), nearPlane(slabs.front()), culler.runLimit(), config.published},
              threads) {
    makeDeposit();
    scratch.resize(static_cast<size_t>(threads.size()) * static_cast<size_t>(bins.bin_count));
    context.check();
}

void SonarRenderer::Parts::makeDeposit() {
    DepositSetup setup = depositSetup(config, beams, slabs, bins);
    setup.strength_scale = strength_scale = strengthScale(config, bins, loudest(*geometry));
    const bool on_cpu = config.deposit == Deposit::Cpu || (config.deposit == Deposit::Auto && context.isSoftware());
    if (on_cpu)
        deposit = std::make_unique<CpuDeposit>(std::move(setup), surface, threads);
    else
        deposit = makeGpuDeposit(setup, context);
}

void SonarRenderer::Parts::lap(size_t stage) {
    const auto now = std::chrono::steady_clock::now();
    stages[stage].seconds += std::chrono::duration<double>(now - last).count();
    last = now;
}

void SonarRenderer::Parts::drawSlabs(const types::Snapshot& snapshot) {
    deposit->begin();
    culler.place(snapshot);
    surface.cull(culler);
    lap(0);
    surface.draw();
    lap(1);
    {
        const auto alone = context.transferring();
        for (size_t i = 0; i < slabs.size(); ++i)
            if (surface.draws(i)) deposit->take(i, surface);
    }
    lap(2);
}

void SonarRenderer::Parts::fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const {
    ping.time = snapshot.time;
    ping.timestamps.clear();
    ping.bin_duration.microseconds = bins.bin_duration_us;
    ping.beam_width = types::Angle::fromDeg(config.beamWidthDeg());
    ping.beam_height = types::Angle::fromDeg(config.beam_height_deg);
    ping.bearings.resize(beams.size());
    for (size_t k = 0; k < beams.size(); ++k) ping.bearings[k] = types::Angle::fromRad(beams[k].centre);
    ping.speed_of_sound = static_cast<float>(bins.speed_of_sound);
    ping.bin_count = static_cast<uint32_t>(bins.bin_count);
    ping.beam_count = static_cast<uint32_t>(beams.size());
    ping.bins.resize(beams.size() * static_cast<size_t>(bins.bin_count));
}

void SonarRenderer::Parts::fillBeam(size_t beam, double* values, types::Sonar& ping) const {
    const auto count = static_cast<size_t>(bins.bin_count);
    const double pixel = slabs.front().du() * slabs.front().dv();  // solid angle of a whole pixel [sr]
    for (size_t k = 0; k < count; ++k) {
        const size_t at = beam * count + k;
        if (config.model == Model::Physical)
            values[k] = static_cast<double>(sums[at]) * (pixel / (quanta_per_unit * strength_scale));
        else
            values[k] =
                sums[2 * at + 1] ? static_cast<double>(sums[2 * at]) / static_cast<double>(sums[2 * at + 1]) : 0;
    }
    levels.apply({values, count}, {ping.bins.data() + beam * count, count});
}

void SonarRenderer::Parts::fillBins(types::Sonar& ping) {
    threads.run([&](int part, int parts) {
        double* values = scratch.data() + static_cast<size_t>(part) * static_cast<size_t>(bins.bin_count);
        for (auto beam = static_cast<size_t>(part); beam < beams.size(); beam += static_cast<size_t>(parts))
            fillBeam(beam, values, ping);
    });
}

SonarRenderer::SonarRenderer(const SonarConfig& config, types::GeometryPtr geometry) {
    const auto alone = gpu::EglContext::making();
    parts_ = std::make_unique<Parts>(config, std::move(geometry));
}

SonarRenderer::~SonarRenderer() {
    const auto alone = gpu::EglContext::making();
    parts_.reset();
}

void SonarRenderer::render(const types::Snapshot& snapshot, types::Sonar& ping) {
    parts_->context.requireThread();
    for (Stage& stage : parts_->stages) stage.seconds = 0;
    parts_->last = std::chrono::steady_clock::now();
    parts_->drawSlabs(snapshot);
    parts_->context.check();
    parts_->sums = parts_->deposit->finish();
    parts_->lap(3);
    parts_->fillHeader(snapshot, ping);
    parts_->fillBins(ping);
    parts_->lap(4);
}

void SonarRenderer::setQuality(int rows, int columns_per_beam) {
    parts_->context.requireThread();
    parts_->config.quality.rows = parts_->plan.rows = rows;
    parts_->config.quality.columns_per_beam = parts_->plan.columns_per_beam = columns_per_beam;
    parts_->slabs = makeSlabs(parts_->config, parts_->beams);
    const auto alone = parts_->context.transferring();
    parts_->surface.resize(parts_->slabs);
    parts_->sums = {};
    parts_->makeDeposit();
    parts_->context.check();
}

std::span<const SonarRenderer::Stage> SonarRenderer::stages() const { return parts_->stages; }
bool SonarRenderer::heard() const {
    bool drawn = false;  // published counts what is not there
    for (size_t i = 0; i < parts_->slabs.size(); ++i) drawn = drawn || !parts_->surface.picture(i).empty();
    return drawn && std::ranges::any_of(parts_->sums, [](uint64_t sum) { return sum > 0; });
}

std::vector<types::Omission> SonarRenderer::culled() const {
    const types::Geometry& geometry = *parts_->geometry;
    std::vector<bool> seen(geometry.objects.size());
    size_t empty_slabs = 0, shown = 0, coarse = 0, replaced = 0;  // of two slabs more than once
    for (size_t i = 0; i < parts_->slabs.size(); ++i) {
        const auto& runs = parts_->surface.picture(i).runs;
        empty_slabs += runs.empty();
        for (const Culler::Run& run : runs) {
            seen[run.object] = true;
            shown += (run.stands_for ? run.stands_for : run.index_count) / 3;
            coarse += run.stands_for ? run.index_count / 3 : 0;
            replaced += run.stands_for / 3;
        }
    }
    std::vector<types::Omission> all;
    const auto add = [&](const char* before, size_t left_out, size_t of, const char* what, const char* reason) {
        if (left_out > 0) all.push_back({fmt::format("{}{} of {} {}", before, left_out, of, what), reason});
    };
    const char* outside = "outside the fan or the range at the first ping";
    add("", static_cast<size_t>(std::ranges::count(seen, false)), seen.size(), "objects", outside);
    const size_t triangles = geometry.triangleCount();
    add("at least ", triangles - std::min(triangles, shown), triangles, "triangles",
        "outside the fan or the range at the first ping, or on the far side of a closed mesh");
    if (replaced > coarse)
        all.push_back({fmt::format("detail of {} triangles", replaced),
                       fmt::format("at the first ping {} within {:g} of a pixel and half a bin of them are drawn",
                                   coarse, parts_->config.detail)});
    add("", empty_slabs, parts_->slabs.size(), "slabs", outside);
    return all;
}

const types::Plan& SonarRenderer::plan() const { return parts_->plan; }
const std::string& SonarRenderer::device() const { return parts_->context.renderer(); }

}  // namespace insonify::sonar
