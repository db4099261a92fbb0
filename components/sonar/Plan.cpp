#include "components/sonar/Plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double speed_gradient = 0.1;  ///< Of the speed of sound with depth, a strong thermocline [1/s].

bool hasNormalMap(const types::Geometry& geometry) {
    return std::ranges::any_of(geometry.materials, [](const auto& material) { return material.normal_map >= 0; });
}

std::vector<std::string> features(const SonarConfig& config, const types::Geometry& geometry) {
    std::vector<std::string> names = {config.model == Model::Physical ? "physical" : "cerqueira2017"};
    if (config.model == Model::Cerqueira2017 && makeAbsorption(config).db_per_m > 0) names.push_back("absorption");
    if (config.published) names.push_back("published");
    if (config.beam_geometry == BeamGeometry::Conical) names.push_back("conical");
    if (hasNormalMap(geometry)) names.push_back("normal_map");
    return names;
}

/** How far a ray is bent at the far edge by the assumed gradient, and what of it can be ignored [m]. */
struct Bending {
    double offset, tolerated;
};
Bending bending(const SonarConfig& config, const BinGrid& grid) {
    const double r = grid.range_max;
    return {speed_gradient * r * r / (2 * grid.speed_of_sound),
            std::max(grid.bin_width, 0.1 * r * types::radians(config.beam_height_deg))};
}

void omitAbsorption(const SonarConfig& config, const BinGrid& grid, types::Plan& plan) {
    if (!config.absorption) return plan.omitted.push_back({"absorption", "not configured"});
    const double residual = makeAbsorption(config).intensityPerMetre() * grid.bin_width / 2;
    if (config.model == Model::Cerqueira2017) return;
    const double decibels = 10 * residual / std::numbers::ln10;
    const std::string bound = residual < 1e-3 ? " < 1e-3" : fmt::format(", {:.2g} dB to either side", decibels);
    plan.omitted.push_back({"absorption inside a bin", fmt::format("beta dR/2 = {:.1e}{}", residual, bound)});
    if (decibels > 0.1)
        plan.notices.push_back(
            fmt::format("Warning: absorption changes within a bin by {:.2g} dB to either side of its "
                        "middle; it is taken in the middle",
                        decibels));
}

void omitPhysical(const types::Geometry& geometry, types::Plan& plan) {
    const bool rough = std::ranges::any_of(geometry.materials, [](const auto& m) { return m.roughness_slope > 0; });
    plan.omitted.push_back({"specular lobe", rough ? "not built yet; lambert_db stands for all of the backscatter"
                                                   : "no material has a roughness_slope"});
}

void omitPublished(const SonarConfig& config, types::Plan& plan) {
    const std::string reason = "cerqueira2017: bins are means of S(n.d)";
    plan.omitted.push_back({"spreading", reason});
    plan.omitted.push_back({"backscatter by material", reason + "; reflectivity scales n.d"});
    if (!config.published) return;
    plan.omitted.push_back({"range footprints", "published: one bin per pixel"});
    plan.omitted.push_back({"elevation mask", "published: the image's edge, nearer than the aperture away from ahead"});
    plan.omitted.push_back({"shared columns", "published: every column belongs to one beam"});
    plan.omitted.push_back({"near blanking", "published: bins begin at range 0"});
}

void omitEffects(const SonarConfig& config, const BinGrid& grid, types::Plan& plan) {
    for (const char* effect :
         {"azimuth beam pattern", "elevation beam pattern", "range point-spread", "volume reverberation", "multipath"})
        plan.omitted.push_back({effect, "not configured"});
    if (plan.slabs == 1)
        plan.omitted.push_back({"further slabs", fmt::format("one image shows all {:g} deg", config.coverageDeg())});
    const Bending bent = bending(config, grid);
    if (bent.offset < bent.tolerated)
        plan.omitted.push_back(
            {"refraction", fmt::format("a gradient of {} 1/s bends by {:.2g} m at {:.4g} m < {:.2g} m", speed_gradient,
                                       bent.offset, grid.range_max, bent.tolerated)});
    plan.omitted.push_back(
        {"motion within a ping", fmt::format("below {:.2g} m/s it is under half a bin",
                                             grid.bin_width * grid.speed_of_sound / (4 * grid.range_max))});
}

