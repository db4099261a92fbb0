// Acoustic extras and normal maps.
#include <gmock/gmock.h>

#include <array>

#include "tests/scene/SceneFiles.hpp"

namespace insonify::scene {
namespace {

/** Two pixels side by side: (255, 128, 128) and (10, 20, 30). */
const std::string png =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR4nGP439DAJSIHAArlAjybukczAAAAAElFTkSuQmCC";
struct GltfMaterialsTest : SceneFiles {
    types::Material acoustics(const std::string& json) const {
        return load(R"("materials":[{"name":"m","doubleSided":true,"extras":{"acoustics":)" + json + "}}]")
            ->materials.at(0);
    }
    std::string diagnosticOfAcoustics(const std::string& json) const {
        return diagnosticOfGltf(R"("materials":[{},{"extras":{"acoustics":)" + json + "}}]");
    }
    /** A unit square whose uvs are its x and -y (v down), with a normal map from `image`. `info` is inside
     *  normalTexture, `attributes` are added to POSITION and TEXCOORD_0 (accessor 1). */
    types::GeometryPtr mapped(const std::string& image, const std::string& info = "",
                              const std::string& attributes = "") const {
        return load(
            R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0,"TEXCOORD_0":1)" +
            attributes + R"(}}]}],"materials":[{"name":"wall","normalTexture":{"index":0)" + info + R"(}}],
            "textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071}],"images":[{"uri":")" +
            image + R"("}],
            "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
                         {"bufferView":1,"componentType":5126,"type":"VEC2","count":3},
                         {"bufferView":2,"componentType":5126,"type":"VEC3","count":3},
                         {"bufferView":3,"componentType":5126,"type":"VEC4","count":3}],
            "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
                           {"buffer":0,"byteOffset":60,"byteLength":36},{"buffer":0,"byteOffset":96,"byteLength":48}],)" +
            buffers(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + toBytes<float>({0, 1, 1, 1, 0, 0}) +
                    toBytes<float>({0, 0, 2, 0, 0, 2, 0, 0, 2}) +
                    toBytes<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1})));
    }
};

TEST_F(GltfMaterialsTest, WithoutExtrasAMaterialIsMediumSand) {
    const auto geometry = load(R"("materials":[{"name":"plain"},{}])");
    EXPECT_FALSE(geometry->materials[0].has_acoustics);
    EXPECT_FLOAT_EQ(geometry->materials[0].lambert_db, -16.7f);
    EXPECT_EQ(geometry->materials[1].name, "material_1");
}

TEST_F(GltfMaterialsTest, AcousticNumbersAreTaken) {
    const types::Material m =
        acoustics(R"({"lambert_db":-12,"reflection":-0.5,"roughness_slope":0.2,"reflectivity":0.25})");
    EXPECT_TRUE(m.has_acoustics && m.double_sided);
    EXPECT_FLOAT_EQ(m.lambert_db, -12);
    EXPECT_FLOAT_EQ(m.reflection, -0.5);
    EXPECT_FLOAT_EQ(m.roughness_slope.value(), 0.2f);
    EXPECT_FLOAT_EQ(m.reflectivity, 0.25);
}

TEST_F(GltfMaterialsTest, AShellIsOfMatterOrOfNumbers) {
    const types::Material pvc =
        acoustics(R"({"shell":{"thickness_mm":3,"material":"pvc","loss":0.02,"fill":"air"},"roughness_slope":0.1})");
    EXPECT_EQ(pvc.shell.value(), (types::Shell{0.003, 1380, 2400, 1060, 0.02, true}));
    EXPECT_FLOAT_EQ(pvc.reflection, 1) << "times what the plate reflects";
    EXPECT_FLOAT_EQ(pvc.lambert_db, -9.23f);
    const types::Material fluid =
        acoustics(R"({"shell":{"thickness_mm":1,"density":1100,"sound_speed":1600},"lambert_db":-20})");
    EXPECT_EQ(fluid.shell.value(), (types::Shell{0.001, 1100, 1600, 0, 0, false}));
    EXPECT_FLOAT_EQ(fluid.lambert_db, -20);
    EXPECT_FALSE(acoustics(R"({"material":"steel"})").shell);
}

