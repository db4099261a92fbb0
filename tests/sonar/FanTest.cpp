// Tables of bearings in any order, with gaps and overlaps, and across the seam at 180 degrees.
#include <gmock/gmock.h>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/Fan.hpp"
#include "tests/support/Tables.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using types::degrees;
using types::radians;

Fan makeFan(const std::vector<double>& bearings_deg, double width_deg = 1) {
    std::vector<Beam> beams;
    for (const double bearing : bearings_deg)
        beams.push_back({radians(bearing), radians(bearing - width_deg / 2), radians(bearing + width_deg / 2)});
    return Fan(beams);
}

std::vector<double> getCentres(const Fan& fan) {
    std::vector<double> centres;
    for (const Beam& beam : fan) centres.push_back(std::round(degrees(beam.centre) * 1e6) / 1e6);
    return centres;
}

std::vector<size_t> getRows(const Fan& fan) {
    std::vector<size_t> rows;
    for (size_t k = 0; k < fan.size(); ++k) rows.push_back(fan.row(k));
    return rows;
}

std::vector<size_t> foundAt(const Fan& fan, double azimuth) {
    std::vector<size_t> found;
    fan.eachAt(azimuth, [&](size_t k) { found.push_back(k); });
    std::ranges::sort(found);
    return found;
}

TEST(FanTest, AnAscendingTableIsTheFan) {
    const Fan fan = makeFan({-30, -10, 0, 25}, 20);
    EXPECT_THAT(getCentres(fan), ElementsAre(-30, -10, 0, 25));
    EXPECT_TRUE(fan.isTableOrder());
    EXPECT_NEAR(degrees(fan.low()), -40, 1e-9);
    EXPECT_NEAR(degrees(fan.high()), 35, 1e-9);
    EXPECT_EQ(fan.seam(), std::numbers::pi);
}

TEST(FanTest, SortsAnyOrderAndFindsEachRowAgain) {
    const Fan fan = makeFan({10, -30, 25, -10, 0});
    EXPECT_THAT(getCentres(fan), ElementsAre(-30, -10, 0, 10, 25));
    EXPECT_THAT(getRows(fan), ElementsAre(1, 3, 4, 0, 2));
    std::vector<int> rows{0, 1, 2, 3, 4};
    fan.toTableOrder(std::span(rows), 1);
    EXPECT_THAT(rows, ElementsAre(3, 0, 4, 1, 2));
}

TEST(FanTest, BearingsAscendAcrossTheSeam) {
    const Fan fan = makeFan({155, 165, 175, -175, -165, -155}, 10);
    EXPECT_THAT(getCentres(fan), ElementsAre(155, 165, 175, 185, 195, 205));
    EXPECT_TRUE(fan.isTableOrder());
    EXPECT_TRUE(fan.joins());
    EXPECT_NEAR(degrees(fan.seam()), 360, 1e-9) << "ahead, above all bearings";
    EXPECT_TRUE(fan.spans(radians(-179)));
    EXPECT_FALSE(fan.spans(radians(0)));
    EXPECT_THAT(foundAt(fan, radians(-172)), ElementsAre(3));
    EXPECT_EQ(fan.tableBearing(3), radians(-175));
}

TEST(FanTest, ARegularFanAllRoundIsCutAstern) {
    SonarConfig config;
    config.field_of_view_deg = 360;
    config.beam_count = 97;
    const Fan fan = makeBeams(config);
    EXPECT_TRUE(fan.isTableOrder());
    EXPECT_TRUE(fan.isRound());
    EXPECT_TRUE(fan.joins());
    std::vector<Beam> table(fan.begin(), fan.end());
    EXPECT_TRUE(Fan(table).isTableOrder()) << "gaps that are equal but for rounding leave the seam where it is";
    std::ranges::rotate(table, table.begin() + 40);
    EXPECT_EQ(Fan(table).front().centre, fan.front().centre);
}

TEST(FanTest, GapsAndOverlapsDoNotJoin) {
    EXPECT_FALSE(makeFan({-10, 0, 10}, 9).joins());
    EXPECT_FALSE(makeFan({-10, 0, 10}, 11).joins());
    EXPECT_TRUE(makeFan({-10, 0, 10}, 10).joins());
    EXPECT_NEAR(degrees(makeFan({-10, 0, 0, 4}, 1).minSpacing()), 4, 1e-9) << "equal bearings have no spacing";
    EXPECT_NEAR(degrees(makeFan({-170, 175}, 1).minSpacing()), 15, 1e-9);
}

