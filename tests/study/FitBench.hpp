#pragma once
// Helpers for tests of fits to simulated recordings.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "components/study/Shapes.hpp"
#include "components/study/fit/FitReport.hpp"
#include "components/study/fit/RecordingFit.hpp"

namespace insonify::study {

/** Random numbers that are the same with every standard library. */
class Draws {
public:
    explicit Draws(uint32_t seed) : random_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(random_()) + 0.5) / 4294967296.0;
    }

private:
    std::mt19937 random_;
};

inline types::GeometryPtr floorAt(double z) {
    auto geometry = std::make_shared<types::Geometry>();
    geometry->materials = {{}};
    geometry->meshes = {levelGround(static_cast<float>(z))};
    geometry->objects.push_back({"floor", 0, glm::dmat4(1)});
    return geometry;
}

/** Returns the mean level of the loudest block of a chain's ping, relative to full scale [dB]. */
inline double loudestLevelDb(FitChain chain) {
    chain.receiver.code->full_scale_db = 60;
    chain.receiver.code->law = receiver::CodeLaw::Log;
    chain.receiver.code->gamma = 1;
    chain.receiver.code->bits = 16;
    chain.receiver.code->dynamic_range_db = 250;
    const LevelBlocks blocks = makeBlocks(simulatedPings(chain, 1).front());
    return 60 + *std::ranges::max_element(blocks.level);
}

/** Expects a finding that is determined, and within a tolerance. */
inline void expectFound(const RecordingFit& fit, const char* name, double expected, double tolerance) {
    const Finding* finding = fit.finding(name);
    ASSERT_NE(finding, nullptr) << name;
    EXPECT_TRUE(finding->is_determined) << name << ": " << finding->text();
    EXPECT_NEAR(finding->found.value, expected, tolerance) << name << ": " << finding->text();
}

/** Returns the gain of a receiver's tvg at the end of the range minus that at a tenth of the range [dB]. */
inline double tvgSpanDb(double log_coefficient, double db_per_m, double range) {
    return log_coefficient + 2 * db_per_m * 0.9 * range;
}

/** Expects what fits find of every simulated sonar. Returns whether the density of scatterers is determined.
 *  @param density_off max error of that density, if it is determined [1] */
inline bool expectTruth(const RecordingFit& fit, const auto& truth, double range, double density_off = 0.2) {
    for (const Finding& finding : fit.findings) testing::Test::RecordProperty(finding.name, finding.text());
    expectFound(fit, "full scale", truth.chain.receiver.code->full_scale_db, 1);
    expectFound(fit, "noise", truth.noise_db, 1);
    const double span = tvgSpanDb(truth.log_coefficient, truth.db_per_m, range);
    expectFound(fit, "TVG span", span, 0.05 * span);
    expectFound(fit, "pulse length", truth.pulse_m, 0.06 * truth.pulse_m);
    const Finding* shape = fit.finding("scatterers per cell");
    EXPECT_NE(shape, nullptr);
    if (!shape) return false;
    const double ratio = fit.chain.sonar.speckle->scatterers_per_m2.value_or(0) / truth.density;
    testing::Test::RecordProperty("density over truth", fmt::format("{:.4f}", ratio));
    const double true_shape = shape->found.value / ratio;  // because the cell is the same
    EXPECT_TRUE(shape->found.low < true_shape && true_shape < shape->found.high) << shape->text();
    if (shape->is_determined) {  // then the interval is narrow
        EXPECT_NEAR(ratio, 1, density_off) << shape->text();
        EXPECT_LT(shape->found.half(), 0.5 * shape->found.value) << shape->text();
    }
    return shape->is_determined;
}

/** Returns `few`, or the seeds from 2 to INSONIFY_FIT_SEEDS if that is set, for the numbers on the pages of studies. */
inline std::vector<uint32_t> fitSeeds(std::vector<uint32_t> few) {
    const char* const last = std::getenv("INSONIFY_FIT_SEEDS");
    if (!last) return few;
    std::vector<uint32_t> all;
    for (uint32_t seed = 2; seed <= std::stoul(last); ++seed) all.push_back(seed);
    return all;
}

}  // namespace insonify::study