TEST_F(GltfMaterialsTest, AFillIsOfATableOrOfNumbers) {
    const auto getFill = [this](const std::string& fill) {
        const types::Shell shell =
            acoustics(R"({"shell":{"thickness_mm":3,"material":"pvc",)" + fill + "}}").shell.value();
        return std::array{shell.fill_density, shell.fill_speed, shell.fill_loss};
    };
    EXPECT_EQ(getFill(R"("fill":"water")"), (std::array{0., 0., 0.}));
    EXPECT_EQ(getFill(R"("fill":"oil","fill_loss":1e-3)"), (std::array{825., 1371., 1e-3}));
    EXPECT_EQ(getFill(R"("fill":"sand","fill_density":2000)"), (std::array{2000., 1650., 0.0147}));
    EXPECT_EQ(getFill(R"("fill_density":900,"fill_sound_speed":1300)"), (std::array{900., 1300., 0.}));
}

TEST_F(GltfMaterialsTest, AWrongValueOfAShellIsOneErrorAndNotAlsoMissing) {
    for (const char* json :
         {R"({"shell":{"thickness_mm":"2","material":"pvc"}})", R"({"shell":{"thickness_mm":2,"material":"acrylik"}})"})
        EXPECT_EQ(diagnosticOfAcoustics(json).find("missing"), std::string::npos) << diagnosticOfAcoustics(json);
    EXPECT_NE(diagnosticOfAcoustics(R"({"mapp":{"decibels":[-30,0]}})").find("map"), std::string::npos);
}

TEST_F(GltfMaterialsTest, ReportsAWrongShellWithItsPlace) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"shell":{"material":"pvc"}})", "acoustics.shell.thickness_mm: is missing"},
        {R"({"shell":{"thickness_mm":0,"material":"pvc"}})",
         "shell.thickness_mm: is 0; must be a number from 0.001 to 1000"},
        {R"({"shell":{"thickness_mm":2}})", "shell.material: is missing; or give density and sound_speed"},
        {R"({"shell":{"thickness_mm":2,"material":"mud"}})",
         "shell.material: is no matter of walls; give density and "},
        {R"({"shell":{"thickness_mm":2,"material":"stel"}})", "shell.material: is \"stel\"; did you mean steel?"},
        {R"({"shell":{"thickness_mm":2,"material":"pvc","shear_speed":2400}})",
         "shell.shear_speed: is 2400; must be below 0.87 times the sound_speed of 2400"},
        {R"({"shell":{"thickness_mm":2,"material":"pvc","thick":2}})", "shell.thick: is not known; "},
        {R"({"shell":{"thickness_mm":2,"material":"pvc","fill":"wine"}})",
         "shell.fill: is \"wine\"; may be water, air"},
        {R"({"shell":{"thickness_mm":2,"material":"pvc","fill":"air","fill_loss":0.1}})",
         "shell.fill: is air, which no sound passes into; omit fill_density"},
        {R"({"shell":{"thickness_mm":2,"material":"pvc","fill_density":900}})",
         "shell.fill_density: needs a fill of oil, sand or mud, or both"},
        {R"({"shell":{"thickness_mm":2,"material":"pvc","fill_density":900,"fill_sound_speed":100}})",
         "shell.fill_sound_speed: is 100; must be a number from 200 to 6000"},
        {R"({"shell":2})", "acoustics.shell: must be a block such as"},
        {R"({"shell":{"thickness_mm":2,"material":"pvc"},"material":"steel"})",
         "acoustics.shell: is given with `sediment`, `material` or `table`; give one of them"},
        {R"({"sediment":{"thickness_mm":2}})", "sediment.thickness_mm: is not known"}};
    for (const auto& [json, part] : cases)
        EXPECT_NE(diagnosticOfAcoustics(json).find(part), std::string::npos)
            << json << ": " << diagnosticOfAcoustics(json);
}

/** A triangle whose uvs are those of `mapped`, with a surface map. */
struct SurfaceMapsTest : SceneFiles {
    /** `map`: the block in extras.acoustics; `more`: inside the material; `uvs`: whether the mesh has coordinates. */
    static std::string painted(const std::string& map, const std::string& more = "", bool uvs = true) {
        return R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0)" +
               std::string(uvs ? R"(,"TEXCOORD_0":1)" : "") +
               R"(}}]}],"materials":[{"name":"floor","extras":{"acoustics":{"lambert_db":-15,"map":)" + map + "}}" +
               more +
               R"(},{"name":"weed","extras":{"acoustics":{"lambert_db":-22}}}],
            "textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071}],"images":[{"uri":")" +
               png + R"("}],
            "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
                         {"bufferView":1,"componentType":5126,"type":"VEC2","count":3}],
            "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],)" +
               buffers(toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + toBytes<float>({0, 1, 1, 1, 0, 0}));
    }
    static constexpr const char* coloured = R"(,"pbrMetallicRoughness":{"baseColorTexture":{"index":0}})";
};

