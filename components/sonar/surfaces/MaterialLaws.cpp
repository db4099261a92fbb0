#include "components/sonar/surfaces/MaterialLaws.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "components/acoustics/Backscatter.hpp"
#include "components/acoustics/Matter.hpp"
#include "components/acoustics/RoughSurface.hpp"
#include "components/acoustics/Seabed.hpp"

namespace insonify::sonar {
namespace {

static_assert(acoustics::BackscatterTable::entries == BACKSCATTER_ENTRIES);

constexpr double min_lobe_share = 1e-4;  ///< A rough solid whose lobe has less energy has no lobe [1].

/** Returns the surface of a material that follows the law of its matter at the sonar's frequency; none of others. */
std::optional<acoustics::RoughSurface> roughSurface(const types::Material& material, const SonarConfig& config) {
    if (material.matter.empty() || !config.frequency_khz) return {};
    const acoustics::Matter matter = acoustics::matterNamed(material.matter).value();
    return acoustics::makeRoughSurface(acoustics::getProperties(matter), *config.frequency_khz, water_density,
                                       config.speedOfSound());
}

/** Adds tables; that of a seabed or a matter only once. */
class TableList {
public:
    TableList(const SonarConfig& config, MaterialLaws& laws) : config_(config), laws_(laws) {}

    /** Returns the number of the table that a material follows; -1: it follows Lambert's law. */
    int of(const types::Material& material) {
        if (!material.measured.empty()) return addMeasured(material);
        if (!material.matter.empty()) return ofMatter(material);
        if (material.seabed.empty()) return -1;
        laws_.lacks_frequency = !config_.frequency_khz;
        if (!config_.frequency_khz) return -1;
        const auto [known, is_new] = seabeds_.try_emplace(material.seabed, -1);
        if (is_new) known->second = addSeabed(material.seabed);
        return known->second;
    }

private:
    int add(const acoustics::BackscatterTable& table) {
        laws_.tables.insert(laws_.tables.end(), table.values().begin(), table.values().end());
        return static_cast<int>(laws_.tables.size() / BACKSCATTER_ENTRIES) - 1;
    }
    int ofMatter(const types::Material& material) {
        const auto surface = roughSurface(material, config_);
        if (!surface) return -1;
        laws_.has_matter = true;
        const auto [known, is_new] = matters_.try_emplace(material.matter, -1);
        if (is_new)
            known->second = add(acoustics::BackscatterTable([&](double grazing) { return surface->diffuse(grazing); }));
        return known->second;
    }
    int addMeasured(const types::Material& material) {
        acoustics::Curve curve;
        for (const glm::dvec2& point : material.measured) {
            curve.x.push_back(point.x);
            curve.y.push_back(point.y);
        }
        laws_.has_measured = true;
        return add(
            acoustics::BackscatterTable([&](double grazing) { return acoustics::measuredSection(curve, grazing); }));
    }
    int addSeabed(const std::string& name) {
        const acoustics::SeabedBackscatter seabed(acoustics::seabedNamed(name).value(), *config_.frequency_khz,
                                                  config_.speedOfSound());
        laws_.has_seabeds = true;
        laws_.outside_validity = acoustics::outsideSeabedModel(*config_.frequency_khz, config_.speedOfSound());
        return add(acoustics::BackscatterTable([&](double grazing) { return seabed.crossSection(grazing); }));
    }

