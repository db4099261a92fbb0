#include <gmock/gmock.h>

#include "components/framework/Deployment.hpp"
#include "components/framework/Registry.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::framework {
namespace {

TEST(LeftOutTest, ATypeThatThisBuildIsWithoutIsToldSoWithTheReason) {
    leaveOut("absent::", "libabsent-dev");
    const Folder folder;
    std::ofstream(folder / "x.yml") << "tasks:\n  a: {type: absent::PoseTask}\n  b: {type: unheard::PoseTask}\n";
    Registry registry;
    try {
        const Deployment deployment(DeploymentSpec::load(folder / "x.yml"), registry);
        FAIL() << "no error";
    } catch (const types::ConfigError& error) {
        ASSERT_EQ(error.diagnostics().size(), 2u);
        EXPECT_EQ(error.diagnostics()[0].message,
                  "is absent::PoseTask, which is left out of this build: it was made without libabsent-dev, or told to "
                  "be without it");
        EXPECT_THAT(error.diagnostics()[1].message, testing::StartsWith("is unheard::PoseTask; "));
    }
}

}  // namespace
}  // namespace insonify::framework