TEST_F(SurfaceMapsTest, TheTextureOfTheBaseColourIsTakenInGrey) {
    const auto geometry = load(painted(R"({"decibels":[-30,0]})", coloured));
    const types::Mesh& mesh = geometry->meshes[0];
    ASSERT_EQ(mesh.maps.size(), 1u);
    const types::SurfaceMap& map = *mesh.maps[0].map;
    EXPECT_EQ(mesh.maps[0].material, 0);
    EXPECT_EQ(std::pair(map.width, map.height), std::pair(2, 1));
    EXPECT_EQ(std::pair(map.repeat_u, map.repeat_v), std::pair(false, true));
    // Greys of (255, 128, 128) and (10, 20, 30).
    for (const auto& [i, grey] : {std::pair(size_t{0}, 166.0), {1, 18.0}})
        EXPECT_NEAR(10 * std::log10(map.strengths.at(i)), -30 + 30 * grey / 255, 0.15);
    ASSERT_EQ(mesh.map_uvs.size(), mesh.positions.size());
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(mesh.map_uvs[i], glm::vec2(mesh.positions[i].x, 1 - mesh.positions[i].y)) << i;
    EXPECT_EQ(geometry->materials[0].max_map_strength, 1);
    EXPECT_TRUE(geometry->notices.empty()) << geometry->notices[0].text;
}

TEST_F(SurfaceMapsTest, ClassesAreSedimentsMatterOrMaterialsOfTheFile) {
    const auto geometry = load(painted(R"({"classes":{"18":"weed","166":"clay","7":"steel"}})", coloured));
    const types::SurfaceMap& map = *geometry->meshes[0].maps.at(0).map;
    ASSERT_EQ(map.materials.size(), 3u);
    const auto nameAt = [&](size_t texel) {
        return geometry->materials.at(static_cast<size_t>(map.materials.at(map.classes.at(texel)))).name;
    };
    EXPECT_EQ(nameAt(0), "clay");
    EXPECT_EQ(nameAt(1), "weed");
    ASSERT_EQ(geometry->materials.size(), 4u) << "clay and steel are added";
    EXPECT_TRUE(std::ranges::all_of(geometry->materials, &types::Material::has_acoustics));
}

TEST_F(SurfaceMapsTest, ReadsAnImageFromTheFolderOfTheScene) {
    write("paint.png", std::string("\x89PNG\r\n\x1a\n", 8));
    EXPECT_NE(diagnosticOfGltf(painted(R"({"image":"paint.png","decibels":[-30,0]})"))
                  .find("its image is neither PNG nor JPEG"),
              std::string::npos);
    EXPECT_NE(diagnosticOfGltf(painted(R"({"image":"none.png","decibels":[-30,0]})")).find("there is no such file"),
              std::string::npos);
    for (const char* foreign : {"../paint.png", "/dev/zero"})
        EXPECT_NE(diagnosticOfGltf(painted(R"({"image":")" + std::string(foreign) + R"(","decibels":[-30,0]})"))
                      .find(std::string(foreign) + ", which is outside of its folder"),
                  std::string::npos);
}

TEST_F(SurfaceMapsTest, ValuesWithoutAClassAndMeshesWithoutCoordinatesAreReported) {
    const auto half = load(painted(R"({"classes":{"18":"rock"}})", coloured));
    EXPECT_EQ(half->meshes[0].maps.at(0).map->classes.at(0), types::SurfaceMap::no_class);
    ASSERT_EQ(half->notices.size(), 1u);
    EXPECT_NE(half->notices[0].text.find("\"floor\": 50 % of its map has values without a class"), std::string::npos);
    const auto bare = load(painted(R"({"decibels":[-30,0]})", coloured, false));
    EXPECT_TRUE(bare->meshes[0].maps.empty());
    ASSERT_EQ(bare->notices.size(), 1u);
    EXPECT_NE(bare->notices[0].text.find("without their map, they have no texture coordinates: 1"), std::string::npos);
}

