// Effects that the plan omits equal the same effects with neutral values, bit for bit or within the bound that the
// reason states.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/renderer/PlanReport.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using ::testing::HasSubstr;
using Bins = std::vector<float>;

SonarConfig plainSonar(Model model = Model::Physical) {
    SonarConfig config = test::getSonar({.beams = 52, .width_deg = 130, .height_deg = 40, .bins = 400, .rows = 96});
    config.model = model;
    config.device = "software";
    return config;
}

Bins getBins(const SonarConfig& config, const types::GeometryPtr& geometry = test::surfaces()) {
    SonarRenderer renderer(config, geometry);
    types::Sonar ping;
    renderer.render(test::makeSnapshot(geometry, {}, 0.1, 0.15), ping);
    EXPECT_GT(std::ranges::count_if(ping.bins, [](float x) { return x != 0; }), 50);
    return ping.bins;
}

/** Returns the scene after `change`. */
types::GeometryPtr changed(auto change) {
    auto geometry = test::surfaces();
    change(*geometry);
    return geometry;
}

/** Returns the scene without normal maps. */
types::GeometryPtr unmapped() {
    return changed([](types::Geometry& g) { g.materials[1].normal_map = -1; });
}

/** Returns the scene with a material that follows a table. */
types::GeometryPtr measured() {
    return changed([](types::Geometry& g) { g.materials[0].measured = {{0, -40}, {90, -10}}; });
}

/** Returns the numbers in the reason for omitting an effect; none when it is not omitted. */
std::optional<Omitted> findOmitted(const SonarConfig& config, std::string_view effect) {
    const RenderPlan plan = makeRenderPlan(config, *unmapped());
    const Omitted* found = plan.findOmitted(effect);
    return found ? std::optional(*found) : std::nullopt;
}

Bins times(Bins bins, float factor) {
    for (float& bin : bins) bin *= factor;
    return bins;
}

}  // namespace

TEST(OmissionTest, EveryOmittedEffectIsTestedHere) {
    const std::set<std::string_view> tested = {"absorption", "absorption inside a bin", "specular lobe", "spreading",
                                               "backscatter by material", "further slabs", "refraction",
                                               "motion within a ping", "normal maps",
                                               // in RingDownTest.cpp and PointTargetTest.cpp:
                                               "transmit ring-down", "point targets",
                                               // where fields are summed, in tests/study/SpecklePingTest.cpp:
                                               "coherent speckle",
                                               // in BackscatterPingTest.cpp:
                                               "seabeds by TR 9407", "measured backscatter", "rough solids",
                                               // in VolumePingTest.cpp:
                                               "volume reverberation",
                                               // of `published`, in PublishedTest.cpp:
                                               "range footprints", "elevation mask", "shared columns", "near blanking",
                                               // without values yet; SonarConfig refuses them:
                                               "azimuth beam pattern", "elevation beam pattern", "range point-spread",
                                               // in MultipathTest.cpp:
                                               "multipath",
                                               // in WallsTest.cpp:
                                               "thin walls",
                                               // in ImperfectionsTest.cpp:
                                               "imperfections",
                                               // in EdgeDiffractionTest.cpp:
                                               "edge diffraction",
                                               // in CrosstalkTest.cpp and CrosstalkRunTest.cpp:
                                               "crosstalk",
                                               // in SurfaceMapTest.cpp:
                                               "surface maps",
                                               // in DeformingMeshTest.cpp:
                                               "deforming meshes"};
    SonarConfig absorbing = plainSonar(), published = plainSonar(Model::Cerqueira2017);
    absorbing.absorption.emplace().db_per_m = 0.1;
    absorbing.field_of_view_deg = 50;
    published.published = true;
    for (const SonarConfig& config : {plainSonar(), plainSonar(Model::Cerqueira2017), absorbing, published})
        for (const Omitted& what : makeRenderPlan(config, *unmapped()).omitted)
            EXPECT_TRUE(tested.contains(what.effect)) << describe(what, {}).name;
}

