#include <gmock/gmock.h>

#include "components/dataset/StatisticsPage.hpp"

namespace insonify::dataset {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Json makeRecord(uint64_t index, const std::string& part, uint32_t area) {
    return {{"index", index},
            {"part", part},
            {"scene", "har<bour>.glb"},
            {"settings", {{"sonar.range", 30}, {"sonar.gain", 0.5 * double(index)}}},
            {"picture", {{"width", 100}, {"height", 50}}},
            {"annotations",
             {{{"name", "pile_0"}, {"category", 1}, {"bbox", {1, 2, 3, 4}}, {"area", area}, {"range_m", {4.0, 8.5}}}}}};
}

TEST(StatisticsPageTest, ShowsCountsSizesRangesAndExamples) {
    const std::vector<std::string> classes{"pile", "rock"};
    StatisticsPage page("sweep.yml", classes);
    page.add(makeRecord(0, "train", 100), "000000_a.png");
    page.add(makeRecord(1, "val", 300), "000001_b.png");
    const std::string text = page.text();
    EXPECT_THAT(text, HasSubstr("<p>2 samples</p>"));
    EXPECT_THAT(text, HasSubstr("<td>pile</td><td>2</td><td>2</td><td>200</td><td>4.00</td><td>8.50</td>"));
    EXPECT_THAT(text, HasSubstr("<td>rock</td><td>0</td>"));
    EXPECT_THAT(text, HasSubstr(">64 to 127 px</td>"));
    EXPECT_THAT(text, HasSubstr(">256 to 511 px</td>"));
    EXPECT_THAT(text, HasSubstr(">5 to 10 m</td>"));
    EXPECT_THAT(text, HasSubstr("sonar.range = 30"));
    EXPECT_THAT(text, HasSubstr("har&lt;bour&gt;.glb"));
    EXPECT_THAT(text, HasSubstr("<image href=\"000001_b.png\" width=\"100\" height=\"50\"/>"));
    EXPECT_THAT(text, HasSubstr("<rect x=\"1\" y=\"2\" width=\"3\" height=\"4\""));
}

TEST(StatisticsPageTest, ASettingWithAValueInEachSampleIsOneRow) {
    const std::vector<std::string> classes{"pile"};
    StatisticsPage page("sweep.yml", classes);
    for (uint64_t index = 0; index < 5; ++index) page.add(makeRecord(index, "train", 100), "");
    EXPECT_THAT(page.text(), HasSubstr("<td>sonar.gain: 0 to 2, median 1</td>"));
    for (uint64_t index = 5; index < 30; ++index) page.add(makeRecord(index, "train", 100), "");
    EXPECT_THAT(page.text(), HasSubstr("sonar.range = 30"));
    EXPECT_THAT(page.text(), HasSubstr("<td>sonar.gain: 0 to 14.5, median 7.25</td>"));
    EXPECT_THAT(page.text(), Not(HasSubstr("sonar.gain = ")));
}

TEST(StatisticsPageTest, ValuesOfAListAreInNumericOrder) {
    const std::vector<std::string> classes{"pile"};
    StatisticsPage page("sweep.yml", classes);
    for (const int value : {100, 20, 9, 20}) {
        Json record = makeRecord(0, "train", 100);
        record["settings"] = {{"sonar.range", value}};
        page.add(record, "");
    }
    const std::string text = page.text();
    const size_t first = text.find("sonar.range = 9<"), middle = text.find("sonar.range = 20<"),
                 last = text.find("sonar.range = 100<");
    ASSERT_NE(last, text.npos);
    EXPECT_TRUE(first < middle && middle < last);
}

TEST(StatisticsPageTest, WithoutPicturesThereAreNoExamples) {
    const std::vector<std::string> classes{"pile"};
    StatisticsPage page("sweep.yml", classes);
    page.add(makeRecord(0, "train", 100), "");
    EXPECT_THAT(page.text(), Not(HasSubstr("Examples")));
}

}  // namespace
}  // namespace insonify::dataset
