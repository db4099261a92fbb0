// Both deposits, on the processor and by compute shader, in the pings that they make.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "components/sonar/plan/Effects.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "tests/support/Pings.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;

SonarConfig depositFan(Model model, BeamGeometry beams, Deposit deposit, double field_of_view_deg = 130) {
    SonarConfig config =
        test::getSonar({.beams = 64, .width_deg = field_of_view_deg, .height_deg = 50, .bins = 400, .rows = 128});
    config.model = model;
    config.beam_geometry = beams;
    config.deposit = deposit;
    config.device = "software";
    return config;
}

types::Snapshot hardScene() { return test::makeSnapshot(test::surfaces(), {0, 0, 0}, 0.1, 0.15, 0.05); }

struct Kind {
    Model model;
    BeamGeometry beams;
    double field_of_view_deg;
};

struct DepositTest : testing::TestWithParam<Kind> {
    SonarConfig with(Deposit deposit) const {
        return depositFan(GetParam().model, GetParam().beams, deposit, GetParam().field_of_view_deg);
    }
};

void expectAgreement(const types::Sonar& cpu, const types::Sonar& gpu) {
    const double floor = 1e-6 * *std::ranges::max_element(cpu.bins);
    size_t compared = 0;
    for (size_t i = 0; i < cpu.bins.size(); ++i) {
        const double a = cpu.bins[i], b = gpu.bins[i];
        if (std::max(a, b) <= floor) continue;
        EXPECT_LE(std::abs(a - b), 1e-4 * std::max(a, b))
            << "beam " << i / cpu.bin_count << ", bin " << i % cpu.bin_count;
        ++compared;
    }
    EXPECT_GT(compared, 3000u);
}

types::Sonar difference(types::Sonar a, const types::Sonar& b) {
    for (size_t i = 0; i < a.bins.size(); ++i) a.bins[i] = std::abs(a.bins[i] - b.bins[i]);
    return a;
}

/** Returns the snapshot with objects and sonar moved to the magnitude of UTM coordinates. */
types::Snapshot asInUtm(types::Snapshot snapshot) {
    const glm::dvec3 offset(500'000, 4'500'000, -100);
    auto geometry = std::make_shared<types::Geometry>(*snapshot.geometry);
    for (types::Object& object : geometry->objects) object.world_from_object[3] += glm::dvec4(offset, 0);
    snapshot.geometry = geometry;
    snapshot.sonar.position += offset;
    return snapshot;
}

/** Energy in 2000 bins over that in one of the same length. */
double manyOverOne(SonarConfig config, const types::Snapshot& snapshot) {
    config.bin_count = 2000;
    const double many = test::computeSum(makePing(config, snapshot));
    config.bin_count = 1;
    return many / test::computeSum(makePing(config, snapshot));
}

/** Sums that the compute shader does not support. */
class OwnSums final : public PingEffect {
    bool hasSums() const override { return true; }
};

class OwnSumsEffect final : public Effect {
    std::string key() const override { return "own_sums"; }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        return plan.config.effects.contains("own_sums");
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<OwnSums>();
    }
};

}  // namespace

TEST_P(DepositTest, TheProcessorAndTheComputeShaderAgree) {
    expectAgreement(makePing(with(Deposit::Cpu), hardScene()), makePing(with(Deposit::Gpu), hardScene()));
}

TEST_P(DepositTest, BothAgreeFarFromTheOriginOfTheWorld) {
    const types::Snapshot far = asInUtm(hardScene());
    const auto gpu = makePing(with(Deposit::Gpu), far);
    expectAgreement(makePing(with(Deposit::Cpu), far), gpu);
    types::Snapshot aside = far;
    aside.sonar.position.x += 0.01;
    EXPECT_GT(test::computeSum(difference(gpu, makePing(with(Deposit::Cpu), aside))), 1e-3 * test::computeSum(gpu))
        << "a centimetre is seen";
}

TEST_P(DepositTest, EachIsRepeatableBitForBitInANewRenderer) {
    for (Deposit where : {Deposit::Cpu, Deposit::Gpu}) {
        const types::Snapshot snapshot = hardScene();
        SonarRenderer renderer(with(where), snapshot.geometry);
        types::Sonar first, elsewhere, again;
        renderer.render(snapshot, first);
        types::Snapshot moved = snapshot;
        moved.sonar.position.x += 3;
        renderer.render(moved, elsewhere);
        renderer.render(snapshot, again);
        EXPECT_NE(first.bins, elsewhere.bins);
        EXPECT_EQ(first.bins, again.bins);
        EXPECT_EQ(first.bins, makePing(with(where), snapshot).bins);
    }
}

