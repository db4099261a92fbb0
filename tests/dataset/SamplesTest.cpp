#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "components/dataset/Samples.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

Sweep gridded() {
    Sweep sweep;
    sweep.file = "sweep.yml";
    sweep.scenes.resize(2);
    sweep.settings = {{"sonar.range", {{"20", 1, 1}, {"30", 1, 1}}}, {"sonar.bin_count", {{"100", 1, 1}}}};
    sweep.grid.emplace();
    sweep.grid->x.values = {1, 2};
    sweep.grid->yaw_deg.values = {0, 90, 180};
    return sweep;
}

Sweep drawn(uint32_t count) {
    Sweep sweep;
    sweep.file = "sweep.yml";
    sweep.random.emplace();
    sweep.random->x.uniform = {0, 10};
    sweep.random->yaw_deg.uniform = {-180, 180};
    sweep.random_count = count;
    return sweep;
}

/** Objects "stone_0" and on, each of half a metre about its origin. */
SceneParts stoneParts(int count) {
    SceneParts parts;
    for (int i = 0; i < count; ++i) {
        Placeable stone;
        stone.radius = 0.5;
        stone.low = -0.5;
        stone.filed.position = {0, 0, -3};
        parts.placeables["stone_" + std::to_string(i)] = stone;
    }
    return parts;
}

TEST(SamplesTest, SettingsOfOnePoseShareThePart) {
    Sweep sweep = gridded();
    sweep.split.train = 0.4, sweep.split.val = 0.3, sweep.split.test = 0.3;
    sweep.grid->x.values.resize(50);
    const Samples samples(sweep, {}, {SceneParts{}, SceneParts{}});
    std::map<std::pair<size_t, uint64_t>, std::set<Part>> parts;
    std::set<Part> all;
    for (uint64_t index = 0; index < samples.count(); ++index) {
        const Sample sample = samples.at(index);
        parts[{sample.scene, sample.pose}].insert(sample.part);
        all.insert(sample.part);
    }
    EXPECT_EQ(parts.size(), 300u);
    for (const auto& [place, of_place] : parts) EXPECT_EQ(of_place.size(), 1u) << place.second;
    EXPECT_EQ(all.size(), 3u);
}

TEST(SamplesTest, PosesVaryFastestThenSettingsThenScenes) {
    const Sweep sweep = gridded();
    const Samples samples(sweep, {}, {SceneParts{}, SceneParts{}});
    ASSERT_EQ(samples.count(), 24u);
    const Sample first = samples.at(0), second = samples.at(1), last = samples.at(23);
    EXPECT_EQ(first.run.front().at.position, glm::dvec3(1, 0, 0));
    EXPECT_NEAR((second.run.front().at.orientation * glm::dvec3(1, 0, 0)).y, 1, 1e-12);
    EXPECT_EQ(samples.at(6).pose, 0u);
    EXPECT_EQ(samples.at(6).setting, 1u);
    EXPECT_EQ(samples.at(12).scene, 1u);
    EXPECT_EQ(last.run.front().at.position, glm::dvec3(2, 0, 0));
    EXPECT_THAT(samples.getSettings(1), ElementsAre(Pair("sonar.range", "30"), Pair("sonar.bin_count", "100")));
}

TEST(SamplesTest, ASampleDependsOnItsNumberAlone) {
    const Sweep few = drawn(3), many = drawn(1000);
    const Samples of_few(few, {}, {SceneParts{}}), of_many(many, {}, {SceneParts{}});
    of_many.at(999);
    for (const uint64_t index : {2, 0, 1}) {
        EXPECT_EQ(of_few.at(index).run.front().at.position, of_many.at(index).run.front().at.position);
        EXPECT_EQ(of_few.at(index).seed, of_many.at(index).seed);
        EXPECT_EQ(of_few.at(index).part, of_many.at(index).part);
    }
    std::set<double> places;
    std::set<uint64_t> seeds;
    for (uint64_t index = 0; index < 1000; ++index) {
        places.insert(of_many.at(index).run.front().at.position.x);
        seeds.insert(of_many.at(index).seed);
    }
    EXPECT_GT(places.size(), 990u);
    EXPECT_EQ(seeds.size(), 1000u);
    EXPECT_FALSE(seeds.contains(0));
}

