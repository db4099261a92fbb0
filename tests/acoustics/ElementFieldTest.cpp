#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/acoustics/BeamPattern.hpp"
#include "types/text/Hash.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

/** Parts of random magnitude and phase. */
std::vector<Complex> randomParts(size_t count, uint64_t seed) {
    std::vector<Complex> parts;
    for (size_t m = 0; m < count; ++m) {
        const uint64_t word = types::hashed(seed, m, count);
        parts.push_back(std::polar(types::unit(word >> 32), 2 * pi * types::unit(word & 0xffffffff)));
    }
    return parts;
}

TEST(ElementFieldTest, TheTableMatchesTheSumOverTheElementsAtAnyU) {
    for (const size_t count : {2u, 3u, 17u, 64u, 255u})
        for (uint64_t seed = 0; seed < 3; ++seed) {
            const std::vector<Complex> parts = randomParts(count, seed);
            const ElementField field(parts);
            double magnitudes = 0;
            for (const Complex& part : parts) magnitudes += std::abs(part);
            for (double u = -2.3 * static_cast<double>(count); u < 2.3 * static_cast<double>(count); u += 0.0931) {
                Complex sum;
                for (size_t m = 0; m < count; ++m)
                    sum += parts[m] * std::polar(1.0, 2 * pi * u * elementPlace(m, count));
                ASSERT_LT(std::abs(field.at(u) - sum), 1e-4 * magnitudes) << count << " at " << u;
            }
        }
    EXPECT_EQ(ElementField().at(3.3), 0.0);
}

TEST(ElementFieldTest, EqualElementsHaveTheClosedFormOfALine) {
    constexpr size_t count = 24;
    const ElementField field(std::vector<Complex>(count, 1.0 / count));
    for (double u = -20; u < 20; u += 0.0713) {
        const double x = pi * u / count;
        const double closed = std::abs(x) < 1e-9 ? 1 : std::sin(count * x) / (count * std::sin(x));
        EXPECT_NEAR(field.at(u).real(), closed, 1e-4) << u;
        EXPECT_NEAR(field.at(u).imag(), 0, 1e-9) << u;
    }
}

}  // namespace
}  // namespace insonify::acoustics
