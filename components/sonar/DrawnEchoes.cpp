#include "components/sonar/DrawnEchoes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/BinLevels.hpp"
#include "components/sonar/CpuDeposit.hpp"
#include "components/sonar/EchoGrid.hpp"
#include "components/sonar/SurfacePass.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

/** Slant range before which nothing is drawn [m]. What is nearer than the blanking is: it casts its shadow. */
constexpr double nearest_drawn = 1e-3;

/** Distance of the image plane that is nowhere farther than `nearest_drawn`, even in the picture's corners. */
double nearPlane(const ViewFrustum& frustum) {
    const double corner = std::sqrt(1 + frustum.extent_u * frustum.extent_u + frustum.extent_v * frustum.extent_v);
    return nearest_drawn / corner;
}

DepositSetup depositSetup(const RenderPlan& plan, const types::Geometry& geometry) {
    DepositSetup setup;
    setup.rules = makeEchoRules(plan, geometry);
    setup.frusta = plan.frusta;
    for (const ViewFrustum& frustum : plan.frusta)
        setup.shares.push_back(makeShares(plan.sampled, plan.cells, frustum));
    setup.beam_count = static_cast<uint32_t>(plan.cells.size());
    return setup;
}

class DrawnEchoes final : public EchoRenderer {
public:
    DrawnEchoes(const RenderPlan& plan, types::GeometryPtr geometry);
    ~DrawnEchoes() override;
    void takeQuality() override;
    void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) override;
    bool hasEchoes() const override;
    std::vector<LeftOut> culled() const override;
    Features compiled() const override;
    const std::string& device() const override { return device_; }
    std::string notice() const override { return context_.fallback(); }

private:
    void makeDeposit();
    void drawSlabs(const types::Snapshot& snapshot, Stages& stages);
    void fillBins(types::Sonar& ping);
    /** Seconds since the last call, put down for a stage. */
    void lap(Stage& stage);

    const RenderPlan& plan_;
    types::GeometryPtr geometry_;
    gpu::EglContext context_;
    std::string device_;
    BinLevels levels_;
    Culler culler_;
    ThreadPool threads_;
    SurfacePass surface_;
    std::unique_ptr<BinDeposit> deposit_;
    std::optional<EchoGrid> grid_;
    EchoRules rules_;
    std::span<const uint64_t> sums_;  ///< Of the last ping.
    std::chrono::steady_clock::time_point last_;
};

DrawnEchoes::DrawnEchoes(const RenderPlan& plan, types::GeometryPtr geometry)
    : plan_(plan),
      geometry_(std::move(geometry)),
      context_(plan.config.device),
      device_(fmt::format("{}, OpenGL {}", context_.renderer(), context_.driver())),
      levels_(plan.config, plan.grid),
      culler_(*geometry_, {nearest_drawn, reachOf(plan), plan.config.draw_all}),
      threads_(plan.config.threads),
      surface_(context_,
               {*geometry_, plan.frusta, plan.features.defines(), nearPlane(plan.frusta.front()),
                culler_.drawRangeLimit(), plan_.config.published},
               threads_) {
    makeDeposit();
    context_.check();
}

DrawnEchoes::~DrawnEchoes() = default;

void DrawnEchoes::makeDeposit() {
    DepositSetup setup = depositSetup(plan_, *geometry_);
    grid_.emplace(plan_, threads_.size());
    rules_ = setup.rules;
    const bool on_cpu =
        plan_.config.deposit == Deposit::Cpu || (plan_.config.deposit == Deposit::Auto && context_.isSoftware());
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
        for (size_t i = 0; i < plan_.frusta.size(); ++i)
            if (surface_.draws(i)) deposit_->take(i, surface_);
    }
    lap(stages[ReadStage]);
}

void DrawnEchoes::fillBins(types::Sonar& ping) {
    const double pixel = plan_.frusta.front().du() * plan_.frusta.front().dv();  // solid angle of a whole pixel [sr]
    threads_.run([&](int part, int parts) {
        for (auto cell = static_cast<size_t>(part); cell < plan_.cells.size(); cell += static_cast<size_t>(parts))
            levels_.fill(rules_, &sums_[cell * rules_.sumCount()], pixel, grid_->cell(cell, ping));
    });
    grid_->finish(ping, threads_);
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

void DrawnEchoes::takeQuality() {
    context_.requireThread();
    const auto alone = context_.transferring();
    surface_.resize(plan_.frusta);
    sums_ = {};
    makeDeposit();
    context_.check();
}

bool DrawnEchoes::hasEchoes() const {
    bool drawn = false;  // published counts what is not there
    for (size_t i = 0; i < plan_.frusta.size(); ++i) drawn = drawn || !surface_.picture(i).empty();
    return drawn && std::ranges::any_of(sums_, [](uint64_t sum) { return sum > 0; });
}

Features DrawnEchoes::compiled() const {
    Features all = deposit_->compiled();
    for (int i = 0; i < feature_count; ++i) {
        const auto feature = static_cast<Feature>(i);
        if (context_.programs().compiledWith(Features{feature}.defines().front())) all.add(feature);
    }
    return all;
}

std::vector<LeftOut> DrawnEchoes::culled() const {
    std::vector<bool> seen(geometry_->objects.size());
    size_t empty_frusta = 0, shown = 0;  // of two frusta more than once
    for (size_t i = 0; i < plan_.frusta.size(); ++i) {
        const auto& ranges = surface_.picture(i).ranges;
        empty_frusta += ranges.empty();
        for (const Culler::DrawRange& range : ranges) {
            seen[range.object] = true;
            shown += range.index_count / 3;
        }
    }
    const size_t triangles = geometry_->triangleCount();
    std::vector<LeftOut> all;
    const auto add = [&](Effect effect, size_t left_out, size_t of) {
        if (left_out > 0)
            all.push_back({effect, Reason::OutOfView, static_cast<double>(left_out), static_cast<double>(of)});
    };
    add(Effect::Objects, static_cast<size_t>(std::ranges::count(seen, false)), seen.size());
    add(Effect::Triangles, triangles - std::min(triangles, shown), triangles);
    add(Effect::Slabs, empty_frusta, plan_.frusta.size());
    return all;
}

}  // namespace

std::unique_ptr<EchoRenderer> makeDrawnEchoes(const RenderPlan& plan, types::GeometryPtr geometry) {
    return std::make_unique<DrawnEchoes>(plan, std::move(geometry));
}

}  // namespace insonify::sonar
