#include <gtest/gtest.h>

#include <cmath>

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
