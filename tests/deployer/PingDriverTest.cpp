// deploy/hil_ping360.yml with the unmodified client of the devices' maker.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <regex>

#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using insonify::test::becomesTrue;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

const fs::path checkout = insonify::test::source_dir, ping_360 = checkout / "deploy/hil_ping360.yml";

/** The numbers in the first match of a pattern with groups of numbers. */
std::vector<double> numbersIn(const std::string& text, const std::string& pattern) {
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern))) << pattern;
    std::vector<double> numbers;
    for (size_t i = 1; i < match.size(); ++i) numbers.push_back(std::stod(match[i]));
    return numbers;
}

/** The running deployment, and the output of the client. */
struct PingDriverTest : testing::Test {
    void SetUp() override {
        if (!insonify::pythonHas("brping"))
            GTEST_SKIP() << "PyPI's bluerobotics-ping is not in " << insonify::python()
                         << ": scripts/setup puts it there";
        run_.emplace(insonifyWords({"run", ping_360, "--out", "out", "--set", "ping360.port=0", "--set",
                                    "ping1d.port=0", "--set", "scene.pose_timeout=60", "--set",
                                    "bottom.pose_timeout=60", "--set", "ping360.seconds_per_gradian=0.001", "--set",
                                    "scanner_noise.speckle=null", "--set", "scanner_noise.ambient=null"}),
                     folder_.path());
        ASSERT_TRUE(says(folder_, "ping1d: listens on serial line"));
    }
    void TearDown() override {
        if (!run_) return;
        run_->signal(SIGINT);
        const Outcome ended = run_->wait();
        EXPECT_THAT(ended, succeeds());
        EXPECT_THAT(ended.out, testing::ContainsRegex("(^|\n)[1-9][0-9]* pings in ")) << "of the device with a driver";
    }
    std::string udpPort(const std::string& task) const {
        const std::string text = readFile(folder_ / "stderr.txt");
        return std::to_string(
            static_cast<int>(numbersIn(text, task + ": listens on UDP 127\\.0\\.0\\.1:(\\d+)").at(0)));
    }
    std::string makeLine(const std::string& task) const { return folder_ / "out" / task; }
    json driven(const std::string& arguments) const {
        const std::string script = checkout / "tests/deployer/ping_driver.py";
        const std::string said = insonify::pythonSays(script + " " + arguments, folder_ / "said.txt");
        const json parsed = json::parse(said, nullptr, false);
        EXPECT_FALSE(parsed.is_discarded()) << said.substr(0, 2000);
        return parsed;
    }

    TestFolder folder_;
    std::optional<Process> run_;
};

/** Returns the range where the echoes of an angle first are about as strong as its strongest [m]. */
double firstReturn(const json& reported, double range) {
    const auto data = reported["data"].get<std::vector<int>>();
    const int strong = *std::ranges::max_element(data) - 40;
    const auto first = std::ranges::find_if(data, [&](int code) { return code >= strong; });
    return (static_cast<double>(first - data.begin()) + 0.5) * range / static_cast<double>(data.size());
}

/** Returns the range that a driver computes for its samples, with sound at 1500 m/s. */
double computeRange(const json& reported) {
    return reported["number_of_samples"].get<double>() * reported["sample_period"].get<double>() * 25e-9 * 1500 / 2;
}

/** Returns the distance from the sonar to the quay's wall along a bearing, by the scene's script and the deployment
 *  [m]. */
double wallAt(double angle) {
    const double wall = numbersIn(readFile(checkout / "scripts/scenes/make_harbour.py"), "QUAY = ([\\d.]+)").at(0);
    const double vehicle = numbersIn(readFile(ping_360), "position: \\[([-\\d.]+), ([-\\d.]+), ([-\\d.]+)\\]").at(1);
    const double to_port = (200 - angle) * std::numbers::pi / 200;
    return (wall - vehicle) / std::sin(to_port);
}