TEST(OmissionTest, NoAbsorptionIsAbsorptionOfZero) {
    for (Model model : {Model::Physical, Model::Cerqueira2017}) {
        SonarConfig with = plainSonar(model);
        with.absorption.emplace().db_per_m = 0;
        EXPECT_EQ(getBins(with), getBins(plainSonar(model)));
        with.absorption->db_per_m = 0.05;
        EXPECT_NE(getBins(with), getBins(plainSonar(model)));
    }
}

TEST(OmissionTest, AbsorptionInsideABinIsWithinTheStatedBound) {
    SonarConfig coarse = plainSonar();
    coarse.absorption.emplace().db_per_m = 1;
    const double bound = makeAbsorption(coarse).intensityPerMetre() * 0.1 / 2;
    EXPECT_NEAR(findOmitted(coarse, "absorption inside a bin")->value, bound, 1e-12 * bound);
    SonarConfig fine = coarse;
    fine.bin_count = 4000;
    const Bins whole = getBins(coarse), tenths = getBins(fine);
    for (size_t i = 0; i < whole.size(); ++i) {
        double sum = 0;
        for (size_t j = 0; j < 10; ++j) sum += tenths[10 * i + j];
        EXPECT_NEAR(whole[i], sum, (bound + 1e-3) * sum) << i;
    }
}

TEST(OmissionTest, ASmoothMaterialHasNoLobeWithAnyReflection) {
    const auto shiny = changed([](types::Geometry& g) { g.materials[0].reflection = 0.9f; });
    EXPECT_EQ(getBins(plainSonar(), shiny), getBins(plainSonar()));
    const auto rough = changed([](types::Geometry& g) { g.materials[0].roughness_slope = 0.1f; });
    EXPECT_EQ(getBins(plainSonar(), rough), getBins(plainSonar())) << "of reflection 0";
}

TEST(OmissionTest, TheModelOfCerqueiraHasNoSpreading) {
    for (Model model : {Model::Cerqueira2017, Model::Physical}) {
        SonarConfig twice = plainSonar(model);
        twice.range *= 2;
        twice.range_min *= 2;
        twice.speed_of_sound = 2000;
        const auto larger = changed([](types::Geometry& g) {
            for (types::Object& object : g.objects)
                object.world_from_object = glm::scale(glm::dmat4(1), glm::dvec3(2)) * object.world_from_object;
        });
        const Bins bins = getBins(plainSonar(model));
        const float spreading = model == Model::Physical ? 4 : 1;  // 1 / r^2
        EXPECT_LT(test::relativeL2(times(getBins(twice, larger), spreading), bins), 1e-6);
    }
}

TEST(OmissionTest, TheModelOfCerqueiraHasNoBackscatter) {
    const Bins bins = getBins(plainSonar(Model::Cerqueira2017));
    const auto hard = changed([](types::Geometry& g) { g.materials[0].lambert_db = -3; });
    EXPECT_EQ(getBins(plainSonar(Model::Cerqueira2017), hard), bins);
    EXPECT_NE(getBins(plainSonar(), hard), getBins(plainSonar())) << "physical does";
}

TEST(OmissionTest, ReflectivityOfOneHasNoEffect) {
    const auto plain = changed([](types::Geometry& g) { g.materials[1] = {}; });
    const auto one = changed([](types::Geometry& g) { g.materials[1] = {}, g.materials[1].reflectivity = 1; });
    EXPECT_EQ(getBins(plainSonar(Model::Cerqueira2017), one), getBins(plainSonar(Model::Cerqueira2017), plain));
    EXPECT_NE(getBins(plainSonar(Model::Cerqueira2017)), getBins(plainSonar(Model::Cerqueira2017), unmapped()))
        << "0.8, mapped";
}