    const SonarConfig& config_;
    MaterialLaws& laws_;
    std::map<std::string, int> seabeds_, matters_;
};

vec4 getLaw(const types::Material& material, const SonarConfig& config, float reflected, TableList& tables) {
    vec4 law(static_cast<float>(tables.of(material)), 0, 0, 0);
    if (const auto surface = roughSurface(material, config)) {
        if (surface->lobeShare() < min_lobe_share) return law;
        law.y = static_cast<float>(std::pow(surface->reflection(), 2) * surface->lobeShare() / (4 * std::numbers::pi));
        law.z = static_cast<float>(surface->squareSlope());
        return law;
    }
    if (!material.roughness_slope) return law;
    law.y = reflected * material.reflection * material.reflection / (4 * std::numbers::pi_v<float>);
    law.z = *material.roughness_slope * *material.roughness_slope;
    return law;
}

}  // namespace

bool MaterialLaws::hasWalls() const {
    return std::ranges::any_of(walls, [](const WallLaw& wall) { return wall.letsThrough() || wall.rings(); });
}

bool MaterialLaws::hasReturns() const {
    return std::ranges::any_of(walls, [](const WallLaw& wall) { return wall.rings() || wall.fill; });
}

void MaterialLaws::separateReturns() {
    for (size_t i = 0; i < walls.size(); ++i)
        if (walls[i].rings()) {
            records[i].values.x *= walls[i].outside.front();
            records[i].law.y *= walls[i].outside.front();
        }
}

bool MaterialLaws::hasLobes() const {
    return std::ranges::any_of(records, [](const MaterialRecord& record) { return record.law.y > 0; });
}

void LobeSample::lookAlong(const glm::dvec3& direction) {
    const double level = std::hypot(direction.x, direction.y);
    cos_az = level > 0 ? direction.x / level : 1;
    sin_az = level > 0 ? direction.y / level : 0;
    cos_el = level;
    sin_el = direction.z;
}

double MaterialLaws::overCosine(size_t material, double cosine, const LobeSlopes& slopes) const {
    BackscatterCode shared{tables.data()};
    const MaterialRecord& record = records[material];
    return shared.backscatterOverCosine(record.law, double{record.values.x}, cosine, slopes);
}

LobeSlopes MaterialLaws::lobeSlopes(size_t material, const LobeSample& sample) const {
    BackscatterCode shared{tables.data()};
    const glm::dvec3 &n = sample.normal, &a = sample.axis;
    return shared.lobeSlopes(sample.facet, double{records[material].law.z},
                             {{n.x, n.y, n.z},
                              {a.x, a.y, a.z},
                              sample.range,
                              sample.cos_az,
                              sample.sin_az,
                              sample.cos_el,
                              sample.sin_el,
                              sample.width,
                              sample.height,
                              sample.mapped});
}

MaterialLaws::Bistatic MaterialLaws::bistatic(size_t material, double in, double out, double half,
                                              const LobeSlopes& slopes) const {
    BackscatterCode shared{tables.data()};
    const MaterialRecord& record = records[material];
    const auto diffuse = [&](double cosine) {  // relative to the cosine
        return record.law.x < 0 ? double{record.values.x} * cosine
                                : shared.tabulatedBackscatter(static_cast<uint>(record.law.x), cosine);
    };
    Bistatic section{std::sqrt(diffuse(in) * diffuse(out) * in / out), 0};
    if (record.law.y > 0) section.lobe = shared.lobeOverCosine(double{record.law.y}, slopes, half) * half / out;
    return section;
}

double MaterialLaws::loudest() const {
    double strongest = 0;
    for (const MaterialRecord& record : records)
        if (record.law.x < 0) strongest = std::max(strongest, double{record.values.x});
    for (size_t i = 0; i < tables.size(); ++i) strongest = std::max(strongest, tables[i]);
    return strongest;
}

double MaterialLaws::loudestLobe(double sample_angle) const {
    BackscatterCode shared{tables.data()};
    double strongest = 0;
    for (const MaterialRecord& record : records) {
        if (record.law.y == 0) continue;
        const double slope = shared.meanSquareSlope(vec4(0), double{record.law.z}, sample_angle * sample_angle, 0);
        for (double cosine = 1; cosine > 1e-3; cosine *= 0.95)
            strongest = std::max(
                strongest,
                shared.lobeOverCosine(double{record.law.y}, {1 - cosine * cosine, 0, slope, slope, 0, 0, 0}, cosine));
    }
    return strongest;
}

MaterialLaws makeMaterialLaws(const SonarConfig& config, const types::Geometry& geometry) {
    MaterialLaws laws;
    TableList tables(config, laws);
    if (config.frequency_khz) laws.wavelength = config.speedOfSound() / (1000 * *config.frequency_khz);
    for (const types::Material& material : geometry.materials) {
        WallLaw wall = config.model == Model::Physical ? makeWallLaw(material, config) : WallLaw();
        const auto reflected = static_cast<float>(wall.reflected);
        const vec4 values(reflected * std::pow(10.0f, material.lambert_db / 10), material.reflectivity,
                          material.normal_scale, 0);
        const vec4 law =
            config.model == Model::Physical ? getLaw(material, config, reflected, tables) : vec4(-1, 0, 0, 0);
        laws.records.push_back({values, law});
        laws.walls.push_back(std::move(wall));
    }
    return laws;
}

}  // namespace insonify::sonar