TEST_F(SurfaceMapsTest, AWrongMapIsReportedAtItsPlace) {
    const std::pair<const char*, const char*> cases[] = {
        {"2", "materials[0].extras.acoustics.map: must be an object such as"},
        {R"({"texcoord":0})", "acoustics.map: has neither decibels nor classes; must have one of the two"},
        {R"({"decibels":[-30,0],"classes":{"1":"rock"}})",
         "acoustics.map: has both decibels and classes; must have one of the two"},
        {R"({"decibels":[-30]})", "map.decibels: must be two numbers, as in [-30, 0]"},
        {R"({"decibels":[-30,"0"]})", "map.decibels: must be two numbers"},
        {R"({"decibels":[-30,60]})", "map.decibels: has 60; may be -200 to 40 dB"},
        {R"({"decibels":[-30,0],"values":[5,5]})", "map.values: must be two numbers that differ"},
        {R"({"classes":{"1.5":"rock"}})", "map.classes: has 1.5; a class is a whole number from 0 to 254"},
        {R"({"classes":{"255":"rock"}})", "map.classes: has 255; a class is a whole number from 0 to 254"},
        {R"({"classes":{"1":"rock","01":"sand"}})", "map.classes: has 01; a class is a whole number from 0 to 254"},
        {R"({"decibels":[-30,0],"texcoord":-1})", "map.texcoord: must be a whole number from 0 on"},
        {R"({"decibels":[-30,0],"texcoord":"1"})", "map.texcoord: must be a whole number from 0 on"},
        {R"({"classes":{"1":"rok"}})", "map.classes.1: is rok; did you mean rock?"},
        {R"({"classes":{"1":3}})", "map.classes.1: must be the name of a sediment"},
        {R"({"classes":[1,2]})", "map.classes: must be an object such as"},
        {R"({"decibls":[-30,0]})", "map.decibls: is not known; did you mean decibels?"},
        {R"({"decibels":[-30,0],"image":7})", "map: has an image that is no path"},
        {R"({"decibels":[-30,0]})", "map: has no image, and the material no texture of its base colour"}};
    for (const auto& [map, part] : cases)
        EXPECT_NE(diagnosticOfGltf(painted(map)).find(part), std::string::npos)
            << map << ": " << diagnosticOfGltf(painted(map));
}

TEST_F(GltfMaterialsTest, NamesOfTheTablesAreTakenAndNumbersRefineThem) {
    EXPECT_FLOAT_EQ(acoustics(R"({"sediment":"cobble"})").lambert_db, -8.1f);
    const types::Material steel = acoustics(R"({"material":"steel","reflectivity":0.5})");
    EXPECT_FLOAT_EQ(steel.reflection, 0.936f);
    EXPECT_NEAR(steel.lambert_db, -9.23 + 20 * std::log10(0.936), 1e-4);
    EXPECT_FLOAT_EQ(steel.reflectivity, 0.5);
    EXPECT_FLOAT_EQ(acoustics(R"({"sediment":"clay","lambert_db":-30})").lambert_db, -30);
}

TEST_F(GltfMaterialsTest, ASedimentKeepsItsNameWhereTheReportHasItAndNothingReplacesIt) {
    EXPECT_EQ(acoustics(R"({"sediment":"cobble"})").seabed, "cobble");
    EXPECT_EQ(acoustics(R"({"sediment":"mackenzie"})").seabed, "") << "measured at 1 kHz, not in the report";
    EXPECT_EQ(acoustics(R"({"sediment":"clay","lambert_db":-30})").seabed, "") << "by Lambert's law";
    EXPECT_EQ(acoustics(R"({"material":"steel"})").seabed, "");
}

TEST_F(GltfMaterialsTest, MatterFollowsItsLawUnlessNumbersReplaceIt) {
    EXPECT_EQ(acoustics(R"({"material":"steel"})").matter, "steel");
    EXPECT_EQ(acoustics(R"({"material":"human_body"})").matter, "human_body");
    EXPECT_EQ(acoustics(R"({"material":"steel","reflectivity":0.5,"mirror":true})").matter, "steel");
    for (const char* number : {R"("lambert_db":-20)", R"("reflection":0.5)", R"("roughness_slope":0.1)"})
        EXPECT_EQ(acoustics(std::string(R"({"material":"steel",)") + number + "}").matter, "") << number;
    EXPECT_FLOAT_EQ(acoustics(R"({"material":"steel","reflection":0.5})").reflection, 0.5);
    EXPECT_EQ(acoustics(R"({"material":"sand"})").matter, "") << "its relief is not known: Lambert's law";
    EXPECT_EQ(acoustics(R"({"shell":{"thickness_mm":3,"material":"pvc"}})").matter, "");
}

