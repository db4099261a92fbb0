#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/study/error/ErrorAnalysis.hpp"

namespace insonify::study {
namespace {

constexpr double gain_factor = 3;  ///< Of an error with gain over that without.

/** Adds a ladder whose error falls as samples^power from `error` on, in a time proportional to samples. */
void addLadder(ErrorResult& result, const std::string& scene, Method method, double error, double power,
               int levels = 4) {
    for (int level = 0; level < levels; ++level) {
        Measurement m{scene, method, 64 << level, 1 << level, 1, {}, 0, 0, 0, 0};
        m.metrics.rel_l2 = error * std::pow(m.samples() / 64, power);
        m.metrics.rel_l2_tvg = gain_factor * m.metrics.rel_l2;
        m.median_ms = m.samples() / 64;
        result.measurements.push_back(m);
    }
}

ErrorResult made() {
    ErrorResult result;
    result.references = {{"flat_bottom", "closed form", 0}};
    addLadder(result, "flat_bottom", Method::Footprint, 0.001, -1);
    addLadder(result, "flat_bottom", Method::Nearest, 0.4, -0.8);
    return result;
}

TEST(ErrorAnalysisTest, TheLadderOmitsOtherSweeps) {
    ErrorResult result = made();
    result.measurements.push_back({"flat_bottom", Method::Footprint, 128, 4, 1, {}, 0, 0, 0, 0});
    EXPECT_EQ(ladder(result, "flat_bottom", Method::Footprint).size(), 4u);
    EXPECT_TRUE(ladder(result, "wall", Method::Footprint).empty());
}

TEST(ErrorAnalysisTest, TheSlopeIsThatOfTheLine) {
    const ErrorResult result = made();
    EXPECT_NEAR(*slope(ladder(result, "flat_bottom", Method::Nearest), 0), -0.8, 1e-9);
    EXPECT_NEAR(*slope(ladder(result, "flat_bottom", Method::Footprint), 1e-6), -1, 1e-9);
    EXPECT_FALSE(slope(ladder(result, "flat_bottom", Method::Footprint), 1e-4)) << "too near the reference's own error";
}

TEST(ErrorAnalysisTest, ASlopeIsOverCellsThatMayMergeSeveralSamples) {
    ErrorResult result;
    addLadder(result, "wall", Method::Footprint, 0.001, -1);
    for (Measurement& m : result.measurements)
        if (m.rows == 512) m.merged = 4, m.metrics.rel_l2 *= 4;  // the error of the previous level
    EXPECT_NEAR(*slope(ladder(result, "wall", Method::Footprint), 0), -1, 1e-9);
}

TEST(ErrorAnalysisTest, LevelsWithTheSameNumberOfCellsHaveNoSlope) {
    ErrorResult result;
    addLadder(result, "wall", Method::Footprint, 0.001, -1, 2);
    result.measurements[1].merged = 4;  // twice the rows and columns, but the same number of cells
    ASSERT_EQ(result.measurements[0].cells(), result.measurements[1].cells());
    EXPECT_FALSE(slope(ladder(result, "wall", Method::Footprint), 0));
}

TEST(ErrorAnalysisTest, ASlopeOfFewLevelsIsOpen) {
    ErrorResult result;
    result.references = {{"wall", "closed form", 0}};
    addLadder(result, "wall", Method::Footprint, 0.001, -0.5, 3);
    ASSERT_EQ(claims(result).size(), 1u);
    EXPECT_STREQ(claims(result)[0].verdict(), "open");
    addLadder(result = {}, "wall", Method::Footprint, 0.001, -0.5, 4);
    result.references = {{"wall", "closed form", 0}};
    EXPECT_STREQ(claims(result)[0].verdict(), "FAIL");
}

TEST(ErrorAnalysisTest, TimesAndErrorsAreOnTheLineOrItsExtension) {
    const auto points = ladder(made(), "flat_bottom", Method::Nearest);
    const double ms = std::pow(0.1 / 0.4, 1 / -0.8);
    EXPECT_NEAR(timeTo(0.1, points, without_gain)->ms, ms, 1e-9 * ms);
    EXPECT_EQ(timeTo(0.1, points, without_gain)->kind, ReachTime::Kind::Interpolated);
    EXPECT_NEAR(*errorAt(ms, points), 0.1, 1e-9);
    EXPECT_NEAR(timeTo(0.004, points, without_gain)->ms, std::pow(0.01, 1 / -0.8), 1e-6) << "beyond the finest point";
    EXPECT_EQ(timeTo(0.004, points, without_gain)->kind, ReachTime::Kind::Extrapolated);
    EXPECT_EQ(timeTo(0.004, points, without_gain)->text(), "316 (extrapolated, 4.9 x the finest)");
    EXPECT_NEAR(timeTo(gain_factor * 0.1, points, with_gain)->ms, ms, 1e-9 * ms);
    EXPECT_FALSE(timeTo(1e-4, points, without_gain)) << "too far beyond it";
    EXPECT_EQ(timeTo(0.5, points, without_gain)->text(), "at most 1") << "the coarsest point is good enough";
    ErrorResult flat;
    addLadder(flat, "x", Method::Published, 0.4, 0);
    EXPECT_FALSE(timeTo(0.1, ladder(flat, "x", Method::Published), without_gain)) << "it never gets there";
}

TEST(ErrorAnalysisTest, NoPointBeatsTheParetoFront) {
    const ErrorResult result = made();
    for (const Measurement& m : result.measurements)
        EXPECT_EQ(onParetoFront(m, result), m.method == Method::Footprint || m.rows == 64)
            << getName(m.method) << m.rows;
}

TEST(ErrorAnalysisTest, AClaimThatDoesNotHoldFails) {
    ErrorResult result = made();
    const auto failures = [&] {
        int count = 0;
        for (const Claim& claim : claims(result)) count += !claim.holds();
        return count;
    };
    EXPECT_EQ(failures(), 0);
    for (Measurement& m : result.measurements)
        if (m.method == Method::Footprint) m.metrics.rel_l2 = 0.3 * std::pow(m.samples() / 64, -0.5);
    EXPECT_EQ(failures(), 3) << "time at equal error, error at equal time, slope";
}

TEST(ErrorAnalysisTest, MarksAClaimOnTimesThatWereNotMeasured) {
    ErrorResult result = made();
    for (Measurement& m : result.measurements)
        if (m.method == Method::Nearest) m.metrics.rel_l2 *= 4;  // 1 % is beyond its finest point
    const auto all = claims(result);
    EXPECT_TRUE(std::ranges::any_of(all, [](const Claim& c) { return c.text.ends_with("footprints (extrapolated)"); }));
}

TEST(ErrorAnalysisTest, ATimeExtrapolatedFromFewLevelsIsOpen) {
    for (const int levels : {2, 3, 4, 5}) {
        ErrorResult result;
        result.references = {{"flat_bottom", "closed form", 0}};
        addLadder(result, "flat_bottom", Method::Footprint, 0.001, -1, levels);
        addLadder(result, "flat_bottom", Method::Nearest, 0.01 * std::pow(4, levels), -0.8, levels);
        const auto all = claims(result);
        const auto time = std::ranges::find_if(all, [](const Claim& c) { return c.text.ends_with("(extrapolated)"); });
        ASSERT_NE(time, all.end()) << levels;
        EXPECT_EQ(time->settled, levels >= 4) << levels;
    }
}

TEST(ErrorAnalysisTest, AReferenceTooCoarseToDecideLeavesClaimsOpen) {
    ErrorResult result;
    result.references = {{"reef", "brute force", 0.004, 0.004, 1e6}};
    addLadder(result, "reef", Method::Footprint, 0.03, -1, 1);
    result.predictions = {{"reef", 64, 2, 0.02, 0.015, 0.06}};
    const auto all = claims(result);
    ASSERT_EQ(all.size(), 2u) << "7.5 times finer, 3 times the target";
    for (const Claim& claim : all) {
        EXPECT_FALSE(claim.holds()) << claim.text;
        EXPECT_FALSE(claim.fails()) << claim.text;
        EXPECT_STREQ(claim.verdict(), "open");
    }
    result.references[0].error_tvg = 0.001;
    EXPECT_STREQ(claims(result)[1].verdict(), "FAIL") << "now it can decide";
    result.predictions[0].predicted_error = 0.05;
    EXPECT_STREQ(claims(result)[1].verdict(), "FAIL") << "more than the sonar reports";
    result.predictions[0].predicted_error = 0.07;
    EXPECT_STREQ(claims(result)[1].verdict(), "pass") << "the sonar reports that it misses the target";
}

}  // namespace
}  // namespace insonify::study
