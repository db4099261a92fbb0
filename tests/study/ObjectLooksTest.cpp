// Figures of crops of objects, on made-up pictures with known answers.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "components/study/likeness/ObjectLooks.hpp"
#include "tests/support/Draw.hpp"

namespace insonify::study {
namespace {

ObjectCrop makeCrop(const auto& level, size_t width = crop_side, size_t height = crop_side) {
    ObjectCrop crop{"made", width, height, {}};
    for (size_t row = 0; row < height; ++row)
        for (size_t column = 0; column < width; ++column)
            crop.levels.push_back(static_cast<uint8_t>(std::clamp(std::lround(level(column, row)), 0l, 255l)));
    return crop;
}

/** Returns the correlation of a field of length `length` [px] at a lag: about exp(-(lag / length)^2). */
double correlation(double length, double lag) {
    double products = 0, squares = 0;
    const auto tap = [&](double at) { return std::exp(-2 * at * at / (length * length)); };
    for (double at = -16; at <= 16; ++at) products += tap(at) * tap(at + lag), squares += tap(at) * tap(at);
    return products / squares;
}

/** A Gaussian field of unit deviation with these lengths of correlation across and along [px]. */
class Field {
public:
    Field(uint64_t seed, double across, double along) : random_(seed) {
        std::normal_distribution<double> normal;
        std::vector<double> white(side * side);
        for (double& value : white) value = normal(random_);
        values_ = filtered(filtered(white, across, 1), along, side);
    }
    double at(size_t column, size_t row) const { return values_[(row + margin) * side + column + margin]; }

private:
    static constexpr size_t margin = 16, side = crop_side + 2 * margin;

    static std::vector<double> filtered(const std::vector<double>& from, double length, size_t stride) {
        std::vector<double> taps(2 * margin + 1), to(from.size(), 0);
        double power = 0;
        for (size_t i = 0; i < taps.size(); ++i) {
            const double lag = static_cast<double>(i) - margin;
            taps[i] = std::exp(-2 * lag * lag / (length * length));
            power += taps[i] * taps[i];
        }
        for (size_t at = 0; at < from.size(); ++at)
            for (size_t i = 0; i < taps.size(); ++i)
                if (const size_t other = at + i * stride - margin * stride; other < from.size())
                    to[at] += taps[i] * from[other] / std::sqrt(power);
        return to;
    }

