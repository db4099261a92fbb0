#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/sonar/beams/Directivity.hpp"
#include "components/sonar/bins/Beamformer.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using types::radians;

constexpr size_t bin_count = 7;

Fan sideBySide(double low, double high, int count) {
    const double width = (high - low) / count;
    std::vector<Beam> all;
    for (int i = 0; i < count; ++i) all.push_back({low + (i + 0.5) * width, low + i * width, low + (i + 1) * width});
    return Fan::sorted(std::move(all));
}

/** A lobe of 2 deg about each bearing, and sidelobes of 1e-3 all over. */
double lobe(double azimuth, double bearing) {
    const double off = (azimuth - bearing) / radians(2);
    return std::exp(-off * off) + 1e-3 * (1 + std::cos(azimuth));
}

/** Returns the bins of one beam, with cells whose bins all contain the number of the cell. */
std::vector<float> formed(Beamformer& beamformer, size_t beam, const std::vector<float>& echoes) {
    for (size_t group = 0; group < beamformer.groupCount(); ++group) beamformer.sumGroup(group, echoes);
    std::vector<float> bins(bin_count);
    beamformer.form(beam, echoes, bins);
    return bins;
}

struct BeamformerTest : testing::Test {
    Fan beams_ = sideBySide(radians(-30), radians(30), 30);
    Fan cells_ = sideBySide(radians(-60), radians(60), 237);  // the last group is not full
    Beamformer beamformer_{beams_, cells_, bin_count, {lobe, radians(8), 1e-6}};
};

TEST_F(BeamformerTest, ACellEchoesInEachBeamByItsWeightInTheBeam) {
    for (const size_t cell : {size_t{0}, size_t{100}, size_t{118}, size_t{236}}) {
        std::vector<float> echoes(cells_.size() * bin_count);
        echoes[cell * bin_count + 3] = 2;
        for (const size_t beam : {size_t{0}, size_t{15}, size_t{29}}) {
            const std::vector<float> bins = formed(beamformer_, beam, echoes);
            EXPECT_FLOAT_EQ(bins[3], 2 * static_cast<float>(beamformer_.weights(beam)[cell]));
            EXPECT_EQ(bins[2], 0);
            EXPECT_EQ(bins[4], 0);
        }
    }
}

TEST_F(BeamformerTest, WeighsNearCellsByTheMeanOfThePatternAndFarCellsInGroups) {
    const Beam& beam = beams_[10];
    const std::vector<double> weights = beamformer_.weights(10);
    size_t single = 0;
    for (size_t c = 0; c < cells_.size(); ++c) {
        double mean = 0;
        constexpr int points = 1000;
        for (int i = 0; i < points; ++i)
            mean += lobe(cells_[c].low + (i + 0.5) / points * (cells_[c].high - cells_[c].low), beam.centre) / points;
        if (std::abs(cells_[c].centre - beam.centre) < radians(8)) {
            EXPECT_NEAR(weights[c], mean, 2e-5) << c << ": by Simpson's rule";
            ++single;
        } else {
            EXPECT_NEAR(weights[c], mean, 3e-5) << c << ": half a group of sidelobes that slope by 1e-3";
        }
    }
    EXPECT_GT(single, 20u);
}

TEST_F(BeamformerTest, EnergyFromAllAroundIsThePatternsIntegral) {
    const std::vector<float> even(cells_.size() * bin_count, 1.0f);
    const double width = cells_.front().high - cells_.front().low;
    for (const size_t beam : {size_t{0}, size_t{14}, size_t{29}}) {
        double integral = 0;
        for (double azimuth = radians(-60); azimuth < radians(60); azimuth += 1e-5)
            integral += 1e-5 * lobe(azimuth, beams_[beam].centre);
        EXPECT_NEAR(static_cast<double>(formed(beamformer_, beam, even)[0]) * width, integral, 1e-5 * integral + 1e-6);
    }
}

TEST_F(BeamformerTest, WeightsBelowTheFloorAreOmitted) {
    const Beamformer deaf{beams_, cells_, bin_count, {lobe, radians(8), 0.01}};
    const std::vector<double> weights = deaf.weights(0);
    EXPECT_EQ(weights.back(), 0);
    EXPECT_GT(weights[60], 0.1) << "its own bearing";
    EXPECT_GT(beamformer_.weights(0).back(), 0);
}

/** Echoes drawn at random in some of the bins of each cell, 0 in the others. */
std::vector<float> drawEchoes(size_t cells, size_t bins, size_t first, size_t end) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<float> echoes(cells * bins);
    for (size_t cell = 0; cell < cells; ++cell)
        for (size_t k = first; k < end; ++k) echoes[cell * bins + k] = normal(random);
    return echoes;
}