TEST_P(DepositTest, BothAgreeInFewBinsAndInMoreThanAWorkGroupHas) {
    for (const int bins : {30, 6000}) {
        SonarConfig cpu = with(Deposit::Cpu), gpu = with(Deposit::Gpu);
        cpu.bin_count = gpu.bin_count = bins;
        EXPECT_LT(test::relativeL2(makePing(gpu, hardScene()), makePing(cpu, hardScene())), 1e-5) << bins;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, DepositTest,
                         testing::Values(Kind{Model::Physical, BeamGeometry::Planar, 130},
                                         Kind{Model::Physical, BeamGeometry::Conical, 130},
                                         Kind{Model::Physical, BeamGeometry::Planar, 180},
                                         Kind{Model::Cerqueira2017, BeamGeometry::Planar, 130},
                                         Kind{Model::Cerqueira2017, BeamGeometry::Conical, 130},
                                         Kind{Model::Cerqueira2017, BeamGeometry::Planar, 180}),
                         [](const auto& kind) {
                             return std::string(kind.param.model == Model::Physical ? "Physical" : "Cerqueira2017") +
                                    (kind.param.beams == BeamGeometry::Planar ? "Planar" : "Conical") +
                                    std::to_string(static_cast<int>(kind.param.field_of_view_deg));
                         });

TEST(DepositPublishedTest, BothAgreeInThePublishedModelWhereMissesCount) {
    SonarConfig cpu = depositFan(Model::Cerqueira2017, BeamGeometry::Planar, Deposit::Cpu, 60);
    cpu.published = true;
    SonarConfig gpu = cpu;
    gpu.deposit = Deposit::Gpu;
    EXPECT_LT(test::relativeL2(makePing(gpu, hardScene()), makePing(cpu, hardScene())), 1e-5);
}

TEST(DepositEffectTest, ReportsAnEffectThatKeepsTheDeviceFromSumming) {
    addEffect(std::make_unique<OwnSumsEffect>());
    const types::Snapshot snapshot = hardScene();
    const types::Notice notice =
        "images are summed on the processor: the compute shader does not sum what the effect 'own_sums' sums";
    for (const bool with_effect : {false, true})
        for (Deposit where : {Deposit::Cpu, Deposit::Gpu}) {
            SonarConfig config = depositFan(Model::Physical, BeamGeometry::Planar, where);
            if (with_effect) config.effects["own_sums"] = {};
            const SonarRenderer renderer(config, snapshot.geometry);
            EXPECT_EQ(std::ranges::count(renderer.plan().notices, notice), with_effect && where == Deposit::Gpu)
                << "effect " << with_effect << ", on the device " << (where == Deposit::Gpu);
        }
    SonarConfig cpu = depositFan(Model::Physical, BeamGeometry::Planar, Deposit::Cpu), gpu = cpu;
    gpu.deposit = Deposit::Gpu;
    gpu.effects["own_sums"] = {};
    EXPECT_EQ(makePing(gpu, snapshot).bins, makePing(cpu, snapshot).bins);
}

TEST(DepositEnergyTest, OneBinHasTheEnergyOfTheBinsThatItCovers) {
    // A pixel's energy is that of the middle of its part of each bin: exact to second order in the pixel's depth, so
    // that it depends on the bins only where a pixel is deep.
    const auto wall = test::makeSnapshot(test::makeScene({test::quad({10, -100, -100}, {0, 200, 0}, {0, 0, 200})}));
    for (Deposit where : {Deposit::Cpu, Deposit::Gpu}) {
        SonarConfig config = depositFan(Model::Physical, BeamGeometry::Planar, where, 30);
        config.beam_height_deg = 20;
        EXPECT_NEAR(manyOverOne(config, wall), 1, 1e-6) << "faced";
        config = depositFan(Model::Physical, BeamGeometry::Planar, where);
        EXPECT_NEAR(manyOverOne(config, hardScene()), 1, 2e-4) << "grazed";
        config.quality.rows = 512;
        EXPECT_NEAR(manyOverOne(config, hardScene()), 1, 5e-5) << "grazed, in shallower pixels";
    }
}

}  // namespace insonify::sonar
