#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/bins/Truth.hpp"
#include "components/sonar/plan/EchoRenderer.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/raster/DeviceNeeds.hpp"
#include "components/sonar/raster/PictureDeposit.hpp"
#include "components/sonar/raster/SurfacePass.hpp"
#include "components/sonar/surfaces/DeformedMeshes.hpp"

namespace insonify::sonar {
namespace {

/** Min slant range that is rasterised [m]. Surfaces nearer than the blanking are rasterised: they cast shadows. */
constexpr double nearest_rasterised = 1e-3;

/** Returns the distance of an image plane that is nowhere beyond `nearest_rasterised`, even in the picture's corners.
 */
double nearPlane(const ViewFrustum& frustum) {
    const double corner = std::sqrt(1 + frustum.extent_u * frustum.extent_u + frustum.extent_v * frustum.extent_v);
    return nearest_rasterised / corner;
}

DepositSetup depositSetup(const RenderPlan& plan, const PingEffects& effects) {
    DepositSetup setup;
    setup.rules = makeEchoRules(plan, effects);
    setup.defines = plan.defines();
    setup.frusta = plan.frusta;
    for (const ViewFrustum& frustum : plan.frusta)
        setup.shares.push_back(makeShares(plan.sampled, plan.cells, frustum, plan.options));
    setup.beam_count = static_cast<uint32_t>(plan.cells.size());
    return setup;
}

std::string outOfView(const Omitted& what, const BinGrid& /*grid*/) {
    return std::string("outside the fan or the range at the first ping") +
           (what.effect == "triangles" ? ", or on the far side of a closed mesh" : "");
}

class RasterEchoes final : public EchoRenderer {
public:
    RasterEchoes(const RenderPlan& plan, types::GeometryPtr geometry, const PingEffects& effects);
    ~RasterEchoes() override;
    void updateQuality() override;
    bool changePlan() override;
    void deform(DeformedMeshes* meshes, types::GeometryPtr /*geometry*/) override { deformed_ = meshes; }
    void updateShapes(const types::Snapshot& snapshot) override;
    void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) override;
    void setTruth(types::SonarTruth* truth) override { truth_ = truth; }
    Accumulator& accumulator() override { return *accumulator_; }
    bool hasEchoes() const override;
    std::vector<Omitted> culled() const override;
    const std::string& device() const override { return device_; }
    void note(types::Notices& notices) const override;

private:
    bool wantsProcessor() const;
    /** Throws GlError where the device cannot rasterise the plan's pictures. Returns why the processor sums pictures
     *  instead of the device, because of limits or an effect; empty where it does not. */
    std::string checkDevice() const;
    bool depositsOnProcessor() const { return wantsProcessor() || !why_on_processor_.empty(); }
    SurfacePass::Setup surfaceSetup() const;
    void makeDeposit();
    void makeTruth();
    void prepareTruth();
    /** Fills the truth, once the bins are filled. */
    void fillTruth();
    /** Passes the rasterised pictures to the deposits. */
    void take(const WaterView& water);
    void fillBins();
    void fill(size_t cell, const uint64_t* sums, size_t thread);
    /** Adds the seconds since the last call to a stage. */
    void lap(Stage& stage);