TEST_F(BeamformerTest, BinsWithoutEchoesAreLeftOutBitForBit) {
    constexpr size_t bins = 600, first = 290, end = 390;  // across tiles
    const Beamformer::Rules rules{lobe, radians(8), 1e-6};
    Beamformer sparse{beams_, cells_, bins, rules}, dense{beams_, cells_, end - first, rules};
    const std::vector<float> echoes = drawEchoes(cells_.size(), bins, first, end),
                             part = drawEchoes(cells_.size(), end - first, 0, end - first);
    for (size_t group = 0; group < sparse.groupCount(); ++group) {
        sparse.sumGroup(group, echoes);
        dense.sumGroup(group, part);
    }
    std::vector<float> of_sparse(bins), of_dense(end - first);
    for (const size_t beam : {size_t{0}, size_t{15}, size_t{29}}) {
        sparse.form(beam, echoes, of_sparse);
        dense.form(beam, part, of_dense);
        for (size_t k = 0; k < bins; ++k)
            ASSERT_EQ(of_sparse[k], k >= first && k < end ? of_dense[k - first] : 0) << beam << " " << k;
    }
}

/** A complex pattern is formed as two real ones; the edges that its cells share may round differently. */
TEST_F(BeamformerTest, TheQuadratureIsFormedByTheImaginaryPartOfThePattern) {
    const auto pattern = [](double azimuth, double bearing) {
        return std::polar(std::sqrt(lobe(azimuth, bearing)), 40 * (azimuth - bearing));
    };
    const auto real = [&](double azimuth, double bearing) { return pattern(azimuth, bearing).real(); };
    const auto imaginary = [&](double azimuth, double bearing) { return pattern(azimuth, bearing).imag(); };
    Beamformer::Rules rules{pattern, radians(360), 1e-6, true};
    rules.is_complex = true;
    Beamformer both{beams_, cells_, bin_count, rules};
    Beamformer first{beams_, cells_, bin_count, {real, radians(360), 1e-6, true}};
    Beamformer second{beams_, cells_, bin_count, {imaginary, radians(360), 1e-6, true}};
    ASSERT_TRUE(both.isComplex());
    ASSERT_FALSE(first.isComplex());
    const std::vector<float> echoes = drawEchoes(cells_.size(), bin_count, 0, bin_count);
    std::vector<float> quadrature(bin_count);
    for (const size_t beam : {size_t{0}, size_t{15}, size_t{29}}) {
        const std::vector<float> a = formed(both, beam, echoes), b = formed(first, beam, echoes),
                                 c = formed(second, beam, echoes);
        both.formQuadrature(beam, 1, echoes, quadrature);
        for (size_t k = 0; k < bin_count; ++k) {
            EXPECT_NEAR(a[k], b[k], 1e-6);
            EXPECT_NEAR(quadrature[k], c[k], 1e-6);
            EXPECT_GT(std::abs(c[k]), 1e-4) << "there is one";
        }
    }
}

SonarConfig sonarWith(acoustics::BeamLaw law) {
    SonarConfig config;
    config.beam_pattern.emplace().receive.azimuth = law;
    return config;
}

acoustics::BeamLaw computeWidth(double degrees, acoustics::Weighting weighting = acoustics::Weighting::Hann) {
    acoustics::BeamLaw law;
    law.weighting = weighting;
    law.width_deg = degrees;
    return law;
}

TEST(DirectivityTest, AStraightArraysBeamsWidenAsTheyAreSteeredAndThoseOfACurvedArrayDoNot) {
    SonarConfig config = sonarWith(computeWidth(2));
    const Directivity curved(config);
    config.beam_geometry = BeamGeometry::Conical;
    const Directivity straight(config);
    const double steered = radians(60);
    EXPECT_NEAR(curved.azimuth(steered + radians(1), steered), 0.5, 1e-3);
    EXPECT_NEAR(straight.azimuth(radians(1), 0), 0.5, 1e-3);
    EXPECT_NEAR(straight.azimuth(steered + radians(2), steered), 0.5, 0.05) << "twice as wide at 60 deg";
    EXPECT_GT(straight.azimuth(steered + radians(1), steered), 0.8);
}

TEST(DirectivityTest, CellsReachToTheFloorAndAreFinerThanBeams) {
    SonarConfig config = sonarWith(computeWidth(2));
    config.field_of_view_deg = 60;
    config.beam_count = 60;
    const SonarConfig sampled = sampledConfig(config, Directivity(config), true);
    EXPECT_LE(*sampled.beam_width_deg, 0.5);
    EXPECT_GT(sampled.coverageDeg(), 62);
    config.beam_pattern->floor_db = -20;
    const double nearer = sampledConfig(config, Directivity(config), true).coverageDeg();
    EXPECT_LT(nearer, sampled.coverageDeg());
    EXPECT_GT(nearer, 59 + 2) << "from one outer bearing to the other, and the main lobe";
    EXPECT_EQ(sampled.beam_height_deg, config.beam_height_deg) << "without a law in elevation, as given";
}

TEST(DirectivityTest, SidelobesInElevationReachBeyondTheGivenAperture) {
    SonarConfig config;
    config.beam_pattern.emplace().receive.elevation = computeWidth(20, acoustics::Weighting::Uniform);
    const SonarConfig sampled = sampledConfig(config, Directivity(config), true);
    EXPECT_GT(sampled.beam_height_deg, 150);
    EXPECT_EQ(sampled.beams(), config.beams()) << "without a law in azimuth, beams are boxes";
}

}  // namespace
}  // namespace insonify::sonar