TEST_F(GltfMaterialsTest, ReadsATableNextToTheFile) {
    write("floor.csv", "grazing_deg,strength_db\n10,-40\n90,-10\n");
    const types::Material m = acoustics(R"({"table":"floor.csv","reflection":0.5})");
    ASSERT_EQ(m.measured.size(), 2u);
    EXPECT_EQ(m.measured[1], glm::dvec2(90, -10));
    EXPECT_FLOAT_EQ(m.reflection, 0.5);
}

/** A model of somebody else could show any file of a machine. */
TEST_F(GltfMaterialsTest, ReadsNoTableOutsideOfItsFolder) {
    std::filesystem::create_symlink("/etc/passwd", folder_ / "link.csv");
    for (const char* table : {"/etc/passwd", "../../../../../etc/passwd", "link.csv"}) {
        const std::string text = diagnosticOfAcoustics((std::string(R"({"table":")") + table + "\"}").c_str());
        EXPECT_THAT(text, testing::HasSubstr(std::string("table: is ") + table + ", which is outside of its folder"))
            << text;
        EXPECT_THAT(text, testing::Not(testing::HasSubstr("root:"))) << text;
    }
}

TEST_F(GltfMaterialsTest, ReportsAWrongTableWithItsPlace) {
    write("floor.csv", "grazing_deg,strength_db\n10,-40\n100,-10\n");
    const auto expect = [this](const char* json, const char* part) {
        EXPECT_NE(diagnosticOfAcoustics(json).find(part), std::string::npos)
            << json << ": " << diagnosticOfAcoustics(json);
    };
    expect(R"({"table":"none.csv"})", "materials[1].extras.acoustics.table: ");
    expect(R"({"table":"none.csv"})", "none.csv");
    expect(R"({"table":"floor.csv"})", "floor.csv:3:1: ");
    expect(R"({"table":7})", "table: is 7; must be the path of a file");
    expect(R"({"table":"floor.csv","sediment":"clay"})", "table: is given with `sediment` or `lambert_db`");
}

TEST_F(GltfMaterialsTest, ReportsWrongAcousticsWithTheAllowedValues) {
    const auto expect = [this](const char* json, const char* part) {
        EXPECT_NE(diagnosticOfAcoustics(json).find(part), std::string::npos)
            << json << ": " << diagnosticOfAcoustics(json);
    };
    expect(R"({"sediment":"sandd"})", "materials[1].extras.acoustics.sediment: is \"sandd\"; may be rough_rock, rock");
    expect(R"({"material":7})", "material: is 7; may be steel");
    expect(R"({"material":true})", "material: is true; may be steel");
    expect(R"({"material":""})", "material: is \"\"; may be steel");
    expect(R"({"material":"Steel"})", "materials[1].extras.acoustics.material: is \"Steel\"; did you mean steel?");
    expect(R"({"material":"unobtainium"})", "fouling, human_body");
    expect(R"({"lambert_db":"loud"})", "lambert_db: is \"loud\"; must be a number from -200 to 20");
    expect(R"({"reflection":1.5})", "reflection: is 1.5; must be a number from -1 to 1");
    expect(R"({"reflectivity":-0.1})", "reflectivity");
    expect(R"({"reflectivity":1.1})", "reflectivity");
    expect(R"({"lamberd_db":-3})",
           "lamberd_db: is not known; did you mean lambert_db? may be sediment, material, lambert_db");
    expect(R"({"sediment":"clay","material":"steel"})", "give one of the two");
    expect(R"([1])", "must be an object");
}

TEST_F(GltfMaterialsTest, ANormalMapBringsUvsNormalsAndTangents) {
    const auto geometry = mapped(png, R"(,"scale":0.5)");
    expectSound(*geometry);
    const types::Mesh& mesh = geometry->meshes.at(0);
    ASSERT_EQ(geometry->normal_maps.size(), 1u);
    const types::NormalMap& map = geometry->normal_maps[0];
    EXPECT_EQ(map.rgb, (std::vector<uint8_t>{255, 128, 128, 10, 20, 30}));
    EXPECT_FALSE(map.repeat_u);
    EXPECT_TRUE(map.repeat_v);
    EXPECT_FLOAT_EQ(geometry->materials[0].normal_scale, 0.5);
    for (size_t i = 0; i < 3; ++i) {  // flat normals and made tangents: u grows along x, v against y
        EXPECT_EQ(mesh.normals.at(i), glm::vec3(0, 0, 1));
        EXPECT_EQ(mesh.tangents.at(i), glm::vec4(1, 0, 0, 1));
    }
}

