#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "components/acoustics/BeamPattern.hpp"
#include "tests/acoustics/Degree.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"
#include "tests/support/Weightings.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;
using test::WeightingRow;
using test::weightings;
using ::testing::HasSubstr;

struct DolphRow {
    double sidelobe_db, width;
};
const DolphRow dolph[] = {{-25, 0.993}, {-30, 1.073}, {-40, 1.218}};

/** Returns a width in u: twice the sine of half an angle, times the aperture [wavelengths]. */
double inWavelengths(double width, const BeamPattern& pattern) { return 2 * std::sin(width / 2) * pattern.aperture(); }

struct BeamPatternTest : ::testing::Test {
    /** An array of 60 wavelengths. */
    static BeamPattern longArray(BeamLaw law) {
        law.aperture_m = 0.12;
        return BeamPattern(law, 0.002);
    }
};

TEST_F(BeamPatternTest, WidthsMatchTheTable) {
    for (const WeightingRow& row : weightings) {
        const BeamPattern pattern = longArray(row.law());
        const CutShape one_way = getShape([&](double a) { return pattern.power(a); });
        const CutShape two_way = getShape([&](double a) { return pattern.power(a) * pattern.power(a); });
        EXPECT_NEAR(inWavelengths(one_way.width_3db, pattern), row.width, 0.01 * row.width) << row.name;
        EXPECT_NEAR(inWavelengths(two_way.width_3db, pattern), row.two_way_width, 0.01 * row.two_way_width) << row.name;
        // The amplitude instead of the power would give another width.
        const CutShape amplitude = getShape([&](double a) { return std::sqrt(pattern.power(a)); });
        EXPECT_GT(inWavelengths(amplitude.width_3db, pattern), 1.2 * row.width) << row.name;
    }
}

TEST_F(BeamPatternTest, FirstNullsAndSidelobesMatchTheTable) {
    for (const WeightingRow& row : weightings) {
        const BeamPattern pattern = longArray(row.law());
        const CutShape shape = getShape([&](double a) { return pattern.power(a); });
        EXPECT_NEAR(pattern.aperture() * std::sin(shape.first_null.value()), row.first_null, 0.02 * row.first_null)
            << row.name;
        EXPECT_NEAR(shape.peak_sidelobe_db.value(), row.peak_sidelobe_db, 0.3) << row.name;
        EXPECT_NEAR(pattern.power(*shape.first_null), 0, 1e-8) << row.name;
    }
}

TEST_F(BeamPatternTest, IntegralsMatchTheTable) {
    for (const WeightingRow& row : weightings) {
        if (!row.integral) continue;
        const BeamPattern pattern = longArray(row.law());
        const double one_way = integralOverSine([&](double a) { return pattern.power(a); }),
                     two_way = integralOverSine([&](double a) { return std::pow(pattern.power(a), 2); });
        EXPECT_NEAR(one_way * pattern.aperture(), *row.integral, 0.01 * *row.integral) << row.name;
        EXPECT_NEAR(two_way * pattern.aperture(), *row.two_way_integral, 0.01 * *row.two_way_integral) << row.name;
    }
}

TEST_F(BeamPatternTest, DolphsBeamsMatchTheTableWithSidelobesOfEqualHeight) {
    for (const DolphRow& row : dolph) {
        BeamLaw law;
        law.weighting = Weighting::Dolph;
        law.sidelobe_db = row.sidelobe_db;
        law.aperture_m = 0.064;  // 64 elements of half a wavelength
        const BeamPattern pattern(law, 0.002);
        const CutShape shape = getShape([&](double a) { return pattern.power(a); });
        EXPECT_NEAR(inWavelengths(shape.width_3db, pattern), row.width, 0.01 * row.width);
        EXPECT_NEAR(shape.peak_sidelobe_db.value(), row.sidelobe_db, 0.01);
        EXPECT_GT(10 * std::log10(pattern.power(80 * degree)), row.sidelobe_db - 30);
    }
}

TEST_F(BeamPatternTest, ABeamHasTheGivenWidthWithAnyWeighting) {
    for (const double width : {0.3, 1.0, 20.0, 60.0})
        for (const auto weighting : {Weighting::Uniform, Weighting::Cosine, Weighting::Hann, Weighting::Hamming,
                                     Weighting::Taylor, Weighting::Dolph, Weighting::Gaussian, Weighting::Piston}) {
            BeamLaw law;
            law.weighting = weighting;
            law.width_deg = width;
            const BeamPattern pattern(law);
            EXPECT_EQ(pattern.power(0), 1);
            EXPECT_NEAR(pattern.power(width / 2 * degree), 0.5, 1e-6) << width << ' ' << static_cast<int>(weighting);
            EXPECT_NEAR(getShape([&](double a) { return pattern.power(a); }).width_3db, width * degree,
                        1e-3 * width * degree);
        }
}

TEST_F(BeamPatternTest, AGaussianHasNoSidelobesAndNoPowerBehind) {
    BeamLaw law;
    law.weighting = Weighting::Gaussian;
    law.width_deg = 10;
    const BeamPattern gaussian(law);
    const CutShape shape = getShape([&](double a) { return gaussian.power(a); });
    EXPECT_FALSE(shape.first_null.has_value());
    EXPECT_FALSE(shape.peak_sidelobe_db.has_value());
    EXPECT_NEAR(10 * std::log10(gaussian.power(10 * degree)), -12.04, 0.1);
    law.weighting = Weighting::Uniform;
    EXPECT_EQ(BeamPattern(law).power(pi), 0);
    EXPECT_GT(BeamPattern(law).power(0.1), 0.2);
}

