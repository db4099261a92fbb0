#include "components/sonar/renderer/PlanReport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "components/acoustics/SoundSpeed.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/effects/Refraction.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/Extent.hpp"

namespace insonify::sonar {
namespace {

std::string getReason(const Omitted& what, const BinGrid& grid) {
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

/** Returns a vector as text, without rounding noise. */
std::string text(const glm::dvec3& v) {
    const glm::dvec3 rounded = glm::round(v * 1e6) / 1e6 + 0.0;
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", rounded.x, rounded.y, rounded.z);
}

double degrees(double radians) { return radians / types::radians(1); }

const char* side(double bearing_deg) { return bearing_deg > 0 ? "port" : "starboard"; }

glm::dvec3 inSonar(const types::Snapshot& scene, const glm::dvec3& point) {
    return glm::conjugate(scene.sonar.orientation) * (point - scene.sonar.position);
}

/** Returns the look direction in the world as text, "looks towards [0, 1, 0] (yaw 90 deg, 12 deg down)". */
std::string directionText(const glm::dvec3& ahead) {
    const double down = degrees(std::asin(std::clamp(-ahead.z, -1.0, 1.0)));
    return fmt::format("looks towards {} (yaw {:.4g} deg, {:.4g} deg {})", text(ahead),
                       degrees(std::atan2(ahead.y, ahead.x)), std::abs(down), down >= 0 ? "down" : "up");
}

/** The range, aperture and fan of a sonar. */
struct Coverage {
    const RenderPlan& plan;
    bool all_round;
};

std::string aboveText(const RenderPlan& plan, double elevation_deg) {
    const double half = plan.sampled.beam_height_deg / 2;
    if (std::abs(elevation_deg) <= half) return "";
    const char* reach = plan.features.has(Feature::ElevationPattern) ? "pattern reaches floor_db" : "aperture ends";
    return fmt::format("{:.4g} deg {} the sonar's plane, where the {} {:.4g} deg to either side",
                       std::abs(elevation_deg), elevation_deg < 0 ? "below" : "above", reach, half);
}

std::string asideText(const RenderPlan& plan, double bearing_deg) {
    const double low = degrees(plan.cells.low()), high = degrees(plan.cells.high());
    const double middle = (low + high) / 2, off = std::remainder(bearing_deg - middle, 360);
    if (std::abs(off) <= (high - low) / 2) return "";
    return fmt::format("at a bearing of {:.4g} deg to {}, where the {} from {:.4g} deg to {} to {:.4g} deg to {}",
                       std::abs(bearing_deg), side(bearing_deg),
                       plan.has(Pass::Beamform) ? "patterns are above floor_db" : "fan covers", std::abs(high),
                       side(high), std::abs(low), side(low));
}

/** Returns why the sonar receives no echo from a point, given in its own frame; empty when no reason is known here. */
std::string hindranceText(const Coverage& coverage, const glm::dvec3& point) {
    const RenderPlan& plan = coverage.plan;
    const double range = glm::length(point);
    if (range > plan.grid.range_max) return fmt::format("beyond the range of {:.4g} m", plan.grid.range_max);
    if (range < plan.grid.range_min) return fmt::format("nearer than range_min, {:g} m", plan.grid.range_min);
    const bool conical = plan.features.has(Feature::Conical);
    const BeamAngles angles = beamAngles(point, conical);
    const std::string above = aboveText(plan, degrees(angles.elevation));
    if (!above.empty() || coverage.all_round) return above;
    if (conical && point.x < 0) return "behind the sonar, a straight array";
    return asideText(plan, degrees(angles.azimuth));
}

/** Returns that the material of an object returns no echo; empty where it does. */
std::string materialText(const SonarConfig& config, const types::Geometry& geometry, uint32_t object) {
    constexpr float nothing_db = -110;  // below a quantum of the sums of echoes
    const bool means = config.model == Model::Cerqueira2017;
    std::string name;
    for (const types::Cluster& run : geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)].clusters) {
        const types::Material& material = geometry.materials[static_cast<size_t>(run.material)];
        const bool has_law = !material.seabed.empty() || !material.matter.empty() || !material.measured.empty() ||
                             material.roughness_slope;
        if (means ? material.reflectivity > 0 : has_law || material.lambert_db > nothing_db) return "";
        name = material.name;
        if (!means) name += fmt::format("', of lambert_db {:g}", material.lambert_db);
    }
    return means ? fmt::format("its material '{}' has reflectivity 0 and returns no echo", name)
                 : fmt::format("its material '{} dB, returns no detectable echo", name);
}

/** Returns "; its nearest point 10 m away at [10, 0, 0] of wall: beyond the range of 5 m". */
std::string surfaceText(const Coverage& coverage, const types::Snapshot& scene) {
    const types::Extent extent = types::getExtent(scene);
    if (extent.isEmpty()) return "; the scene has no triangles";
    const types::NearestPoint nearest = types::nearestPoint(scene, scene.sonar.position);
    std::string hindrance = hindranceText(coverage, inSonar(scene, nearest.point));
    if (hindrance.empty()) hindrance = materialText(coverage.plan.config, *scene.geometry, nearest.object);
    const bool is_above = scene.sonar.position.z > std::max(0.0, extent.high.z);
    return fmt::format("; the scene extends from {} to {}, its nearest point {:.4g} m away at {} of {}{}{}{}",
                       text(extent.low), text(extent.high), nearest.distance, text(nearest.point),
                       scene.geometry->objects[nearest.object].name, hindrance.empty() ? "" : ": ", hindrance,
                       is_above ? "; the sonar is above all of it (z is up: depths are negative)" : "");
}

/** Returns the same for the nearest point target; empty where there is none. */
std::string targetText(const Coverage& coverage, const types::Snapshot& scene) {
    if (scene.targets.empty() || coverage.plan.config.model != Model::Physical) return "";
    const glm::dvec3& place = scene.sonar.position;
    const auto nearest = std::ranges::min_element(
        scene.targets, {}, [&](const auto& target) { return glm::distance(target.position, place); });
    const auto index = static_cast<size_t>(nearest - scene.targets.begin());
    const std::string hindrance = hindranceText(coverage, inSonar(scene, nearest->position));
    return fmt::format("; its nearest target {:.4g} m away at {}, {}: {}", glm::distance(nearest->position, place),
                       text(nearest->position), scene.target_names ? scene.target_names->at(index) : "",
                       hindrance.empty() ? "hidden, or below floor_db" : hindrance);
}

/** Max S of a surface without echo, because of rounding, in `cerqueira2017` (ACOUSTICS.md 8.1) [1]. */
constexpr float min_mean = 6.2e-6f;

bool isLoud(Model model, const types::Sonar& ping) {
    const float minimum = model == Model::Cerqueira2017 ? min_mean : 0;
    return std::ranges::any_of(ping.bins, [minimum](float bin) { return bin > minimum; });
}

/** Returns why a sonar may receive no echo. The text states its place and look direction, the extent of the scene, and
 *  the distances of its nearest point and nearest point target. It names what prevents their echoes: range, aperture,
 *  fan, or a material without echo. Sidelobes count as far as the plan uses them. `all_round`: its head has turned. */
std::string silenceText(const RenderPlan& plan, bool all_round, const types::Snapshot& scene) {
    const Coverage coverage{plan, all_round};
    const glm::dvec3 ahead = scene.sonar.orientation * glm::dvec3(1, 0, 0);
    return fmt::format("{} {} and {}{}{}",
                       plan.fills_water ? "receives no echo but that of the water. The sonar is at"
                                        : "receives no echo. The sonar is at",
                       text(scene.sonar.position), directionText(ahead), surfaceText(coverage, scene),
                       targetText(coverage, scene));
}

/** Returns that the sonar is inside of an object, with its place and the distance to the object's nearest point. */
std::string enclosureText(const types::Snapshot& scene, uint32_t object) {
    const types::NearestPoint nearest = types::nearestPoint(scene, scene.sonar.position);
    return fmt::format(
        "is inside of {}, which has its faces outward: the sonar is at {}, its nearest surface {:.4g} m away at {}, "
        "and everything outside is hidden; move the sonar out of it, or turn its faces inward",
        scene.geometry->objects[object].name, text(scene.sonar.position), nearest.distance, text(nearest.point));
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
        return {name, getReason(what, grid), !what.words && what.reason == Reason::NotConfigured};
    return {fmt::format("{}{:.0f} of {:.0f} {}", name == "triangles" ? "at least " : "", what.value, what.bound, name),
            getReason(what, grid)};
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
    for (const Effect* effect : effects()) calling(*effect, [&] { effect->note(plan, geometry, reported.notices); });
    return reported;
}

std::string PingDiagnostics::follow(bool received, const SonarRenderer& renderer, const types::Snapshot& scene,
                                    const types::Sonar& ping, const std::function<RenderPlan()>& coverage) {
    if (pings_++ % between_looks == 0) {
        if (geometry_ != renderer.geometry()) sightlines_.emplace(*renderer.geometry());
        geometry_ = renderer.geometry();
        sightlines_->place(scene);
        const auto around = sightlines_->enclosing();
        inside_ = around.has_value();
        if (enclosure_.isDue(inside_)) return enclosureText(scene, *around);
    }
    const bool receives = received && isLoud(renderer.renderPlan().config.model, ping);
    silent_ = receives ? 0 : silent_ + 1;
    if (!receives && silent_ < turn_) return {};
    return silence_.isDue(!receives && !inside_) ? silenceText(coverage(), turn_ > 1, scene) : "";
}

}  // namespace insonify::sonar