TEST(SamplesTest, SettingsAndScenesShareTheirPosesAndHaveNoiseOfTheirOwn) {
    Sweep sweep = drawn(5);
    sweep.settings = {{"sonar.range", {{"20", 1, 1}, {"30", 1, 1}}}};
    sweep.objects.emplace_back();
    sweep.objects[0].names = {"stone_*"};
    sweep.objects[0].x = sweep.objects[0].y = {-10, 10};
    const Samples samples(sweep, {}, {stoneParts(3)});
    const Sample near = samples.at(2), far = samples.at(7);
    EXPECT_EQ(near.run.front().at.position, far.run.front().at.position);
    EXPECT_NE(near.seed, far.seed);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(near.objects[i].at.position, far.objects[i].at.position);
}

TEST(SamplesTest, ATrajectoryGivesItsPosesAtTheirTimes) {
    Sweep sweep;
    sweep.trajectory.emplace();
    types::Pose there;
    there.position = {3, 0, 0};
    const Samples samples(sweep, {{{0, {}}}, {{2.5, there}}}, {SceneParts{}});
    EXPECT_EQ(samples.count(), 2u);
    EXPECT_EQ(samples.at(1).run.front().time, 2.5);
    EXPECT_EQ(samples.at(1).run.front().at.position, there.position);
}

TEST(SamplesTest, LinesGoStraightAheadFromEachPoseAndWavesMoveEachRunByItself) {
    Sweep sweep;
    sweep.grid.emplace();
    sweep.grid->x.values = {1, 2};
    sweep.grid->z.values = {-3};
    sweep.grid->pitch_deg.values = {10};
    sweep.grid->yaw_deg.values = {90};
    sweep.lines = LinesConfig{.count = 50, .period = 0.2, .speed = 1.5};
    const Sample still = Samples(sweep, {}, {SceneParts{}}).at(1);
    ASSERT_EQ(still.run.size(), 50u);
    for (size_t i = 0; i < still.run.size(); ++i) {
        EXPECT_NEAR(still.run[i].time, 0.2 * static_cast<double>(i), 1e-12);
        const glm::dvec3 there(2, 0.3 * static_cast<double>(i), -3);
        EXPECT_LT(glm::distance(still.run[i].at.position, there), 1e-9) << "level, though the bow is down";
        EXPECT_EQ(still.run[i].at.orientation, still.run[0].at.orientation);
    }
    sweep.lines->motion.emplace();
    sweep.lines->motion->heave_m = 0.1;
    const Samples waves(sweep, {}, {SceneParts{}});
    const Sample first = waves.at(0), second = waves.at(1), again = waves.at(1);
    double apart = 0, heave = 0;
    for (size_t i = 0; i < first.run.size(); ++i) {
        apart = std::max(apart, std::abs(first.run[i].at.position.z - second.run[i].at.position.z));
        heave = std::max(heave, std::abs(second.run[i].at.position.z + 3));
        EXPECT_EQ(second.run[i].at.position, again.run[i].at.position);
    }
    EXPECT_GT(heave, 0.03);
    EXPECT_LT(heave, 0.5);
    EXPECT_GT(apart, 0.03);
}

TEST(SamplesTest, RefusesMissingAndRepeatedObjectsWithTheirPlace) {
    Sweep sweep = drawn(1);
    sweep.objects.resize(2);
    for (ObjectGroup& group : sweep.objects) group.names = {"stone_1"}, group.x = group.y = {0, 1}, group.line = 9;
    const auto makeMessage = [&] {
        return test::computeError<types::ConfigError>([&] { const Samples samples(sweep, {}, {stoneParts(2)}); });
    };
    EXPECT_EQ(makeMessage(), "sweep.yml:9: objects[1].names: places stone_1 for the second time");
    sweep.objects[1].names = {"stne_0"};
    EXPECT_THAT(makeMessage(),
                HasSubstr("objects[1].names[0]: is stne_0, which is no name in the scene; did you mean"));
}

