#include <gtest/gtest.h>

#include "components/viewer/Server.hpp"

namespace insonify::viewer {
namespace {

using Use = AccessPolicy::Use;

unsigned validated(const std::string& token, const AccessPolicy::Request& request, Use use = Use::Control) {
    const auto refusal = AccessPolicy{token}.decide(request, use);
    return refusal ? refusal->status : 200;
}

TEST(AccessPolicyTest, TakesATokenFromTheQueryOrAsABearer) {
    EXPECT_EQ(validated("a b", {"/?x=1&token=a%20b", "far.example", "", ""}), 200u);
    EXPECT_EQ(validated("ab", {"/", "far.example", "", "Bearer ab"}), 200u);
    EXPECT_EQ(validated("ab", {"/?token=ax", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(validated("ab", {"/?token=", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(validated("ab", {"/?token=abc", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(validated("ab", {"/", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(validated("ab", {"/fan.js", "127.0.0.1", "", ""}, Use::File), 200u)
        << "files of the page hold nothing secret";
}

TEST(AccessPolicyTest, WithoutATokenOnlyPagesOfThisServerControl) {
    EXPECT_EQ(validated("", {"/", "127.0.0.1:8765", "http://127.0.0.1:8765", ""}), 200u);
    EXPECT_EQ(validated("", {"/", "[::1]:8765", "http://[::1]:8765", ""}), 200u);
    EXPECT_EQ(validated("", {"/", "127.0.0.1:8765", "", ""}), 200u) << "a program, no browser";
    EXPECT_EQ(validated("", {"/", "127.0.0.1:8765", "http://evil.example", ""}), 403u);
    EXPECT_EQ(validated("", {"/", "evil.example:8765", "http://evil.example:8765", ""}), 403u)
        << "a name that leads here today";
}

TEST(AccessPolicyTest, WithoutATokenOnlyFoxglovesWebSitesRead) {
    const auto reads = [](const std::string& origin) {
        return validated("", {"/", "127.0.0.1:8765", origin, ""}, Use::Read);
    };
    for (const char* origin :
         {"", "http://127.0.0.1:8765", "https://app.foxglove.dev", "https://studio.foxglove.dev", "file://"})
        EXPECT_EQ(reads(origin), 200u) << origin;
    for (const char* origin :
         {"http://evil.example", "https://evil.example", "null", "https://app.foxglove.dev.evil.example",
          "http://app.foxglove.dev", "http://127.0.0.1:8766"})
        EXPECT_EQ(reads(origin), 403u) << origin;
    EXPECT_EQ(validated("", {"/", "127.0.0.1:8765", "https://app.foxglove.dev", ""}, Use::Control), 403u);
    EXPECT_EQ(validated("ab", {"/?token=ab", "127.0.0.1:8765", "https://evil.example", ""}, Use::Read), 200u)
        << "clients with the token may";
}

TEST(AccessPolicyTest, ProgramsAndClientsWithTheTokenSetParameters) {
    const auto sets = [](const std::string& token, const std::string& origin) {
        return AccessPolicy{token}.maySet({"/?token=ab", "127.0.0.1:8765", origin, ""});
    };
    for (const char* origin : {"", "file://", "foxglove://studio", "http://127.0.0.1:8765"})
        EXPECT_TRUE(sets("", origin)) << origin;
    for (const char* origin :
         {"https://app.foxglove.dev", "https://studio.foxglove.dev", "http://evil.example", "null"})
        EXPECT_FALSE(sets("", origin)) << origin;
    EXPECT_TRUE(sets("ab", "https://app.foxglove.dev"));
}

}  // namespace
}  // namespace insonify::viewer
