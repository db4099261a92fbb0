#include <gmock/gmock.h>

#include "components/device/wire/Http.hpp"
#include "tests/device/ByteStrings.hpp"
#include "tests/support/CommaLocale.hpp"

namespace insonify::device {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string toText(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

const std::string post =
    "POST /api/v1/x?a=b HTTP/1.1\r\nHost: s\r\nContent-Type: application/json\r\nContent-Length: 4\r\n\r\ntrue";

TEST(HttpTest, ReadsCompleteRequestsFromAnyPieces) {
    HttpReader reader;
    const std::string all = post + "GET /about HTTP/1.1\r\nHost: s\r\nConnection: close\r\n\r\n";
    std::vector<HttpRequest> requests;
    for (const char c : all) {
        reader.add(toBytes(std::string{c}));
        while (auto request = reader.next()) requests.push_back(*request);
    }
    ASSERT_EQ(requests.size(), 2u);
    EXPECT_EQ(requests[0].method, "POST");
    EXPECT_EQ(requests[0].path, "/api/v1/x");
    EXPECT_EQ(requests[0].body, "true");
    EXPECT_TRUE(requests[0].keep_alive);
    EXPECT_EQ(requests[1].path, "/about");
    EXPECT_FALSE(requests[1].keep_alive);
    reader.add(toBytes(all));
    EXPECT_TRUE(reader.next() && reader.next() && !reader.next()) << "and at once";
}

TEST(HttpTest, ReadsItsOwnRequests) {
    HttpReader reader;
    reader.add(httpBytes(HttpRequest{"POST", "/a", "{\"min\": 1}", false}, "192.168.194.96"));
    const auto request = reader.next();
    ASSERT_TRUE(request);
    EXPECT_EQ(request->body, "{\"min\": 1}");
    EXPECT_FALSE(request->keep_alive);
    EXPECT_THAT(toText(httpBytes(HttpReply{200, "1.5"}, true)), StartsWith("HTTP/1.1 200 OK\r\n"));
    EXPECT_THAT(toText(httpBytes(HttpReply{200, "1.5"}, true)), HasSubstr("Content-Length: 3\r\n\r\n1.5"));
    EXPECT_THAT(toText(httpBytes(HttpReply{}, false)), StartsWith("HTTP/1.1 204 No Content\r\n"));
    EXPECT_EQ(httpError(400, "what \xFF is").body, "{\"error\":\"what \xEF\xBF\xBD is\"}");
}

TEST(HttpTest, RefusesInvalidRequestsOnce) {
    const auto getStatus = [](const std::string& text) {
        HttpReader reader;
        reader.add(toBytes(text));
        EXPECT_FALSE(reader.next());
        reader.add(toBytes(post));
        EXPECT_FALSE(reader.refusal() && reader.next()) << "reads nothing after a refusal";
        return reader.refusal() ? reader.refusal()->status : 0;
    };
    EXPECT_EQ(getStatus("@0008\x08 not HTTP at all\r\n\r\n"), 400);
    EXPECT_EQ(getStatus("GET / HTTP/9.9\r\n\r\n"), 400);
    EXPECT_EQ(getStatus("POST / HTTP/1.1\r\nContent-Length: -4\r\n\r\n"), 400);
    EXPECT_EQ(getStatus("POST / HTTP/1.1\r\nContent-Length: 65537\r\n\r\n"), 413);
    EXPECT_EQ(getStatus("GET / HTTP/1.1\r\nA: " + std::string(20000, 'a')), 431);
    EXPECT_EQ(getStatus("POST / HTTP/1.1\r\nContent-Length: 40\r\n\r\ntrue"), 0) << "may still become complete";
}

TEST(HttpTest, ReadsTimesInAnyZone) {
    const types::Time moment{1'763'867'405'250'000};
    EXPECT_EQ(isoText(moment), "2025-11-23T03:10:05.250000Z");
    for (const char* text : {"2025-11-23T03:10:05.25Z", "2025-11-23T03:10:05.250000+00:00",
                             "2025-11-23T04:40:05.250000000+01:30", "2025-11-22T22:10:05.25-05:00"})
        EXPECT_EQ(isoTime(text), moment) << text;
    for (const char* text : {"",
                             "now",
                             "2025-11-23",
                             "2025-11-23T03:10:05",
                             "2025-13-23T03:10:05Z",
                             "2025-02-30T03:10:05Z",
                             "2025-11-23T24:10:05Z",
                             "2025-11-23T03:10:nanZ",
                             "2025-11-23T03:10:05+25:00",
                             "2025-11-23T03:10:05Zulu",
                             "1969-11-23T03:10:05Z",
                             "1970-01-01T00:00:00+01:00",
                             "2025-11-23T03:10:05,25Z",
                             "2025-11-23T03:10:Z",
                             "2025-11-23T03:10:05+",
                             "2025-11-23T03:10:05+01",
                             "2025-11-23T03:10:05+0100",
                             "2025-11-23T03:10:05+-1:00",
                             "2025-11-23T-3:10:05Z",
                             "2025-11-23 03:10:05Z"})
        EXPECT_FALSE(isoTime(text)) << text;
}

TEST(HttpTest, ReadsTimesInAnyLocale) {
    const test::CommaLocale german;
    if (!german.isThere()) GTEST_SKIP() << german.why();
    const types::Time moment{1'763'867'405'250'000};
    EXPECT_EQ(isoTime("2025-11-23T03:10:05.25Z"), moment);
    EXPECT_EQ(isoTime(isoText(moment)), moment);
    EXPECT_FALSE(isoTime("2025-11-23T03:10:05,25Z"));
}

}  // namespace
}  // namespace insonify::device
