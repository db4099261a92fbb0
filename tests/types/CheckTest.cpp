// INSONIFY_CHECK where it is on; CheckOffTest.cpp tests it where it is off.
#include <gmock/gmock.h>

#include <map>
#include <tuple>

#include "tests/support/Refused.hpp"
#include "types/Check.hpp"

#ifndef INSONIFY_CHECKS
#error "builds with tests have checks"
#endif

namespace insonify::types {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::MatchesRegex;
using testing::StartsWith;

template <int a, int b>
constexpr int sum = a + b;

std::string failure(const auto& check) { return test::computeError<CheckFailure>(check); }

TEST(CheckTest, AFailureSaysPlaceConditionAndValues) {
    const size_t bin = 50, bins = 40;
    const double share = 0.25;
    const std::string text = failure([&] { INSONIFY_CHECK(bin < bins, bin, bins, share, "beam"); });
    EXPECT_THAT(text, MatchesRegex("an error of the program in CheckTest.cpp:[0-9]+: bin < bins does not hold; "
                                   "bin, bins, share, \"beam\": 50, 40, 0.25, beam"));
    EXPECT_THAT(text, StartsWith("an error of the program in CheckTest.cpp:" + std::to_string(__LINE__ - 3) + ": "));
}

TEST(CheckTest, AFailureWithoutValuesSaysPlaceAndCondition) {
    const double share = 0.25;
    EXPECT_THAT(failure([&] { INSONIFY_CHECK(share > 1); }), EndsWith(": share > 1 does not hold"));
}

TEST(CheckTest, ConditionsAndValuesMayHaveCommasAndNestedTemplates) {
    const std::map<int, std::pair<int, std::map<int, int>>> all{{1, {2, {{3, 4}}}}};
    EXPECT_THAT(failure([&] { INSONIFY_CHECK((sum<1, 2> == 4), sum<1, 2>, std::max<int>(5, sum<3, 4>)); }),
                EndsWith(": (sum<1, 2> == 4) does not hold; sum<1, 2>, std::max<int>(5, sum<3, 4>): 3, 7"));
    EXPECT_THAT(failure([&] {
                    INSONIFY_CHECK((all == std::map<int, std::pair<int, std::map<int, int>>>{}),
                                   (std::get<1>(std::tuple<int, std::pair<int, int>>{1, {2, 3}}).second), all.size());
                }),
                EndsWith(": 3, 1"));
    if (all.empty())
        INSONIFY_CHECK(all.empty());  // is one statement
    else
        EXPECT_EQ(all.size(), 1u);
}

TEST(CheckTest, ValuesAreNumbersTextsAndVectors) {
    struct Vector {
        double x, y, z;
    };
    const float tenth = 0.1f;
    const std::string name = "sonar";
    const Vector way{1, -0.5, std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THAT(failure([&] {
                    INSONIFY_CHECK(false, uint64_t{1} << 63, int64_t{-5}, uint8_t{7}, true, tenth, 1e300, name,
                                   std::string_view("a"), way);
                }),
                EndsWith(": 9223372036854775808, -5, 7, 1, 0.100000001, 1e+300, sonar, a, (1, -0.5, nan)"));
}

TEST(CheckTest, WhatHoldsEvaluatesItsConditionOnceAndNoValue) {
    int conditions = 0, values = 0;
    INSONIFY_CHECK(++conditions == 1, ++values);
    EXPECT_EQ(conditions, 1);
    EXPECT_EQ(values, 0);
    EXPECT_THROW(INSONIFY_CHECK(++conditions == 1, ++values), std::logic_error);
    EXPECT_EQ(conditions, 2);
    EXPECT_EQ(values, 1);
}

}  // namespace
}  // namespace insonify::types
