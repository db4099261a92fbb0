#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>

#include "components/dataset/Placement.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> numbered(int count) {
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) names.push_back("stone_" + std::to_string(i));
    return names;
}

SceneParts stones(int count) {
    SceneParts parts;
    for (const std::string& name : numbered(count)) {
        Placeable& stone = parts.placeables[name];
        stone.radius = 0.5;
        stone.low = -0.4;
        stone.filed.position = {0, 0, -3};
    }
    return parts;
}

Sweep makeSweep(std::vector<double> x, std::vector<double> y) {
    Sweep sweep;
    sweep.file = "sweep.yml";
    ObjectGroup& group = sweep.objects.emplace_back();
    group.names = {"stone_*"};
    group.x = std::move(x), group.y = std::move(y);
    group.line = 4, group.column = 5;
    return sweep;
}

std::vector<PlacedObject> placed(const Sweep& sweep, const SceneParts& scene, int count, uint64_t pose,
                                 const types::Pose& vehicle = {}) {
    Placement placement(sweep, scene, pose, vehicle);
    placement.add(0, numbered(count));
    return placement.objects();
}

double apart(const glm::dvec3& a, const glm::dvec3& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(PlacementTest, ObjectsStandInTheirAreaAndDoNotTouch) {
    const Sweep sweep = makeSweep({-4, 4}, {2, 8});
    const SceneParts scene = stones(12);
    for (uint64_t pose = 0; pose < 50; ++pose) {
        const auto objects = placed(sweep, scene, 12, pose);
        ASSERT_EQ(objects.size(), 12u);
        for (size_t i = 0; i < objects.size(); ++i) {
            const glm::dvec3& at = objects[i].at.position;
            EXPECT_TRUE(at.x >= -4 && at.x <= 4 && at.y >= 2 && at.y <= 8 && at.z == -3) << at.x << " " << at.y;
            for (size_t k = 0; k < i; ++k) EXPECT_GE(apart(at, objects[k].at.position), 1.1);
        }
        EXPECT_NE(objects[0].at.position, placed(sweep, scene, 12, pose + 1)[0].at.position);
        EXPECT_EQ(objects[7].at.position, placed(sweep, scene, 12, pose)[7].at.position);
    }
}

TEST(PlacementTest, ObjectsKeepClearOfTheVehicleAndAvoidedNodes) {
    Sweep sweep = makeSweep({-2, 2}, {-2, 2});
    sweep.objects[0].avoid = {"wall*"};
    SceneParts scene = stones(1);
    scene.boxes["wall_a"].add(glm::dvec3(-2, -2, -5));
    scene.boxes["wall_a"].add(glm::dvec3(2, 0, 5));
    for (uint64_t pose = 0; pose < 200; ++pose) {
        const glm::dvec3 at = placed(sweep, scene, 1, pose)[0].at.position;
        EXPECT_GE(at.y, 0.6) << pose;
        EXPECT_GE(std::hypot(at.x, at.y), 0.6) << pose;
    }
}

TEST(PlacementTest, AnAreaMovesWithTheVehicle) {
    Sweep sweep = makeSweep({5, 6}, {0, 1});
    sweep.objects[0].frame = Frame::Vehicle;
    types::Pose vehicle;
    vehicle.position = {100, 200, -5};
    vehicle.orientation = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 0, 1));  // looks west
    for (uint64_t pose = 0; pose < 50; ++pose) {
        const glm::dvec3 at = placed(sweep, stones(1), 1, pose, vehicle)[0].at.position;
        EXPECT_TRUE(at.x >= 99 && at.x <= 100 && at.y >= 205 && at.y <= 206) << at.x << " " << at.y;
    }
}

