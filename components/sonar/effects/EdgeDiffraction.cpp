#include "components/sonar/base/Counters.hpp"
#include "components/sonar/multipath/EdgeEchoes.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr const char* own_key = "edge_diffraction";
constexpr const char* edges_name = "edge diffraction";
constexpr double default_turn_deg = 60;  ///< The `crease` of MeshEdges.hpp.

std::string withoutLobe(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no material has a reflection and a roughness_slope, or is a smooth matter";
}
std::string withoutEdges(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no straight edge turns by min_turn_deg";
}
std::string silentEdges(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "edges hidden, or out of the pattern or the range, at the first ping";
}

class EdgesInPings final : public PingEffect {
public:
    EdgesInPings(const RenderPlan& plan, const types::Geometry& geometry)
        : plan_(plan), edges_(std::make_unique<EdgeEchoes>(plan, geometry)) {}

    void updateShapes(const types::Snapshot& snapshot) override { edges_->updateShapes(snapshot); }
    void setScene(const types::Geometry& geometry) override { edges_ = std::make_unique<EdgeEchoes>(plan_, geometry); }
    void addEchoes(PingInMaking& ping) override {
        received_ = edges_->add(ping);
        count(Counter::Edges, received_);
        pinged_ = true;
    }
    size_t received() const override { return received_; }
    std::optional<Omitted> omissions() const override {
        const size_t all = edges_->count();
        if (!pinged_ || (all > 0 && received_ == all)) return {};
        if (all == 0) return Omitted{.effect = edges_name, .reason = Reason::NoneInScene, .words = withoutEdges};
        return Omitted{edges_name, Reason::OutOfView, static_cast<double>(all - received_), static_cast<double>(all),
                       silentEdges};
    }

private:
    const RenderPlan& plan_;
    std::unique_ptr<EdgeEchoes> edges_;
    size_t received_ = 0;  ///< Edges with an echo in the last ping [1].
    bool pinged_ = false;
};

/** Echoes of straight edges (ACOUSTICS.md 3.12). */
class EdgeDiffraction final : public Effect {
public:
    std::string key() const override { return own_key; }
    std::vector<types::Field> numbers() const override {
        return {{"min_turn_deg", "deg", "min turn of a surface at a sharp edge; absent: 60", 1, 180}};
    }
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (!config.effects.contains(own_key)) return;
        const std::string path = std::string("effects.") + own_key;
        if (config.model == Model::Cerqueira2017)
            diagnostics.push_back({path, "is given with model: cerqueira2017; it belongs to physical"});
        else if (!config.frequency_khz)
            diagnostics.push_back({path, "needs frequency_khz, for the wavelength"});
        if ((config.water && config.water->profile) || followsMotion(config))
            diagnostics.push_back(
                {path, "needs straight sound paths: no profile of the speed of sound and no motion within a ping"});
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        const auto own = plan.config.effects.find(own_key);
        if (own == plan.config.effects.end()) return leaveOut(plan, {edges_name, Reason::NotConfigured});
        if (!plan.laws.hasLobes())
            return leaveOut(plan, {.effect = edges_name, .reason = Reason::NoneInScene, .words = withoutLobe});
        const auto turn = own->second.find("min_turn_deg");
        plan.laws.sharp_turn = types::radians(turn == own->second.end() ? default_turn_deg : turn->second);
        return true;
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& geometry) const override {
        return std::make_unique<EdgesInPings>(plan, geometry);
    }
    std::string removeFrom(SonarConfig& config) const override {
        return config.effects.erase(own_key) > 0 ? edges_name : "";
    }
};

}  // namespace

const Effect& edgeDiffraction() { return only<EdgeDiffraction>(); }

}  // namespace insonify::sonar
