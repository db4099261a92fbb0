// A reset simulation, compared with a new one.
#include <gtest/gtest.h>

#include <iostream>

#include "components/deployer/Simulation.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::deployer {
namespace {

struct Restarted {
    const char* name;
    const char* deployment;
    std::vector<std::string> set = {};
    double z = 0;  ///< Height of the vehicle in WholeLabelsTest [m].
};

struct RestartTest : testing::TestWithParam<Restarted> {
    Simulation made() const {
        SimulationOptions options;
        options.overrides = GetParam().set;
        options.truth = true;
        return {test::sourceFile(std::string("deploy/") + GetParam().deployment), options};
    }
    /** Two pings, apart in place and direction. */
    static std::vector<SteppedPing> getPings(Simulation& simulation, double x, double yaw) {
        std::vector<SteppedPing> all;
        for (int step = 0; step < 2; ++step) {
            std::map<std::string, types::Pose> at;
            for (const std::string& port : simulation.poses()) {
                at[port].position = {x + step, -4, -5.5};
                at[port].orientation = glm::angleAxis(yaw + 0.1 * step, glm::dvec3(0, 0, 1));
            }
            for (SteppedPing& made : simulation.step(at, {})) all.push_back(std::move(made));
        }
        return all;
    }
};

TEST_P(RestartTest, ItsPingsEqualThoseOfANewSimulation) {
    Simulation kept = made(), fresh = made();
    for (const double x : {4.0, 18.0, 11.0}) {
        getPings(kept, x, -0.4);
        kept.reset({});
    }
    const auto again = getPings(kept, 9, 0.2), first = getPings(fresh, 9, 0.2);
    ASSERT_EQ(again.size(), first.size());
    size_t received = 0;
    for (size_t i = 0; i < first.size(); ++i) {
        ASSERT_EQ(again[i].ping == nullptr, first[i].ping == nullptr) << i;
        if (!first[i].ping) continue;
        EXPECT_EQ(again[i].ping->bins, first[i].ping->bins) << i;
        EXPECT_EQ(again[i].ping->time.microseconds, first[i].ping->time.microseconds) << i;
        for (size_t beam = 0; beam < first[i].ping->bearings.size(); ++beam)
            EXPECT_EQ(again[i].ping->bearings[beam].rad, first[i].ping->bearings[beam].rad) << i;
        ++received;
        ASSERT_TRUE(again[i].truth && first[i].truth) << i;
        EXPECT_EQ(again[i].truth->object, first[i].truth->object) << i;
    }
    EXPECT_GT(received, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    All, RestartTest,
    testing::Values(Restarted{"Fan", "truth.yml"},
                    Restarted{"Drawn", "truth.yml", {"sonar.visibility=gl", "sonar.device=software"}},
                    Restarted{"ChosenQuality", "minimal.yml", {"sonar.quality={target_error: 0.1}"}},
                    Restarted{"MotionInAPing", "truth.yml", {"sonar.motion_in_ping=true"}},
                    Restarted{"Coherent", "harbour_recording.yml"}, Restarted{"TurningHead", "harbour_msis.yml"},
                    Restarted{"SideScan", "harbour_sidescan.yml"},
                    Restarted{
                        "Grid", "harbour_sonar3d.yml", {"sonar.horizontal={beam_count: 20, field_of_view_deg: 90}"}},
                    Restarted{"Mirrors", "tank_multipath.yml"}, Restarted{"ThinWalls", "vessels.yml"}),
    [](const auto& tested) { return std::string(tested.param.name); });

class WholeLabelsTest : public testing::TestWithParam<Restarted> {};

TEST_P(WholeLabelsTest, NinetyNinePercentOfTheEnergyHasALabel) {
    SimulationOptions options;
    options.overrides = GetParam().set;
    options.truth = true;
    Simulation simulation(test::sourceFile(std::string("deploy/") + GetParam().deployment), options);
    std::map<std::string, types::Pose> at;
    for (const std::string& port : simulation.poses()) at[port].position = {0, 0, GetParam().z};
    const SteppedPing made = simulation.step(at, {}).front();
    double all = 0, labelled = 0, ghosts = 0, water = 0;
    for (size_t k = 0; k < made.ping->bins.size(); ++k) {
        const auto energy = std::max(0.0, static_cast<double>(made.ping->bins[k]));
        all += energy;
        const bool of_water = made.truth->path[k] == types::SonarTruth::water;
        if (made.truth->object[k] < 0 && !of_water) continue;
        labelled += energy;
        if (made.truth->isByMirror(k)) ghosts += energy;
        if (of_water) water += energy;
    }
    std::cout << GetParam().deployment << ": " << 100 * labelled / all << " % with a label, " << 100 * ghosts / all
              << " % by mirrors, " << 100 * water / all << " % of the water\n";
    EXPECT_GT(labelled, 0.99 * all);
    EXPECT_EQ(water > 0, std::string(GetParam().name).ends_with("Water"));
}

INSTANTIATE_TEST_SUITE_P(All, WholeLabelsTest,
                         testing::Values(Restarted{"Tank", "tank_multipath.yml"},
                                         Restarted{"Harbour", "harbour_fls.yml", {"noise.speckle=null"}, -5.5},
                                         Restarted{"HarbourInWater",
                                                   "harbour_fls.yml",
                                                   {"noise.speckle=null", "sonar.volume={strength_db: -60}"},
                                                   -5.5},
                                         Restarted{"ThinWalls", "vessels.yml"}, Restarted{"Fish", "fish.yml", {}, -5},
                                         Restarted{"FishInWater", "fish.yml", {"sonar.volume={strength_db: -60}"}, -5}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace insonify::deployer