TEST(SamplesTest, ACountIsAtMostTheNumberOfObjectsInTheSceneWithMost) {
    Sweep sweep = drawn(1);
    sweep.scenes.resize(2);
    ObjectGroup& group = sweep.objects.emplace_back();
    group.names = {"stone_*"}, group.x = group.y = {-10, 10}, group.line = 9;
    const auto makeMessage = [&](uint32_t low, uint32_t high) {
        sweep.objects.front().count = {low, high};
        return test::computeError<types::ConfigError>([&] {
            const Samples samples(sweep, {}, {stoneParts(1), stoneParts(4)});
        });
    };
    EXPECT_EQ(makeMessage(1, 4), "");
    EXPECT_EQ(makeMessage(1, 5), "sweep.yml:9: objects[0].count: is [1, 5], but only 4 objects match names");
}

TEST(SamplesTest, APatternMustMatchInOneOfTheScenes) {
    Sweep sweep = drawn(1);
    sweep.scenes.resize(2);
    ObjectGroup& group = sweep.objects.emplace_back();
    group.names = {"stone_0", "stone_3"};
    group.avoid = {"wall"};
    group.x = group.y = {-10, 10};
    SceneParts few = stoneParts(1), many = stoneParts(4);
    few.nodes = {"wall"};
    const Samples samples(sweep, {}, {few, many});
    EXPECT_THAT(samples.getObjects(0), ElementsAre("stone_0"));
    EXPECT_THAT(samples.getObjects(1), ElementsAre("stone_0", "stone_3"));
    const auto makeMessage = [&] {
        return test::computeError<types::ConfigError>([&] { const Samples refused(sweep, {}, {few, many}); });
    };
    group.avoid = {"wal"};
    EXPECT_THAT(makeMessage(), HasSubstr("objects[0].avoid[0]: is wal, which is no name in any of the scenes"));
    group.names = {"stone_4"};
    EXPECT_THAT(makeMessage(), HasSubstr("objects[0].names[0]: is stone_4, which is no name in any of the scenes"));
}

TEST(SamplesTest, EachSampleDrawsItsSettingsByItsNumberAlone) {
    Sweep sweep = drawn(400);
    DrawnSetting& law = sweep.drawn.emplace_back();
    law.property = "scene.materials.sand.lambert_db", law.law.uniform = {-30, -10};
    DrawnSetting& choice = sweep.drawn.emplace_back();
    choice.property = "sonar.range", choice.choice = {{"20", 1, 1}, {"30", 1, 1}, {"50", 1, 1}};
    const Samples samples(sweep, {}, {SceneParts{}});
    std::map<std::string, int> laws, choices;
    for (uint64_t index = 0; index < 400; ++index) {
        const Sample sample = samples.at(index);
        EXPECT_EQ(sample.settings, samples.at(index).settings);
        ASSERT_EQ(sample.settings.size(), 2u);
        EXPECT_EQ(sample.settings[0].first, "scene.materials.sand.lambert_db");
        const double value = std::stod(sample.settings[0].second);
        EXPECT_TRUE(value >= -30 && value <= -10) << value;
        ++laws[sample.settings[0].second], ++choices[sample.settings[1].second];
    }
    EXPECT_GT(laws.size(), 395u);
    EXPECT_EQ(choices.size(), 3u);
    for (const auto& [value, count] : choices) EXPECT_NEAR(count, 400 / 3.0, 5 * std::sqrt(400 * 2 / 9.0)) << value;
    const std::string seventh = samples.at(7).settings[0].second;
    sweep.settings = {{"sonar.bin_count", {{"100", 1, 1}, {"200", 1, 1}}}};
    EXPECT_EQ(Samples(sweep, {}, {SceneParts{}}).at(7).settings[1].second, seventh);
}

