#include <gmock/gmock.h>

#include "components/gpu/EglContext.hpp"
#include "tests/support/PromisedLimits.hpp"

namespace insonify::gpu {
namespace {

using ::testing::IsEmpty;

TEST(LimitsTest, AContextHasTheLimitsThatOpenGl45Guarantees) {
    const EglContext context("software");
    EXPECT_THAT(context.limits().shortfall(test::promisedLimits()), IsEmpty());
}

TEST(LimitsTest, AShortfallIsTheFirstLimitWithBothNumbers) {
    const Limits limits{.draw_parameters = 1, .texture_size = 4096, .storage_blocks = 8, .shared_bytes = 32768};
    EXPECT_EQ(limits.shortfall({}), "");
    EXPECT_EQ(limits.shortfall(limits), "");
    EXPECT_EQ(limits.shortfall({.texture_size = 4097, .shared_bytes = 40000}),
              "GL_MAX_TEXTURE_SIZE is 4096, and 4097 is needed");
    EXPECT_EQ(limits.shortfall({.storage_blocks = 9}), "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS is 8, and 9 is needed");
    EXPECT_EQ(Limits{}.shortfall(limits), "GL_ARB_shader_draw_parameters is missing");
}

}  // namespace
}  // namespace insonify::gpu
