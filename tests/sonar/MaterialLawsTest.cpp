// Backscatter of materials between the entries of their tables, and materials that follow Lambert's law.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "components/acoustics/Matter.hpp"
#include "components/acoustics/RoughSurface.hpp"
#include "components/acoustics/Seabed.hpp"
#include "components/sonar/bins/CellDeposit.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

MaterialLaws makeLaws(types::Material material, std::optional<double> frequency_khz = 100) {
    SonarConfig config;
    config.frequency_khz = frequency_khz;
    types::Geometry geometry;
    geometry.materials = {std::move(material)};
    return makeMaterialLaws(config, geometry);
}

TEST(MaterialLawsTest, ATableMatchesItsLawBetweenItsEntriesToo) {
    const MaterialLaws laws = makeLaws({.name = "floor", .seabed = "medium_sand"});
    const acoustics::SeabedBackscatter sand(acoustics::seabedNamed("medium_sand").value(), 100, 1500);
    for (double grazing_deg = 3; grazing_deg <= 90; grazing_deg += 0.37) {
        const double grazing = types::radians(grazing_deg), cosine = std::sin(grazing);
        const double exact = sand.crossSection(grazing) / cosine, given = laws.overCosine(0, cosine);
        EXPECT_NEAR(10 * std::log10(given / exact), 0, grazing_deg < 6 ? 0.5 : 0.1) << grazing_deg;
    }
    EXPECT_EQ(laws.overCosine(0, 2), laws.overCosine(0, 1)) << "no cosine is above 1";
}

TEST(MaterialLawsTest, LambertsLawAppliesWithoutTableAndLobe) {
    const MaterialLaws lambert = makeLaws({.name = "mud", .lambert_db = -16.7f});
    EXPECT_TRUE(lambert.followsLambert(0));
    for (const double cosine : {0.001, 0.2, 0.7071, 1.0})
        EXPECT_NEAR(lambert.overCosine(0, cosine), std::pow(10, -1.67) * cosine, 1e-6) << cosine;
    EXPECT_FALSE(makeLaws({.name = "floor", .seabed = "silt"}).followsLambert(0));
    EXPECT_FALSE(makeLaws({.name = "measured", .measured = {{10, -30}, {90, -10}}}).followsLambert(0));
    EXPECT_FALSE(makeLaws({.name = "steel", .reflection = 0.9f, .roughness_slope = 0.1f}).followsLambert(0));
}

TEST(MaterialLawsTest, MatterIsARoughSolidAtTheSonarsFrequency) {
    for (const double frequency_khz : {100.0, 900.0, 3000.0})
        for (const acoustics::Matter matter : {acoustics::Matter::Steel, acoustics::Matter::Concrete}) {
            const MaterialLaws laws =
                makeLaws({.name = "m", .matter = std::string(acoustics::getName(matter))}, frequency_khz);
            const acoustics::RoughSurface surface =
                acoustics::makeRoughSurface(acoustics::getProperties(matter), frequency_khz, 1025, 1500);
            EXPECT_TRUE(laws.has_matter && laws.hasLobes());
            const double power = std::pow(surface.reflection(), 2) * surface.lobeShare() / (4 * M_PI);
            EXPECT_NEAR(double{laws.records[0].law.y} / power, 1, 1e-6);
            EXPECT_NEAR(double{laws.records[0].law.z} / surface.squareSlope(), 1, 1e-6);
            // Beyond the lobe: small perturbations, between two entries of the table to 0.5 dB.
            const LobeSlopes far{1, 0, 1e-6, 1e-6, 0, 0, 0};
            for (double grazing_deg = 20; grazing_deg < 75; grazing_deg += 1.7) {
                const double cosine = std::sin(types::radians(grazing_deg));
                const double exact = surface.diffuse(types::radians(grazing_deg)) / cosine;
                EXPECT_NEAR(10 * std::log10(laws.overCosine(0, cosine, far) / exact), 0, 0.5) << grazing_deg;
            }
        }
}

TEST(MaterialLawsTest, MatterWithoutALobeIsOnlyATable) {
    const MaterialLaws rock = makeLaws({.name = "m", .matter = "rock"}, 900);
    EXPECT_FALSE(rock.hasLobes());
    EXPECT_FALSE(rock.followsLambert(0));
    const double r =
        acoustics::makeRoughSurface(acoustics::getProperties(acoustics::Matter::Rock), 900, 1025, 1500).reflection();
    EXPECT_NEAR(rock.overCosine(0, 0.6), r * r / M_PI * 0.6, 1e-4) << "Lambert's law of all that is reflected";
}

TEST(MaterialLawsTest, WithoutAFrequencyMatterFollowsLambertsLaw) {
    const types::Material steel{.name = "m", .lambert_db = -9.8f, .matter = "steel", .reflection = 0.936f};
    types::Material plain = steel;
    plain.matter.clear();
    const MaterialLaws laws = makeLaws(steel, {}), as_before = makeLaws(plain, {});
    EXPECT_TRUE(laws.followsLambert(0));
    EXPECT_FALSE(laws.has_matter || laws.hasLobes());
    for (const double cosine : {0.1, 0.5, 1.0}) EXPECT_EQ(laws.overCosine(0, cosine), as_before.overCosine(0, cosine));
}

/** Materials of each law: Lambert's, a table, a lobe, both. */
types::Geometry allLaws() {
    types::Geometry geometry;
    geometry.materials = {{.name = "mud", .lambert_db = -20},
                          {.name = "sand", .seabed = "medium_sand"},
                          {.name = "glossy", .lambert_db = -12, .reflection = 0.8f, .roughness_slope = 0.15f},
                          {.name = "steel", .matter = "carbon_steel"},
                          {.name = "measured",
                           .measured = {{5, -40}, {45, -30}, {90, -10}},
                           .reflection = 0.5f,
                           .roughness_slope = 0.05f}};
    return geometry;
}

