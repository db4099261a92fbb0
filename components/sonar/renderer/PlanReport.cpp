#include "components/sonar/renderer/PlanReport.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/beams/WaterView.hpp"
#include "components/sonar/effects/Refraction.hpp"
#include "components/sonar/plan/Effects.hpp"

namespace insonify::sonar {
namespace {

std::string reasonOf(const Omitted& what, const BinGrid& grid) {
    if (what.words) return what.words(what, grid);
    switch (what.reason) {
        case Reason::NotConfigured: return "not configured";
        case Reason::NoneInScene: return "the scene has none";
        case Reason::OutOfView: return "outside the fan or the range at the first ping";
        default: return {};
    }
}

void noteRange(const SonarConfig& config, const BinGrid& grid, types::Notices& notices) {
    const double longer = grid.range_max / config.range - 1;
    if (std::abs(longer) > 1e-9)
        notices.push_back({fmt::format("range reached is {:.6g} m, {:.2g} % more than {:g} m: bins last {} us one way",
                                       grid.range_max, 100 * longer, config.range, grid.bin_duration_us),
                           longer > 0.01 ? types::Notice::Kind::Warning : types::Notice::Kind::Note});
    const double blanked = std::floor(grid.range_min / grid.bin_width + 1e-9), bins = config.bin_count;
    if (blanked >= 0.1 * bins)
        notices.push_back(
            fmt::format("{:g} of {:g} bins are empty, because bin_count counts from range 0 and range_min is {:g} m; "
                        "with bin_count: {:.0f} there are {:g} bins beyond it",
                        blanked, bins, grid.range_min, std::ceil(bins / (1 - grid.range_min / grid.range_max)), bins));
    const float far = static_cast<float>(grid.range_max);
    const double ulp = static_cast<double>(std::nextafter(far, std::numeric_limits<float>::infinity()) - far);
    if (grid.bin_width < ulp)
        notices.push_back(
            types::warning(fmt::format("a bin of {:.2g} m is smaller than the {:.2g} m between neighbouring "
                                       "float ranges; bins merge",
                                       grid.bin_width, ulp)));
}

void noteWater(const SonarConfig& config, const BinGrid& grid, types::Notices& notices) {
    if (grid.speed_of_sound < 1350 || grid.speed_of_sound > 1650)
        notices.push_back(
            types::warning(fmt::format("speed of sound is {:g} m/s; water has 1350 to 1650", grid.speed_of_sound)));
    if (config.water && !config.speed_of_sound) {
        const std::string outside = acoustics::outsideValidity(config.water->sound_speed_law, *config.water);
        if (!outside.empty())
            notices.push_back(
                types::warning(fmt::format("speed of sound is extrapolated outside its law's validity: {}", outside)));
    }
    if (config.absorbedKhz()) {
        const std::string outside =
            acoustics::outsideValidity(config.absorption->law, *config.absorbedKhz(), *config.water);
        if (!outside.empty())
            notices.push_back(
                types::warning(fmt::format("absorption is extrapolated outside its law's validity: {}", outside)));
    }
    const Bending bent = bending(config, grid);
    if (bent.offset >= bent.tolerated && !(config.water && config.water->profile))
        notices.push_back(
            types::warning(fmt::format("rays are straight; a gradient of {} 1/s would bend them by {:.3g} m at "
                                       "{:.4g} m",
                                       speed_gradient, bent.offset, grid.range_max)));
}

}  // namespace

types::Notices configNotices(const SonarConfig& config) {
    const BinGrid grid = makeBinGrid(config);
    types::Notices notices;
    noteRange(config, grid, notices);
    noteWater(config, grid, notices);
    return notices;
}

std::optional<types::Notice> depthNotice(const RenderPlan& plan, const types::Snapshot& snapshot) {
    if (!plan.profile) return {};
    const double depth = -waterView(snapshot).height, top = plan.profile->top(), bottom = plan.profile->bottom();
    if (depth >= top && depth <= bottom) return {};
    return types::warning(fmt::format(
        "at the first ping the sonar is {:.4g} m deep, its profile of the speed of sound covers {:g} to {:g} "
        "m; outside, the speed is that of the nearer end",
        depth, top, bottom));
}

types::Omission describe(const Omitted& what, const BinGrid& grid) {
    const std::string name(what.effect);
    if (what.reason != Reason::OutOfView)
        return {name, reasonOf(what, grid), !what.words && what.reason == Reason::NotConfigured};
    return {fmt::format("{}{:.0f} of {:.0f} {}", name == "triangles" ? "at least " : "", what.value, what.bound, name),
            reasonOf(what, grid)};
}

types::Plan report(const RenderPlan& plan, const types::Geometry& geometry) {
    types::Plan reported;
    reported.rows = plan.config.rows();
    reported.columns_per_beam = plan.config.columnsPerBeam();
    reported.slabs = static_cast<int>(plan.frusta.size());
    reported.predicted_error = std::numeric_limits<double>::quiet_NaN();
    reported.features = plan.featureNames();
    for (Pass pass : plan.passes)
        reported.passes.emplace_back(types::EnumNames<Pass>::names[static_cast<size_t>(pass)]);
    for (const Omitted& what : plan.omitted) reported.omitted.push_back(describe(what, plan.grid));
    reported.notices = configNotices(plan.config);
    for (const Effect* effect : effects()) effect->note(plan, geometry, reported.notices);
    return reported;
}

}  // namespace insonify::sonar