    const RenderPlan& plan_;
    types::GeometryPtr geometry_;
    const PingEffects& effects_;
    const std::string wanted_device_;  ///< As configured.
    gpu::EglContext context_;
    std::string why_on_processor_;  ///< Empty unless the device was to sum the pictures and cannot.
    std::string device_;
    Culler culler_;
    ThreadPool threads_;
    SurfacePass surface_;
    DeformedMeshes* deformed_ = nullptr;  ///< Null: no mesh deforms.
    std::unique_ptr<BinDeposit> deposit_;
    types::SonarTruth* truth_ = nullptr;           ///< Truth to be filled; null: none.
    std::optional<TruthTable> shown_;              ///< Made at the first ping with truth.
    std::optional<WaterTruth> water_;              ///< Made with it, where effects have own sums.
    std::unique_ptr<PictureDeposit> cpu_deposit_;  ///< Made for truth, where the device deposits.
    PictureDeposit* truth_deposit_ = nullptr;      ///< The deposit on the processor that records the truth.
    std::unique_ptr<Accumulator> accumulator_;
    EchoRules rules_;
    std::span<const uint64_t> sums_;  ///< Sums of the last ping, until the quality changes.
    bool rendered_ = false;           ///< Whether there is a last ping.
    std::chrono::steady_clock::time_point last_;
};

RasterEchoes::RasterEchoes(const RenderPlan& plan, types::GeometryPtr geometry, const PingEffects& effects)
    : plan_(plan),
      geometry_(std::move(geometry)),
      effects_(effects),
      wanted_device_(plan.config.device),
      context_(wanted_device_),
      why_on_processor_(checkDevice()),
      device_(fmt::format("{}, OpenGL {}", context_.renderer(), context_.driver())),
      culler_(*geometry_, {nearest_rasterised, reach(plan), plan.config.draw_all}),
      threads_(plan.options.threads),
      surface_(context_, surfaceSetup(), culler_, threads_) {
    makeDeposit();
    context_.check();
}

RasterEchoes::~RasterEchoes() = default;

bool RasterEchoes::wantsProcessor() const {
    return plan_.config.deposit == Deposit::Cpu || (plan_.config.deposit == Deposit::Auto && context_.isSoftware());
}

std::string RasterEchoes::checkDevice() const {
    requireDrawing(context_.limits(), drawingNeeds(plan_, *geometry_), context_.renderer());
    if (wantsProcessor()) return {};
    if (const std::string why = effects_.whyNotOnDevice(); !why.empty())
        return fmt::format("images are summed on the processor: {}", why);
    return whyOnProcessor(plan_.config.deposit, context_.limits(),
                          depositNeeds(depositSetup(plan_, effects_), *geometry_), context_.renderer());
}

SurfacePass::Setup RasterEchoes::surfaceSetup() const {
    return {.geometry = *geometry_,
            .laws = plan_.laws,
            .frusta = plan_.frusta,
            .defines = plan_.defines(),
            .near_plane = nearPlane(plan_.frusta.front()),
            .empty_too = plan_.config.published || plan_.echoes_from_misses,
            .cull_on_device = !depositsOnProcessor()};
}

void RasterEchoes::makeDeposit() {
    DepositSetup setup = depositSetup(plan_, effects_);
    if (accumulator_)
        accumulator_->setQuality(plan_);
    else
        accumulator_ = makeAccumulator(plan_, threads_.size());
    rules_ = setup.rules;
    if (depositsOnProcessor())
        deposit_ = std::make_unique<PictureDeposit>(std::move(setup), surface_, context_, threads_);
    else
        deposit_ = makeGpuDeposit(setup, context_);
    cpu_deposit_.reset();
    shown_.reset();
    water_.reset();
}

void RasterEchoes::makeTruth() {
    shown_.emplace(plan_.beams.size(), static_cast<size_t>(plan_.grid.bin_count));
    if (!rules_.own.empty()) water_.emplace(plan_, static_cast<size_t>(plan_.grid.bin_count), threads_.size());
    truth_deposit_ = dynamic_cast<PictureDeposit*>(deposit_.get());
    if (!truth_deposit_) {
        const auto alone = context_.transferring();
        cpu_deposit_ = std::make_unique<PictureDeposit>(depositSetup(plan_, effects_), surface_, context_, threads_);
        truth_deposit_ = cpu_deposit_.get();
    }
    truth_deposit_->prepareTruth(beamsOfCells(plan_));
}

void RasterEchoes::prepareTruth() {
    if (truth_ && !shown_) makeTruth();
    if (shown_) truth_deposit_->setTruth(truth_ ? &*shown_ : nullptr);
}

void RasterEchoes::fillTruth() {
    threads_.run([&](int part, int parts) {
        for (auto beam = static_cast<size_t>(part); beam < plan_.beams.size(); beam += static_cast<size_t>(parts))
            shown_->report(beam, beam, *truth_, water_ ? water_->beam(beam) : std::span<const uint64_t>());
    });
}

void RasterEchoes::lap(Stage& stage) {
    const auto now = std::chrono::steady_clock::now();
    stage.seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
}

void RasterEchoes::take(const WaterView& water) {
    const auto alone = context_.transferring();
    const auto passAll = [&](BinDeposit& deposit) {
        deposit.begin(water);
        for (size_t i = 0; i < plan_.frusta.size(); ++i)
            if (surface_.draws(i)) deposit.take(i, surface_);
    };
    passAll(*deposit_);
    if (truth_ && cpu_deposit_) passAll(*cpu_deposit_);
}

void RasterEchoes::fillBins() {
    if (truth_ && water_) water_->begin();
    threads_.run([&](int part, int parts) {
        for (auto cell = static_cast<size_t>(part); cell < plan_.cells.size(); cell += static_cast<size_t>(parts))
            fill(cell, &sums_[cell * rules_.sumCount()], static_cast<size_t>(part));
    });
    accumulator_->finish(threads_);
}

void RasterEchoes::fill(size_t cell, const uint64_t* sums, size_t thread) {
    const double pixel = plan_.frusta.front().du() * plan_.frusta.front().dv();  // solid angle of a whole pixel [sr]
    if (truth_ && water_) water_->take(rules_, sums, cell, pixel, thread);
    count(Counter::Bins, static_cast<uint64_t>(plan_.grid.bin_count));
    accumulator_->fill(cell, rules_, sums, pixel, thread);
}

void RasterEchoes::render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) {
    context_.requireThread();
    prepareTruth();
    last_ = std::chrono::steady_clock::now();
    culler_.place(snapshot);
    surface_.cull();
    lap(stages[CullStage]);
    surface_.draw();
    lap(stages[DrawStage]);
    for (size_t i = 0; i < plan_.frusta.size(); ++i)
        if (surface_.draws(i)) count(Counter::Pixels, plan_.frusta[i].pixels());
    take(waterView(snapshot));
    context_.check();
    lap(stages[ReadStage]);
    if (truth_) shown_->clear();
    sums_ = deposit_->finish();
    if (truth_ && cpu_deposit_) cpu_deposit_->finish();
    lap(stages[DepositStage]);
    accumulator_->begin(snapshot, ping);
    fillBins();
    if (truth_) fillTruth();
    rendered_ = true;
    lap(stages[BeamStage]);
}