TEST_F(BeamPatternTest, SteeringWidensABeamAsTheInverseCosine) {
    const BeamPattern pattern = longArray({});
    const double axis = 60 * degree;
    EXPECT_EQ(pattern.power(axis, axis), 1);
    const CutShape shape = getShape([&](double a) { return pattern.power(axis + a, axis); });
    EXPECT_NEAR(inWavelengths(shape.width_3db, pattern), 2 * 0.8859, 0.01 * 2 * 0.8859);
}

TEST_F(BeamPatternTest, AnApertureNeedsTheWavelengthAndAWidthDoesNot) {
    BeamLaw law;
    law.aperture_m = 0.1;
    EXPECT_NEAR(BeamPattern(law, 0.002).aperture(), 50, 1e-12);
    EXPECT_NEAR(BeamPattern(law, 0.001).aperture(), 100, 1e-12);
    EXPECT_THROW(BeamPattern{law}, types::ConfigError);
    law.aperture_m.reset();
    law.width_deg = 1;
    EXPECT_EQ(BeamPattern(law).power(0.02), BeamPattern(law, 0.1).power(0.02));
}

TEST_F(BeamPatternTest, AMeasuredTableGivesTheMeasuredPattern) {
    const Folder folder;
    BeamLaw law;
    law.weighting = Weighting::Taylor;
    law.width_deg = 12;
    const BeamPattern taylor(law);
    std::ofstream table_file(folder / "beam.csv");
    table_file << "angle_deg,level_db\n";
    for (double angle = 0; angle <= 60; angle += 0.1)  // one side, not relative to its axis
        table_file << angle << ',' << 5 + 10 * std::log10(std::max(1e-8, taylor.power(angle * degree))) << '\n';
    table_file.close();
    BeamLaw measured_law;
    measured_law.file = folder / "beam.csv";
    const BeamPattern measured(measured_law);
    EXPECT_EQ(measured.aperture(), 0);
    for (const double angle : {-20.0, -7.3, 0.0, 3.0, 15.05, 40.0})
        EXPECT_NEAR(measured.power(angle * degree), taylor.power(angle * degree), 2e-3) << angle;
    EXPECT_EQ(measured.power(61 * degree), 0);
    const CutShape a = getShape([&](double x) { return measured.power(x); }),
                   b = getShape([&](double x) { return taylor.power(x); });
    EXPECT_NEAR(a.width_3db, b.width_3db, 0.01 * b.width_3db);
    EXPECT_NEAR(*a.first_null, *b.first_null, 0.02 * *b.first_null);
    EXPECT_NEAR(*a.peak_sidelobe_db, *b.peak_sidelobe_db, 0.3);
}

TEST_F(BeamPatternTest, DiagnosticsOfATableHaveFileLineAndColumn) {
    const Folder folder;
    const auto findDiagnostic = [&](const std::string& text) {
        std::ofstream(folder / "beam.csv") << text;
        BeamLaw law;
        law.file = folder / "beam.csv";
        return test::computeError<types::ConfigError>([&] { BeamPattern pattern(law); });
    };
    EXPECT_THAT(findDiagnostic("angle,level\n"),
                HasSubstr("beam.csv:1:1: is 'angle,level'; the header must have angle_deg,level_db"));
    EXPECT_THAT(findDiagnostic("angle_deg,level_db\n0,0\n1,loud\n"), HasSubstr("beam.csv:3:3: level_db: is 'loud'"));
    EXPECT_THAT(findDiagnostic("angle_deg,level_db\n0,0\n0,-1\n"), HasSubstr("beam.csv:3:1: angle_deg: is not above"));
    EXPECT_THAT(findDiagnostic("angle_deg,level_db\n0,0\n1,-1,2\n"),
                HasSubstr("beam.csv:3:6: has too many fields; a line has 2"));
    EXPECT_THAT(findDiagnostic("angle_deg,level_db\n0,0\n200,nan\n"), HasSubstr("beam.csv:3:5: level_db: is 'nan'"));
    EXPECT_THAT(findDiagnostic("angle_deg,level_db\n0,0\n"), HasSubstr("needs at least 2"));
    EXPECT_THAT(findDiagnostic("angle_deg,level_db\n5,0\n6,0\n"), HasSubstr("does not include 0"));
    EXPECT_THAT(findDiagnostic(""), HasSubstr("is empty"));
    BeamLaw nowhere;
    nowhere.file = folder / "nowhere.csv";
    EXPECT_THROW(BeamPattern{nowhere}, types::ConfigError);
}

TEST_F(BeamPatternTest, ALawHasOneWidthAndOnlyTheParametersOfItsWeighting) {
    EXPECT_EQ(test::countRefusals(BeamLaw{}).size(), 1u);
    BeamLaw law;
    law.width_deg = 1;
    EXPECT_TRUE(test::countRefusals(law).empty());
    law.sidelobe_db = -30;
    EXPECT_THAT(test::countRefusals(law).at(0), testing::StartsWith("sidelobe_db: "));
    law.weighting = Weighting::Dolph;
    EXPECT_TRUE(test::countRefusals(law).empty());
    law.sidelobe_db = -5;
    law.nbar = 4;
    EXPECT_EQ(test::countRefusals(law).size(), 2u);
    law.sidelobe_db = -30;
    law.weighting = Weighting::Taylor;
    EXPECT_TRUE(test::countRefusals(law).empty());
    law.aperture_m = 0.1;
    EXPECT_EQ(test::countRefusals(law).size(), 1u);
    BeamLaw gaussian;
    gaussian.weighting = Weighting::Gaussian;
    gaussian.aperture_m = 0.1;
    EXPECT_THAT(test::countRefusals(gaussian).at(0), testing::StartsWith("aperture_m: "));
}

}  // namespace
}  // namespace insonify::acoustics
