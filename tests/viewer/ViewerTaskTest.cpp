#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <span>

#include "components/ros/Cdr.hpp"
#include "components/viewer/ViewerTask.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "tests/viewer/Bench.hpp"
#include "tests/viewer/Client.hpp"
#include "tests/viewer/Running.hpp"

namespace insonify::viewer {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

ViewerConfig viewerAt(const std::string& address, const std::string& token = "") {
    ViewerConfig config;
    config.address = address;
    config.token = token;
    return config;
}

TEST(ViewerTaskTest, AnAddressReachableByOthersNeedsAToken) {
    for (const char* local : {"127.0.0.1", "127.1.2.3", "::1"})
        EXPECT_THAT(test::countRefusals(viewerAt(local)), IsEmpty()) << local;
    for (const char* open : {"0.0.0.0", "192.168.0.1", "::"}) {
        EXPECT_THAT(test::countRefusals(viewerAt(open)), Contains(HasSubstr("token: is missing"))) << open;
        EXPECT_THAT(test::countRefusals(viewerAt(open, "secret")), IsEmpty()) << open;
    }
    EXPECT_THAT(test::countRefusals(viewerAt("localhost", "secret")),
                Contains(HasSubstr("address: is 'localhost'; it must be a numeric address")));
}

TEST(ViewerTaskTest, ReportsAPortInUse) {
    Bench first;
    first.start();
    ViewerTask second("second");
    ViewerConfig config;
    config.port = first.port();
    second.config.set(config);
    EXPECT_FALSE(second.configure());
    ASSERT_NE(second.configError(), nullptr);
    EXPECT_THAT(second.configError()->what(),
                testing::AllOf(HasSubstr("second.port: is " + std::to_string(first.port())),
                               HasSubstr("Address already in use"), HasSubstr("0 for any free port")));
}

TEST(ViewerTaskTest, ReportsAnAddressOfAnotherMachine) {
    ViewerTask viewer("viewer");
    viewer.config.set(viewerAt("203.0.113.7", "secret"));  // reserved for examples
    EXPECT_FALSE(viewer.configure());
    ASSERT_NE(viewer.configError(), nullptr);
    EXPECT_THAT(viewer.configError()->what(), HasSubstr("viewer.address: is 203.0.113.7, on which nothing can listen"));
}

TEST(ViewerTaskTest, ReadsATokenFromAFile) {
    const Folder folder;
    Bench bench;
    bench.viewer.environment().input_folder = folder.path();
    ViewerConfig config;
    config.token_file = "token.txt";
    ViewerConfig open = config, both = config;
    open.address = "0.0.0.0";
    EXPECT_THAT(test::countRefusals(open), IsEmpty());
    both.token = "x";
    EXPECT_THAT(test::countRefusals(both), Contains(HasSubstr("token_file: is given in addition to token")));
    config.port = 0;
    bench.viewer.config.set(config);
    EXPECT_FALSE(bench.viewer.configure());
    EXPECT_THAT(bench.viewer.configError()->what(), HasSubstr("viewer.token_file: is "));
    std::ofstream(folder / "token.txt") << "open sesame\n";
    ASSERT_TRUE(bench.viewer.recover());
    ASSERT_TRUE(bench.viewer.configure() && bench.viewer.start()) << bench.viewer.lastError();
    EXPECT_THAT(Client(bench.port()).get("/?token=open%20sesame"), testing::StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(Client(bench.port()).get("/"), testing::StartsWith("HTTP/1.1 401"));
}

TEST(ViewerTaskTest, TheNoticeHasTheFreePort) {
    Bench bench;
    EXPECT_TRUE(bench.viewer.notices().empty());
    bench.start();
    EXPECT_THAT(bench.viewer.notices(),
                testing::ElementsAre("open http://127.0.0.1:" + std::to_string(bench.port()) + "/"));
    const uint16_t port = bench.port();
    ASSERT_TRUE(bench.viewer.stop());
    ASSERT_TRUE(bench.viewer.cleanup());
    EXPECT_FALSE(Client(port).connected());
}

/** A type that is not a sample. */
struct Unknown {
    static constexpr const char* type_name = "/unknown";
};

TEST(ViewerTaskTest, RefusesATypeThatItCannotShowByName) {
    ViewerTask viewer("viewer");
    test::Writer<std::shared_ptr<const Unknown>> source("depth");
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { viewer.makeInput("x", source.port); }),
                HasSubstr("depth.port is /unknown, which a viewer cannot show"));
}

