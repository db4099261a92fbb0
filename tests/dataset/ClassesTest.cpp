#include <gmock/gmock.h>

#include "components/dataset/Classes.hpp"
#include "tests/support/Refused.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<std::string> objects = {"pile_00", "pile_01", "hull", "rock.001", "rock.002", "12"};

TEST(ClassesTest, WithoutRulesAClassIsANameWithoutItsNumber) {
    const Classes classes(Sweep{}, objects);
    EXPECT_THAT(classes.names(), ElementsAre("12", "hull", "pile", "rock"));
    EXPECT_EQ(classes.of("pile_01"), 3u);
    EXPECT_EQ(classes.of("rock.002"), 4u);
    EXPECT_EQ(classes.of("12"), 1u);
    EXPECT_EQ(classes.of("crane"), 0u);
}

TEST(ClassesTest, TheFirstMatchingRuleCounts) {
    Sweep sweep;
    sweep.classes = {{"wreck", {"hull"}, 3, 1}, {"first", {"*_00"}, 4, 1}, {"pile", {"pile_*"}, 5, 1}};
    const Classes classes(sweep, objects);
    EXPECT_THAT(classes.names(), ElementsAre("wreck", "first", "pile"));
    EXPECT_EQ(classes.of("hull"), 1u);
    EXPECT_EQ(classes.of("pile_00"), 2u);
    EXPECT_EQ(classes.of("pile_01"), 3u);
    EXPECT_EQ(classes.of("rock.001"), 0u);
}

TEST(ClassesTest, AClassWhoseNamesAreAllOfClassesBeforeIsANotice) {
    Sweep sweep;
    sweep.classes = {{"wreck", {"hull"}, 3, 1}, {"first", {"*_00", "pile_00"}, 4, 1}, {"pile", {"pile_*"}, 5, 1}};
    EXPECT_THAT(Classes(sweep, objects).notices(), ElementsAre()) << "pile_01 is left";
    std::swap(sweep.classes[1], sweep.classes[2]);
    EXPECT_THAT(Classes(sweep, objects).notices(),
                ElementsAre("classes.first: all its names match a class before it, which counts: pile_00 is a pile"));
    sweep.classes.back() = {"rest", {"*"}, 5, 1};
    EXPECT_THAT(Classes(sweep, objects).notices(), ElementsAre());
}

TEST(ClassesTest, ClassesOfShadowsFollowAllOthers) {
    Sweep sweep;
    EXPECT_EQ(Classes(sweep, objects).shadow(3), 0u);
    sweep.annotations.shadows = true;
    const Classes classes(sweep, objects);
    EXPECT_THAT(classes.names(),
                ElementsAre("12", "hull", "pile", "rock", "12_shadow", "hull_shadow", "pile_shadow", "rock_shadow"));
    EXPECT_EQ(classes.shadow(classes.of("pile_01")), 7u);
    EXPECT_EQ(classes.shadow(0), 0u);
}

TEST(ClassesTest, APatternThatMatchesNothingNextToOthersIsANotice) {
    Sweep sweep;
    sweep.file = "sweep.yml";
    sweep.classes = {{"wreck", {"hull"}, 3, 1}, {"pile", {"pile_*", "post_*"}, 4, 1}, {"mine", {"mine_*"}, 5, 1}};
    const Classes classes(sweep, objects);
    EXPECT_THAT(classes.names(), ElementsAre("wreck", "pile", "mine"));
    EXPECT_EQ(classes.of("pile_01"), 2u);
    EXPECT_THAT(classes.notices(),
                ElementsAre(HasSubstr("sweep.yml:4:1: classes.pile[1]: is post_*, which is no name in the scene"),
                            HasSubstr("sweep.yml:5:1: classes.mine[0]: is mine_*, which is no name in the scene")));
}

TEST(ClassesTest, PatternsThatAllMatchNothingAreRefused) {
    Sweep sweep;
    sweep.file = "sweep.yml";
    sweep.classes = {{"wreck", {"hul"}, 3, 1}};
    EXPECT_THAT(test::computeError<types::ConfigError>([&] { const Classes classes(sweep, objects); }),
                HasSubstr("sweep.yml:3:1: classes.wreck[0]: is hul, which is no "
                          "name in the scene; did you mean hull?"));
}

}  // namespace
}  // namespace insonify::dataset
