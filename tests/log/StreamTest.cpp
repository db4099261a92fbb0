#include <gmock/gmock.h>

#include "components/log/Stream.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log {
namespace {

TEST(StreamTest, TimesOfThisCenturyAreDatesOthersAreSeconds) {
    EXPECT_EQ(readable({1'500'000}), "1.500000 s");
    EXPECT_EQ(readable({0}), "0.000000 s");
    EXPECT_EQ(readable({1'700'000'000'000'001}), "2023-11-14 22:13:20.000001");
}

TEST(StreamTest, AReadableTimeIsReadBackToTheMicrosecond) {
    const types::Time time{1'700'000'000'123'456};
    EXPECT_EQ(readTime(readable(time), "--from"), time);
    EXPECT_EQ(readTime("2023-11-14T22:13:20.123456Z", "--from"), time);
    EXPECT_EQ(readTime("2023-11-14T22:13:20Z", "--from").microseconds, 1'700'000'000'000'000);
    EXPECT_EQ(readTime("1700000000.5", "--from").microseconds, 1'700'000'000'500'000);
    EXPECT_EQ(readTime("-2", "--from").microseconds, -2'000'000);
    EXPECT_EQ(readTime("0.25", "--from", time) - time, types::Time{250'000}) << "after the start";
    EXPECT_EQ(readTime(readable(time), "--from", types::Time{7}), time) << "a date is a date";
}

TEST(StreamTest, RefusesInvalidTimesByName) {
    for (const char* text : {"noon", "", "2023-11-14", "2023-11-14T22:13:20Zulu", "1e300", "nan", "3 s"})
        EXPECT_THAT(test::computeError<types::ConfigError>([&] { readTime(text, "--until"); }),
                    testing::HasSubstr("--until: is " + std::string(text)));
}

}  // namespace
}  // namespace insonify::log
