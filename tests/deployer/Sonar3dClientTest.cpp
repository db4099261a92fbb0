// A Sonar 3D-15 with its maker's own client, PyPI's wlsonar: HTTP, unicast and multicast, and the received voxels.
#include <gmock/gmock.h>

#include "components/device/wire/Http.hpp"
#include "tests/deployer/HilRun.hpp"
#include "tests/support/Needs.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"
#include "tests/support/Wire.hpp"

namespace insonify::device {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double ball_radius = 0.8;  // [m]

/** A sonar at the origin looks north at a wall 5 m away, with a ball in front of it to port, above. */
std::string sonar3dIn(const TestFolder& folder) {
    writeFile(folder / "wall.world", wallAndBall(5, "3.5 1 0.6", ball_radius));
    writeFile(folder / "x.yml", R"(schedule: realtime
tasks:
  vehicle: {type: pose::TrajectoryTask, activity: {period: 0.05}, properties: {waypoints: [{time: 0, position: [0, 0, 0]}]}}
  scene: {type: scene::SceneTask, properties: {file: wall.world}}
  sonar:
    type: sonar::Sonar3dTask
    properties:
      range: 8
      range_rounding: exact
      bin_count: 1200
      speed_of_sound: 1500
      horizontal: {beam_count: 128, field_of_view_deg: 90}
      vertical: {beam_count: 64, field_of_view_deg: 40}
      beam_height_deg: 0.625
      quality: {rows: 4, columns_per_beam: 4}
  device: {type: device::Sonar3dTask}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: device.settings, to: sonar.settings, policy: {type: buffer, size: 4}}
  - {from: sonar.range_image, to: device.range_image, policy: {type: buffer, size: 4}}
)");
    return folder / "x.yml";
}

class Sonar3dClientTest : public ::testing::TestWithParam<bool> {};

TEST_P(Sonar3dClientTest, TheMakersClientSetsItAndReceivesTheWallAndTheBall) {
    INSONIFY_NEEDS("sdf");
    if (!pythonHas("wlsonar, numpy"))
        GTEST_SKIP() << "PyPI's wlsonar is not in " << python() << ": scripts/setup puts it there";
    const bool unicast = GetParam();
    const std::string group_port = std::to_string(20000 + getpid() % 20000);  // differs from that of a parallel test
    const TestFolder folder;
    HilRun run(sonar3dIn(folder), {"device.multicast_port=" + group_port});
    const int port = run.port();
    ASSERT_GT(port, 0) << readFile(run.folder() / "stderr.txt");
    const std::string script = test::sourceFile("tests/deployer/sonar3d_client.py ");
    const std::string said = pythonSays(script + std::to_string(port) + " " + (unicast ? "unicast" : group_port) + " " +
                                            (folder / "voxels.npz").string(),
                                        folder / "said.json");
    const json reported = json::parse(said, nullptr, false);
    ASSERT_FALSE(reported.is_discarded()) << said << readFile(run.folder() / "stderr.txt");
    if (reported.contains("no_multicast")) GTEST_SKIP() << "no multicast on this machine: " << reported["no_multicast"];
    std::cout << "wall " << reported["wall"] << ", ball " << reported["ball"] << "\n";
    EXPECT_EQ(reported["about"], "Sonar 3D-15");
    EXPECT_EQ(reported["ready"], true);
    EXPECT_EQ(reported["temperature"], 12.0);
    EXPECT_EQ(reported["enabled_at_first"], false);
    EXPECT_EQ(reported["kept"], json::parse(R"([1500.0, [0.3, 8.0], "low-frequency", "fresh", true, "10.0.0.1"])"));
    for (const json& refusal : reported["refused"]) EXPECT_EQ(refusal[0], 400) << refusal;
    EXPECT_THAT(reported["refused"][0][1].get<std::string>(), HasSubstr("must be 0 <= min < max <= 15"));
    EXPECT_EQ(reported["udp"], unicast ? "unicast" : "multicast");
    EXPECT_EQ(reported["size"], json({128, 64, 128, 64}));
    EXPECT_NEAR(reported["view"][0], 90.0 * 256 / 255 * 127 / 128, 1e-4) << "between the outermost of 128 columns";
    EXPECT_NEAR(reported["view"][1], 40.0 * 63 / 64, 1e-4);
    EXPECT_EQ(reported["frequency"], 1'200'000);
    EXPECT_EQ(reported["speed"], 1500.0);
    EXPECT_EQ(reported["strongest"], 10644) << "255 on the device's scale";
    EXPECT_EQ(reported["same_pixels"], true);
    EXPECT_GT(reported["age"], 0);

    EXPECT_GT(reported["wall"]["voxels"], 5000);
    EXPECT_NEAR(reported["wall"]["mean"], 5, 0.002);
    EXPECT_LT(reported["wall"]["worst"], 0.01) << "every voxel of a flat wall at 5 m";
    EXPECT_LT(reported["wall"]["worst_beside_ball"], 0.03) << "including beams partly hidden by the ball";
    EXPECT_GT(reported["ball"]["voxels"], 300);
    EXPECT_NEAR(reported["ball"]["radius"], ball_radius, 0.01);
    EXPECT_NEAR(reported["ball"]["centre"][0], 3.5, 0.01) << "ahead";
    EXPECT_NEAR(reported["ball"]["centre"][1], -1.0, 0.01) << "to port, where the client counts to starboard";
    EXPECT_NEAR(reported["ball"]["centre"][2], -0.6, 0.01) << "above, where the client counts down";
    EXPECT_EQ(reported["high"][0], 2'400'000);
    EXPECT_NEAR(reported["high"][1], 40.0 * 256 / 255 * 127 / 128, 1e-4);
    EXPECT_NEAR(reported["high_wall"], 5, 0.002);
    EXPECT_EQ(reported["synchronised"], true);
    EXPECT_THAT(run.stop(), deployer::succeeds());
}

INSTANTIATE_TEST_SUITE_P(Ways, Sonar3dClientTest, ::testing::Bool(),
                         [](const auto& unicast) { return unicast.param ? "Unicast" : "Multicast"; });

/** Clients that leave in the middle of a request, and one that asks and never reads, delay no other client. */
TEST(Sonar3dReconnectTest, SurvivesAThousandReconnectsAndAClientThatDoesNotRead) {
    INSONIFY_NEEDS("sdf");
    const TestFolder folder;
    HilRun run(sonar3dIn(folder), {});
    const int port = run.port();
    ASSERT_GT(port, 0) << readFile(run.folder() / "stderr.txt");
    const Bytes about = httpBytes(HttpRequest{"GET", "/api/v1/integration/about", ""}, "sonar");
    const Bytes enable = httpBytes(HttpRequest{"POST", "/api/v1/integration/acoustics/enabled", "true"}, "sonar");
    const Wire deaf(Wire::connected(port));
    for (int i = 0; i < 1000; ++i) {
        deaf.say(about);
        const Wire wire(Wire::connected(port));
        const Bytes& whole = i % 2 == 0 ? about : enable;
        wire.say({whole.begin(), whole.begin() + i % static_cast<int>(whole.size())});
    }
    const Wire last(Wire::connected(port));
    last.say(about);
    Bytes received;
    const auto text = [&] { return std::string(received.begin(), received.end()); };
    while (text().find("is_ready") == std::string::npos) {
        const Bytes more = last.receive();
        received.insert(received.end(), more.begin(), more.end());
    }
    EXPECT_THAT(text(), HasSubstr("HTTP/1.1 200 OK"));
    EXPECT_THAT(run.stop(), deployer::succeeds());
}

}  // namespace
}  // namespace insonify::device
