#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "components/acoustics/Backscatter.hpp"
#include "tests/acoustics/Degree.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

/** Returns the integral of a function of the angle of incidence, from 0 to a right angle. */
double overIncidence(const auto& f) {
    constexpr int cells = 200000;
    double sum = 0;
    for (int i = 0; i < cells; ++i) sum += f((i + 0.5) / cells * pi / 2);
    return sum * pi / 2 / cells;
}

/** Returns the echo of a sphere of radius a whose surface scatters by a law of the cosine of incidence [m^2]. */
double sphereSection(double a, const auto& section) {
    return overIncidence([&](double t) { return 2 * pi * a * a * std::sin(t) * section(std::cos(t)); });
}

TEST(BackscatterTest, ALambertSphereEchoesAsTwoThirdsOfPiOfItsParameter) {
    const double mu = std::pow(10, -1.67);
    EXPECT_NEAR(sphereSection(0.5, [](double c) { return lambertSection(-16.7, c); }), mu * 2 * pi * 0.25 / 3, 1e-9);
    EXPECT_NEAR(10 * std::log10(lambertSection(-27, std::sin(30 * degree))), -27 - 6.0206, 1e-4);
}

TEST(BackscatterTest, TheLobeGivesASphereItsTargetStrengthWithAnySlope) {
    for (const double slope : {0.02, 0.1, 0.3}) {
        const double received = sphereSection(2, [&](double c) { return objectSection(-300, 0.9, slope * slope, c); });
        EXPECT_NEAR(received, 0.81 * 4.0 / 4 * (1 + slope * slope / 2), 2e-3) << slope;
        // Without sec^4 a rough sphere would have another strength.
        const double bare =
            sphereSection(2, [&](double c) { return objectSection(-300, 0.9, slope * slope, c) * std::pow(c, 4); });
        if (slope > 0.2) {
            EXPECT_LT(bare, 0.95 * received);
        }
    }
}

/** Returns the echo of an ellipsoid of semi-axes a, b, c along a, whose surface scatters by a law of the cosine
 *  [m^2]. */
double ellipsoidSection(double a, double b, double c, const auto& section) {
    constexpr int rings = 4000, cells = 200;
    double sum = 0;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < cells; ++j) {
            const double u = (i + 0.5) / rings * pi / 2, v = (j + 0.5) / cells * 2 * pi;
            // The normal times the area of a cell of (a cos u, b sin u cos v, c sin u sin v).
            const double x = b * c * std::sin(u) * std::cos(u), y = a * c * std::sin(u) * std::sin(u) * std::cos(v),
                         z = a * b * std::sin(u) * std::sin(u) * std::sin(v);
            const double area = std::sqrt(x * x + y * y + z * z);
            sum += area * section(x / area);
        }
    return sum * (pi / 2 / rings) * (2 * pi / cells);
}

TEST(BackscatterTest, TheLobeGivesAnEllipsoidItsTargetStrength) {
    const double slope = 0.05, received = ellipsoidSection(2, 0.7, 0.4, [&](double cosine) {
                                   return objectSection(-300, 1, slope * slope, cosine);
                               });
    const double urick = std::pow(0.7 * 0.4 / (2 * 2), 2);
    EXPECT_NEAR(10 * std::log10(received / urick), 0, 0.05);
    // A sphere of the ellipsoid's length would have another strength.
    EXPECT_GT(10 * std::log10(1 / urick), 20);
}

TEST(BackscatterTest, TheLobeOfASmoothPlateIsItsTargetStrengthAtNormalIncidence) {
    const double wavelength = 0.002, area = 0.04;
    const Slopes smooth{0, 0, wavelength, area};
    const double sigma = area * objectSection(-300, 1, smooth.meanSquare(), 1);
    EXPECT_NEAR(sigma, area * area / (wavelength * wavelength), 1e-9 * sigma);
    // The cell is the area of the plate: half the area would give half the echo.
    const Slopes half{0, 0, wavelength, area / 2};
    EXPECT_NEAR(area * objectSection(-300, 1, half.meanSquare(), 1), sigma / 2, 1e-9 * sigma);
}

TEST(BackscatterTest, SlopesOfReliefMeshAndWaveAddAsSquares) {
    EXPECT_NEAR((Slopes{0.1, 0.2, 0, 1}.meanSquare()), 0.05, 1e-15);
    EXPECT_NEAR((Slopes{0.1, 0, 0.002, 1e-6}.meanSquare()), 0.01 + 4e-6 / (4 * pi * 1e-6), 1e-12);
    for (const double cosine : {0.0, 1e-6, 0.5, 1.0})
        EXPECT_TRUE(std::isfinite(objectSection(-20, 1, 1e-6, cosine))) << cosine;
}

