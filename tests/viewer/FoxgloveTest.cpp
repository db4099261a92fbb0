#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "components/viewer/Foxglove.hpp"

namespace insonify::viewer {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST(FoxgloveTest, AdvertisesChannelsWithTheirSchemas) {
    const json said = json::parse(advertise({{"/a/b", "pkg/Type", "int32 x\n"}, {"/c", "pkg/Other", ""}}));
    EXPECT_EQ(said["op"], "advertise");
    EXPECT_EQ(said["channels"][1]["id"], 1);
    EXPECT_EQ(said["channels"][0], (json{{"id", 0},
                                         {"topic", "/a/b"},
                                         {"encoding", "cdr"},
                                         {"schemaName", "pkg/Type"},
                                         {"schema", "int32 x\n"},
                                         {"schemaEncoding", "ros2msg"}}));
}

TEST(FoxgloveTest, AMessageBeginsWithItsSubscriptionAndTime) {
    EXPECT_EQ(messageHead(0x04030201, 0x0807060504030201), std::string("\1\1\2\3\4\1\2\3\4\5\6\7\x8", 13));
}

TEST(FoxgloveTest, TheServerSendsItsSessionTimeAndParameters) {
    const json said = json::parse(serverInfo("17"));
    EXPECT_EQ(said["op"], "serverInfo");
    EXPECT_EQ(said["sessionId"], "17");
    EXPECT_EQ(said["capabilities"], json({"time", "parameters", "parametersSubscribe"}));
    EXPECT_EQ(timeMessage(0x0807060504030201), std::string("\2\1\2\3\4\5\6\7\x8", 9));
}

TEST(FoxgloveTest, ReadsRequestsForParametersSettingsAndSubscriptions) {
    using enum ParameterRequest::Kind;
    EXPECT_EQ(readParameterRequest(R"({"op":"subscribe"})").kind, Other);
    EXPECT_EQ(readParameterRequest("[").kind, Other);
    const auto get = readParameterRequest(R"({"op":"getParameters","parameterNames":["a.b","c.d"],"id":"7"})");
    EXPECT_EQ(get.kind, Get);
    EXPECT_EQ(get.id, "7");
    EXPECT_THAT(get.names, ElementsAre("a.b", "c.d"));
    const auto set = readParameterRequest(
        R"({"op":"setParameters","parameters":[{"name":"a","value":2.5,"type":"float64"},{"name":"b","value":true},
            {"name":"c","value":"{rows: 3}"},{"name":"d","value":[1,2]},{"name":"e"}]})");
    EXPECT_EQ(set.kind, Set);
    EXPECT_FALSE(set.id);
    EXPECT_THAT(set.values, ElementsAre(Pair("a", "2.5"), Pair("b", "true"), Pair("c", "{rows: 3}"), Pair("d", "[1,2]"),
                                        Pair("e", "null")));
    for (const char* wrong :
         {R"({"op":"getParameters","parameterNames":[1]})", R"({"op":"setParameters","parameters":[1]})",
          R"({"op":"setParameters","parameters":[{"value":1}]})",
          R"({"op":"setParameters","parameters":[{"name":"a","value":"QQ==","type":"byte_array"}]})"})
        EXPECT_THROW(readParameterRequest(wrong), std::invalid_argument) << wrong;
    EXPECT_EQ(json::parse(parameterValues({{"a", "2.0"}, {"b", "3"}, {"c", "\"x\""}}, "7")),
              json::parse(R"({"op":"parameterValues","id":"7","parameters":[{"name":"a","value":2.0,"type":"float64"},
                              {"name":"b","value":3},{"name":"c","value":"x"}]})"));
}

TEST(FoxgloveTest, AParameterSubscriberReceivesOnlyItsParameters) {
    using enum ParameterRequest::Kind;
    ParameterSubscriptions wanted;
    EXPECT_FALSE(wanted.any());
    wanted.take({Subscribe, {}, {"a", "b"}, {}});
    wanted.take({Unsubscribe, {}, {"b"}, {}});
    EXPECT_TRUE(wanted.contains("a"));
    EXPECT_FALSE(wanted.contains("b"));
    wanted.take({Subscribe, {}, {}, {}});
    wanted.take({Unsubscribe, {}, {"a"}, {}});
    EXPECT_TRUE(wanted.contains("c")) << "all, but one";
    EXPECT_FALSE(wanted.contains("a"));
    wanted.take({Unsubscribe, {}, {}, {}});
    EXPECT_FALSE(wanted.any());
}

TEST(FoxgloveTest, SubscriptionsComeAndGo) {
    Subscriptions subscriptions(2);
    EXPECT_EQ(
        subscriptions.take(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":0}]})"),
        "");
    EXPECT_THAT(subscriptions.all(), ElementsAre(Pair(7, 1), Pair(8, 0)));
    EXPECT_EQ(subscriptions.take(R"({"op":"unsubscribe","subscriptionIds":[7, 99]})"), "");
    EXPECT_THAT(subscriptions.all(), ElementsAre(Pair(8, 0)));
    EXPECT_EQ(subscriptions.take(R"({"op":"fetchAsset"})"), "") << "of the protocol, but not for this server";
}

TEST(FoxgloveTest, ReportsInvalidMessagesAndChangesNothing) {
    Subscriptions subscriptions(2);
    for (const char* text : {"", "{", "[]", "{}", R"({"op":1})", "\xff\xfe"})
        EXPECT_THAT(subscriptions.take(text), HasSubstr("not a JSON object with an op")) << text;
    for (const char* one :
         {"1", "{}", R"({"id":-1,"channelId":0})", R"({"id":1,"channelId":"0"})", R"({"id":5000000000,"channelId":0})"})
        EXPECT_THAT(subscriptions.take(std::string(R"({"op":"subscribe","subscriptions":[)") + one + "]}"),
                    HasSubstr("an id and a channelId"))
            << one;
    EXPECT_THAT(subscriptions.take(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})"),
                HasSubstr("no channel 2; there are 2"));
    EXPECT_TRUE(subscriptions.all().empty());
}

TEST(FoxgloveTest, AllowsOneSubscriptionOfAClientForEachChannel) {
    Subscriptions subscriptions(2);
    EXPECT_EQ(subscriptions.take(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})"), "");
    EXPECT_THAT(subscriptions.take(R"({"op":"subscribe","subscriptions":[{"id":2,"channelId":0}]})"),
                HasSubstr("channel 0 has subscription 1 already"));
    EXPECT_EQ(subscriptions.take(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})"), "");
    EXPECT_EQ(subscriptions.take(R"({"op":"subscribe","subscriptions":[{"id":2,"channelId":1}]})"), "");
    EXPECT_THAT(subscriptions.all(), ElementsAre(Pair(1, 0), Pair(2, 1)));
}

TEST(FoxgloveTest, AMissingListIsEmpty) {
    Subscriptions subscriptions(2);
    EXPECT_EQ(subscriptions.take(R"({"op":"subscribe","subscriptions":{"a":{"id":1,"channelId":0}}})"), "");
    EXPECT_TRUE(subscriptions.all().empty());
}

}  // namespace
}  // namespace insonify::viewer
