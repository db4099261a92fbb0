#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <map>
#include <stdexcept>
#include <vector>

#include "components/viewer/Server.hpp"
#include "tests/viewer/Bench.hpp"
#include "tests/viewer/Client.hpp"

namespace insonify::viewer {
namespace {

/** Throws in every function. */
struct Throwing final : ServerHandler {
    std::optional<PageFile> file(std::string_view) override { throw std::runtime_error("no files today"); }
    std::vector<Frame> greeting() override { return {}; }
    void request(uint64_t, std::string) override { throw std::runtime_error("no answers today"); }
    void parameters(uint64_t, ParameterRequest, bool) override { throw std::runtime_error("no parameters today"); }
    void subscribed(const std::vector<uint32_t>&) override { throw std::runtime_error("no subscriptions today"); }
    void subscribedToParameters() override { throw std::runtime_error("no subscriptions today"); }
};

TEST(ServerTest, AnErrorClosesOnlyItsSession) {
    Throwing throwing;
    Server server({}, throwing);
    EXPECT_EQ(Client(server.port()).get("/"), "");
    EXPECT_EQ(server.consumeWarning(), "1 connection refused; the last: an error in this server: no files today");
    Client asks(server.port()), silent(server.port());
    for (Client* client : {&asks, &silent}) ASSERT_THAT(client->upgrade(page_protocol), testing::HasSubstr("101"));
    asks.say("{}");
    EXPECT_EQ(asks.nextMessage(), std::nullopt);
    EXPECT_TRUE(becomesTrue([&] { return server.counts().clients == 1; }));
    EXPECT_EQ(server.counts().refused, 2u);
    server.toPages(0, {"", toBytes("still there"), true});
    EXPECT_EQ(silent.textOfNext(), "still there");
}

/** Serves one file, and nothing else. */
struct Quiet final : ServerHandler {
    std::optional<PageFile> file(std::string_view) override { return PageFile{"text/plain", "a page"}; }
    std::vector<Frame> greeting() override { return {}; }
    void request(uint64_t, std::string) override {}
    void parameters(uint64_t, ParameterRequest, bool) override {}
    void subscribed(const std::vector<uint32_t>&) override {}
    void subscribedToParameters() override {}
};

TEST(ServerTest, CountsHandshakesUnderWayAsClients) {
    Quiet quiet;
    ServerOptions options;
    options.clients = 3;
    Server server(options, quiet);
    std::vector<Client> asking;
    for (int i = 0; i < 12; ++i) asking.emplace_back(server.port());
    for (Client& client : asking) client.sendUpgrade(page_protocol);
    std::map<std::string, int> answers;
    for (Client& client : asking) ++answers[client.upgraded()];
    EXPECT_THAT(answers, testing::ElementsAre(testing::Pair(testing::HasSubstr("101"), 3),
                                              testing::Pair(testing::HasSubstr("503"), 9)));
    asking.clear();
    EXPECT_TRUE(becomesTrue([&] { return server.counts().clients == 0; }));
}

/** Serves one file, but the one that is slow only when it is let. */
struct Slow final : ServerHandler {
    std::optional<PageFile> file(std::string_view path) override {
        if (path == "/slow") {
            is_asked = true;
            released.wait();
        }
        return PageFile{"text/plain", "a page"};
    }
    std::vector<Frame> greeting() override { return {}; }
    void request(uint64_t, std::string) override {}
    void parameters(uint64_t, ParameterRequest, bool) override {}
    void subscribed(const std::vector<uint32_t>&) override {}
    void subscribedToParameters() override {}

    std::atomic<bool> is_asked{false};
    std::promise<void> release;
    std::shared_future<void> released{release.get_future()};
};

/** A full server has read the request of its oldest connection, and is still answering it, when another connection
 *  takes its place: both happen while the server's thread is busy. */
TEST(ServerTest, AHandshakeThatIsEvictedIsCountedNoLonger) {
    constexpr size_t spare = 32;  // connections in addition to clients
    Slow slow;
    ServerOptions options;
    options.clients = 1;
    Server server(options, slow);
    Client oldest(server.port()), blocks(server.port());
    std::vector<Client> asked;
    for (size_t i = 2; i < options.clients + spare; ++i) {
        asked.emplace_back(server.port());
        asked.back().send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
        ASSERT_THAT(asked.back().upgraded(), testing::HasSubstr("200"));
    }
    blocks.send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(becomesTrue([&] { return slow.is_asked.load(); }));
    oldest.sendUpgrade(page_protocol);
    Client newest(server.port());
    newest.sendUpgrade(page_protocol);
    slow.release.set_value();
    EXPECT_THAT(newest.upgraded(), testing::HasSubstr("101")) << "no other client is connected";
    EXPECT_EQ(server.counts().clients, 1u);
}

TEST(ServerTest, AHostIsOwnWithANumberAsItsPortOnly) {
    for (const char* own : {"localhost", "localhost:8080", "127.0.0.1", "127.0.0.1:1", "192.168.2.3:65535", "[::1]",
                            "[::1]:8080", "[fe80::1]:80"})
        EXPECT_TRUE(isOwnName(own)) << own;
    for (const char* other : {"",
                              ":80",
                              "localhost:",
                              "localhost:x",
                              "127.0.0.1:1@evil",
                              "127.0.0.1:80:80",
                              "127.0.0.1:65536",
                              "127.0.0.1:-1",
                              "127.0.0.1: 80",
                              "127.0.0.1:80 ",
                              "127.0.0.1.evil",
                              "evil",
                              "localhost.evil:80",
                              "[::1",
                              "[",
                              "[]",
                              "[::1]80",
                              "[::1]:",
                              "[::1]evil",
                              "[::1]:1@evil",
                              "[127.0.0.1]",
                              "::1",
                              "user@127.0.0.1:80"})
        EXPECT_FALSE(isOwnName(other)) << other;
    for (int port = 0; port < 70'000; port += 7)
        EXPECT_EQ(isOwnName("127.0.0.1:" + std::to_string(port)), port <= 65535) << port;
}

/** Otherwise a link on the page would reveal the token in its address. */
TEST(ServerTest, DoesNotSendThePagesAddressAsReferrer) {
    Quiet quiet;
    Server server({}, quiet);
    EXPECT_THAT(Client(server.port()).get("/?token=secret"), testing::HasSubstr("Referrer-Policy: no-referrer\r\n"));
}

TEST(ServerTest, CountsReplacedFramesForEachClient) {
    Quiet quiet;
    Server server({}, quiet);
    Client client(server.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    ASSERT_TRUE(becomesTrue([&] { return server.pages() == 1; }));
    constexpr uint64_t published = 20000;
    for (uint64_t i = 0; i < published; ++i) server.toPages(0, {"", toBytes("sample"), true});
    server.toPages(1, {"", toBytes("last"), true});
    uint64_t textOfNext = 0;
    while (client.textOfNext() == "sample") ++textOfNext;
    EXPECT_EQ(textOfNext + server.counts().dropped, published);
}

}  // namespace
}  // namespace insonify::viewer