TEST(ViewerTaskTest, APingOfTheWrongShapeIsAnErrorUntilTheNext) {
    Bench bench;
    bench.start();
    const auto bad = blockPing();
    bad->bins.pop_back();
    bench.show(bad);
    EXPECT_EQ(bench.viewer.state(), framework::TaskState::RunTimeError);
    EXPECT_THAT(bench.viewer.lastError(), HasSubstr("has other numbers of bins or bearings than it says"));
    bench.show(blockPing());
    EXPECT_EQ(bench.viewer.state(), framework::TaskState::Running);
}

TEST(ViewerTaskTest, AcceptsAllKindsOfSamples) {
    Bench bench;
    Feed<types::Pose> pose(bench.viewer, "vehicle");
    Feed<types::ImagePtr> image(bench.viewer, "fan");
    Feed<types::SnapshotPtr> scene(bench.viewer, "scene");
    bench.start();
    Client client(bench.port());
    EXPECT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
    ASSERT_TRUE(client.nextMessage());
    const auto channels = nlohmann::json::parse(client.textOfNext())["channels"];
    std::vector<std::pair<std::string, std::string>> topics;
    for (const auto& channel : channels) topics.emplace_back(channel["topic"], channel["schemaName"]);
    using testing::Pair;
    EXPECT_THAT(topics, testing::ElementsAre(Pair("/sonar/port", "marine_acoustic_msgs/ProjectedSonarImage"),
                                             Pair("/sonar/port/image", "sensor_msgs/Image"),
                                             Pair("/sonar/port/points", "sensor_msgs/PointCloud2"),
                                             Pair("/vehicle/port", "geometry_msgs/PoseStamped"),
                                             Pair("/vehicle/port/transforms", "foxglove_msgs/FrameTransforms"),
                                             Pair("/fan/port", "sensor_msgs/Image"),
                                             Pair("/scene/port", "geometry_msgs/PoseStamped"),
                                             Pair("/scene/port/transforms", "foxglove_msgs/FrameTransforms"),
                                             Pair("/scene/port/scene", "foxglove_msgs/SceneUpdate")));
}

// -- in a deployment --------------------------------------------------------------------------------------------------

/** Sends a request and returns the answer. */
nlohmann::json replyTo(Client& client, const std::string& request) {
    client.say(request);
    while (const auto message = client.nextMessage()) {
        const auto json = nlohmann::json::parse(*message, nullptr, false);
        if (json.is_object() && json["type"] == "answer") return json;
    }
    return nullptr;
}

TEST(ViewerTaskTest, APageSetsPropertiesButNoStates) {
    Running running;
    Client client(running.port());
    ASSERT_THAT(client.upgrade(page_protocol), HasSubstr("101"));
    const auto done = replyTo(client, R"({"id":4,"call":"source.setLevel","arguments":["7.5"]})");
    EXPECT_EQ(done["id"], 4);
    EXPECT_EQ(done["result"], "");
    EXPECT_EQ(std::get<double>(running.deployment().task("source")->record().properties.at("level")), 7.5);
    const auto refused = [&](const std::string& call, const std::string& argument) {
        return replyTo(client, R"({"call":")" + call + R"(","arguments":[")" + argument + "\"]}")["refused"]
            .get<std::string>();
    };
    EXPECT_THAT(refused("source.setLevel", "700"), HasSubstr("level: is 700"));
    EXPECT_THAT(refused("source.setLevl", "7"), HasSubstr("no operation setLevl"));
    EXPECT_THAT(refused("sauce.setLevel", "7"), HasSubstr("no task sauce"));
    EXPECT_THAT(refused("source.stop", ""), HasSubstr("states of tasks"));
    EXPECT_THAT(refused("viewer.setPort", "1"), HasSubstr("does not control itself"));
    EXPECT_THAT(replyTo(client, "nonsense")["refused"], "is not a JSON object");
}