TEST(FanTest, HalfwaysAreBetweenNeighboursAndTheSameDistanceBeyondTheEnds) {
    std::vector<double> midpoints;
    for (const double edge : makeFan({-10, 0, 20}).midpoints()) midpoints.push_back(std::round(degrees(edge)));
    EXPECT_THAT(midpoints, ElementsAre(-15, -5, 10, 30));
    const std::vector<double> round = makeFan({-175, -55, 65}, 120).midpoints();
    EXPECT_NEAR(degrees(round.back() - round.front()), 360, 1e-9);
}

TEST(FanTest, RejectsBeamsWithoutExtent) {
    EXPECT_THROW(Fan({{0, 0, 0}}), std::invalid_argument);
    EXPECT_THROW(Fan({{std::nan(""), -1, 1}}), std::invalid_argument);
    EXPECT_TRUE(Fan().empty());
}

/** Checks the guarantees of every fan for random tables in random order. */
TEST(FanTest, EveryTableMeetsItsGuarantees) {
    std::mt19937 random(11);
    for (int round = 0; round < 50; ++round)
        for (const test::Table& table : test::drawTables(random)) {
            SCOPED_TRACE(testing::PrintToString(table));
            std::vector<double> shuffled = table.bearings_deg;
            std::ranges::shuffle(shuffled, random);
            const Fan fan = makeFan(shuffled, table.width_deg);
            std::vector<double> asked = table.bearings_deg;
            for (size_t k = 0; k < fan.size(); ++k) {
                EXPECT_NEAR(std::remainder(degrees(fan[k].centre) - shuffled[fan.row(k)], 360), 0, 1e-9);
                EXPECT_NEAR(std::remainder(degrees(fan[k].centre) - asked[k], 360), 0, 1e-9) << "along the arc";
                EXPECT_GE(fan[k].centre, fan[k > 0 ? k - 1 : 0].centre);
                EXPECT_THAT(foundAt(fan, fan[k].centre), testing::Contains(k));
                EXPECT_THAT(foundAt(fan, fan[k].centre - 2 * std::numbers::pi), testing::Contains(k));
                EXPECT_TRUE(fan.spans(fan[k].centre));
            }
            std::vector<double> rows;
            for (const Beam& beam : fan) rows.push_back(std::remainder(degrees(beam.centre), 360));
            fan.toTableOrder(std::span(rows), 1);
            for (size_t row = 0; row < rows.size(); ++row)
                EXPECT_NEAR(std::remainder(rows[row] - shuffled[row], 360), 0, 1e-9);
            // The beam at an azimuth is the one that a search through all beams finds.
            for (int i = 0; i < 20; ++i) {
                const double azimuth = std::uniform_real_distribution<double>(-7, 7)(random);
                std::vector<size_t> searched;
                for (size_t k = 0; k < fan.size(); ++k)
                    for (int turns = -3; turns <= 3; ++turns) {
                        const double at = azimuth + turns * 2 * std::numbers::pi;
                        if (at >= fan[k].low && at < fan[k].high) searched.push_back(k);
                    }
                EXPECT_THAT(foundAt(fan, std::remainder(azimuth, 2 * std::numbers::pi)), ElementsAreArray(searched));
            }
        }
}

TEST(FanTest, CoverageIsThatOfTheArc) {
    SonarConfig config;
    config.beam_width_deg = 10;
    config.bearings_deg = {155, 165, 175, -175, -165, -155};
    EXPECT_DOUBLE_EQ(config.coverageDeg(), 60);
    config.bearings_deg = {20, -20, 0};
    EXPECT_DOUBLE_EQ(config.coverageDeg(), 50);
}

TEST(FanTest, TheEndsOfARingAreNeighbours) {
    const auto isRing = [](double first, double step, int count, double width) {
        std::vector<Beam> table;
        for (int k = 0; k < count; ++k) {
            const double at = std::remainder(radians(first + k * 7 % count * step), 2 * std::numbers::pi);
            table.push_back({at, at - radians(width) / 2, at + radians(width) / 2});
        }
        return Fan(table).isRing();
    };
    for (const double first : {-180.0, -175.0, 3.0, 90.0}) {
        EXPECT_TRUE(isRing(first, 10, 36, 10)) << first;
        EXPECT_TRUE(isRing(first, 10, 36, 4)) << "with gaps";
        EXPECT_TRUE(isRing(first, 10, 36, 25)) << "with overlaps";
        EXPECT_FALSE(isRing(first, 10, 35, 10)) << first;
        EXPECT_FALSE(isRing(first, 9, 36, 9)) << first;
    }
    EXPECT_FALSE(isRing(0, 180, 2, 10)) << "two beams are neighbours once";
    SonarConfig config;
    for (const double view_deg : {360.0, 350.0}) {
        config.field_of_view_deg = view_deg;
        EXPECT_EQ(makeBeams(config).isRing(), view_deg == 360);
    }
}

}  // namespace
}  // namespace insonify::sonar
