// What clients receive, and what they cannot do, over a plain socket.
#include <gmock/gmock.h>

#include <atomic>
#include <cstring>
#include <future>
#include <mutex>
#include <optional>
#include <set>

#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"
#include "tests/viewer/Bench.hpp"
#include "tests/viewer/Client.hpp"

namespace insonify::viewer {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

template <class T>
T at(const std::string& bytes, size_t place) {
    T value;
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

/** Returns a page that has received its first message. */
Client page(uint16_t port) {
    Client client(port);
    EXPECT_THAT(client.upgrade(page_protocol), HasSubstr("101"));
    EXPECT_EQ(json::parse(client.nextMessage().value_or("{}"))["type"], "interfaces");
    return client;
}

/** Returns the JSON of the next ping that a page receives. */
json nextPing(Client& client) {
    while (const auto message = client.nextMessage())
        if (message->size() > 8 && at<uint32_t>(*message, 0) == ping_kind)
            return json::parse(message->substr(8, at<uint32_t>(*message, 4)));
    return nullptr;
}

TEST(ClientTest, ServesThePageAndItsFiles) {
    Bench bench;
    bench.start();
    EXPECT_THAT(Client(bench.port()).get("/"),
                testing::AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("<title>Insonify")));
    EXPECT_THAT(Client(bench.port()).get("/fan.js?x"),
                testing::AllOf(HasSubstr("text/javascript"), HasSubstr("class Fan")));
    EXPECT_THAT(Client(bench.port()).get("/../etc/passwd"), StartsWith("HTTP/1.1 404"));
    Client post(bench.port());
    post.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n");
    EXPECT_THAT(post.get("/"), StartsWith("HTTP/1.1 405"));
}

TEST(ClientTest, SendsFoxgloveItsChannelAndThePingAsACdrMessage) {
    Bench bench;
    bench.start();
    Client client(bench.port());
    EXPECT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
    EXPECT_THAT(client.head(), HasSubstr("Sec-WebSocket-Protocol: foxglove.websocket.v1"));
    EXPECT_EQ(json::parse(client.textOfNext())["op"], "serverInfo");
    const json channel = json::parse(client.textOfNext())["channels"][0];
    EXPECT_EQ(channel["topic"], "/sonar/port");
    EXPECT_EQ(channel["schemaName"], "marine_acoustic_msgs/ProjectedSonarImage");
    client.say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":99}]})");
    EXPECT_THAT(client.textOfNext(), HasSubstr("no channel 99"));
    client.say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":0}]})");
    client.say("is the subscription taken?");
    EXPECT_THAT(client.textOfNext(), HasSubstr("not a JSON object"));
    bench.show(blockPing());

    const std::string message = client.textOfNext();
    ASSERT_GT(message.size(), 13u);
    EXPECT_EQ(message[0], 1);
    EXPECT_EQ(at<uint32_t>(message, 1), 5u);
    EXPECT_EQ(at<uint64_t>(message, 5), 3'000'000'000u);
    ros::ProjectedSonarImage image;
    ros::decode(std::span(message).subspan(13), image);
    EXPECT_EQ(image.image.beam_count, 32u);
    const auto shown = blockPing();  // float32, bin by bin
    const auto bin = [&](size_t beam, size_t k) {
        float value = 0;
        std::memcpy(&value, image.image.data.data() + (k * 32 + beam) * sizeof value, sizeof value);
        return value;
    };
    ASSERT_EQ(image.image.data.size(), shown->bins.size() * sizeof(float));
    EXPECT_EQ(bin(15, 45), shown->bins[15 * shown->bin_count + 45]);
    EXPECT_EQ(bin(25, 45), shown->bins[25 * shown->bin_count + 45]);
    EXPECT_NE(bin(15, 45), bin(25, 45));
}

TEST(ClientTest, FoxglovesNewerProtocolIsTheSame) {
    Bench bench;
    bench.start();
    for (const auto& [offered, agreed] : {std::pair("foxglove.sdk.v1", "foxglove.sdk.v1"),
                                          {"foxglove.sdk.v1, foxglove.websocket.v1", "foxglove.sdk.v1"},
                                          {"foxglove.sdk.v2,foxglove.websocket.v1", "foxglove.websocket.v1"}}) {
        Client client(bench.port());
        EXPECT_THAT(client.upgrade(offered), HasSubstr("101"));
        EXPECT_THAT(client.head() + "\r\n", HasSubstr(std::string("Sec-WebSocket-Protocol: ") + agreed + "\r\n"));
        EXPECT_EQ(json::parse(client.textOfNext())["op"], "serverInfo");
        EXPECT_EQ(json::parse(client.textOfNext())["op"], "advertise");
    }
    EXPECT_THAT(Client(bench.port()).upgrade("foxglove.sdk.v10"), HasSubstr("400"));
}

