// Runs the Python tests of scripts/sim_to_real.
#include <gmock/gmock.h>

#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

TEST(SimToRealTest, HalvesNeverShareAFilmAndWrongInputIsOneError) {
    if (!insonify::pythonHas("numpy, PIL, yaml")) GTEST_SKIP() << "python lacks numpy, Pillow or PyYAML";
    const std::filesystem::path answer = std::filesystem::path(testing::TempDir()) / "sim_to_real.txt";
    const std::string said =
        insonify::pythonSays(insonify::test::sourceFile("tests/dataset/check_sim_to_real.py"), answer);
    // Without torch, the test of its training is skipped.
    EXPECT_THAT(said, testing::AnyOf(testing::HasSubstr("\nOK\n"), testing::HasSubstr("\nOK (skipped=1)\n")));
}
