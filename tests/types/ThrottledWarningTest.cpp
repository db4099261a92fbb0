#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "types/text/Notice.hpp"

namespace insonify::types {
namespace {

using std::chrono::seconds;

TEST(ThrottledWarningTest, WarnsAtOnceAndThenEveryTenSeconds) {
    const auto start = ThrottledWarning::Clock::now();
    ThrottledWarning refused("connection", "refused");
    EXPECT_EQ(refused.consumeWarning(start), "");
    refused.add("no HTTP");
    EXPECT_EQ(refused.consumeWarning(start), "1 connection refused; the last: no HTTP");
    refused.add("no HTTP");
    refused.add("a wrong token", " from 10.0.0.1");
    EXPECT_EQ(refused.consumeWarning(start + seconds(9)), "");
    EXPECT_EQ(refused.consumeWarning(start + seconds(10)),
              "3 connections refused; the last: a wrong token from 10.0.0.1");
    EXPECT_EQ(refused.consumeWarning(start + seconds(30)), "");
    EXPECT_THAT(refused.summary(),
                testing::ElementsAre("1 connection refused: a wrong token", "2 connections refused: no HTTP"));
    refused.reset();
    EXPECT_EQ(refused.count(), 0u);
    EXPECT_TRUE(refused.summary().empty());
}

TEST(ThrottledWarningTest, FurtherReasonsAreCountedTogetherFromTheThirtySecondOn) {
    ThrottledWarning dropped("message", "dropped");
    for (int i = 0; i < 100; ++i) dropped.add("reason " + std::to_string(i));
    EXPECT_EQ(dropped.count(), 100u);
    EXPECT_EQ(dropped.byReason().size(), 33u);
    EXPECT_EQ(dropped.byReason().at("other reasons"), 68u);
}

}  // namespace
}  // namespace insonify::types