    std::mt19937_64 random_;
    std::vector<double> values_;
};

/** Lengths as of the real pictures: windows of 9 pixels remove a part of longer correlations. */
TEST(ObjectLooksTest, CorrelationsAreThoseOfTheFieldOverRandomLengths) {
    const test::Seeds seeds(12);
    for (uint64_t draw = seeds.first; draw < seeds.end(); ++draw) {
        test::Draw random(draw);
        const double across = random.between(0.7, 1.4), along = random.between(0.7, 1.4);
        SCOPED_TRACE(testing::Message() << across << " px across, " << along << " px along");
        std::vector<ObjectLooks> all;
        for (uint64_t seed = 0; seed < 12; ++seed) {
            const Field field(100 * draw + seed, across, along);
            all.push_back(computeLooks(makeCrop([&](size_t x, size_t y) { return 120 + 15 * field.at(x, y); })));
        }
        const ObjectLooks looks = computeMedian(all);
        for (size_t lag = 1; lag <= 3; ++lag)
            EXPECT_NEAR(looks.across[lag - 1], correlation(across, static_cast<double>(lag)), 0.08) << lag;
        for (size_t lag = 1; lag <= 2; ++lag)
            EXPECT_NEAR(looks.along[lag - 1], correlation(along, static_cast<double>(lag)), 0.08) << lag;
        EXPECT_NEAR(looks.skew, 0, 0.1);
        EXPECT_NEAR(looks.depth, 15 * 1.881, 2.5) << "3 % of a normal law";
        EXPECT_NEAR(looks.step, std::sqrt(4 / std::numbers::pi * (1 - correlation(along, 1))), 0.05);
        EXPECT_NEAR(looks.fall_off, 0, 4);
    }
}

TEST(ObjectLooksTest, RunsAreAsLongAsHighlightsAreWide) {
    const test::Seeds seeds(20);
    for (uint64_t draw = seeds.first; draw < seeds.end(); ++draw) {
        test::Draw random(draw);
        const auto wide = static_cast<size_t>(2 + random.upTo(12)), high = static_cast<size_t>(2 + random.upTo(8));
        const ObjectLooks looks = computeLooks(makeCrop([&](size_t x, size_t y) {
            return x % 24 < wide && y % 24 < high && x < 48 && y < 48 ? 220.0
                                                                      : static_cast<double>(90 + (x * 7 + y * 3) % 9);
        }));
        EXPECT_DOUBLE_EQ(looks.run_across, static_cast<double>(wide));
        EXPECT_DOUBLE_EQ(looks.run_along, static_cast<double>(high));
    }
}

TEST(ObjectLooksTest, AShadowInTheFarQuarterLowersItAndTheDarkest) {
    const ObjectLooks looks = computeLooks(makeCrop([](size_t x, size_t y) {
        return y < crop_side / 4 && x < crop_side / 2 ? 40.0 : static_cast<double>(96 + (x * 5 + y * 3) % 9);
    }));
    EXPECT_NEAR(looks.fall_off, -30, 0.5) << "half of the quarter is 60 darker";
    EXPECT_NEAR(looks.depth, 60, 0.5);
    EXPECT_NEAR(looks.skew, 0, 0.05) << "a shadow is no background";
}

TEST(ObjectLooksTest, ATrendOverRangeIsNoCorrelation) {
    const Field field(5, 0.5, 0.5);
    const ObjectLooks looks = computeLooks(makeCrop(
        [&](size_t x, size_t y) { return 150 - 0.5 * static_cast<double>(crop_side - y) + 12 * field.at(x, y); }));
    EXPECT_NEAR(looks.along[0], 0, 0.06);
    EXPECT_NEAR(looks.across[0], 0, 0.06);
    EXPECT_NEAR(looks.fall_off, -36, 3);
}

TEST(ObjectLooksTest, SpeckleOfOneLookInDecibelsIsSkewed) {
    std::mt19937_64 random(3);
    std::exponential_distribution<double> power;
    const ObjectLooks looks =
        computeLooks(makeCrop([&](size_t, size_t) { return 150 + 255.0 / 80 * 10 * std::log10(power(random)); }));
    EXPECT_NEAR(looks.skew, -0.35, 0.06) << "without its tails; with them -1.14";
    EXPECT_NEAR(looks.depth, 43, 3) << "in codes of 80 dB: that of the real pictures";
}

TEST(ObjectLooksTest, ClaimsHoldForTheRealValuesAndFailBeyondTheirTolerance) {
    ObjectLooks looks{{0.57, 0.21, 0.06}, {0.44, 0.13}, -0.01, 4.5, 7.5, 0.36, -23, 43};
    for (const Claim& claim : claims(looks, 10)) EXPECT_TRUE(claim.holds()) << claim.text;
    for (const ObjectFigure& figure : getFigures(looks)) EXPECT_GT(figure.tolerance, 0) << figure.name;
    looks = {{0.7, 0.26, 0.12}, {0.54, 0.16}, -0.22, 5.5, 9.1, 0.44, -28, 52};
    for (const Claim& claim : claims(looks, 10)) EXPECT_TRUE(claim.fails()) << claim.text;
    for (const Claim& claim : claims(looks, 9)) EXPECT_STREQ(claim.verdict(), "open") << "too few crops";
    looks = computeMedian({});
    for (const Claim& claim : claims(looks, 10)) EXPECT_TRUE(claim.fails()) << "no number is no pass: " << claim.text;
}

TEST(ObjectLooksTest, RefusesACropThatIsTooSmall) {
    EXPECT_THROW(computeLooks(makeCrop([](size_t, size_t) { return 9.0; }, 23, 96)), std::invalid_argument);
    EXPECT_TRUE(std::isnan(computeLooks(makeCrop([](size_t, size_t) { return 9.0; })).run_across))
        << "nothing is bright";
}

}  // namespace
}  // namespace insonify::study