/** Returns the water's depth below the vehicle's sounder, by the floor in the scene's script [m]. */
double bottomBelow() {
    const TestFolder folder;
    const std::string program = "import sys; sys.dont_write_bytecode = True; sys.path.insert(0, '" +
                                (checkout / "scripts/scenes").string() +
                                "'); import numpy; from make_harbour import *; "
                                "print(-5.8 - Floor(fractal_surface(numpy.random.default_rng(2017))).z(17, -1))";
    return std::stod(python(folder, program).out);
}

}  // namespace

TEST_F(PingDriverTest, AScanOfAllAnglesByUdpHasTheWallAtItsRange) {
    const json reported = driven("ping360 " + udpPort("ping360"));
    EXPECT_EQ(reported["information"]["device_type"], 2);
    ASSERT_EQ(reported["scan"].size(), 400u);
    int compared = 0;
    for (const json& echoes : reported["scan"]) {
        const double angle = echoes["angle"];
        const double off = std::abs(angle - 100);  // the wall is abeam to port, behind a ladder and between piles
        EXPECT_EQ(echoes["number_of_samples"], 800);
        EXPECT_EQ(echoes["sample_period"], 1000);
        EXPECT_EQ(echoes["transmit_frequency"], 750);
        if (off < 6 || off > 16) continue;
        EXPECT_NEAR(firstReturn(echoes, computeRange(echoes)), wallAt(angle), 0.1) << angle;
        ++compared;
    }
    EXPECT_EQ(compared, 22);
    EXPECT_EQ(reported["coarser"]["data"].size(), 400u);
    EXPECT_NEAR(firstReturn(reported["coarser"], computeRange(reported["coarser"])), wallAt(90), 0.1)
        << "with other samples";
    EXPECT_EQ(reported["refusals"][0]["id"], 2601);
    EXPECT_EQ(reported["refusals"][0]["text"], "angle is 400; must be 0 to 399");
    EXPECT_EQ(reported["refusals"][1]["text"], "number_of_samples is 5000; must be 200 to 1200");
    const auto angles = reported["automatic"]["angles"].get<std::vector<int>>();
    ASSERT_EQ(angles.size(), 8u);
    for (const int angle : angles) EXPECT_TRUE(angle >= 95 && angle <= 99) << angle;
    EXPECT_EQ(reported["automatic"]["stopped"], 2903);
}

TEST_F(PingDriverTest, TheSerialLineGivesTheSame) {
    const json reported = driven("ping360 " + makeLine("ping360") + " 90 110 20");
    for (const json& echoes : reported["scan"])
        EXPECT_NEAR(firstReturn(echoes, computeRange(echoes)), wallAt(echoes["angle"]), 0.1) << echoes["angle"];
    EXPECT_EQ(reported["scan"].size(), 2u);
    EXPECT_EQ(reported["automatic"]["angles"].size(), 8u);
}

TEST_F(PingDriverTest, AnEchoSounderFindsTheBottomByUdpAndBySerialLine) {
    const double bottom = bottomBelow();
    for (const std::string& line : {udpPort("ping1d"), makeLine("ping1d")}) {
        const json reported = driven("ping1d " + line);
        EXPECT_EQ(reported["information"]["device_type"], 1) << line;
        EXPECT_EQ(reported["range"]["scan_length"], 6000) << line;
        EXPECT_EQ(reported["profile"]["profile_data"].size(), 200u) << line;
        EXPECT_NEAR(reported["profile"]["distance"].get<double>() / 1000, bottom, 0.1) << line;
        EXPECT_EQ(reported["distance"]["distance"], reported["profile"]["distance"]) << "nothing has moved";
        EXPECT_EQ(reported["simple"]["distance"], reported["profile"]["distance"]) << line;
        EXPECT_GT(reported["simple"]["confidence"], 80) << line;
        const auto pings = reported["streamed"].get<std::vector<int>>();
        EXPECT_TRUE(std::ranges::is_sorted(pings)) << line;
        EXPECT_EQ(pings.size(), 5u) << line;
    }
}
