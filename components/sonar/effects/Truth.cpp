#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string nobody(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "nobody is connected to truth or returns at the first ping";
}

/** Whether pings record the truth, which a plan does not know. */
class TruthInPings final : public PingEffect {
public:
    void begin(const PingStart& start) override { omitted_ = !start.truth; }
    std::optional<Omitted> omissions() const override {
        if (!omitted_) return {};
        return Omitted{.effect = "truth", .reason = Reason::Other, .words = nobody};
    }

private:
    bool omitted_ = false;
};

/** The truth of a ping's bins (types::SonarTruth). The deposit of cells records it, because it counts the same
 *  energies. */
class Truth final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& /*plan*/) const override { return true; }
    std::unique_ptr<PingEffect> make(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<TruthInPings>();
    }
};

}  // namespace

const Effect& truth() { return only<Truth>(); }

}  // namespace insonify::sonar