/** A batch of random cells of random materials, some of them misses. */
class RandomCells {
public:
    void fill(const EchoRules& rules, Cells& cells) {
        cells.count = static_cast<int>(random_() % (Cells::capacity + 1));
        for (int i = 0; i < cells.count; ++i) {
            const auto at = static_cast<size_t>(i);
            runs_[at].normal_x[0] = runs_[at].normal_y[1] = runs_[at].normal_z[2] = 1;
            facets_[at] = drawFacet();
            drawPlane(i, cells);
            cells.material[i] = static_cast<uint32_t>(random_() % rules.laws.records.size());
            cells.strength[i] = double{rules.laws.records[cells.material[i]].values.x} * rules.strength_scale;
            cells.facet[i] = &facets_[at], cells.run[i] = &runs_[at];
            cells.width[i] = draw(1e-4, 0.01), cells.height[i] = draw(1e-4, 0.01), cells.lean[i] = 0;
            cells.size[i] = draw(0.1, 2), cells.beam[i] = 0;
        }
    }

private:
    double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    float drawFloat(double low, double high) { return static_cast<float>(draw(low, high)); }

    FacetRecord drawFacet() {
        const float wave = random_() % 2 == 0 ? drawFloat(1e-5, 1e-3) : 0;
        const auto direction = [&] { return vec4(drawFloat(0, 0.1), wave, drawFloat(0, 2), drawFloat(-0.2, 0.2)); };
        return {vec4(drawFloat(-1, 1), drawFloat(-1, 1), drawFloat(-1, 1), static_cast<float>(random_() % 2)),
                direction(), direction()};
    }

    void drawPlane(int i, Cells& cells) {
        const double azimuth = draw(-0.5, 0.5), elevation = draw(-0.2, 0.2), range = draw(1, 60);
        cells.cos_az[i] = std::cos(azimuth), cells.sin_az[i] = std::sin(azimuth);
        cells.cos_el[i] = std::cos(elevation), cells.sin_el[i] = std::sin(elevation);
        if (random_() % 10 == 0) return cells.setMiss(i);
        cells.normal_x[i] = draw(-1, 0), cells.normal_y[i] = draw(-1, 1), cells.normal_z[i] = draw(-1, 1);
        const double across = cells.normal_x[i] * cells.cos_az[i] + cells.normal_y[i] * cells.sin_az[i];
        cells.distance[i] = range * (cells.cos_el[i] * across + cells.normal_z[i] * cells.sin_el[i]);
        cells.near_limit[i] = 10, cells.far_limit[i] = 0;
        cells.mapped[i] = random_() % 3 == 0 ? draw(0, 1) : 0;
    }

    std::mt19937 random_{5};
    std::array<FacetRecord, Cells::capacity> facets_;
    std::array<PlacedRun, Cells::capacity> runs_{};
};

/** Returns the strength of a cell alone, by the law of its material. */
double computeStrength(const EchoRules& rules, const CellDeposit& deposit, int i) {
    const Cells& cells = deposit.cells;
    const double inverse_range = deposit.covered.pixel[i], x = cells.normal_x[i], y = cells.normal_y[i],
                 z = cells.normal_z[i];
    const LobeSample sample{*cells.facet[i],   {x, y, z},       glm::dvec3(cells.facet[i]->axis),
                            1 / inverse_range, cells.cos_az[i], cells.sin_az[i],
                            cells.cos_el[i],   cells.sin_el[i], cells.width[i],
                            cells.height[i],   cells.mapped[i]};
    const double of_plane =
        std::min(std::abs(cells.distance[i]) * inverse_range / std::sqrt(x * x + y * y + z * z), 1.0);
    const double cosine = cells.mapped[i] > 0 ? cells.mapped[i] : of_plane;
    const uint32_t material = cells.material[i];
    const LobeSlopes slopes = rules.laws.hasLobe(material) ? rules.laws.lobeSlopes(material, sample) : LobeSlopes{};
    return rules.strength_scale / inverse_range * rules.laws.overCosine(material, cosine, slopes);
}

TEST(MaterialLawsTest, EachCellOfABatchFollowsTheLawOfItsMaterial) {
    const types::Geometry geometry = allLaws();
    SonarConfig config;
    config.frequency_khz = 700;
    config.range = 50;
    const RenderPlan plan = makeRenderPlan(config, geometry);
    const PingEffects effects(plan, geometry);
    const EchoRules rules = makeEchoRules(plan, effects);
    ASSERT_TRUE(rules.features.has(Feature::BackscatterLaws));
    std::vector<uint64_t> sums(rules.sumCount() * plan.beams.size());
    RandomCells random;
    int compared = 0;
    for (int round = 0; round < 200; ++round) {
        CellDeposit deposit(rules, {}, false, {0, sums.data()});
        random.fill(rules, deposit.cells);
        deposit.cover();
        for (int i = 0; i < deposit.cells.count; ++i) {
            const uint32_t material = deposit.cells.material[i];
            if (!(deposit.covered.pixel[i] > 0) || rules.laws.followsLambert(material)) continue;
            const double expected = computeStrength(rules, deposit, i);
            ASSERT_GT(expected, 0) << material;
            ASSERT_EQ(deposit.covered.strength_range[i], expected) << "material " << material << ", cell " << i;
            ASSERT_EQ(deposit.covered.fade[i], 0);
            ++compared;
        }
    }
    EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace insonify::sonar
