#include "components/sonar/DrawnEchoes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BinLevels.hpp"
#include "components/sonar/CpuDeposit.hpp"
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

/** Distance of the image plane before which nothing is drawn: under the blanking even in the picture's corners. */
double nearPlane(const SonarConfig& config, const Slab& slab) {
    const double corner = std::sqrt(1 + slab.extent_u * slab.extent_u + slab.extent_v * slab.extent_v);
    return std::max(config.published ? 0 : config.range_min, 1e-3) / corner;
}

CullRules cullRules(const SonarConfig& config, const BinGrid& bins) {
    return {config.range_min, bins.range_max, config.draw_all};
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

class DrawnEchoes final : public EchoRenderer {
public:
    DrawnEchoes(const SonarConfig& config, types::GeometryPtr geometry, const types::Plan& plan);
    ~DrawnEchoes() override;
    void setQuality(int rows, int columns_per_beam) override;
    void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) override;
    bool heard() const override;
    std::vector<types::Omission> culled() const override;
    const std::string& device() const override { return device_; }
    std::string notice() const override { return context_.fallback(); }

private:
    void makeDeposit();
    void drawSlabs(const types::Snapshot& snapshot, Stages& stages);
    void fillBins(types::Sonar& ping);
    void fillBeam(size_t beam, double* values, types::Sonar& ping) const;
    /** Seconds since the last call, put down for a stage. */
    void lap(Stage& stage);

    SonarConfig config_;
    types::GeometryPtr geometry_;
    gpu::EglContext context_;
    std::string device_;
    std::vector<Beam> beams_;
    std::vector<Slab> slabs_;
    BinGrid bins_;
    BinLevels levels_;
    Culler culler_;
    ThreadPool threads_;
    SurfacePass surface_;
    std::unique_ptr<BinDeposit> deposit_;
    double strength_scale_ = 1;
    std::span<const uint64_t> sums_;  ///< Of the last ping.
    std::vector<double> scratch_;
    std::chrono::steady_clock::time_point last_;
};

DrawnEchoes::DrawnEchoes(const SonarConfig& config, types::GeometryPtr geometry, const types::Plan& plan)
    : config_(config),
      geometry_(std::move(geometry)),
      context_(config_.device),
      device_(fmt::format("{}, OpenGL {}", context_.renderer(), context_.driver())),
      beams_(makeBeams(config_)),
      slabs_(makeSlabs(config_, beams_)),
      bins_(makeBinGrid(config_)),
      levels_(config_, bins_),
      culler_(*geometry_, cullRules(config_, bins_)),
      threads_(config_.threads),
      surface_(context_,
               {*geometry_, slabs_, defines(plan), nearPlane(config_, slabs_.front()), culler_.runLimit(),
                config_.published},
               threads_) {
    makeDeposit();
    scratch_.resize(static_cast<size_t>(threads_.size()) * static_cast<size_t>(bins_.bin_count));
    context_.check();
}

DrawnEchoes::~DrawnEchoes() = default;

void DrawnEchoes::makeDeposit() {
    DepositSetup setup = depositSetup(config_, beams_, slabs_, bins_);
    setup.strength_scale = strength_scale_ = strengthScale(config_, bins_, loudest(*geometry_));
    const bool on_cpu = config_.deposit == Deposit::Cpu || (config_.deposit == Deposit::Auto && context_.isSoftware());
    if (on_cpu)
        deposit_ = std::make_unique<CpuDeposit>(std::move(setup), surface_, threads_);
    else
        deposit_ = makeGpuDeposit(setup, context_);
}

void DrawnEchoes::lap(Stage& stage) {
    const auto now = std::chrono::steady_clock::now();
    stage.seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
}

void DrawnEchoes::drawSlabs(const types::Snapshot& snapshot, Stages& stages) {
    deposit_->begin();
    culler_.place(snapshot);
    surface_.cull(culler_);
    lap(stages[CullStage]);
    surface_.draw();
    lap(stages[DrawStage]);
    {
        const auto alone = context_.transferring();
        for (size_t i = 0; i < slabs_.size(); ++i)
            if (surface_.draws(i)) deposit_->take(i, surface_);
    }
    lap(stages[ReadStage]);
}

void DrawnEchoes::fillBeam(size_t beam, double* values, types::Sonar& ping) const {
    const auto count = static_cast<size_t>(bins_.bin_count);
    const double pixel = slabs_.front().du() * slabs_.front().dv();  // solid angle of a whole pixel [sr]
    for (size_t k = 0; k < count; ++k) {
        const size_t at = beam * count + k;
        if (config_.model == Model::Physical)
            values[k] = static_cast<double>(sums_[at]) * (pixel / (quanta_per_unit * strength_scale_));
        else
            values[k] =
                sums_[2 * at + 1] ? static_cast<double>(sums_[2 * at]) / static_cast<double>(sums_[2 * at + 1]) : 0;
    }
    levels_.apply({values, count}, {ping.bins.data() + beam * count, count});
}

void DrawnEchoes::fillBins(types::Sonar& ping) {
    threads_.run([&](int part, int parts) {
        double* values = scratch_.data() + static_cast<size_t>(part) * static_cast<size_t>(bins_.bin_count);
        for (auto beam = static_cast<size_t>(part); beam < beams_.size(); beam += static_cast<size_t>(parts))
            fillBeam(beam, values, ping);
    });
}

void DrawnEchoes::render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) {
    context_.requireThread();
    last_ = std::chrono::steady_clock::now();
    drawSlabs(snapshot, stages);
    context_.check();
    sums_ = deposit_->finish();
    lap(stages[DepositStage]);
    fillBins(ping);
    lap(stages[BeamStage]);
}

void DrawnEchoes::setQuality(int rows, int columns_per_beam) {
    context_.requireThread();
    config_.quality.rows = rows;
    config_.quality.columns_per_beam = columns_per_beam;
    slabs_ = makeSlabs(config_, beams_);
    const auto alone = context_.transferring();
    surface_.resize(slabs_);
    sums_ = {};
    makeDeposit();
    context_.check();
}

bool DrawnEchoes::heard() const {
    bool drawn = false;  // published counts what is not there
    for (size_t i = 0; i < slabs_.size(); ++i) drawn = drawn || !surface_.picture(i).empty();
    return drawn && std::ranges::any_of(sums_, [](uint64_t sum) { return sum > 0; });
}

std::vector<types::Omission> DrawnEchoes::culled() const {
    const types::Geometry& geometry = *geometry_;
    std::vector<bool> seen(geometry.objects.size());
    size_t empty_slabs = 0, shown = 0;  // of two slabs more than once
    for (size_t i = 0; i < slabs_.size(); ++i) {
        const auto& runs = surface_.picture(i).runs;
        empty_slabs += runs.empty();
        for (const Culler::Run& run : runs) {
            seen[run.object] = true;
            shown += run.index_count / 3;
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
    add("", empty_slabs, slabs_.size(), "slabs", outside);
    return all;
}

}  // namespace

std::unique_ptr<EchoRenderer> makeDrawnEchoes(const SonarConfig& config, types::GeometryPtr geometry,
                                              const types::Plan& plan) {
    return std::make_unique<DrawnEchoes>(config, std::move(geometry), plan);
}

}  // namespace insonify::sonar
