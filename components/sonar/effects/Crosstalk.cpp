#include "components/sonar/multipath/ForeignEchoes.hpp"
#include "components/sonar/multipath/OtherSonars.hpp"
#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

constexpr const char* crosstalk_name = "crosstalk";

std::string silentPings(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no ping of another sonar arrives on the port others at the first ping";
}

/** The pulses of other sonars in a snapshot, which a plan does not know. */
class CrosstalkInPings final : public PingEffect {
public:
    CrosstalkInPings(const RenderPlan& plan, const types::Geometry& geometry)
        : direct_(plan, geometry),
          echoes_(plan.config.crosstalk->echoes && plan.traces_rays ? makeForeignEchoes(plan) : nullptr) {}

    void updateQuality() override {
        if (echoes_) echoes_->updateQuality();
    }
    void setScene(const types::Geometry& geometry) override { direct_.setScene(geometry); }
    void begin(const PingStart& start) override {
        snapshot_ = &start.snapshot;
        had_any_ = !start.snapshot.transmissions.empty();
        received_ = 0;
        if (echoes_) echoes_->begin(start.snapshot);
    }
    bool followsRays() const override { return echoes_ != nullptr; }
    void followRays(const TracedPing& ping, std::span<const TracedTile> tiles) override {
        if (had_any_) echoes_->follow(ping, tiles);
    }
    bool addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins) override {
        return had_any_ && !is_silent && echoes_->addEnergies(ping, cell, bins);
    }
    void addToBins(types::Sonar& ping) override {
        if (had_any_ && !is_silent) received_ = direct_.add(*snapshot_, ping);
    }
    size_t received() const override { return received_; }
    std::optional<Omitted> omissions() const override {
        if (!snapshot_ || had_any_) return {};
        return Omitted{.effect = crosstalk_name, .reason = Reason::Other, .words = silentPings};
    }

private:
    DirectSound direct_;
    std::unique_ptr<ForeignEchoes> echoes_;      ///< Null where echoes of surfaces are not simulated.
    const types::Snapshot* snapshot_ = nullptr;  ///< Snapshot of the ping; null before the first.
    size_t received_ = 0;                        ///< Transmissions that arrived directly in the last ping [1].
    bool had_any_ = false;                       ///< Whether the ping has transmissions.
};

/** The pulses of other sonars (ACOUSTICS.md 5.29). */
class Crosstalk final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        const bool needs_rays = config.crosstalk && config.crosstalk->echoes;  // refused elsewhere
        if (config.crosstalk && !needs_rays && config.model == Model::Cerqueira2017)
            diagnostics.push_back({"crosstalk", "is given with model: cerqueira2017; it belongs to physical"});
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        return plan.config.crosstalk || leaveOut(plan, {crosstalk_name, Reason::NotConfigured});
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& geometry) const override {
        return std::make_unique<CrosstalkInPings>(plan, geometry);
    }
    std::string removeFrom(SonarConfig& config) const override { return removeBlock(config.crosstalk, crosstalk_name); }
};

}  // namespace

const Effect& crosstalk() { return only<Crosstalk>(); }

}  // namespace insonify::sonar