TEST(PlacementTest, ObjectsStandOnTheHighestGroundBelowTheirOrigin) {
    Sweep sweep = makeSweep({1, 3}, {1, 3});
    sweep.objects[0].ground = "floor";
    SceneParts scene = stones(1);
    scene.grounds["floor"] = {{glm::dvec3(-9, -9, -9), glm::dvec3(9, -9, -9), glm::dvec3(0, 20, -9)},
                              {glm::dvec3(-9, -9, -7), glm::dvec3(9, -9, -7), glm::dvec3(0, 20, -7)}};
    EXPECT_NEAR(placed(sweep, scene, 1, 3)[0].at.position.z, -6.6, 1e-9);
    EXPECT_EQ(highestAt(scene.grounds["floor"], 50, 50), std::nullopt);
    const std::vector<std::array<glm::dvec3, 3>> slope = {
        {glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 4), glm::dvec3(0, 4, 0)}};
    EXPECT_NEAR(*highestAt(slope, 1, 1), 1, 1e-12);
}

TEST(PlacementTest, AScaledObjectIsOnTheGroundClearOfOthers) {
    Sweep sweep = makeSweep({1, 12}, {1, 12});
    sweep.objects[0].ground = "floor";
    sweep.objects[0].scale = {0.5, 2};
    SceneParts scene = stones(8);
    scene.grounds["floor"] = {{glm::dvec3(-99, -99, -9), glm::dvec3(99, -99, -9), glm::dvec3(0, 200, -9)}};
    double minimum = 2, maximum = 0.5;
    for (uint64_t pose = 0; pose < 30; ++pose) {
        const auto objects = placed(sweep, scene, 8, pose);
        for (size_t i = 0; i < objects.size(); ++i) {
            const double scale = objects[i].scale;
            minimum = std::min(minimum, scale), maximum = std::max(maximum, scale);
            EXPECT_NEAR(objects[i].at.position.z, -9 + 0.4 * scale, 2e-6);
            for (size_t k = 0; k < i; ++k)
                EXPECT_GE(apart(objects[i].at.position, objects[k].at.position),
                          0.5 * (scale + objects[k].scale) + 0.1 - 1e-9);
        }
    }
    EXPECT_GE(minimum, 0.5);
    EXPECT_LT(minimum, 0.6);
    EXPECT_LE(maximum, 2);
    EXPECT_GT(maximum, 1.9);
}

TEST(PlacementTest, ATiltedObjectIsOnTheGroundClearOfOthers) {
    Sweep sweep = makeSweep({1, 30}, {1, 30});
    sweep.objects[0].ground = "floor";
    sweep.objects[0].roll_deg = {90, 90};
    SceneParts scene = stones(2);
    scene.grounds["floor"] = {{glm::dvec3(-99, -99, -9), glm::dvec3(99, -99, -9), glm::dvec3(0, 200, -9)}};
    for (auto& [name, pole] : scene.placeables) {  // upright, from its origin to 3 m above
        pole.radius = 0.1, pole.low = 0;
        pole.points = {{0.1, 0, 0}, {0, 0.1, 0}, {0, -0.1, 0}, {0, 0, 3}};
    }
    for (uint64_t pose = 0; pose < 50; ++pose) {
        const auto poles = placed(sweep, scene, 2, pose);
        EXPECT_GE(apart(poles[0].at.position, poles[1].at.position), 6.1) << pose;
        EXPECT_NEAR(poles[0].at.position.z, -8.9, 1e-6);  // half its thickness above the ground
        EXPECT_NEAR((poles[0].at.orientation * glm::dvec3(0, 0, 1)).y, -1, 1e-9);
    }
    sweep.objects[0].roll_deg = {180, 180};
    EXPECT_NEAR(placed(sweep, scene, 2, 0)[0].at.position.z, -6, 1e-6);
}