TEST(OmissionTest, NoNormalMapMatchesANeutralMap) {
    for (Model model : {Model::Physical, Model::Cerqueira2017}) {
        const Bins bins = getBins(plainSonar(model), unmapped());
        const auto unused = changed([](types::Geometry& g) {
            g.materials.push_back(g.materials[1]);
            g.materials[1].normal_map = -1;
        });
        EXPECT_EQ(getBins(plainSonar(model), unused), bins) << "compiled, but no surface has it";
        const auto unscaled = changed([](types::Geometry& g) { g.materials[1].normal_scale = 0; });
        EXPECT_LT(test::relativeL2(getBins(plainSonar(model), unscaled), bins), 1e-6)
            << "its cosine is of single precision";
        const auto flat = changed([](types::Geometry& g) { g.normal_maps = {test::flatMap()}; });
        EXPECT_LT(test::relativeL2(getBins(plainSonar(model), flat), bins), 5e-3) << "(128, 128, 255) leans by 0.3 deg";
        EXPECT_GT(test::relativeL2(getBins(plainSonar(model)), bins), 0.01);
    }
}

TEST(OmissionTest, OneFrustumMatchesSeveral) {
    SonarConfig one = plainSonar(), two = plainSonar();
    one.quality.rows = two.quality.rows = 512;
    one.field_of_view_deg = one.beam_count = 60;
    two.field_of_view_deg = two.beam_count = 62;
    EXPECT_EQ(findOmitted(one, "further slabs")->value, 60);
    EXPECT_FALSE(findOmitted(two, "further slabs"));
    const auto floor = test::makeScene({test::ground(-5)});
    const Bins narrow = getBins(one, floor), wide = getBins(two, floor);
    EXPECT_LT(test::relativeL2(narrow, {wide.begin() + 400, wide.end() - 400}), 1e-3) << "beams 1 to 60 of 62";
}

TEST(OmissionTest, AheadConesAreNearlyPlanes) {
    SonarConfig planar = plainSonar(), conical = plainSonar();
    planar.beam_count = conical.beam_count = 1;
    planar.field_of_view_deg = conical.field_of_view_deg = 2;
    conical.beam_geometry = BeamGeometry::Conical;
    const double widest =
        1 / std::cos(types::radians(20)) - 1;  // of the cone against the plane, at the aperture's edge
    const Bins flat = getBins(planar, unmapped()), cone = getBins(conical, unmapped());
    EXPECT_LT(test::relativeL2(cone, flat), widest);
    EXPECT_NE(cone, flat);
}

TEST(OmissionTest, RefractionIsOmittedByItsBound) {
    const auto refraction = findOmitted(plainSonar(), "refraction");
    ASSERT_TRUE(refraction);
    EXPECT_DOUBLE_EQ(refraction->value, 0.1 * 40 * 40 / (2 * 1000)) << "a gradient of 0.1 1/s";
    EXPECT_DOUBLE_EQ(refraction->bound, 0.1 * 40 * types::radians(40)) << "a tenth of the aperture's height";
    EXPECT_LT(refraction->value, refraction->bound);
    SonarConfig far = plainSonar();
    far.range = 4000;
    far.beam_height_deg = 2;
    EXPECT_FALSE(findOmitted(far, "refraction"));
    EXPECT_THAT(configNotices(far), testing::Contains(HasSubstr("rays are straight")));
}

TEST(OmissionTest, MotionWithinAPingIsOmittedBelowASpeed) {
    const auto motion = findOmitted(plainSonar(), "motion within a ping");
    ASSERT_TRUE(motion);
    const double travel_time = 2 * 40 / 1000.0;  // [s]
    EXPECT_DOUBLE_EQ(motion->value * travel_time, 0.1 / 2) << "half a bin [m]";
    SonarConfig at_rest = plainSonar();
    at_rest.device = "";
    at_rest.visibility = Visibility::Cpu;
    const Bins without = getBins(at_rest);
    at_rest.motion_in_ping = true;
    EXPECT_EQ(getBins(at_rest), without);
}

