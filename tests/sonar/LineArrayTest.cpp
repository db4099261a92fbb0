// Elements of a straight array, and beams formed from them, compared with sums and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/sonar/bins/LineArray.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
namespace {

using acoustics::Taper;
using acoustics::Weighting;
using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double line_wavelength = 0.002;
const Taper uniform(Weighting::Uniform);

LineArray halfWave(size_t count, const Taper& taper = uniform) {
    return {count, line_wavelength / 2, line_wavelength, taper};
}

/** Cells of a complex Gaussian field, at sines from -0.9 to 0.9. */
struct Cells {
    ComplexRows field;
    std::vector<Cone> cones;
};

Cells speckled(size_t cells, size_t samples) {
    Cells made{ComplexRows(cells, samples), {}};
    for (size_t cell = 0; cell < cells; ++cell) {
        const double sine = 1.8 * (static_cast<double>(cell) + 0.5) / static_cast<double>(cells) - 0.9;
        made.cones.push_back({sine, sine});
        for (size_t i = 0; i < samples; ++i) {
            const uint64_t word = types::hashed(3, cell, i);
            made.field.row(cell)[i] = std::complex<float>(
                std::polar(std::sqrt(-std::log(types::unit(word >> 32))), 2 * pi * types::unit(word & 0xffffffff)));
        }
    }
    return made;
}

/** Returns the power of one echo of unit amplitude in a beam. */
double receivedPower(const LineArray& array, double from, double looking) {
    ComplexRows echo(1, 1);
    echo.values[0] = 1;
    return std::norm(
        Complex(array.form(array.elementSignals(echo, std::vector{Cone{from, from}}), std::vector{looking}).values[0]));
}

TEST(LineArrayTest, ElementsReceiveTheSumOfEchoesWithThePhasesOfTheirPaths) {
    const LineArray array = halfWave(16);
    const Cells cells = speckled(50, 7);
    const ComplexRows received = array.elementSignals(cells.field, cells.cones);
    ASSERT_EQ(received.rowCount(), 16u);
    for (size_t m = 0; m < 16; ++m)
        for (size_t i = 0; i < 7; ++i) {
            Complex sum;
            const double place = (static_cast<double>(m) - 7.5) * line_wavelength / 2;
            for (size_t cell = 0; cell < 50; ++cell)
                sum += Complex(cells.field.row(cell)[i]) *
                       std::polar(1.0, 2 * pi / line_wavelength * place * cells.cones[cell].low);
            EXPECT_NEAR(std::abs(Complex(received.row(m)[i]) - sum), 0, 1e-4) << m << " " << i;
        }
}

TEST(LineArrayTest, AWideCellEqualsTheSumOfNarrowCells) {
    const LineArray array = halfWave(32);
    ComplexRows one(1, 1), many(1000, 1);
    one.values[0] = 1;
    std::ranges::fill(many.values, std::complex<float>(1e-3f));
    std::vector<Cone> narrow;
    for (int i = 0; i < 1000; ++i) narrow.push_back({0.2 + i * 5e-5, 0.2 + (i + 1) * 5e-5});
    const ComplexRows wide = array.elementSignals(one, std::vector{Cone{0.2, 0.25}}),
                      fine = array.elementSignals(many, narrow);
    for (size_t m = 0; m < 32; ++m) EXPECT_NEAR(std::abs(wide.row(m)[0] - fine.row(m)[0]), 0, 1e-4) << m;
}

TEST(LineArrayTest, BeamsByTheTransformMatchTheSumsOverTheElements) {
    for (const size_t count : {17u, 64u}) {
        const LineArray array = halfWave(count, Taper(Weighting::Taylor));
        const Cells cells = speckled(80, 5);
        const ComplexRows received = array.elementSignals(cells.field, cells.cones);
        std::vector<double> looking;
        for (double sine = -0.95; sine < 0.96; sine += 0.0171) looking.push_back(sine);
        const ComplexRows beams = array.form(received, looking);
        double worst = 0, mean = 0;
        for (size_t k = 0; k < looking.size(); ++k)
            for (size_t i = 0; i < 5; ++i) {
                Complex sum;
                for (size_t m = 0; m < count; ++m)
                    sum += array.weights()[m] * Complex(received.row(m)[i]) *
                           std::polar(1.0, -2 * pi / line_wavelength * array.position(m) * looking[k]);
                worst = std::max(worst, std::abs(Complex(beams.row(k)[i]) - sum));
                mean += std::abs(sum) / static_cast<double>(looking.size() * 5);
            }
        EXPECT_LT(worst, 0.01 * mean) << count;
    }
}

TEST(LineArrayTest, AUniformArrayHasThePatternOfItsClosedForm) {
    constexpr int count = 24;
    const LineArray array = halfWave(count);
    for (const double looking : {0.0, 0.3, -0.6})
        for (double from = -0.9; from < 0.9; from += 0.0137) {
            const double x = pi * 0.5 * (from - looking);
            const double expected = std::pow(std::sin(count * x) / (count * std::sin(x)), 2);
            EXPECT_NEAR(receivedPower(array, from, looking), expected, 0.012 * std::sqrt(expected) + 1e-5)
                << from << " from " << looking;
        }
}

TEST(LineArrayTest, WeightsMakeThePatternOfTheBeamLaw) {
    constexpr size_t count = 96;
    for (const Taper& taper :
         {uniform, Taper(Weighting::Hann), Taper(Weighting::Hamming), Taper(Weighting::Taylor, -30, 4),
          Taper(Weighting::Cosine), Taper(Weighting::Dolph, -30, 4, count)}) {
        const LineArray array = halfWave(count, taper);
        double sum = 0;
        for (const double weight : array.weights()) sum += weight;
        EXPECT_NEAR(sum, 1, 1e-6);
        for (double u = 0; u < 6; u += 0.11) {  // u = L / wavelength sine: as far as the fifth sidelobe
            const double received = std::sqrt(receivedPower(array, u / (0.5 * count), 0));
            EXPECT_NEAR(received, std::abs(taper.amplitude(u)), 6e-3) << u;
        }
    }
}

TEST(LineArrayTest, HannsWeightsAreARaisedCosine) {
    const LineArray array = halfWave(64, Taper(Weighting::Hann));
    for (size_t m = 0; m < 64; ++m)
        EXPECT_NEAR(array.weights()[m], (1 + std::cos(2 * pi * array.position(m) / (32 * line_wavelength))) / 64, 1e-8);
}

TEST(LineArrayTest, AnArrayCannotMakeAGaussian) {
    const Taper gaussian(Weighting::Gaussian);
    const LineArray array = halfWave(96, gaussian);
    EXPECT_GT(std::abs(std::sqrt(receivedPower(array, 0.6 / 48, 0)) - gaussian.amplitude(0.6)), 0.03);
}

TEST(LineArrayTest, ElementsFartherApartThanHalfAWaveHaveGratingLobes) {
    const LineArray sparse(32, 1.25 * line_wavelength, line_wavelength, uniform),
        dense(80, line_wavelength / 2, line_wavelength, uniform);
    const double grating = 0.1 + 1 / 1.25;  // path difference of one wavelength between neighbours
    EXPECT_NEAR(receivedPower(sparse, grating, 0.1), 1, 0.01) << "as loud as the axis";
    EXPECT_NEAR(receivedPower(sparse, 0.1, 0.1), 1, 0.01);
    EXPECT_LT(receivedPower(dense, grating, 0.1), 1e-3) << "the same aperture, filled";
}

TEST(LineArrayTest, RejectsWrongNumbersOfRows) {
    const LineArray array = halfWave(4);
    EXPECT_THROW(array.elementSignals(ComplexRows(3, 2), std::vector<Cone>(2)), std::invalid_argument);
    EXPECT_THROW(array.form(ComplexRows(3, 2), std::vector{0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace insonify::sonar
