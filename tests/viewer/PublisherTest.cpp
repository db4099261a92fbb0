#include <gmock/gmock.h>

#include <chrono>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "components/viewer/Publisher.hpp"
#include "tests/viewer/Bench.hpp"
#include "tests/viewer/Client.hpp"

namespace insonify::viewer {
namespace {

/** Returns the next answer, skipping other messages. */
nlohmann::json answer(Client& client) {
    while (const auto message = client.nextMessage()) {
        const auto json = nlohmann::json::parse(*message, nullptr, false);
        if (json.is_object() && json["type"] == "answer") return json;
    }
    return nullptr;
}

std::string call(uint64_t id, const std::string& operation) {
    return nlohmann::json{{"id", id}, {"call", operation}}.dump();
}

/** A deployment in which one task does not answer until it is released. */
class Blocked : public types::DeploymentControl {
    std::promise<void> release_;
    std::shared_future<void> released_{release_.get_future()};

public:
    Publisher publisher{config(), {}, {"viewer", this, [](const std::string&) {}}};

    types::DeploymentStatus status() const override { return {}; }
    std::vector<types::TaskInterface> interfaces() const override { return {{"deaf", {}, {}}, {"lively", {}, {}}}; }
    std::string call(const std::string& operation, const std::vector<std::string>&) override {
        if (operation == "deaf.ask") released_.wait();
        return operation;
    }
    void pause(bool) override {}
    void step() override {}
    void release() { release_.set_value(); }

private:
    static ViewerConfig config() {
        ViewerConfig config;
        config.port = 0;
        config.idle_timeout = 3600;
        return config;
    }
};

TEST(PublisherTest, ATaskThatDoesNotAnswerBlocksNoOther) {
    Blocked blocked;
    Client client(blocked.publisher.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    client.say(call(1, "deaf.ask"));
    client.say(call(2, "lively.ask"));
    EXPECT_EQ(answer(client)["id"], 2);
    client.say(R"({"id":3,"pause":false})");
    EXPECT_EQ(answer(client)["id"], 3);
    client.say(call(4, "unknown.ask"));
    EXPECT_EQ(answer(client)["id"], 4);
    blocked.release();
    EXPECT_EQ(answer(client)["result"], "deaf.ask");
}

TEST(PublisherTest, PagesCannotControlTheViewerAndTheStatesOfTasks) {
    Blocked blocked;
    Client client(blocked.publisher.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    client.say(call(1, "viewer.setControl"));
    EXPECT_THAT(answer(client)["refused"], testing::HasSubstr("the viewer does not control itself"));
    client.say(call(2, "lively.stop"));
    EXPECT_THAT(answer(client)["refused"], testing::HasSubstr("only the deployment changes the states of tasks"));
    client.say(call(3, "lively.stopwatch"));
    EXPECT_EQ(answer(client)["result"], "lively.stopwatch");
}

TEST(PublisherTest, RefusesARequestTooManyByItsId) {
    Blocked blocked;
    Client client(blocked.publisher.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    for (uint64_t id = 1; id <= SerialExecutors::max_waiting + 2; ++id) client.say(call(id, "deaf.ask"));
    const auto refused = answer(client);
    EXPECT_GT(refused["id"], SerialExecutors::max_waiting);
    EXPECT_THAT(refused["refused"], testing::HasSubstr("too many requests are waiting"));
    blocked.release();
}

// -- scenes for Foxglove ----------------------------------------------------------------------------------------------

/** Pings, then a scene: a source that takes long before a source that is sent once. */
class SceneBench {
public:
    static constexpr int ping_channel = 0, picture_channel = 1, scene_channel = 5;

    Publisher publisher{
        config(),
        {{"sonar", getForms<types::Sonar>("sonar"), false}, {"scene", getForms<types::Snapshot>("scene"), false}},
        {"viewer", nullptr, [](const std::string&) {}}};

    void offerPing(int64_t seconds, uint32_t beams = 32, uint32_t bins = 100) {
        publisher.offer(0, blockPing(seconds * 1'000'000, beams, bins), {seconds * 1'000'000});
    }
    void offerScene(int64_t seconds) {
        types::Snapshot snapshot;
        snapshot.geometry = std::make_shared<types::Geometry>();
        publisher.offer(1, std::make_shared<const types::Snapshot>(snapshot), {seconds * 1'000'000});
    }

private:
    static ViewerConfig config() {
        ViewerConfig config = Bench::patient();
        config.port = 0;
        config.clients = 128;
        return config;
    }
};

/** Returns a Foxglove client that the server knows. */
Client joined(const SceneBench& bench) {
    Client client(bench.publisher.port());
    client.upgrade(foxglove_protocol);
    EXPECT_THAT(client.textOfNext(), testing::HasSubstr("serverInfo"));
    EXPECT_THAT(client.textOfNext(), testing::HasSubstr("advertise"));
    return client;
}

void subscribe(Client& client, int channel) {
    client.say(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":)" + std::to_string(channel) + "}]}");
}

/** Returns whether a sample arrives, skipping other messages. */
bool receivesSample(Client& client) {
    const auto end = std::chrono::steady_clock::now() + test::patience;
    while (std::chrono::steady_clock::now() < end) {
        const auto message = client.nextMessage();
        if (!message || message->front() == 1) return message.has_value();
    }
    return false;
}

TEST(PublisherTest, ASubscriberDuringAnotherSourceReceivesTheSceneToo) {
    SceneBench bench;
    Client watcher = joined(bench);
    subscribe(watcher, SceneBench::scene_channel);
    bench.offerScene(1);
    ASSERT_TRUE(receivesSample(watcher)) << "it is new to nobody after this";
    Client busy = joined(bench);
    subscribe(busy, SceneBench::picture_channel);
    const std::jthread pings([&](const std::stop_token& stop) {
        for (int64_t i = 2; !stop.stop_requested(); ++i) bench.offerPing(i, 256, 1000);
    });
    for (int newcomer = 0; newcomer < 100; ++newcomer) {
        Client client = joined(bench);
        subscribe(client, SceneBench::scene_channel);
        ASSERT_TRUE(receivesSample(client)) << "newcomer " << newcomer;
    }
}

/** Returns the number of samples received before the server's clock shows this time. */
int samplesUntil(Client& client, uint64_t seconds) {
    int samples = 0;
    while (const auto message = client.nextMessage()) {
        if (*message == timeMessage(seconds * 1'000'000'000)) return samples;
        samples += message->front() == 1 ? 1 : 0;
    }
    ADD_FAILURE() << "the connection has ended";
    return samples;
}

TEST(PublisherTest, DoesNotSendASceneAgainForOtherSubscriptions) {
    SceneBench bench;
    Client watcher = joined(bench);
    bench.offerScene(1);
    EXPECT_EQ(samplesUntil(watcher, 1), 0);
    subscribe(watcher, SceneBench::scene_channel);
    ASSERT_TRUE(receivesSample(watcher));
    bench.offerPing(2);
    EXPECT_EQ(samplesUntil(watcher, 2), 0);
    Client other = joined(bench);
    subscribe(other, SceneBench::ping_channel);
    ASSERT_TRUE(receivesSample(other));
    bench.offerPing(3);
    EXPECT_EQ(samplesUntil(watcher, 3), 0);
}

}  // namespace
}  // namespace insonify::viewer
