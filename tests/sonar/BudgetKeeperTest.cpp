#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "components/sonar/renderer/QualityKeeper.hpp"

namespace insonify::sonar {
namespace {

constexpr double minimum = 32768, maximum = 4e6;

/** A machine on which a ping takes a constant time plus a time per sample, and a ladder with rungs of 9 %. */
struct Machine {
    double fixed_ms = 1, ms_per_sample = 4e-5, jitter = 0;
    std::minstd_rand random{7};

    static double rung(double limit) {
        const double steps = std::floor(8 * std::log2(std::max(limit, minimum) / minimum) + 1e-9);
        return std::min(maximum, minimum * std::exp2(steps / 8));
    }
    double ms(double samples) {
        const double noise = 2 * static_cast<double>(random()) / std::minstd_rand::max() - 1;
        return (fixed_ms + samples * ms_per_sample) * (1 + jitter * noise);
    }
    /** Returns the times of a number of pings. */
    std::vector<double> run(BudgetKeeper& keeper, int pings) {
        std::vector<double> times;
        for (int i = 0; i < pings; ++i) {
            const double samples = rung(keeper.limit());
            times.push_back(ms(samples));
            keeper.note(times.back(), samples);
        }
        return times;
    }
};

double median(std::vector<double> times) {
    std::ranges::sort(times);
    return times[times.size() / 2];
}

TEST(BudgetKeeperTest, UsesAtLeastFourFifthsOfTheBudgetAndDoesNotExceedIt) {
    for (const double fixed_ms : {0.1, 1.0, 5.0})
        for (const double budget : {10.0, 33.0, 80.0}) {
            Machine machine{fixed_ms, 4e-5, 0.03};
            BudgetKeeper keeper(budget, minimum);
            machine.run(keeper, 60);
            const std::vector<double> times = machine.run(keeper, 200);
            EXPECT_GE(median(times), 0.8 * budget) << fixed_ms << " ms and more";
            EXPECT_LE(std::ranges::count_if(times, [&](double ms) { return ms > budget; }), 10) << budget << " ms";
        }
}

TEST(BudgetKeeperTest, TwoLatePingsInTwentyLowerTheQualityAndOneDoesNot) {
    BudgetKeeper keeper(10, 1e5);
    EXPECT_FALSE(keeper.note(11, 1e5));
    for (int i = 0; i < 25; ++i) EXPECT_FALSE(keeper.note(9.5, 1e5)) << "one late ping is forgotten";
    EXPECT_FALSE(keeper.note(12, 1e5));
    EXPECT_TRUE(keeper.note(12, 1e5));
    EXPECT_NEAR(keeper.limit(), 0.9 * 10 / 12 * 1e5, 1);
}

TEST(BudgetKeeperTest, TheQualityFallsOnABusyMachineAndRecoversInSomeTensOfPings) {
    Machine machine;
    BudgetKeeper keeper(33, minimum);
    machine.run(keeper, 100);
    const double before = keeper.limit();
    machine.ms_per_sample *= 3;
    const std::vector<double> busy = machine.run(keeper, 40);
    EXPECT_LT(keeper.limit(), before / 2);
    EXPECT_LE(std::ranges::count_if(busy, [](double ms) { return ms > 33; }), 4);
    machine.ms_per_sample /= 3;
    machine.run(keeper, 60);
    EXPECT_GE(median(machine.run(keeper, 20)), 0.8 * 33);
}

TEST(BudgetKeeperTest, DoesNotOscillateBetweenTwoQualities) {
    Machine machine;
    machine.jitter = 0.12;
    BudgetKeeper keeper(33, minimum);
    int moves = 0;
    for (int i = 0; i < 2000; ++i) {
        const double samples = Machine::rung(keeper.limit());
        moves += keeper.note(machine.ms(samples), samples);
    }
    EXPECT_LE(moves, 40);
}

TEST(BudgetKeeperTest, DoesNotExceedTheQualityThatAPingNeeds) {
    BudgetKeeper keeper(33);
    for (int i = 0; i < 200; ++i) EXPECT_FALSE(keeper.note(1, minimum));
    BudgetKeeper limited(33, 1e6);
    for (int i = 0; i < 200; ++i) EXPECT_FALSE(limited.note(10, minimum)) << "the budget is not used up";
}

TEST(BudgetKeeperTest, AChangedBudgetAppliesAtOnce) {
    Machine machine;
    BudgetKeeper keeper(33, minimum);
    machine.run(keeper, 100);
    keeper.setBudget(10);
    machine.run(keeper, 20);
    EXPECT_LE(median(machine.run(keeper, 20)), 10);
}

TEST(PeriodMeterTest, IgnoresAMissingPingAndTwoAtOnce) {
    PeriodMeter meter;
    EXPECT_EQ(meter.period(), 0);
    for (int i = 0; i < 40; ++i) meter.note(i % 4 == 0 ? 0.2 : i % 16 == 1 ? 0.001 : 0.1);
    EXPECT_EQ(meter.period(), 0.1);
    for (int i = 0; i < 16; ++i) meter.note(0.05);
    EXPECT_EQ(meter.period(), 0.05);
}

}  // namespace
}  // namespace insonify::sonar
