#include <gmock/gmock.h>

#include "components/dataset/SampleFiles.hpp"
#include "tests/support/Fans.hpp"

namespace insonify::dataset {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

types::SonarPtr makeLine(float level, uint32_t bins = 5) {
    auto ping = std::make_shared<types::Sonar>(test::emptyPing(180, 2, bins));
    std::ranges::fill(ping->bins, level);
    return ping;
}

types::SonarTruthPtr getTruth(const types::Sonar& ping, int32_t object) {
    auto truth = std::make_shared<types::SonarTruth>();
    truth->copyGrid(ping);
    truth->objects = {"floor", "rock"};
    std::ranges::fill(truth->object, object);
    std::ranges::fill(truth->shadow, uint8_t{1});
    return truth;
}

TEST(RunTest, JoinsTheBeamsOfAllPingsInOrder) {
    dataset::Run run;
    for (int i = 0; i < 3; ++i) {
        const auto line = makeLine(static_cast<float>(i));
        run.add(line, getTruth(*line, i % 2));
    }
    EXPECT_EQ(run.size(), 3u);
    EXPECT_EQ(run.ping().beam_count, 6u);
    EXPECT_TRUE(run.ping().wellShaped());
    EXPECT_EQ(run.truth().diagnostic(), nullptr);
    EXPECT_THAT(std::vector(run.ping().bins.begin() + 20, run.ping().bins.end()), Each(2));
    EXPECT_THAT(std::vector(run.truth().object.begin() + 10, run.truth().object.begin() + 20), Each(1));
    EXPECT_THAT(run.truth().shadow, Each(1));
    EXPECT_THAT(run.truth().objects, ElementsAre("floor", "rock"));
    EXPECT_EQ(run.pings()[1]->bins[0], 1);
}

TEST(RunTest, PingsOfOtherBinsAreRefused) {
    dataset::Run run;
    for (const uint32_t bins : {5, 6}) {
        const auto line = makeLine(1, bins);
        if (bins == 5)
            run.add(line, getTruth(*line, 0));
        else
            EXPECT_THROW(run.add(line, getTruth(*line, 0)), std::runtime_error);
    }
}

}  // namespace
}  // namespace insonify::dataset
