#include "components/sonar/effects/Refraction.hpp"

#include <fmt/format.h>

#include "components/sonar/plan/Effect.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sonar {
namespace {

bool hasProfile(const SonarConfig& config) { return config.water && config.water->profile; }

/** Returns whether a profile moves any echo: by bending its ray, or by another speed of sound than the sonar's. */
bool matters(const acoustics::SoundProfile& profile, const SonarConfig& config, const BinGrid& grid) {
    const double c = grid.speed_of_sound, slow = profile.slowest();
    const Bending bent = bending(config, grid, profile.steepest() * c / slow);
    const double off = std::max(c / slow - 1, 1 - c / profile.fastest()) * grid.range_max;
    return !(bent.offset < bent.tolerated) || !(off < grid.bin_width / 2);
}

std::shared_ptr<const acoustics::SoundProfile> bendingProfile(const SonarConfig& config, const BinGrid& grid) {
    if (!hasProfile(config)) return nullptr;
    auto profile =
        std::make_shared<const acoustics::SoundProfile>(acoustics::SoundProfile::read(*config.water->profile));
    return matters(*profile, config, grid) ? profile : nullptr;
}

std::string bendWords(const Omitted& what, const BinGrid& grid) {
    return fmt::format("a gradient of {:.3g} 1/s bends by {:.2g} m at {:.4g} m < {:.2g} m",
                       2 * what.value * grid.speed_of_sound / (grid.range_max * grid.range_max), what.value,
                       grid.range_max, what.bound);
}

/** Rays that a sound speed profile bends (ACOUSTICS.md 5.19). RayPaths computes them. */
class Refraction final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.traces_rays)
            plan.profile = bendingProfile(plan.config, plan.grid);
        else if (const std::string why = whyStraight(plan.config); !why.empty())
            throw types::ConfigError("", "water.profile", why);
        if (plan.profile) {
            plan.effect_features.emplace_back("refraction");
            return true;
        }
        const double gradient = hasProfile(plan.config)
                                    ? acoustics::SoundProfile::read(*plan.config.water->profile).steepest()
                                    : speed_gradient;
        const Bending bent = bending(plan.config, plan.grid, gradient);
        if (bent.offset < bent.tolerated)
            leaveOut(plan, {"refraction", Reason::BelowBound, bent.offset, bent.tolerated, bendWords});
        return false;
    }
    std::vector<std::string> features() const override { return {"refraction"}; }
};

}  // namespace

Bending bending(const SonarConfig& config, const BinGrid& grid, double gradient) {
    const double r = grid.range_max;
    return {gradient * r * r / (2 * grid.speed_of_sound),
            std::max(grid.bin_width, 0.1 * r * types::radians(config.beam_height_deg))};
}

std::string whyStraight(const SonarConfig& config) {
    const bool rasterised = hasProfile(config) && !config.tracesRays();
    if (!bendingProfile(config, makeBinGrid(config)) || !rasterised) return {};
    return "bends the rays of a sonar of this range, which only ray tracing shows; visibility may be auto or cpu, "
           "without "
           "published: true and deposit: gpu, in a build with rays";
}

const Effect& refraction() { return only<Refraction>(); }

}  // namespace insonify::sonar
