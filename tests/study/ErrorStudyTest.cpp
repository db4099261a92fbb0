// Scenes without a closed form, small: their reference is brute force, which estimates its own error.
#include <gmock/gmock.h>

#include <algorithm>

#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Probe.hpp"
#include "components/study/error/ErrorAnalysis.hpp"
#include "components/study/error/ErrorStudy.hpp"

namespace insonify::study {
namespace {

ErrorOptions quick(double rays) {
    ErrorOptions options;
    options.pings = 1;
    options.levels = 2;
    options.reference_rays = rays;
    return options;
}

StudyScene smallRoughFloor() {
    StudyScene scene = roughFloor(64);
    scene.config.beam_count = 4;
    scene.config.field_of_view_deg = 4;
    scene.config.bin_count = 100;
    return scene;
}

const Reference& onlyReference(const ErrorResult& result) {
    EXPECT_EQ(result.references.size(), 1u);
    return result.references.front();
}

/** Returns the claims that fail, except those on run times, which a busy machine may change. */
std::vector<std::string> findFailures(const ErrorResult& result) {
    std::vector<std::string> failures;
    for (const Claim& claim : claims(result))
        if (claim.fails() && !claim.timed) failures.push_back(claim.text + ": " + std::to_string(claim.measured));
    return failures;
}

class ClosedFormStudyTest : public testing::TestWithParam<SceneMaker> {};
INSTANTIATE_TEST_SUITE_P(Scenes, ClosedFormStudyTest, testing::ValuesIn(closedFormScenes()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(ClosedFormStudyTest, EveryClaimHolds) {
    const bool plane = std::ranges::count(slope_scenes, std::string(GetParam().name)) > 0;
    ErrorOptions options = quick(1);
    options.levels = plane ? 4 : 2;
    const ErrorResult result = studyError({GetParam().make()}, options);
    EXPECT_THAT(findFailures(result), testing::IsEmpty());
    const auto all = claims(result);
    EXPECT_EQ(std::ranges::count_if(all, [](const Claim& c) { return c.text.find("slope of") < c.text.size(); }),
              plane ? 3 : 0);
    EXPECT_EQ(std::ranges::count(all, std::string("open"), &Claim::verdict), 0);
}

/** Errors below four times the reference's own, and below this bound, are no difference. */
constexpr double effect_bound = 0.02;

class EffectTest : public testing::TestWithParam<Effect> {};
INSTANTIATE_TEST_SUITE_P(Effects, EffectTest, testing::ValuesIn(effects));

TEST_P(EffectTest, PingsEqualBruteForceOnFlatAndRoughFloors) {
    for (StudyScene plain : {closedFormScenes().front().make(), smallRoughFloor()}) {
        plain.config.beam_count = 4;
        plain.config.field_of_view_deg = 8;
        ErrorOptions options = quick(1e7);
        options.levels = 3;
        options.coherent_poses = 100;
        const ErrorResult result = studyError({withEffect(plain, GetParam())}, options);
        const Reference& reference = onlyReference(result);
        const auto points = ladder(result, reference.scene, Method::Footprint);
        ASSERT_GE(points.size(), 3u);
        EXPECT_LT(reference.error, 0.1) << reference.scene << " is too coarse to show anything";
        EXPECT_LT(points.back().metrics.rel_l2, std::hypot(4 * reference.error, effect_bound)) << reference.scene;
        EXPECT_LT(std::abs(points.back().metrics.energy_bias), std::hypot(0.01, reference.error)) << reference.scene;
        EXPECT_THAT(findFailures(result), testing::IsEmpty());
    }
}

TEST(ErrorEffectsTest, EachEffectChangesThePingByMoreThanItsBound) {
    StudyScene plain = closedFormScenes().front().make();
    plain.config.beam_count = 4;
    plain.config.field_of_view_deg = 8;
    types::Sonar without, with;
    sonar::SonarRenderer(plain.config, plain.snapshot.geometry).render(plain.snapshot, without);
    for (const Effect effect : effects) {
        const StudyScene scene = withEffect(plain, effect);
        sonar::SonarRenderer(scene.config, scene.snapshot.geometry).render(scene.snapshot, with);
        EXPECT_GT(difference(with, without), effect_bound) << scene.name;
    }
}

TEST(ErrorStudyTest, RefinesAReferenceUntilItIsTenTimesFinerThanEveryPoint) {
    const ErrorResult result = studyError({smallRoughFloor()}, quick(1e9));
    EXPECT_THAT(onlyReference(result).source, testing::HasSubstr("brute force"));
    EXPECT_GT(onlyReference(result).error, 0);
    for (const Measurement& m : result.measurements)
        EXPECT_GE(m.metrics.rel_l2, reference_margin * onlyReference(result).error) << getName(m.method) << m.rows;
}

TEST(ErrorStudyTest, AReferenceThatRunsOutOfRaysIsOpenAndDoesNotFail) {
    StudyScene plane = closedFormScenes().front().make();  // few points decide nothing: footprints are too accurate
    plane.name = "plane";
    plane.truth = nullptr;
    const ErrorResult result = studyError({plane}, quick(1));
    const auto all = claims(result);
    const auto open = std::ranges::find(all, std::string("open"), &Claim::verdict);
    ASSERT_NE(open, all.end());
    EXPECT_THAT(open->text, testing::HasSubstr("plane: smallest error over that of the reference"));
    EXPECT_THAT(makeSheet(result), testing::HasSubstr("| open |"));
}

TEST(ErrorStudyTest, RaysAndImagesAgreeOnFloors) {
    for (StudyScene scene : {smallRoughFloor(), benchFloor(40), rippledFloor(64)}) {
        scene.config.beam_count = 4;
        scene.config.field_of_view_deg = 8;
        const ErrorResult result = studyError({scene}, quick(4e6));
        for (const Method method : {Method::Footprint, Method::Embree}) {
            const auto points = ladder(result, scene.name, method);
            ASSERT_EQ(points.size(), 2u);
            // The ray tracer looks a map up at points, without means: two levels are too coarse for ripples.
            if (scene.name == "rippled_floor" && method == Method::Embree) continue;
            EXPECT_LT(points[1].metrics.rel_l2, 0.15) << scene.name << " " << getName(method);
            if (scene.name == "rippled_floor") continue;  // means of a map are as good with few cells as with some more
            EXPECT_LT(points[1].metrics.rel_l2, points[0].metrics.rel_l2) << scene.name << " " << getName(method);
        }
    }
}

TEST(ErrorStudyTest, RipplesOfAMapChangeThePings) {
    StudyScene mapped = rippledFloor(64), plain = mapped;
    const auto geometry = makeCopy(plain.snapshot.geometry);
    geometry->materials[0].normal_map = -1;
    plain.snapshot.geometry = geometry;
    std::vector<std::vector<float>> bins;
    for (const StudyScene& scene : {mapped, plain}) {
        sonar::SonarRenderer renderer(scene.config, scene.snapshot.geometry);
        types::Sonar ping;
        renderer.render(scene.snapshot, ping);
        bins.push_back(ping.bins);
    }
    const sonar::BinGrid grid = sonar::makeBinGrid(mapped.config);
    const std::vector<double> without(bins[1].begin(), bins[1].end());
    const double change =
        sonar::compare(bins[0], without, {mapped.config.beam_count, grid.bin_count, grid.bin_width, 0}).rel_l2_tvg;
    EXPECT_GT(change, 0.05);
    EXPECT_LT(change, 2);
}

TEST(ErrorStudyTest, EveryMethodAgreesWithTheClosedFormOfAPatternInElevation) {
    const auto maker = std::ranges::find(closedFormScenes(), std::string("pitched_bottom_pattern"), &SceneMaker::name);
    ASSERT_NE(maker, closedFormScenes().end());
    StudyScene scene = maker->make();
    scene.config.beam_count = 4;
    scene.config.field_of_view_deg = 8;
    scene.config.bin_count = 250;
    const ErrorResult result = studyError({scene}, quick(1));
    for (const Method method : {Method::Footprint, Method::Embree})
        EXPECT_LT(ladder(result, scene.name, method).back().metrics.rel_l2, 0.01) << getName(method);
    scene.config.beam_pattern->receive.elevation.reset();
    const ErrorResult one_way = studyError({scene}, quick(1));
    EXPECT_GT(ladder(one_way, scene.name, Method::Footprint).back().metrics.rel_l2, 0.1) << "a wrong form passes";
}

TEST(ErrorStudyTest, RefusesASceneWithoutEchoes) {
    StudyScene scene = smallRoughFloor();
    scene.snapshot.sonar.position.z = 1000;
    EXPECT_THROW(studyError({scene}, quick(1e5)), std::runtime_error);
}

}  // namespace
}  // namespace insonify::study
