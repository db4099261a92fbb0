#include <gmock/gmock.h>

#include <stdexcept>

#include "components/viewer/Server.hpp"
#include "tests/viewer/Bench.hpp"
#include "tests/viewer/Client.hpp"

namespace insonify::viewer {
namespace {

/** Fails at everything. */
struct Throwing final : ServerHandler {
    std::optional<PageFile> file(std::string_view) override { throw std::runtime_error("no files today"); }
    std::vector<Frame> greeting() override { return {}; }
    void request(uint64_t, std::string) override { throw std::runtime_error("no answers today"); }
    void parameters(uint64_t, ParameterRequest, bool) override { throw std::runtime_error("no parameters today"); }
    void subscribed(const std::vector<uint32_t>&) override { throw std::runtime_error("no subscriptions today"); }
    void subscribedToParameters() override { throw std::runtime_error("no subscriptions today"); }
};

TEST(ServerTest, AnErrorClosesTheSessionThatItWasFor) {
    Throwing throwing;
    Server server({}, throwing);
    EXPECT_EQ(Client(server.port()).get("/"), "");
    EXPECT_EQ(server.takeWarning(), "1 connection refused; the last: an error of this server: no files today");
    Client asks(server.port()), silent(server.port());
    for (Client* client : {&asks, &silent}) ASSERT_THAT(client->upgrade(page_protocol), testing::HasSubstr("101"));
    asks.say("{}");
    EXPECT_EQ(asks.hear(), std::nullopt);
    EXPECT_TRUE(comesTrue([&] { return server.counts().clients == 1; }));
    EXPECT_EQ(server.counts().refused, 2u);
    server.toPages(0, {"", bytesOf("still there"), true});
    EXPECT_EQ(silent.heard(), "still there");
}

TEST(ServerTest, WhatIsReplacedBeforeItIsSentIsCountedForEachClient) {
    struct Quiet final : ServerHandler {
        std::optional<PageFile> file(std::string_view) override { return std::nullopt; }
        std::vector<Frame> greeting() override { return {}; }
        void request(uint64_t, std::string) override {}
        void parameters(uint64_t, ParameterRequest, bool) override {}
        void subscribed(const std::vector<uint32_t>&) override {}
        void subscribedToParameters() override {}
    } quiet;
    Server server({}, quiet);
    Client client(server.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    ASSERT_TRUE(comesTrue([&] { return server.pages() == 1; }));
    constexpr uint64_t published = 20000;
    for (uint64_t i = 0; i < published; ++i) server.toPages(0, {"", bytesOf("sample"), true});
    server.toPages(1, {"", bytesOf("last"), true});
    uint64_t heard = 0;
    while (client.heard() == "sample") ++heard;
    EXPECT_EQ(heard + server.counts().dropped, published);
}

}  // namespace
}  // namespace insonify::viewer