TEST(SamplesTest, RefusesTooManySamples) {
    Sweep sweep = drawn(100000000);
    sweep.settings = {{"sonar.range", {{"20", 1, 1}, {"30", 1, 1}}}};
    EXPECT_THROW(Samples(sweep, {}, {SceneParts{}}), types::ConfigError);
}

/** A plate of 20 x 20 m at a height, which faces up or down. */
void addPlate(types::Geometry& geometry, float z, bool faces_up) {
    types::Mesh& mesh = geometry.meshes.emplace_back();
    mesh.positions = {{-10, -10, z}, {10, -10, z}, {10, 10, z}, {-10, 10, z}};
    mesh.indices = faces_up ? std::vector<uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<uint32_t>{0, 2, 1, 0, 3, 2};
    geometry.objects.push_back({"plate", static_cast<int>(geometry.meshes.size()) - 1, glm::dmat4(1)});
}

TEST(SamplesTest, OddPosesAreCountedWithTheirFirst) {
    const auto describe = [](std::vector<glm::dvec3> at, const Surroundings& around) {
        return describeOddPoses(at, around);
    };
    EXPECT_THAT(describe({{0, 0, -1}, {1, 2, 0.5}, {0, 0, 3}}, {0.0, nullptr}),
                ElementsAre("2 of 3 poses: the sonar is above the water surface, at z 0 m (z is up: depths are "
                            "negative); the first is pose 1, at [1, 2, 0.5]"));
    EXPECT_THAT(describe({{0, 0, -1}, {0, 0, 0}}, {0.0, nullptr}), ElementsAre());
    const auto floor = std::make_shared<types::Geometry>();
    addPlate(*floor, -8, true);
    EXPECT_THAT(describe({{0, 0, -7}, {1, 3, -9}, {5, -5, -3}}, {{}, floor}),
                ElementsAre(HasSubstr("1 of 3 poses: the sonar is below the floor or inside of a body")));
    EXPECT_THAT(describe({{0, 0, -7}, {100, 0, -7}, {21, 0, -7}}, {{}, floor, 12}),
                ElementsAre(AllOf(HasSubstr("1 of 3 poses: the sonar is farther from the scene than its range of 12 m"),
                                  HasSubstr("the first is pose 1"))));
    const auto box = std::make_shared<types::Geometry>(*floor);
    addPlate(*box, -9, false);
    EXPECT_EQ(describe({{0, 0, -7}, {0, 0, -8.5}}, {{}, box}).size(), 1u) << "within the box that is the floor";
    const auto hull = std::make_shared<types::Geometry>();
    addPlate(*hull, 0, false);
    EXPECT_THAT(describe({{0, 0, -7}}, {{}, hull}), ElementsAre()) << "below a hull";
    const auto deck = std::make_shared<types::Geometry>(*floor);
    addPlate(*deck, 0, true);
    EXPECT_THAT(describe({{0, 0, -7}}, {{}, deck}), ElementsAre()) << "between a floor and a deck";
    floor->objects[0].world_from_object[0][0] = -1;  // a mirror turns the winding, not the face
    EXPECT_EQ(describe({{0, 0, -9}, {0, 0, -7}}, {{}, floor}).size(), 1u);
}

TEST(SamplesTest, APartWithoutSamplesIsReported) {
    Sweep sweep = drawn(3);
    sweep.split = {0.98, 0.01, 0.01};
    const Samples samples(sweep, {}, {SceneParts{}});
    EXPECT_THAT(describeEmptyParts(sweep, Selection(samples.count()), samples),
                HasSubstr("split: none of 3 samples is in val (share 0.01), nor in test (share 0.01); "));
    sweep.split = {1, 0, 0};
    EXPECT_EQ(describeEmptyParts(sweep, Selection(samples.count()), samples), "");
    sweep.random_count = 200, sweep.split = {0.6, 0.2, 0.2};
    const Samples many(sweep, {}, {SceneParts{}});
    EXPECT_EQ(describeEmptyParts(sweep, Selection(many.count()), many), "");
}

}  // namespace
}  // namespace insonify::dataset
