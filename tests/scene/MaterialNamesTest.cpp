#include <gmock/gmock.h>

#include "components/scene/Acoustics.hpp"
#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MaterialNamesTest, MatterIsFoundInNamesAsModellersWriteThem) {
    const std::pair<const char*, const char*> cases[] = {{"Steel", "steel"},
                                                         {"steel_01", "steel"},
                                                         {"Steel.001", "steel"},
                                                         {"Material_Aluminium", "aluminium"},
                                                         {"aluminum", "aluminium"},
                                                         {"M-PVC pipe (2)", "pvc"},
                                                         {"pipePvc", "pvc"},
                                                         {"castIron", "cast_iron"},
                                                         {"Closed Cell Foam", "closed_cell_foam"},
                                                         {"waterlogged_wood", "waterlogged_wood"},
                                                         {"Gazebo/Wood", "wood"},
                                                         {"wood2", "wood"},
                                                         {"ROCK", "rock"},
                                                         {"rough_rock", "rough_rock"},
                                                         {"RustedSteel", "carbon_steel"},
                                                         {"Human", "human_body"},
                                                         {"PET.001", "pet"},
                                                         {"painted metal", "painted_metal"},
                                                         {"CartonBox", "paper"},
                                                         {"fishing net", "net"},
                                                         {"Sand", "medium_sand"},
                                                         {"fine_sand.002", "fine_sand"},
                                                         {"steel steel", "steel"}};
    for (const auto& [name, matter] : cases) EXPECT_THAT(matterIn(name), ElementsAre(matter)) << name;
}

TEST(MaterialNamesTest, OtherNamesHaveNoMatter) {
    for (const char* name : {"", " ", "...", "default", "material_1", "Material.001", "steelworks", "hot", "Planet",
                             "glassy", "m", "mackenzie", "stee_l", "\xff\xfe", "body"})
        EXPECT_THAT(matterIn(name), IsEmpty()) << name;
}

TEST(MaterialNamesTest, ANameOfTwoHasBoth) {
    EXPECT_THAT(matterIn("steel_glass"), ElementsAre("steel", "glass"));
    EXPECT_THAT(matterIn("sandOnConcrete"), ElementsAre("medium_sand", "concrete"));
}

struct TakeNamesTest : ::testing::Test {
    static types::GeometryPtr makeScene(std::vector<types::Material> materials) {
        auto geometry = std::make_shared<types::Geometry>();
        geometry->materials = std::move(materials);
        return geometry;
    }
};

TEST_F(TakeNamesTest, UnknownNamesLeaveTheSceneUnchanged) {
    const auto geometry = makeScene({{.name = "hull"}, {.name = "steel", .lambert_db = -20, .has_acoustics = true}});
    EXPECT_EQ(applyMaterialNames(geometry), geometry);
}

TEST_F(TakeNamesTest, MaterialsWithoutAcousticsAreTakenWithOneNotice) {
    const auto geometry = makeScene(
        {{.name = "Steel.001"}, {.name = "hull"}, {.name = "Sand"}, {.name = "steel_glass"}, {.name = "PVC"}});
    const auto named = applyMaterialNames(geometry);
    EXPECT_EQ(named->materials[0].matter, "steel");
    EXPECT_FLOAT_EQ(named->materials[0].reflection, 0.936f);
    EXPECT_TRUE(named->materials[0].has_acoustics && named->materials[0].is_named);
    EXPECT_EQ(named->materials[1], geometry->materials[1]);
    EXPECT_EQ(named->materials[2].seabed, "medium_sand");
    EXPECT_EQ(named->materials[3], geometry->materials[3]) << "neither, since both may be meant";
    ASSERT_EQ(named->notices.size(), 1u);
    EXPECT_THAT(
        named->notices[0],
        HasSubstr("are taken by their names: \"Steel.001\" as steel, \"Sand\" as medium_sand, \"PVC\" as pvc; "));
    EXPECT_THAT(named->notices[0], HasSubstr("\"steel_glass\" as steel or glass"));
    EXPECT_THAT(named->notices[0], HasSubstr("`materials_by_name: false` takes none"));
    EXPECT_TRUE(geometry->notices.empty());
}

TEST_F(TakeNamesTest, ANoticeOfManyMaterialsStaysShort) {
    std::vector<types::Material> materials;
    for (int i = 0; i < 500; ++i) materials.push_back({.name = "steel_" + std::to_string(i)});
    const auto named = applyMaterialNames(makeScene(materials));
    ASSERT_EQ(named->notices.size(), 1u);
    EXPECT_THAT(named->notices[0], HasSubstr("\"steel_19\" as steel and 480 more"));
}

}  // namespace
}  // namespace insonify::scene