TEST(ClientTest, EachServerHasItsOwnSession) {
    std::set<std::string> sessions;
    for (int i = 0; i < 2; ++i) {
        Bench bench;
        bench.start();
        for (int k = 0; k < 2; ++k) {
            Client client(bench.port());
            ASSERT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
            sessions.insert(json::parse(client.textOfNext())["sessionId"].get<std::string>());
        }
    }
    EXPECT_EQ(sessions.size(), 2u) << "the same after a reconnection, another after a restart";
}

TEST(ClientTest, SendsFoxgloveTheTimeOfTheDeployment) {
    Bench bench;
    bench.start();
    Client client(bench.port());
    ASSERT_THAT(client.upgrade(foxglove_sdk_protocol), HasSubstr("101"));
    client.textOfNext();
    client.textOfNext();
    bench.show(blockPing());
    const std::string time = client.textOfNext();
    ASSERT_EQ(time.size(), 9u);
    EXPECT_EQ(time[0], 2);
    EXPECT_EQ(at<uint64_t>(time, 1), 3'500'000'000u) << "the clock, not the stamp";
}

TEST(ClientTest, SendsTheNewestSampleAtOnceToANewSubscriber) {
    Bench bench;
    bench.start();
    bench.show(blockPing());
    Client client(bench.port());
    ASSERT_THAT(client.upgrade(foxglove_protocol), HasSubstr("101"));
    client.say(R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":1}]})");
    while (const auto message = client.nextMessage()) {
        if ((*message)[0] != 1) continue;
        ros::Image image;
        ros::decode(std::span(*message).subspan(13), image);
        EXPECT_EQ(image.encoding, "mono8");
        return;
    }
    FAIL() << "no picture came";
}

TEST(ClientTest, SendsAPageTheLastPingAtOnceAndEachFollowingPing) {
    Bench bench;
    bench.start();
    bench.show(blockPing(1'000'000));
    Client client = page(bench.port());
    const json first = nextPing(client);
    EXPECT_EQ(first["time_us"], 1'000'000);
    EXPECT_EQ(first["source"], "sonar.port");
    EXPECT_EQ(first["latency_s"], 2.5);
    bench.show(blockPing(2'000'000));
    EXPECT_EQ(nextPing(client)["time_us"], 2'000'000);
}

TEST(ClientTest, RefusesAWrongTokenWith401) {
    ViewerConfig config;
    config.token = "open sesame";
    Bench bench(config);
    bench.start();
    EXPECT_THAT(Client(bench.port()).get("/"), StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(Client(bench.port()).get("/?token=open%20sesame"), StartsWith("HTTP/1.1 200"));
    for (const char* protocol : {page_protocol, foxglove_protocol}) {
        EXPECT_THAT(Client(bench.port()).upgrade(protocol, "/?token=open"), HasSubstr("401")) << protocol;
        EXPECT_THAT(Client(bench.port()).upgrade(protocol, "/?token=open%20sesame"), HasSubstr("101")) << protocol;
    }
    EXPECT_EQ(bench.viewer.counts().refused, 3u);
}

TEST(ClientTest, OtherWebSitesCanNeitherControlNorRead) {
    Bench bench;
    bench.start();
    EXPECT_THAT(Client(bench.port()).upgrade(page_protocol, "/", "Origin: http://evil.example\r\n"), HasSubstr("403"));
    EXPECT_THAT(Client(bench.port()).upgrade(page_protocol, "/", "Origin: http://localhost\r\n"), HasSubstr("101"));
    EXPECT_THAT(Client(bench.port()).upgrade(foxglove_protocol, "/", "Origin: http://evil.example\r\n"),
                HasSubstr("403"));
    EXPECT_THAT(Client(bench.port()).upgrade(foxglove_protocol, "/", "Origin: https://app.foxglove.dev\r\n"),
                HasSubstr("101"));
    EXPECT_THAT(Client(bench.port()).upgrade("other.protocol"), HasSubstr("400"));
}

/** Returns everything received until the connection is closed. */
std::string answerTo(uint16_t port, const std::string& bytes) {
    Client client(port);
    client.send(bytes);
    return client.rest();
}

TEST(ClientTest, AnswersAndCountsInvalidRequests) {
    Bench bench;
    std::vector<std::string> warnings;
    std::mutex mutex;
    bench.viewer.environment().warn = [&](const std::string& text) {
        std::lock_guard lock(mutex);
        warnings.push_back(text);
    };
    bench.start();
    const uint16_t port = bench.port();
    EXPECT_THAT(answerTo(port, std::string(2000, '\xee') + "\r\n\r\n"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(answerTo(port, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello"),
                StartsWith("HTTP/1.1 413"));
    EXPECT_THAT(answerTo(port, "PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1073741824\r\n\r\n" +
                                   std::string(100'000, 'x')),
                StartsWith("HTTP/1.1 413"));
    EXPECT_THAT(answerTo(port, "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n"),
                StartsWith("HTTP/1.1 431"));
    EXPECT_EQ(bench.viewer.counts().refused, 4u);
    const auto reported = [&] {
        std::lock_guard lock(mutex);
        return !warnings.empty();
    };
    EXPECT_TRUE(becomesTrue(reported));
    std::lock_guard lock(mutex);
    EXPECT_THAT(warnings, testing::Each(testing::MatchesRegex("viewer: [1-4] connections? refused; the last: .*")));
    EXPECT_THAT(bench.viewer.notices(), testing::Contains("4 connections refused"));
}

TEST(ClientTest, InvalidFramesCloseOnlyThatClientAndAreCounted) {
    Bench bench;
    bench.start();
    Client good = page(bench.port());
    const std::pair<std::string, int> frames[] = {{std::string(500, '\xff'), 1002},
                                                  {std::string("\x81\x02hi", 4), 1002},  // not masked
                                                  {std::string("\x82\xff\0\0\0\0\x40\0\0\0abcd", 14), 1009}};  // 2^30 B
    for (const auto& [bytes, code] : frames) {
        Client client = page(bench.port());
        client.send(bytes);
        while (client.nextMessage()) {
        }
        EXPECT_EQ(client.closeCode(), code);
    }
    EXPECT_TRUE(becomesTrue([&] { return bench.viewer.counts().clients == 1; }));
    EXPECT_EQ(bench.viewer.counts().refused, 3u);
    bench.show(blockPing());
    EXPECT_EQ(nextPing(good)["count"], 1);
}

TEST(ClientTest, UnfinishedRequestsBlockNobody) {
    Bench bench;
    bench.start();
    std::vector<Client> halves;
    for (int i = 0; i < 100; ++i) {
        halves.emplace_back(bench.port());
        halves.back().send("GET / HTTP/1.1\r\nHost: ");
    }
    EXPECT_THAT(Client(bench.port()).get("/"), StartsWith("HTTP/1.1 200"));
    Client client = page(bench.port());
    bench.show(blockPing());
    EXPECT_EQ(nextPing(client)["count"], 1);
    EXPECT_GT(bench.viewer.counts().refused, 50u);
    EXPECT_EQ(halves.back().rest(), "") << "given up after five seconds";
}

TEST(ClientTest, RefusesMoreClientsThanTheMax) {
    ViewerConfig config;
    config.clients = 2;
    Bench bench(config);
    bench.start();
    const Client first = page(bench.port()), second = page(bench.port());
    EXPECT_THAT(Client(bench.port()).upgrade(page_protocol), HasSubstr("503"));
    EXPECT_THAT(Client(bench.port()).get("/"), StartsWith("HTTP/1.1 200")) << "files need no place";
}

TEST(ClientTest, ThousandsOfConnectionsBlockNobody) {
    Bench bench;
    bench.start();
    Client good = page(bench.port());
    int connected = 0;
    std::vector<Client> idle;
    for (int i = 0; i < 10000; ++i) {
        Client client(bench.port());
        connected += client.connected() ? 1 : 0;
        if (i < 200) idle.push_back(std::move(client));  // connections that stay open and send nothing
    }
    EXPECT_GT(connected, 9900);
    bench.show(blockPing(7'000'000));
    EXPECT_EQ(nextPing(good)["time_us"], 7'000'000);
    EXPECT_GT(bench.viewer.counts().refused, 0u);
}

TEST(ClientTest, AClientThatNeverReadsDelaysNoCycleAndLosesTheOldest) {
    Bench bench;
    bench.start();
    std::optional<Client> deaf(page(bench.port()));
    Client good = page(bench.port());
    const auto ping = blockPing(3'000'000, 256, 2000);
    std::atomic<int> shown{0};
    auto all = std::async(std::launch::async, [&] {
        for (; shown < 300; ++shown) {
            const auto sample = std::make_shared<types::Sonar>(*ping);
            sample->time = {shown + 1};
            bench.show(sample);
            EXPECT_EQ(nextPing(good)["time_us"], shown + 1);
        }
    });
    const bool continues = test::reaches(shown, 300);
    EXPECT_TRUE(continues) << "ping " << shown << " waits for a client that never reads";
    if (!continues) deaf.reset();
    all.get();
    EXPECT_GT(bench.viewer.counts().dropped, 200u) << "of 300 pings of 512 kB a socket holds few";
}

TEST(ClientTest, DisconnectsAClientThatDoesNotAnswer) {
    ViewerConfig config;
    config.idle_timeout = 1;
    Bench bench(config);
    bench.start();
    const Client silent = page(bench.port());  // a client, because it has received the first message
    EXPECT_TRUE(becomesTrue([&] { return bench.viewer.counts().clients == 0; }));
}

}  // namespace
}  // namespace insonify::viewer
