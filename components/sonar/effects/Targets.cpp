#include "components/sonar/base/Counters.hpp"
#include "components/sonar/multipath/PointTargets.hpp"
#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

constexpr const char* name = "point targets";

std::string meansTargets(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "cerqueira2017: bins are means of S(n.d)";
}
std::string silent(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "hidden, or out of the pattern or the range, at the first ping";
}

/** Targets in the snapshots, which a plan does not know. */
class TargetsInPings final : public PingEffect {
public:
    TargetsInPings(const RenderPlan& plan, const types::Geometry& geometry) : plan_(plan), geometry_(&geometry) {}

    void setScene(const types::Geometry& geometry) override {
        geometry_ = &geometry;
        if (targets_) targets_->setScene(geometry);
    }
    void addEchoes(PingInMaking& ping) override {
        all_ = ping.snapshot.targets.size();
        received_ = 0;
        pinged_ = true;
        if (all_ == 0) return;
        if (!targets_) targets_.emplace(plan_, *geometry_);
        received_ = targets_->add(ping);
        count(Counter::Targets, received_);
    }
    size_t received() const override { return received_; }
    std::optional<Omitted> omissions() const override {
        if (!pinged_ || (all_ > 0 && received_ == all_)) return {};
        if (all_ == 0) return Omitted{name, Reason::NoneInScene};
        return Omitted{name, Reason::OutOfView, static_cast<double>(all_ - received_), static_cast<double>(all_),
                       silent};
    }

private:
    const RenderPlan& plan_;
    const types::Geometry* geometry_;
    std::optional<PointTargets> targets_;  ///< Made at the first ping with a target.
    size_t all_ = 0, received_ = 0;        ///< Targets of the last ping, and those with an echo [1].
    bool pinged_ = false;
};

/** Point targets (ACOUSTICS.md 5.14). */
class Targets final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.config.model == Model::Physical) return true;
        return leaveOut(plan, {.effect = name, .reason = Reason::Other, .words = meansTargets});
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& geometry) const override {
        return std::make_unique<TargetsInPings>(plan, geometry);
    }
};

}  // namespace

const Effect& pointTargets() { return only<Targets>(); }

}  // namespace insonify::sonar
