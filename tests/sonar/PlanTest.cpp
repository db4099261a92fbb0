#include <gmock/gmock.h>

#include <algorithm>

#include "components/acoustics/Backscatter.hpp"
#include "components/sonar/renderer/PlanReport.hpp"

namespace insonify::sonar {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

types::Material sand() {
    types::Material material;
    material.name = "sand";
    material.has_acoustics = true;
    return material;
}

types::Geometry makeScene(std::vector<types::Material> materials) {
    types::Geometry geometry;
    geometry.materials = std::move(materials);
    return geometry;
}

types::Plan makePlan(const SonarConfig& config, const types::Geometry& geometry) {
    return report(makeRenderPlan(config, geometry), geometry);
}

/** Returns the reason for which the plan omits `name`; empty when it does not. */
std::string reason(const types::Plan& plan, const std::string& name) {
    const auto found = std::ranges::find(plan.omitted, name, &types::Omission::name);
    return found == plan.omitted.end() ? "" : found->reason;
}

/** A sonar without notices: bins of whole microseconds. */
SonarConfig quietSonar() {
    SonarConfig config;
    config.range = 75;
    config.visibility = Visibility::Gl;
    return config;
}

TEST(PlanTest, ThePlainPhysicalSonarCompilesNothingElseAndStatesWhy) {
    const types::Plan plan = makePlan(quietSonar(), makeScene({sand()}));
    EXPECT_THAT(plan.features, ElementsAre("physical"));
    EXPECT_THAT(plan.passes, ElementsAre("cull", "surface", "deposit", "beams"));
    EXPECT_THAT(plan.notices, IsEmpty());
    EXPECT_EQ(plan.rows, 256);
    EXPECT_EQ(plan.columns_per_beam, 2);
    EXPECT_EQ(plan.slabs, 2);
    for (const char* effect : {"absorption", "azimuth beam pattern", "elevation beam pattern", "range point-spread",
                               "volume reverberation", "multipath"})
        EXPECT_EQ(reason(plan, effect), "not configured") << effect;
    EXPECT_EQ(reason(plan, "normal maps"), "no material has one");
    EXPECT_EQ(reason(plan, "specular lobe"), "no material has a reflection and a roughness_slope");
    EXPECT_THAT(reason(plan, "refraction"), HasSubstr("< 2.6 m"));
}

TEST(PlanTest, FeaturesOfTheSceneOrConfigurationAreNotOmitted) {
    struct Case {
        const char* effect;
        const char* feature;
        void (*change)(SonarConfig&, types::Material&);
    };
    for (const Case& c :
         {Case{"normal maps", "normal_map", [](SonarConfig&, types::Material&m) { m.normal_map = 0; }},
          Case{"absorption", nullptr, [](SonarConfig&s, types::Material&) { s.absorption.emplace().db_per_m = 0.1; }},
          Case{"spreading", "physical", [](SonarConfig&, types::Material&) {}},
          Case{"further slabs", nullptr, [](SonarConfig&s, types::Material&) { s.field_of_view_deg = 61; }},
          Case{"refraction", nullptr,
               [](SonarConfig&s, types::Material&) { s.range = 2000, s.beam_height_deg = 2; }}}) {
        SonarConfig config = quietSonar();
        types::Material material = sand();
        c.change(config, material);
        const types::Plan plan = makePlan(config, makeScene({material}));
        EXPECT_EQ(reason(plan, c.effect), "") << c.effect;
        if (c.feature) {
            EXPECT_THAT(plan.features, Contains(c.feature)) << c.effect;
        }
    }
}

TEST(PlanTest, MultipathIsAPassIfAnythingReflects) {
    SonarConfig config = quietSonar();
    config.visibility = Visibility::Auto;
    types::Material steel = sand();
    steel.reflection = 0.9f;
    steel.roughness_slope = 0.1f;
    const auto passes = [&](int bounces) {
        config.multipath->bounces = bounces;
        return makePlan(config, makeScene({sand(), steel})).passes;
    };
    config.multipath.emplace().bounces = 0;
    EXPECT_EQ(reason(makePlan(config, makeScene({steel})), "multipath"), "bounces is 0");
    EXPECT_THAT(passes(1), Not(Contains("paths")));
    EXPECT_THAT(reason(makePlan(config, makeScene({steel})), "multipath"), HasSubstr("no material is `mirror: true`"));
    EXPECT_THAT(passes(2), ElementsAre("cull", "rays", "deposit", "paths", "beams"));
    steel.mirror = true;
    EXPECT_THAT(passes(1), Contains("paths"));
    steel = sand();
    config.multipath->surface.emplace();
    EXPECT_THAT(passes(1), Contains("paths"));
    EXPECT_EQ(reason(makePlan(config, makeScene({sand()})), "multipath"), "");
}

TEST(PlanTest, ThePublishedModelOmitsThePhysics) {
    SonarConfig config = quietSonar();
    config.model = Model::Cerqueira2017;
    config.absorption.emplace().db_per_m = 0.2;
    const types::Plan plan = makePlan(config, makeScene({sand()}));
    EXPECT_THAT(plan.features, ElementsAre("cerqueira2017", "absorption"));
    for (const char* effect : {"spreading", "backscatter by material"})
        EXPECT_THAT(reason(plan, effect), HasSubstr("means of S(n.d)")) << effect;
    config.absorption->db_per_m = 0;
    EXPECT_THAT(makePlan(config, makeScene({sand()})).features, ElementsAre("cerqueira2017"));
}

TEST(PlanTest, UsesTheMinNumberOfFrustaThatCoverTheFan) {
    struct Case {
        double fov;
        int frusta;
    };
    for (const Case& c :
         {Case{3, 1}, Case{60, 1}, Case{61, 2}, Case{120, 2}, Case{130, 3}, Case{180, 3}, Case{360, 6}}) {
        SonarConfig config = quietSonar();
        config.field_of_view_deg = c.fov;
        EXPECT_EQ(makePlan(config, makeScene({sand()})).slabs, c.frusta) << c.fov << " deg";
    }
}

TEST(PlanTest, AbsorptionWithinABinIsBounded) {
    SonarConfig config = quietSonar();
    config.absorption.emplace().db_per_m = 0.02;  // beta = 0.00921 1/m, bins of 0.15 m
    types::Plan plan = makePlan(config, makeScene({sand()}));
    EXPECT_EQ(reason(plan, "absorption inside a bin"), "beta dR/2 = 6.9e-04 < 1e-03");
    EXPECT_THAT(plan.notices, IsEmpty());
    config.absorption->db_per_m = 0.2;
    plan = makePlan(config, makeScene({sand()}));
    EXPECT_EQ(reason(plan, "absorption inside a bin"), "beta dR/2 = 6.9e-03, 0.03 dB to either side");
    EXPECT_THAT(plan.notices, IsEmpty());
    config.absorption->db_per_m = 2;
    plan = makePlan(config, makeScene({sand()}));
    EXPECT_THAT(plan.notices, ElementsAre(HasSubstr("changes within a bin by 0.3 dB")));
}

TEST(PlanTest, ReportsMaterialsWithoutValuesAndTooLoudMaterialsOnce) {
    types::Material concrete, rope, mirror = sand(), mapped = sand(), limit = sand();
    concrete.name = "Concrete";
    rope.name = "Rope";
    mirror.name = "Mirror";
    mirror.lambert_db = 0;
    mapped.name = "Mapped";
    mapped.lambert_db = -7;
    mapped.max_map_strength = 2;
    limit.lambert_db = acoustics::max_lambert_db;
    const types::Plan plan = makePlan(quietSonar(), makeScene({concrete, sand(), rope, mirror, mapped, limit}));
    EXPECT_THAT(plan.notices,
                ElementsAre(HasSubstr("2 of 6 materials have no acoustic values and are medium sand, -16.7 "
                                      "dB: 'Concrete', 'Rope'"),
                            HasSubstr("with its map, returns more energy than it receives: 'Mirror', 'Mapped'")));
}

TEST(PlanTest, HasNoticesOfTheConfiguration) {
    struct Case {
        const char* words;
        void (*change)(SonarConfig&);
    };
    for (const Case& c :
         {Case{"range reached is 50.25 m, 0.5 % more than 50 m: bins last 67 us", [](SonarConfig& s) { s.range = 50; }},
          Case{"Warning: range reached is 51 m, 2 % more", [](SonarConfig& s) { s.range = 50, s.bin_count = 1000; }},
          Case{"125 of 500 bins are empty, because bin_count counts from range 0 and range_min is 18.75 m; with "
               "bin_count: "
               "667 there are 500 bins beyond it",
               [](SonarConfig& s) { s.range_min = s.range / 4; }},
          Case{"speed of sound is 1700 m/s", [](SonarConfig& s) { s.speed_of_sound = 1700, s.range = 85; }},
          Case{"speed of sound is 340 m/s", [](SonarConfig& s) { s.speed_of_sound = 340, s.range = 17; }},
          Case{"10000 kHz (0.2 to 1000)",
               [](SonarConfig& s) {
                   s.water.emplace(), s.speed_of_sound = 1500;
                   s.absorption.emplace().frequency_khz = 10000;
               }},
          Case{"rays are straight", [](SonarConfig& s) { s.range = 3000, s.beam_height_deg = 5; }},
          Case{"smaller than the 0.00012 m between neighbouring float ranges", [](SonarConfig& s) {
                   s.range = 2000, s.bin_count = 20000000, s.range_rounding = RangeRounding::Exact;
               }}}) {
        SonarConfig config = quietSonar();
        c.change(config);
        EXPECT_THAT(configNotices(config), Contains(HasSubstr(c.words)));
        EXPECT_THAT(makePlan(config, makeScene({sand()})).notices, Contains(HasSubstr(c.words)));
    }
    EXPECT_THAT(configNotices(quietSonar()), IsEmpty());
}

}  // namespace
}  // namespace insonify::sonar