TEST(BackscatterTest, AFluidHalfSpaceReflectsByItsImpedanceAtTheNormal) {
    const HalfSpace sand{1.845, 1.1782, 0};
    EXPECT_NEAR(halfSpaceReflection(sand, pi / 2).real(), (1.845 * 1.1782 - 1) / (1.845 * 1.1782 + 1), 1e-12);
    EXPECT_NEAR(halfSpaceReflection(sand, 1e-6).real(), -1, 1e-5);
    // Below the critical angle of a fast half-space all is reflected; just above, not.
    const double critical = std::acos(1 / 1.1782);
    EXPECT_NEAR(std::abs(halfSpaceReflection(sand, 0.95 * critical)), 1, 1e-12);
    EXPECT_LT(std::abs(halfSpaceReflection(sand, 1.05 * critical)), 0.9);
}

TEST(BackscatterTest, TheLossOfSeabedsMatchesFigure1OfTheReport) {
    // APL-UW TR 9407, figure 1: silt of 6 phi peaks at some 35 dB near 16 deg and loses 24 dB at the vertical; rock
    // less than 0.1 dB below its critical angle of 66 deg, and 2.8 dB at the vertical.
    const auto lossDb = [](const char* name, double grazing_deg) {
        return -20 *
               std::log10(std::abs(halfSpaceReflection(halfSpace(seabedNamed(name).value()), grazing_deg * degree)));
    };
    double peak = 0, peak_deg = 0;
    for (double grazing = 1; grazing <= 90; grazing += 0.5)
        if (lossDb("silt", grazing) > peak) {
            peak = lossDb("silt", grazing);
            peak_deg = grazing;
        }
    EXPECT_NEAR(peak_deg, 16, 2);
    EXPECT_NEAR(peak, 35, 2);
    EXPECT_NEAR(lossDb("silt", 90), 24, 1.5);
    EXPECT_LT(lossDb("rock", 30), 0.1);
    EXPECT_LT(lossDb("rock", 60), 0.1);
    EXPECT_NEAR(lossDb("rock", 90), 2.8, 0.3);
}

TEST(BackscatterTest, ATableIsItsLawOverTheCosine) {
    const BackscatterTable lambert([](double grazing) { return lambertSection(-16.7, std::sin(grazing)); });
    EXPECT_EQ(lambert.values().size(), 1024u);
    for (size_t i = 1; i < 1024; ++i) {
        const double cosine = BackscatterTable::computeCosine(static_cast<int>(i));
        EXPECT_NEAR(lambert.values()[i], std::pow(10, -1.67) * cosine, 1e-12) << cosine;
    }
}

TEST(BackscatterTest, ATableIsClampedNearGrazing) {
    const BackscatterTable table([](double grazing) { return grazing; });
    EXPECT_NEAR(table.values()[0], 1, 1e-6);
    EXPECT_NEAR(table.values()[1023], pi / 2, 1e-9);
}

TEST(BackscatterTest, ReadsAMeasuredTableAndReportsErrorsWithTheirPlace) {
    const Folder folder;
    std::ofstream(folder / "sand.csv") << "grazing_deg,strength_db\n10,-30\n30,-20\n\n90,-10\n";
    const Curve measured = readBackscatter(folder / "sand.csv");
    EXPECT_NEAR(10 * std::log10(measuredSection(measured, 20 * degree)), -25, 1e-9);
    EXPECT_NEAR(10 * std::log10(measuredSection(measured, 90 * degree)), -10, 1e-9);
    EXPECT_NEAR(10 * std::log10(measuredSection(measured, 1 * degree)), -30, 1e-9);
    std::ofstream(folder / "bad.csv") << "grazing_deg,strength_db\n10,-30\n91,-20\n95,loud\n";
    const std::vector<std::string> refusals = test::refused([&] { readBackscatter(folder / "bad.csv"); });
    EXPECT_THAT(refusals, Contains(HasSubstr("bad.csv:3:1: grazing_deg: is '91'; it must be a number from 0 to 90")));
    EXPECT_THAT(refusals, Contains(HasSubstr("bad.csv:4:4: strength_db: is 'loud'")));
    EXPECT_EQ(refusals.size(), 3u);
}

}  // namespace
}  // namespace insonify::acoustics