void noteRange(const SonarConfig& config, const BinGrid& grid, std::vector<std::string>& notices) {
    const double read = static_cast<double>(grid.bin_duration_us) * 1e-6 * grid.speed_of_sound;
    const double off = grid.range_max / read - grid.range_max / grid.bin_width;
    if (config.range_rounding == RangeRounding::Exact && std::abs(off) > 1e-6)
        notices.push_back(
            fmt::format("Warning: bin_duration is {} us in whole microseconds; a reader of it is off by "
                        "{:.3g} bins at the far edge",
                        grid.bin_duration_us, std::abs(off)));
    const double longer = grid.range_max / config.range - 1;
    if (std::abs(longer) > 1e-9)
        notices.push_back(fmt::format("{}range reached is {:.6g} m, {:.2g} % more than {:g} m: bins last {} us",
                                      longer > 0.01 ? "Warning: " : "", grid.range_max, 100 * longer, config.range,
                                      grid.bin_duration_us));
    const float far = static_cast<float>(grid.range_max);
    const double ulp = static_cast<double>(std::nextafter(far, std::numeric_limits<float>::infinity()) - far);
    if (grid.bin_width < ulp)
        notices.push_back(
            fmt::format("Warning: a bin of {:.2g} m is smaller than the {:.2g} m between neighbouring "
                        "float ranges; bins merge",
                        grid.bin_width, ulp));
}

void noteWater(const SonarConfig& config, const BinGrid& grid, std::vector<std::string>& notices) {
    if (grid.speed_of_sound < 1350 || grid.speed_of_sound > 1650)
        notices.push_back(
            fmt::format("Warning: speed of sound is {:g} m/s; water has 1350 to 1650", grid.speed_of_sound));
    if (config.absorption && config.absorption->frequency_khz) {
        const AbsorptionConfig& absorption = *config.absorption;
        const std::string outside = outsideValidity(absorption.law, *absorption.frequency_khz, *config.water);
        if (!outside.empty())
            notices.push_back(
                fmt::format("Warning: absorption is extrapolated outside its law's validity: {}", outside));
    }
    const Bending bent = bending(config, grid);
    if (bent.offset >= bent.tolerated)
        notices.push_back(
            fmt::format("Warning: rays are straight; a gradient of {} 1/s would bend them by {:.3g} m at "
                        "{:.4g} m",
                        speed_gradient, bent.offset, grid.range_max));
}

/** Names in quotes, at most five of them. */
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (size_t i = 0; i < names.size() && i < 5; ++i) text += fmt::format("{}'{}'", i ? ", " : "", names[i]);
    return names.size() > 5 ? text + ", ..." : text;
}

void noteMaterials(const types::Geometry& geometry, types::Plan& plan) {
    std::vector<std::string> plain, loud;
    for (const types::Material& material : geometry.materials) {
        if (!material.has_acoustics) plain.push_back(material.name);
        if (std::pow(10, material.lambert_db / 10.0) > 1 / std::numbers::pi) loud.push_back(material.name);
    }
    if (!plain.empty())
        plan.notices.push_back(
            fmt::format("{} of {} materials have no acoustic values and are medium sand, -16.7 dB: {}", plain.size(),
                        geometry.materials.size(), listed(plain)));
    if (!loud.empty())
        plan.notices.push_back(
            fmt::format("Warning: a lambert_db above -4.97 dB gives back more than it gets: {}", listed(loud)));
}

}  // namespace

std::vector<std::string> configNotices(const SonarConfig& config) {
    const BinGrid grid = makeBinGrid(config);
    std::vector<std::string> notices;
    noteRange(config, grid, notices);
    noteWater(config, grid, notices);
    return notices;
}

types::Plan makePlan(const SonarConfig& config, const types::Geometry& geometry) {
    const BinGrid grid = makeBinGrid(config);
    types::Plan plan;
    plan.rows = config.rows();
    plan.columns_per_beam = config.columnsPerBeam();
    plan.slabs = static_cast<int>(makeSlabs(config, makeBeams(config)).size());
    plan.predicted_error = std::numeric_limits<double>::quiet_NaN();
    plan.features = features(config, geometry);
    plan.passes = {"cull", "surface", "deposit", "beams"};
    plan.notices = configNotices(config);

    omitAbsorption(config, grid, plan);
    if (config.model == Model::Physical)
        omitPhysical(geometry, plan);
    else
        omitPublished(config, plan);
    omitEffects(config, grid, plan);
    if (!hasNormalMap(geometry)) plan.omitted.push_back({"normal maps", "no material has one"});
    if (config.model == Model::Physical) noteMaterials(geometry, plan);
    return plan;
}

}  // namespace insonify::sonar