/** Sonars that need each feature, ray-traced and rasterised. */
std::vector<std::pair<SonarConfig, RenderOptions>> sonarsOfAllFeatures() {
    std::vector<std::pair<SonarConfig, RenderOptions>> all;
    for (Model model : {Model::Physical, Model::Cerqueira2017})
        for (BeamGeometry beams : {BeamGeometry::Planar, BeamGeometry::Conical})
            for (Visibility visibility : {Visibility::Gl, Visibility::Cpu})
                for (Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
                    if (visibility == Visibility::Cpu && deposit == Deposit::Gpu) continue;
                    SonarConfig config = plainSonar(model);
                    config.visibility = visibility;
                    config.deposit = deposit;
                    config.beam_geometry = beams;
                    if (deposit == Deposit::Cpu) config.absorption.emplace().db_per_m = 0.1;
                    all.emplace_back(config, RenderOptions{});
                    if (model != Model::Physical) continue;
                    SonarConfig& patterned = all.emplace_back(config, RenderOptions{}).first;
                    acoustics::BeamLaw& law = patterned.beam_pattern.emplace().receive.elevation.emplace();
                    law.width_deg = 20;
                    for (const VolumeLayer& water : {VolumeLayer{{}, {}, -70}, VolumeLayer{1, 5, -70}})
                        all.emplace_back(config, RenderOptions{}).first.volume = {water};
                }
    for (Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        for (Estimator estimator : {Estimator::Nearest, Estimator::NearestJitter}) {
            auto& [config, options] = all.emplace_back(plainSonar(), RenderOptions{});
            options.estimator = estimator;
            config.deposit = deposit;
        }
        SonarConfig& config = all.emplace_back(plainSonar(Model::Cerqueira2017), RenderOptions{}).first;
        config.published = true;
        config.deposit = deposit;
    }
    SonarConfig& coherent = all.emplace_back(plainSonar(), RenderOptions{}).first;
    coherent.visibility = Visibility::Cpu;
    coherent.device = "";
    coherent.frequency_khz = 300;
    coherent.speckle.emplace().coherent = true;
    SonarConfig& bent = all.emplace_back(plainSonar(), RenderOptions{}).first;
    bent.visibility = Visibility::Cpu;
    bent.device = "";
    bent.motion_in_ping = true;
    static const Folder folder;
    bent.water.emplace().profile = folder / "omission.csv";
    std::ofstream(*bent.water->profile) << "depth_m,sound_speed_m_s\n0,1000\n20,1050\n";
    return all;
}

TEST(OmissionTest, EachFeatureRendersByItsPlan) {
    std::set<std::string> seen, all;
    for (std::string_view name : types::EnumNames<Feature>::names) all.emplace(name);
    for (const Effect* effect : effects())
        for (const std::string& name : effect->features()) all.insert(name);
    for (const auto& [config, options] : sonarsOfAllFeatures())
        for (const types::GeometryPtr& geometry : {types::GeometryPtr(test::surfaces()), unmapped(), measured()}) {
            SonarRenderer renderer(config, geometry, options);
            types::Sonar ping;
            renderer.render(test::makeSnapshot(geometry, {}, 0.1, 0.15), ping);
            const RenderPlan& plan = renderer.renderPlan();
            for (const std::string& name : plan.featureNames()) seen.insert(name);
            const bool drew = std::ranges::count(plan.passes, Pass::Surface) == 1;
            EXPECT_NE(drew, plan.traces_rays);
            EXPECT_EQ(renderer.device().find("rays") == std::string::npos, drew);
            for (StageOf stage : {CullStage, DrawStage, DepositStage, BeamStage})
                EXPECT_GT(renderer.stages()[stage].seconds, 0) << stage;
        }
    EXPECT_EQ(seen, all) << "each feature has been used";
}

}  // namespace insonify::sonar
