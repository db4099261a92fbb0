// The limits of OpenGL that rasterising needs, compared with drivers that do not exist.
#include <gmock/gmock.h>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/raster/DeviceNeeds.hpp"
#include "tests/support/PromisedLimits.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string renderer = "Imaginary GPU";

RenderPlan makePlan(const types::Geometry& geometry, const RenderOptions& options = {}) {
    SonarConfig config = test::getSonar({.beams = 256, .width_deg = 60, .bins = 500, .rows = 512, .columns = 8});
    config.visibility = Visibility::Gl;
    config.device = "software";
    return makeRenderPlan(config, geometry, options);
}

DepositSetup makeSetup(const RenderPlan& plan) {
    DepositSetup setup;
    setup.rules = makeEchoRules(plan, PingEffects(plan, *test::surfaces()));
    setup.frusta = plan.frusta;
    for (const ViewFrustum& frustum : plan.frusta)
        setup.shares.push_back(makeShares(plan.sampled, plan.cells, frustum, plan.options));
    setup.beam_count = static_cast<uint32_t>(plan.cells.size());
    return setup;
}

std::string drawingError(const gpu::Limits& limits, const gpu::Limits& needs) {
    return test::computeError<gpu::GlError>([&] { requireDrawing(limits, needs, renderer); });
}

TEST(DeviceNeedsTest, ADriverOfOpenGl45RasterisesAndSums) {
    const auto geometry = test::surfaces();
    const RenderPlan plan = makePlan(*geometry);
    EXPECT_NO_THROW(requireDrawing(test::promisedLimits(), drawingNeeds(plan, *geometry), renderer));
    for (Deposit deposit : {Deposit::Auto, Deposit::Gpu})
        EXPECT_EQ(whyOnProcessor(deposit, test::promisedLimits(), depositNeeds(makeSetup(plan), *geometry), renderer),
                  "");
}

TEST(DeviceNeedsTest, NamesALimitThatIsTooLowToRasterise) {
    const auto geometry = test::surfaces();
    const RenderPlan plan = makePlan(*geometry);
    gpu::Limits limits = test::promisedLimits();
    limits.draw_parameters = 0;
    EXPECT_THAT(drawingError(limits, drawingNeeds(plan, *geometry)),
                AllOf(HasSubstr(renderer), HasSubstr("GL_ARB_shader_draw_parameters is missing"),
                      HasSubstr("visibility: cpu")));
    limits = test::promisedLimits();
    limits.texture_size = 1024;
    EXPECT_THAT(drawingError(limits, drawingNeeds(plan, *geometry)),
                HasSubstr("GL_MAX_TEXTURE_SIZE is 1024, and " + std::to_string(plan.frusta[0].columns) + " is needed"));
    geometry->normal_maps[0].width = 20'000;
    EXPECT_THAT(drawingError(test::promisedLimits(), drawingNeeds(plan, *geometry)), HasSubstr("and 20000 is needed"));
}

TEST(DeviceNeedsTest, SeveralSamplesAPixelNeedMultisampledIntegers) {
    const auto geometry = test::surfaces();
    const gpu::Limits needs = drawingNeeds(makePlan(*geometry, {.samples_per_pixel = 4}), *geometry);
    EXPECT_THAT(drawingError(test::promisedLimits(), needs), HasSubstr("GL_MAX_INTEGER_SAMPLES is 1, and 4 is needed"));
}

TEST(DeviceNeedsTest, TheProcessorSumsIfTheDeviceCannotUnlessTheDeviceIsRequired) {
    const auto geometry = test::surfaces();
    const gpu::Limits needs = depositNeeds(makeSetup(makePlan(*geometry)), *geometry);
    const std::pair<int64_t gpu::Limits::*, std::string> limits[] = {
        {&gpu::Limits::storage_blocks, "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS is 0, and 8 is needed"},
        {&gpu::Limits::storage_bytes, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE is 0, and"},
        {&gpu::Limits::shared_bytes, "GL_MAX_COMPUTE_SHARED_MEMORY_SIZE is 0, and"},
        {&gpu::Limits::group_invocations, "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS is 0, and 64 is needed"},
        {&gpu::Limits::group_count, "GL_MAX_COMPUTE_WORK_GROUP_COUNT is 0, and"}};
    for (const auto& [limit, words] : limits) {
        gpu::Limits low = test::promisedLimits();
        low.*limit = 0;
        EXPECT_THAT(whyOnProcessor(Deposit::Auto, low, needs, renderer),
                    AllOf(HasSubstr("summed on the processor"), HasSubstr(renderer), HasSubstr(words)));
        EXPECT_THAT(test::computeError<gpu::GlError>([&] { whyOnProcessor(Deposit::Gpu, low, needs, renderer); }),
                    AllOf(HasSubstr(renderer), HasSubstr(words), HasSubstr("deposit: cpu")));
    }
}

TEST(DeviceNeedsTest, TheLargestBufferContainsTrianglesOrBins) {
    const auto geometry = test::surfaces();
    DepositSetup setup = makeSetup(makePlan(*geometry));
    const auto bytes = [&] { return static_cast<size_t>(depositNeeds(setup, *geometry).storage_bytes); };
    setup.beam_count = 100'000;
    EXPECT_EQ(bytes(), setup.sumCount() * sizeof(uint64_t));
    geometry->meshes[0].indices.resize(3 * 50'000'000);
    EXPECT_GE(bytes(), 50'000'000 * sizeof(PlaneRecord));
}

TEST(DeviceNeedsTest, FacetsFollowThePlanesIfAMaterialHasALobe) {
    for (const bool lobed : {false, true}) {
        const auto geometry = test::surfaces();
        if (lobed) geometry->materials.back().reflection = 0.9f, geometry->materials.back().roughness_slope = 0.1f;
        const DepositSetup setup = makeSetup(makePlan(*geometry));
        geometry->meshes[0].indices.resize(3 * 1'000'000);
        size_t triangles = 0;
        for (const types::Mesh& mesh : geometry->meshes) triangles += mesh.indices.size() / 3;
        EXPECT_EQ(static_cast<size_t>(depositNeeds(setup, *geometry).storage_bytes),
                  triangles * (sizeof(PlaneRecord) + (lobed ? sizeof(FacetRecord) : 0)));
    }
}

}  // namespace
}  // namespace insonify::sonar