void RasterEchoes::updateShapes(const types::Snapshot& snapshot) {
    context_.requireThread();
    const std::vector<uint32_t>& objects = deformed_->objects();
    threads_.run([&](int part, int parts) {
        deformed_->take(snapshot, static_cast<size_t>(part), static_cast<size_t>(parts));
        for (auto i = static_cast<size_t>(part); i < objects.size(); i += static_cast<size_t>(parts))
            surface_.updateShape(objects[i]);
    });
    surface_.uploadShapes(objects);
    context_.check();
}

void RasterEchoes::updateQuality() {
    context_.requireThread();
    const auto alone = context_.transferring();
    why_on_processor_ = checkDevice();
    surface_.resize(plan_.frusta);
    sums_ = {};
    makeDeposit();
    context_.check();
}

void RasterEchoes::note(types::Notices& notices) const {
    if (!why_on_processor_.empty()) return notices.push_back(why_on_processor_);
    if (std::string why = context_.fallback(); !why.empty())
        notices.push_back(context_.missesCard() ? types::warning(std::move(why)) : types::Notice(std::move(why)));
}

bool RasterEchoes::changePlan() {
    context_.requireThread();
    if (plan_.config.device != wanted_device_) return false;
    const auto alone = context_.transferring();
    why_on_processor_ = checkDevice();
    if (!surface_.serves(surfaceSetup())) return false;
    culler_.setRules({nearest_rasterised, reach(plan_), plan_.config.draw_all});
    surface_.updateLaws();
    surface_.resize(plan_.frusta);
    sums_ = {};
    rendered_ = false;
    accumulator_.reset();
    makeDeposit();
    context_.check();
    return true;
}

bool RasterEchoes::hasEchoes() const {
    const bool rasterised = rendered_ && !surface_.lists().empty();  // `published` also counts misses
    return rasterised && std::ranges::any_of(sums_, [](uint64_t sum) { return sum > 0; });
}

std::vector<Omitted> RasterEchoes::culled() const {
    std::vector<Omitted> all;
    if (!rendered_) return all;
    const Shown shown = surface_.lists().shown();
    const size_t triangles = geometry_->triangleCount();
    const auto add = [&](const char* effect, size_t omitted, size_t of) {
        if (omitted > 0)
            all.push_back(
                {effect, Reason::OutOfView, static_cast<double>(omitted), static_cast<double>(of), outOfView});
    };
    add("objects", static_cast<size_t>(std::ranges::count(shown.objects, false)), shown.objects.size());
    add("triangles", triangles - std::min(triangles, shown.triangles), triangles);
    add("slabs", shown.empty_frusta, plan_.frusta.size());
    return all;
}

}  // namespace

std::unique_ptr<EchoRenderer> makeRasterEchoes(const RenderPlan& plan, types::GeometryPtr geometry,
                                               const PingEffects& effects) {
    return std::make_unique<RasterEchoes>(plan, std::move(geometry), effects);
}

}  // namespace insonify::sonar
