// deploy/foxglove_layout.json, compared with the topics of deploy/live_view.yml.
#include <gmock/gmock.h>

#include <csignal>
#include <regex>

#include "tests/deployer/Command.hpp"
#include "tests/support/Python.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::Contains;
using testing::HasSubstr;

TEST(FoxgloveLayoutTest, TheLiveViewServesEachTopicAndField) {
    if (!pythonHas("websockets, mcap_ros2"))
        GTEST_SKIP() << "SKIPPED: Python packages websockets and mcap_ros2; scripts/setup installs them";
    const TestFolder folder;
    const Process run(insonifyWords({"run", test::sourceFile("deploy/live_view.yml"), "--out", "out", "--set",
                                     "sonar.beam_count=64", "--set", "sonar.bin_count=200"}),
                      folder.path());
    ASSERT_TRUE(says(folder, "http://")) << readFile(folder / "stderr.txt");
    std::smatch port;
    const std::string text = readFile(folder / "stderr.txt");
    ASSERT_TRUE(std::regex_search(text, port, std::regex(R"(http://127\.0\.0\.1:(\d+))"))) << text;
    const std::string said =
        pythonSays(test::sourceFile("tests/deployer/foxglove_layout.py") + " " +
                       test::sourceFile("deploy/foxglove_layout.json") + " ws://127.0.0.1:" + port[1].str(),
                   folder / "said");
    run.signal(SIGINT);
    EXPECT_EQ(run.wait().code, 0);
    ASSERT_THAT(said, testing::StartsWith("{"));
    const json found = json::parse(said);
    EXPECT_EQ(found["panels"], (json{"3D", "Image", "Parameters", "Plot", "Plot"}));
    EXPECT_EQ(found["topics"].size(), 6u);
    EXPECT_EQ(found["paths"].size(), 3u);
    EXPECT_THAT(found["parameters"].get<std::vector<std::string>>(), Contains("sonar.range"));
}
