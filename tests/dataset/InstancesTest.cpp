#include <gmock/gmock.h>

#include "components/dataset/Annotate.hpp"

namespace insonify::dataset {
namespace {

using ::testing::ElementsAre;

Classes getClasses(std::vector<ClassRule> rules, const std::vector<std::string>& objects,
                   const std::vector<std::string>& nodes) {
    Sweep sweep;
    sweep.classes = std::move(rules);
    sweep.annotations.shadows = true;
    return {sweep, objects, nodes};
}

TEST(InstancesTest, PartsBelowANodeOfAClassAreOneInstanceOfItsName) {
    const std::vector<Lineage> objects = {{"floor"},
                                          {"torso", "diver_1", "world"},
                                          {"arm_l", "arms", "diver_1", "world"},
                                          {"torso.001", "diver_2", "world"},
                                          {"arm_r", "arms", "diver_1", "world"}};
    const Classes classes = getClasses({{"diver", {"diver_*"}, 1, 1}}, {"floor", "torso"}, {"diver_1", "diver_2"});
    const Instances instances(classes, objects);
    EXPECT_EQ(instances.category(instances.of(0)), 0u);
    EXPECT_EQ(instances.name(instances.of(0)), "floor");
    for (const int32_t part : {1, 2, 4}) EXPECT_EQ(instances.of(part), 1) << part;
    EXPECT_EQ(instances.name(1), "diver_1");
    EXPECT_EQ(instances.category(1), 1u);
    EXPECT_EQ(instances.shadow(1), 2u);
    EXPECT_THAT(instances.parts(1), ElementsAre(1, 2, 4));
    EXPECT_THAT(instances.parts(3), ElementsAre(3)) << "another diver";
}

TEST(InstancesTest, TheNearestClassCountsAndTheOutermostNodeThatHasIt) {
    const std::vector<Lineage> objects = {{"wheel_1", "car_1"},
                                          {"car_body", "car_1"},
                                          {"chain_03", "chain_02", "chain_01", "mooring"},
                                          {"chain_01", "mooring"},
                                          {"chain_02", "chain_01", "mooring"}};
    const Classes classes =
        getClasses({{"wheel", {"wheel_*"}, 1, 1}, {"car", {"car_*"}, 1, 1}, {"chain", {"chain_*"}, 1, 1}},
                   {"wheel_1", "car_body", "chain_03"}, {"car_1"});
    const Instances instances(classes, objects);
    EXPECT_EQ(instances.name(instances.of(0)), "wheel_1");
    EXPECT_EQ(instances.name(instances.of(1)), "car_1");
    EXPECT_THAT(instances.parts(2), ElementsAre(2, 3, 4)) << "one chain of links";
    EXPECT_EQ(instances.name(2), "chain_01");
}

TEST(InstancesTest, WithoutRulesEachObjectIsAlone) {
    const Classes classes(Sweep{}, {"pile_1", "pile_2"}, {"piles"});
    const Instances instances(classes, {{"pile_1", "piles"}, {"pile_2", "piles"}});
    EXPECT_EQ(instances.of(1), 1);
    EXPECT_EQ(instances.name(1), "pile_2");
    EXPECT_EQ(instances.category(0), instances.category(1));
}

}  // namespace
}  // namespace insonify::dataset
