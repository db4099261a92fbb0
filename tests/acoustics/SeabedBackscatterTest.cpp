// The published tables of APL-UW TR 9407 (1994): table 2, parameters of sediments, and table 3, their strengths.
#include <gmock/gmock.h>

#include <cmath>

#include "components/acoustics/Seabed.hpp"
#include "tests/acoustics/Degree.hpp"

namespace insonify::acoustics {
namespace {

constexpr double report_speed = 1528;  // speed of sound in the water of table 3 [m/s]

constexpr double grazing_deg[] = {1, 2, 3, 5, 7, 10, 20, 40, 60, 70, 80, 85, 88, 89, 90};

/** A column of table 3 [dB]. */
struct Column {
    const char* name;
    double khz;
    double strength_db[std::size(grazing_deg)];
};

const Column table[] = {
    {"rough_rock",
     30,
     {-23.0, -19.4, -17.4, -14.8, -13.3, -11.3, -7.9, -5.4, -4.9, -5.0, -5.4, -5.3, -5.4, -5.4, -5.4}},
    {"rock", 30, {-44.0, -37.3, -33.3, -28.4, -25.2, -21.7, -15.4, -10.0, -9.1, -8.3, -7.3, -6.8, -6.6, -6.6, -6.6}},
    {"cobble",
     30,
     {-48.5, -41.7, -37.6, -32.6, -29.2, -25.7, -19.3, -14.9, -13.1, -11.5, -9.2, -8.2, -7.9, -7.9, -7.8}},
    {"sandy_gravel",
     30,
     {-50.3, -44.2, -40.3, -35.1, -31.7, -28.1, -22.1, -18.9, -16.5, -13.7, -9.9, -8.4, -8.0, -7.9, -7.8}},
    {"coarse_sand",
     30,
     {-47.1, -43.8, -41.5, -37.9, -34.9, -31.5, -25.1, -21.4, -18.8, -15.3, -8.9, -5.6, -4.6, -4.4, -4.4}},
    {"medium_sand",
     10,
     {-61.5, -56.8, -53.2, -47.6, -43.4, -38.8, -30.9, -24.4, -22.6, -20.4, -13.2, -5.0, 1.2, 2.3, 2.6}},
    {"medium_sand",
     30,
     {-51.4, -48.1, -45.8, -42.1, -39.0, -35.4, -28.3, -23.5, -21.2, -17.7, -10.8, -5.5, -3.4, -3.1, -3.1}},
    {"medium_sand",
     100,
     {-50.0, -44.9, -41.5, -36.6, -33.3, -29.8, -24.2, -21.7, -19.5, -16.4, -12.2, -10.4, -9.8, -9.7, -9.7}},
    {"very_fine_sand",
     30,
     {-59.7, -54.7, -50.8, -44.6, -40.1, -35.2, -27.1, -24.9, -23.7, -23.1, -20.2, -13.1, -5.9, -4.3, -3.8}},
    {"very_fine_sand",
     100,
     {-51.4, -47.9, -45.4, -41.3, -37.9, -34.0, -27.0, -24.8, -23.5, -22.3, -18.0, -12.9, -10.3, -10.0, -10.0}},
    {"silt",
     30,
     {-58.2, -51.1, -46.6, -41.3, -38.3, -35.7, -31.8, -28.8, -27.4, -27.0, -26.3, -23.9, -13.1, -6.8, -3.6}},
};

double strengthDb(const SeabedBackscatter& seabed, double grazing) {
    return 10 * std::log10(seabed.crossSection(grazing * degree));
}

TEST(SeabedBackscatterTest, SedimentsMatchTable2OfTheReport) {
    const Seabed sand = seabedNamed("medium_sand").value();
    EXPECT_NEAR(sand.density_ratio, 1.845, 5e-4);
    EXPECT_NEAR(sand.speed_ratio, 1.1782, 5e-5);
    EXPECT_NEAR(sand.loss, 0.01624, 5e-6);
    EXPECT_EQ(sand.volume, 0.002);
    EXPECT_NEAR(sand.roughness, 0.004446, 1e-6);
    EXPECT_EQ(sand.roughness_slope, 3.25);
    struct Row {
        const char* name;
        double rho, nu, delta;
    };
    for (const Row& row : {Row{"sandy_gravel", 2.492, 1.3370, 0.01705}, Row{"coarse_sand", 2.231, 1.2503, 0.01638},
                           Row{"fine_sand", 1.451, 1.1073, 0.01602}, Row{"muddy_sand", 1.339, 1.0800, 0.01728},
                           Row{"very_fine_sand", 1.268, 1.0568, 0.01875}, Row{"clayey_sand", 1.224, 1.0364, 0.02019},
                           Row{"coarse_silt", 1.195, 1.0179, 0.02158}, Row{"sandy_silt", 1.169, 0.9999, 0.01261}}) {
        const Seabed seabed = seabedNamed(row.name).value();
        EXPECT_NEAR(seabed.density_ratio, row.rho, 6e-4) << row.name;
        EXPECT_NEAR(seabed.speed_ratio, row.nu, 6e-5) << row.name;
        EXPECT_NEAR(seabed.loss, row.delta, 6e-6) << row.name;
    }
    EXPECT_NEAR(seabedNamed("sandy_gravel")->roughness, 0.012937, 1e-6);
    EXPECT_NEAR(seabedNamed("sandy_mud")->roughness, 0.000518, 1e-6);
    EXPECT_EQ(seabedNamed("sandy_mud")->volume, 0.001);
    EXPECT_FALSE(seabedNamed("basalt").has_value());
    EXPECT_EQ(grainSizeNamed("clay"), 9);
    EXPECT_FALSE(grainSizeNamed("rock").has_value());
}

TEST(SeabedBackscatterTest, StrengthsMatchTable3OfTheReport) {
    for (const Column& column : table) {
        const SeabedBackscatter seabed(seabedNamed(column.name).value(), column.khz, report_speed);
        for (size_t i = 0; i < std::size(grazing_deg); ++i)
            EXPECT_NEAR(strengthDb(seabed, grazing_deg[i]), column.strength_db[i], 0.6)
                << column.name << ' ' << column.khz << " kHz, " << grazing_deg[i] << " deg";
    }
}

TEST(SeabedBackscatterTest, SoftBottomsFollowOnlyTheVolume) {
    // The report's second column of silt, with sigma_2 of 0.0003.
    const double thin[] = {-63.4, -56.3, -51.8, -46.5, -43.5, -40.9, -37.0, -34.0,
                           -32.6, -32.1, -30.5, -25.8, -13.3, -6.8,  -3.6};
    Seabed silt = seabedNamed("silt").value();
    silt.volume = 0.0003;
    const SeabedBackscatter seabed(silt, 30, report_speed);
    for (size_t i = 0; i < std::size(grazing_deg); ++i)
        EXPECT_NEAR(strengthDb(seabed, grazing_deg[i]), thin[i], 0.6) << grazing_deg[i];
}

TEST(SeabedBackscatterTest, KirchhoffWithoutItsLevelMissesTheTableNearTheVertical) {
    const double level = std::pow(2, 1.2);  // 2^(2 (1 - a) / a) with a = 3.25 / 2 - 1
    for (const Column& column : table) {
        if (std::string(column.name).find("sand") == std::string::npos || column.khz != 30) continue;
        const SeabedBackscatter seabed(seabedNamed(column.name).value(), column.khz, report_speed);
        if (std::string(column.name) == "sandy_gravel") continue;
        const double printed = 10 * std::log10(seabed.kirchhoff(90 * degree) / level);
        EXPECT_NEAR(printed, column.strength_db[14] - 3.6, 0.4) << column.name;
        EXPECT_GT(std::abs(printed - column.strength_db[14]), 3) << column.name;
    }
}

TEST(SeabedBackscatterTest, IsExtrapolatedAboveTheBandOfTheReport) {
    struct Case {
        double khz, at_20, at_40, at_60;
    };
    for (const Case& c : {Case{300, -22.2, -20.2, -18.5}, Case{700, -21.0, -19.4, -18.8}}) {
        const SeabedBackscatter sand(seabedNamed("medium_sand").value(), c.khz, 1500);
        EXPECT_NEAR(strengthDb(sand, 20), c.at_20, 0.4) << c.khz;
        EXPECT_NEAR(strengthDb(sand, 40), c.at_40, 0.4) << c.khz;
        EXPECT_NEAR(strengthDb(sand, 60), c.at_60, 0.4) << c.khz;
    }
    EXPECT_EQ(outsideSeabedModel(100, 1500), "");
    EXPECT_EQ(outsideSeabedModel(750, 1500), "750 kHz (10 to 100)");
    EXPECT_EQ(outsideSeabedModel(5, 1300), "5 kHz (10 to 100), 1300 m/s (1400 to 1600)");
    EXPECT_EQ(outsideGrainSizes(12), "12 phi (-1 to 9)");
    EXPECT_EQ(outsideGrainSizes(1.5), "");
}

TEST(SeabedBackscatterTest, LambertParametersOfTheSeabedsAreTheirMean) {
    // ACOUSTICS.md 3.2 tabulates the mean difference to 20 log10(sin) over 5 to 60 deg at 100 kHz.
    struct Case {
        const char* name;
        double lambert_db;
    };
    for (const Case& c :
         {Case{"rough_rock", 1.5}, Case{"rock", -3.7}, Case{"cobble", -8.1}, Case{"sandy_gravel", -11.7},
          Case{"coarse_sand", -14.2}, Case{"medium_sand", -16.7}, Case{"fine_sand", -19.3}, Case{"muddy_sand", -20.0},
          Case{"very_fine_sand", -20.0}, Case{"coarse_silt", -20.2}, Case{"sandy_silt", -20.4}, Case{"clay", -23.7}}) {
        const SeabedBackscatter seabed(seabedNamed(c.name).value(), 100, report_speed);
        double sum = 0;
        for (int grazing = 5; grazing <= 60; ++grazing)
            sum += strengthDb(seabed, grazing) - 20 * std::log10(std::sin(grazing * degree));
        EXPECT_NEAR(sum / 56, c.lambert_db, 0.6) << c.name;
    }
}

TEST(SeabedBackscatterTest, EverySeabedIsFiniteAtEveryAngleAndFrequency) {
    for (const std::string& name : seabedNames())
        for (const double khz : {1.0, 10.0, 100.0, 2000.0}) {
            const SeabedBackscatter seabed(seabedNamed(name).value(), khz, 1500);
            for (const double grazing : {0.0, 1e-4, 0.001, 0.5, 39.99, 40.0, 89.9, 90.0})
                EXPECT_TRUE(std::isfinite(strengthDb(seabed, grazing))) << name << ' ' << khz << ' ' << grazing;
            EXPECT_EQ(seabed.crossSection(0), seabed.crossSection(0.001 * degree)) << name;
        }
}

TEST(SeabedBackscatterTest, GrainSizesAreClampedAtTheEnds) {
    EXPECT_EQ(seabedOfGrainSize(-5).density_ratio, seabedOfGrainSize(-1).density_ratio);
    EXPECT_EQ(seabedOfGrainSize(20).speed_ratio, seabedOfGrainSize(9).speed_ratio);
    EXPECT_EQ(seabedOfGrainSize(1.5).loss, seabedNamed("medium_sand")->loss);
}

}  // namespace
}  // namespace insonify::acoustics