TEST_F(GltfMaterialsTest, NormalsAndTangentsOfTheFileTakePrecedence) {
    const auto geometry = mapped(png, "", R"(,"NORMAL":2,"TANGENT":3)");
    expectSound(*geometry);
    EXPECT_EQ(geometry->meshes[0].tangents.at(0), glm::vec4(0, 1, 0, -1));
}

TEST_F(GltfMaterialsTest, TheTextureTransformScalesThenTurnsThenShifts) {
    const auto geometry = mapped(png, R"(,"extensions":{"KHR_texture_transform":
        {"offset":[0.5,0.25],"rotation":1.5707963267948966,"scale":[2,4]}})");
    const types::Mesh& mesh = geometry->meshes.at(0);
    for (size_t i = 0; i < 3; ++i) {  // u' = 4 v + 0.5, v' = -2 u + 0.25 with u = x and v = 1 - y
        EXPECT_NEAR(mesh.uvs.at(i).x, 4 * (1 - mesh.positions[i].y) + 0.5, 1e-6);
        EXPECT_NEAR(mesh.uvs.at(i).y, -2 * mesh.positions[i].x + 0.25, 1e-6);
    }
}

TEST_F(GltfMaterialsTest, OmitsTheMapWithoutTextureCoordinates) {
    const auto geometry = mapped(png, R"(,"texCoord":1)");
    expectSound(*geometry);
    EXPECT_TRUE(hasNotice(*geometry, "they have no texture coordinates: 1"));
    const int material = geometry->meshes.at(0).clusters.at(0).material;
    EXPECT_EQ(geometry->materials.at(static_cast<size_t>(material)).normal_map, -1);
}

TEST_F(GltfMaterialsTest, AMissingOrDamagedImageIsANotice) {
    for (const std::string& image : {std::string("nowhere.png"), std::string("https://example.org/a.png"),
                                     png.substr(0, 90), std::string("data:image/png;base64,AAAA")}) {
        const auto geometry = mapped(image);
        EXPECT_EQ(geometry->triangleCount(), 1u);
        EXPECT_TRUE(geometry->normal_maps.empty());
        EXPECT_TRUE(hasNotice(*geometry, "\"wall\" is loaded without its normal map")) << image;
    }
}

TEST_F(GltfMaterialsTest, OtherImagesAreNeverDecoded) {
    const auto geometry = load(R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
        "textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,AAAA"}])");
    EXPECT_TRUE(geometry->normal_maps.empty());
    EXPECT_EQ(geometry->notices.size(), 1u);  // the empty sea
}

TEST_F(GltfMaterialsTest, IndicesOfTexturesImagesSamplersAndMaterialsAreChecked) {
    const std::string material = R"("materials":[{"normalTexture":{"index":0}}])";
    EXPECT_NE(diagnosticOfGltf(material).find("textures[0]: does not exist"), std::string::npos);
    EXPECT_NE(diagnosticOfGltf(material + R"(,"textures":[{"source":4}])").find("images[4]"), std::string::npos);
    EXPECT_NE(diagnosticOfGltf(material + R"(,"textures":[{"source":0,"sampler":2}],"images":[{"uri":")" + png + "\"}]")
                  .find("samplers[2]"),
              std::string::npos);
}

TEST_F(GltfMaterialsTest, FileNamesMayHaveSpaces) {
    write("the floor.bin", toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
    const auto geometry = load(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"the%20floor.bin"}])");
    EXPECT_EQ(geometry->triangleCount(), 1u);
}

TEST_F(GltfMaterialsTest, NamesOfFilesWithPercentSignsAreTakenAsTheyStand) {
    const auto triangles = [&](const std::string& name, const std::string& uri) {
        write(name, toBytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
        const auto geometry = load(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
            "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri" : ")" +
                                   uri + "\"}]");
        std::filesystem::remove(folder_ / name);
        return geometry->triangleCount();
    };
    EXPECT_EQ(triangles("ten 10%.bin", "ten 10%.bin"), 1u) << "as Blender names it";
    EXPECT_EQ(triangles("ten 10%.bin", "ten%2010%25.bin"), 1u) << "as the specification has it";
    EXPECT_EQ(triangles("a%20b.bin", "a%20b.bin"), 1u);
    EXPECT_EQ(triangles("%%%.bin", "%%%.bin"), 1u);
}

}  // namespace
}  // namespace insonify::scene