TEST(PlacementTest, AnyTurnIsUniform) {
    Sweep sweep = makeSweep({1, 30}, {1, 30});
    sweep.objects[0].any_turn = true;
    const SceneParts scene = stones(1);
    constexpr int poses = 4000;
    glm::dmat3 mean(0), square(0);
    double angle = 0;
    for (uint64_t pose = 0; pose < poses; ++pose) {
        const glm::dquat turn = placed(sweep, scene, 1, pose)[0].at.orientation;
        ASSERT_NEAR(glm::length(turn), 1, 1e-12);
        const glm::dmat3 axes = glm::mat3_cast(turn);
        mean += axes / double(poses), square += glm::matrixCompMult(axes, axes) / double(poses);
        angle += 2 * std::acos(std::min(std::abs(turn.w), 1.0)) / poses;
    }
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(mean[i][k], 0, 0.03) << i << k;
            EXPECT_NEAR(square[i][k], 1 / 3.0, 0.02) << i << k;
        }
    EXPECT_NEAR(angle, std::numbers::pi / 2 + 2 / std::numbers::pi, 0.03);  // the mean of (1 - cos) / pi from 0 to pi
}

TEST(PlacementTest, PlacesTheCountAndMovesTheOthersOutOfReach) {
    Sweep sweep = makeSweep({-20, 20}, {-20, 20});
    sweep.objects[0].count = {2, 5};
    std::array<int, 7> seen{};
    for (uint64_t pose = 0; pose < 300; ++pose) {
        const auto objects = placed(sweep, stones(6), 6, pose);
        const auto there = static_cast<size_t>(std::ranges::count_if(objects, &PlacedObject::present));
        ++seen[there];
        for (const PlacedObject& object : objects) EXPECT_EQ(object.present, object.at.position.z > -1000);
    }
    for (size_t i = 0; i < 7; ++i) EXPECT_EQ(seen[i] > 0, i >= 2 && i <= 5) << i;
}

TEST(PlacementTest, EachObjectIsChosenEquallyOftenAndByThePoseAlone) {
    Sweep sweep = makeSweep({-20, 20}, {-20, 20});
    sweep.objects[0].count = {2, 2};
    constexpr int poses = 1200;
    std::array<int, 6> chosen{};
    std::map<std::pair<size_t, size_t>, int> pairs;
    for (uint64_t pose = 0; pose < poses; ++pose) {
        const auto objects = placed(sweep, stones(6), 6, pose), again = placed(sweep, stones(6), 6, pose);
        std::vector<size_t> there;
        for (size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(objects[i].present, again[i].present);
            if (objects[i].present) ++chosen[i], there.push_back(i);
        }
        ASSERT_EQ(there.size(), 2u);
        ++pairs[{there[0], there[1]}];
    }
    for (const int count : chosen) EXPECT_NEAR(count, poses / 3, 5 * std::sqrt(poses * 2 / 9.0));
    EXPECT_EQ(pairs.size(), 15u);
}

TEST(PlacementTest, ReportsAnAreaWithoutGround) {
    Sweep sweep = makeSweep({2, 4}, {2, 4});
    sweep.objects[0].ground = "sea_floor";
    SceneParts scene = stones(1);
    for (const double x : {0.0, 20.0}) {  // elsewhere, and below the area
        scene.grounds["sea_floor"] = {{glm::dvec3(20 - x, 0, -9), {30 - x, 0, -9}, {20 - x, 10, -9}}};
        const auto work = [&] { placed(sweep, scene, 1, 8); };
        if (x == 0)
            EXPECT_THAT(test::computeError<types::ConfigError>(work),
                        HasSubstr("no ground, sea_floor, is below its area: give it another area"));
        else
            EXPECT_NO_THROW(work());
    }
}

TEST(PlacementTest, ReportsTheNumberOfObjectsThatFit) {
    const Sweep sweep = makeSweep({2, 4}, {2, 4});
    EXPECT_THAT(
        test::computeError<types::ConfigError>([&] { placed(sweep, stones(30), 30, 8); }),
        testing::AllOf(HasSubstr("sweep.yml:4:5: objects[0]: has room for "), HasSubstr("of its 30 objects at pose 8")))
        << "30 stones of a metre on 4 m2";
}

}  // namespace
}  // namespace insonify::dataset
