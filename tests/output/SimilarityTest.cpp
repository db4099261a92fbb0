#include <random>

#include "components/output/pictures/PlainPicture.hpp"
#include "tests/output/Pixels.hpp"

namespace insonify::output {
namespace {

types::Sonar speckle(unsigned seed, float echo) {
    types::Sonar ping = test::emptyPing(120, 60);
    std::minstd_rand random(seed);
    for (float& bin : ping.bins) bin = 1e-3f * static_cast<float>(1 + random() % 100);
    for (uint32_t beam = 20; beam < 40; ++beam) ping = test::withEcho(std::move(ping), beam, 50, echo);
    return ping;
}

TEST(SimilarityTest, TheSamePingIsFullySimilar) {
    EXPECT_DOUBLE_EQ(structuralSimilarity(speckle(1, 1), speckle(1, 1), {}), 1);
}

TEST(SimilarityTest, OtherSpeckleIsLessSimilarAndBrightnessHardlyMatters) {
    types::Sonar brighter = speckle(1, 1);
    for (float& bin : brighter.bins) bin *= 1.1f;
    const double speckled = structuralSimilarity(speckle(1, 1), speckle(2, 1), {});
    EXPECT_LT(speckled, 0.5);
    EXPECT_GT(structuralSimilarity(speckle(1, 1), brighter, {}), 0.98);
}

TEST(SimilarityTest, WhiteAndBlackFollowTheFormula) {
    types::Sonar white = test::emptyPing(120, 60), black = white;
    std::fill(white.bins.begin(), white.bins.end(), 1.f);
    DisplayConfig display;
    display.reference_db = 0;
    const double c1 = 0.01 * 255 * 0.01 * 255;
    EXPECT_NEAR(structuralSimilarity(white, black, display), c1 / (255.0 * 255 + c1), 1e-9);
}

TEST(SimilarityTest, BothUseTheScaleOfTheFirst) {
    types::Sonar loud = test::withEcho(test::emptyPing(120, 60), 30, 50, 1e6f);
    EXPECT_NEAR(referenceLevel(loud, {}), 60, 0.2);
    EXPECT_LT(structuralSimilarity(loud, test::withEcho(test::emptyPing(120, 60), 30, 50, 1), {}), 1);
}

TEST(SimilarityTest, ComparesAPingOfOneBeam) {
    const types::Sonar ping = test::withEcho(test::emptyPing(3, 1), 0, 50);
    EXPECT_DOUBLE_EQ(structuralSimilarity(ping, ping, {}), 1);
    EXPECT_LT(structuralSimilarity(ping, test::withEcho(test::emptyPing(3, 1), 0, 80), {}), 1);
}

}  // namespace
}  // namespace insonify::output