/** Returns the next text message with this op. */
nlohmann::json getNext(Client& client, const std::string& op) {
    while (const auto message = client.nextMessage()) {
        const auto json = nlohmann::json::parse(*message, nullptr, false);
        if (json.is_object() && json["op"] == op) return json;
    }
    return nullptr;
}

/** Returns the values by name, from parameterValues. */
std::map<std::string, nlohmann::json> valuesIn(const nlohmann::json& message) {
    std::map<std::string, nlohmann::json> values;
    for (const auto& one : message["parameters"]) values[one["name"]] = one["value"];
    return values;
}

TEST(ViewerTaskTest, FoxglovesParametersAreThePropertiesOfTasks) {
    Running running;
    Client client(running.port());
    ASSERT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
    client.say(R"({"op":"getParameters","parameterNames":[],"id":"all"})");
    auto said = getNext(client, "parameterValues");
    EXPECT_EQ(said["id"], "all");
    EXPECT_EQ(valuesIn(said).at("source.level"), 1);
    EXPECT_EQ(valuesIn(said).at("world.water"), true);
    EXPECT_TRUE(valuesIn(said).contains("viewer.port"));

    client.say(
        R"({"op":"setParameters","id":"one","parameters":[{"name":"source.level","value":7.5},{"name":"world.water","value":false}]})");
    said = getNext(client, "parameterValues");
    EXPECT_EQ(said["id"], "one");
    EXPECT_EQ(valuesIn(said).size(), 2u);
    EXPECT_EQ(valuesIn(said).at("source.level"), 7.5);
    EXPECT_EQ(std::get<double>(running.deployment().task("source")->record().properties.at("level")), 7.5);

    for (const auto& [name, why] : {std::pair("source.level", "source.level: level: is 700"),
                                    {"source.levl", "no operation setLevl"},
                                    {"sauce.level", "is not a property of any task"},
                                    {"source", "is not a property of any task"},
                                    {"viewer.port", "does not control itself"}}) {
        client.say(std::string(R"({"op":"setParameters","parameters":[{"name":")") + name + R"(","value":700}]})");
        const auto refused = getNext(client, "status");
        EXPECT_THAT(refused["message"].get<std::string>(), HasSubstr(why));
        EXPECT_EQ(refused["level"], 2);
    }
}

TEST(ViewerTaskTest, SendsFoxgloveParametersThatChange) {
    Running running;
    Client client(running.port());
    ASSERT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
    client.say(R"({"op":"subscribeParameterUpdates","parameterNames":["source.level"]})");
    EXPECT_EQ(valuesIn(getNext(client, "parameterValues")),
              (std::map<std::string, nlohmann::json>{{"source.level", 1}}))
        << "as it is";
    running.deployment().call("world.setWater", {"false"});
    running.deployment().call("source.setLevel", {"3"});
    for (nlohmann::json level = 1; level != 3;) {
        const auto reported = valuesIn(getNext(client, "parameterValues"));
        ASSERT_EQ(reported.size(), 1u) << "of this one alone";
        level = reported.at("source.level");
        ASSERT_TRUE(level == 1 || level == 3) << level;
    }
}

TEST(ViewerTaskTest, AWebSiteReadsParametersAndSetsThemOnlyWithTheToken) {
    Running running;
    Client client(running.port());
    ASSERT_THAT(client.upgrade(foxglove_protocol, "/", "Origin: https://app.foxglove.dev\r\n"), HasSubstr("101"));
    client.say(R"({"op":"setParameters","id":"x","parameters":[{"name":"source.level","value":9}]})");
    EXPECT_THAT(getNext(client, "status")["message"].get<std::string>(), HasSubstr("only with the viewer's token"));
    EXPECT_EQ(valuesIn(getNext(client, "parameterValues")).at("source.level"), 1);
}

/** Returns a plate and a door of one triangle of steel each. */
types::GeometryPtr plateAndDoor() {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->meshes.resize(1);
    geometry->meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry->meshes[0].indices = {0, 1, 2};
    geometry->meshes[0].clusters.resize(1);
    geometry->meshes[0].clusters[0].index_count = 3;
    geometry->materials.resize(1);
    geometry->materials[0].name = "Steel";
    geometry->objects = {{"plate", 0, glm::dmat4(1)}, {"door", 0, glm::dmat4(1)}};
    return geometry;
}

/** Returns a snapshot with the door moved north [m]. */
types::SnapshotPtr withDoorAt(const types::GeometryPtr& geometry, double north) {
    auto snapshot = std::make_shared<types::Snapshot>();
    snapshot->geometry = geometry;
    snapshot->sonar.target_frame = "world";
    if (north == 0) return snapshot;
    snapshot->moved = {{1, glm::dmat4(1)}};
    snapshot->moved[0].world_from_object[3] = {north, 0, 0, 1};
    return snapshot;
}

/** Returns the next message of a channel; empty if none arrives. */
foxglove::SceneUpdate nextScene(Client& client) {
    foxglove::SceneUpdate update;
    std::optional<std::string> message;
    do message = client.nextMessage();
    while (message && (*message)[0] != 1);
    if (message) ros::decode(std::span(*message).subspan(13), update);
    return update;
}

TEST(ViewerTaskTest, FoxgloveReceivesTheWholeSceneOnSubscriptionAndThenMovedObjects) {
    Bench bench;
    Feed<types::SnapshotPtr> scene(bench.viewer, "scene");
    bench.start();
    const types::GeometryPtr geometry = plateAndDoor();
    const auto show = [&](double north) {
        scene.write(withDoorAt(geometry, north));
        bench.viewer.update();
    };
    show(0);
    for (int i = 0; i < 2; ++i) {  // a later subscriber receives it too
        Client client(bench.port());
        ASSERT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
        client.say(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":5}]})");
        auto update = nextScene(client);
        ASSERT_EQ(update.entities.size(), 2u);
        EXPECT_EQ(update.deletions.size(), 1u);
        EXPECT_EQ(update.entities[0].id, "0 plate");
        EXPECT_EQ(update.entities[0].frame_id, "world");
        EXPECT_EQ(update.entities[0].triangles[0].indices, (std::vector<uint32_t>{0, 1, 2}));
        EXPECT_NEAR(update.entities[0].triangles[0].points[1].y, 1, 1e-6) << "north is y in ENU";
        EXPECT_NEAR(update.entities[0].triangles[0].color.r, 0.53, 1e-6);
        for (const double north : {4.0, 0.0}) {
            show(north);
            update = nextScene(client);
            ASSERT_EQ(update.entities.size(), 1u) << north;
            EXPECT_EQ(update.entities[0].id, "1 door");
            EXPECT_NEAR(update.entities[0].triangles[0].points[0].y, north, 1e-6);
            EXPECT_TRUE(update.deletions.empty());
        }
    }
}

TEST(ViewerTaskTest, APagePausesALockstepRunAndStepsIt) {
    Running running;
    Client client(running.port());
    ASSERT_THAT(client.upgrade(page_protocol), HasSubstr("101"));
    const auto time = [&] { return running.deployment().status().now.microseconds; };
    ASSERT_TRUE(becomesTrue([&] { return time() > 1'000'000; }));
    EXPECT_THAT(replyTo(client, R"({"id":1,"step":true})")["refused"], "cannot step: the deployment is not paused");
    EXPECT_EQ(replyTo(client, R"({"id":2,"pause":true})")["result"], "");
    const int64_t paused = time();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(time(), paused);
    EXPECT_EQ(replyTo(client, R"({"id":3,"step":true})")["result"], "");
    EXPECT_TRUE(becomesTrue([&] { return time() > paused; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(time(), paused + 10'000);
    EXPECT_EQ(replyTo(client, R"({"id":4,"pause":false})")["result"], "");
    EXPECT_TRUE(becomesTrue([&] { return time() > paused + 50'000; }));
}

}  // namespace
}  // namespace insonify::viewer
