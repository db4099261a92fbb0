// Runs the Python tests of scripts/research/sim_to_real.
#include <gmock/gmock.h>

#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

namespace {

void expectPasses(const std::string& file) {
    const std::filesystem::path answer = std::filesystem::path(testing::TempDir()) / (file + ".txt");
    const std::string said = insonify::pythonSays(insonify::test::sourceFile("tests/dataset/" + file), answer);
    EXPECT_THAT(said, testing::HasSubstr("\nOK\n"));
}

}  // namespace

TEST(SimToRealTest, HalvesNeverShareAFilmAndWrongInputIsOneError) {
    if (!insonify::pythonHas("numpy, PIL, yaml")) GTEST_SKIP() << "python lacks numpy, Pillow or PyYAML";
    expectPasses("check_sim_to_real.py");
}

TEST(SimToRealTest, TrainingVariesCropsAndUsesSizes) {
    if (!insonify::pythonHas("torch, skimage, sklearn"))
        GTEST_SKIP()
            << "python lacks torch, scikit-image or scikit-learn; scripts/research/sim_to_real_requirements.txt has it";
    expectPasses("check_sim_to_real_training.py");
}
