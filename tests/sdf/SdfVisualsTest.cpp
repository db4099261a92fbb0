// Shapes, materials and heightmaps of SDF visuals, against their closed forms.
#include <numbers>

#include "components/meshes/VisualMeshes.hpp"
#include "components/scene/Acoustics.hpp"
#include "components/scene/Drawings.hpp"
#include "tests/sdf/SdfFiles.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

struct SdfVisualsTest : SdfFiles {
    types::GeometryPtr shape(const std::string& geometry) const { return world(model("m", geometry)).geometry; }
    static const types::Material& getMaterial(const types::Geometry& geometry, size_t object) {
        const types::Mesh& mesh = geometry.meshes.at(static_cast<size_t>(geometry.objects.at(object).mesh));
        return geometry.materials.at(static_cast<size_t>(mesh.clusters.at(0).material));
    }
    static std::string acoustics(const std::string& keys) {
        return "<insonify:acoustics>" + keys + "</insonify:acoustics>";
    }
};

/** Volume of a body of revolution with 64 facets relative to the round body. */
const double faceted = std::sin(2 * std::numbers::pi / 64) * 64 / (2 * std::numbers::pi);

TEST_F(SdfVisualsTest, ABoxHasItsSize) {
    const auto geometry = shape("<box><size>2 4 6</size></box>");
    expectBounds(getBounds(*geometry), {-1, -2, -3}, {1, 2, 3});
    EXPECT_NEAR(computeVolume(*geometry), 48, 1e-5);
    EXPECT_EQ(geometry->triangleCount(), 12u);
}

TEST_F(SdfVisualsTest, TheCornersOfASphereAreOnIt) {
    const auto geometry = shape("<sphere><radius>3</radius></sphere>");
    expectSound(*geometry);
    for (const glm::dvec3 corner : worldCorners(*geometry)) EXPECT_NEAR(glm::length(corner), 3, 1e-6);
    const double volume = 4 * std::numbers::pi / 3 * 27;
    EXPECT_LT(computeVolume(*geometry), volume);
    EXPECT_GT(computeVolume(*geometry), volume * 0.995);
}

TEST_F(SdfVisualsTest, AnEllipsoidIsASphereOfThreeRadii) {
    const auto geometry = shape("<ellipsoid><radii>1 2 3</radii></ellipsoid>");
    for (const glm::dvec3 corner : worldCorners(*geometry))
        EXPECT_NEAR(glm::length(corner / glm::dvec3(1, 2, 3)), 1, 1e-6);
}

TEST_F(SdfVisualsTest, ACylinderIsAlongZ) {
    const auto geometry = shape("<cylinder><radius>0.5</radius><length>4</length></cylinder>");
    expectBounds(getBounds(*geometry), {-0.5, -0.5, -2}, {0.5, 0.5, 2});
    EXPECT_NEAR(computeVolume(*geometry), std::numbers::pi * 0.25 * 4 * faceted, 1e-5);
    EXPECT_EQ(geometry->triangleCount(), 4u * 64);
}

TEST_F(SdfVisualsTest, ACapsuleIsACylinderBetweenHalfSpheres) {
    const auto geometry = shape("<capsule><radius>0.5</radius><length>4</length></capsule>");
    expectSound(*geometry);
    for (const glm::dvec3 corner : worldCorners(*geometry)) {
        const double beyond = std::max(0.0, std::abs(corner.z) - 2);
        EXPECT_NEAR(glm::length(glm::dvec3(corner.x, corner.y, beyond)), 0.5, 1e-6);
    }
    const double half_spheres = computeVolume(*shape("<sphere><radius>0.5</radius></sphere>"));
    EXPECT_NEAR(computeVolume(*geometry), std::numbers::pi * 0.25 * 4 * faceted + half_spheres, 1e-5);
}

TEST_F(SdfVisualsTest, APlaneIsPerpendicularToItsNormal) {
    expectBounds(getBounds(*shape("<plane><normal>0 0 1</normal><size>20 10</size></plane>")), {-10, -5, 0},
                 {10, 5, 0});
    const auto wall = shape("<plane><normal>1 0 0</normal><size>20 10</size></plane>");
    expectBounds(getBounds(*wall), {0, -5, -10}, {0, 5, 10});
    const auto corners = worldCorners(*wall);
    EXPECT_GT(glm::cross(corners[1] - corners[0], corners[2] - corners[0]).x, 0);
}

TEST_F(SdfVisualsTest, EqualVisualsShareTheirMesh) {
    const Scene scene =
        world(model("a", box_) + model("b", "<box><size>1 1 9</size></box>") + "<model name='c'><link name='l'>" +
              visual("v", box_, acoustics("<material>steel</material>")) + "</link></model>");
    const auto& objects = scene.geometry->objects;
    EXPECT_EQ(scene.geometry->meshes.size(), 2u);
    EXPECT_EQ(objects.at(0).mesh, objects.at(1).mesh);
    EXPECT_NE(objects.at(0).mesh, objects.at(2).mesh);
}

TEST_F(SdfVisualsTest, TheAcousticTagHasTheKeysOfGltf) {
    const Scene scene =
        world("<model name='a'><link name='l'>" +
              visual("v", box_, acoustics("<sediment>rough_rock</sediment><roughness_slope>0.2</roughness_slope>")) +
              visual("u", box_, "<insonify:acoustics material='steel'/>") + visual("w", box_) + "</link></model>");
    EXPECT_FLOAT_EQ(getMaterial(*scene.geometry, 0).lambert_db, -5);
    EXPECT_FLOAT_EQ(getMaterial(*scene.geometry, 0).roughness_slope.value(), 0.2f);
    EXPECT_FLOAT_EQ(getMaterial(*scene.geometry, 1).reflection, 0.936f);
    EXPECT_EQ(getMaterial(*scene.geometry, 1).matter, "steel");
    EXPECT_TRUE(getMaterial(*scene.geometry, 1).has_acoustics);
    EXPECT_FALSE(getMaterial(*scene.geometry, 2).has_acoustics);
}

TEST_F(SdfVisualsTest, AShellIsABlockOfElements) {
    const auto shell = [&](const std::string& keys) {
        return "<model name='a'><link name='l'>" + visual("v", box_, acoustics("<shell>" + keys + "</shell>")) +
               "</link></model>";
    };
    const Scene scene = world(shell("<thickness_mm>2</thickness_mm><material>glass</material><fill>air</fill>"));
    EXPECT_EQ(getMaterial(*scene.geometry, 0).shell.value(), (types::Shell{0.002, 2500, 5660, 3420, 5e-4, true}));
    EXPECT_NE(diagnosticOfWorld(shell("<material>glass</material>")).find("shell.thickness_mm: is missing"),
              std::string::npos);
}

TEST_F(SdfVisualsTest, ReportsAWrongAcousticTagWithItsLine) {
    const std::string diagnostic = diagnosticOfWorld(
        "<model name='a'>\n<link name='l'>\n" +
        visual("v", box_, "\n" + acoustics("<sediment>sandd</sediment><lamber_db>1</lamber_db>")) + "</link></model>");
    EXPECT_NE(diagnostic.find("case.world:4: a::l::v.insonify:acoustics.sediment: is \"sandd\"; may be rough_rock, "),
              std::string::npos)
        << diagnostic;
    EXPECT_NE(diagnostic.find("insonify:acoustics.lamber_db: is not known; did you mean lambert_db? may be sediment, "),
              std::string::npos)
        << diagnostic;
}

TEST_F(SdfVisualsTest, MaterialsAreOverriddenByScriptNameAndByModel) {
    const std::string script = "<material><script><name>Gazebo/Wood</name></script></material>";
    const Scene scene = world("<model name='pier'><link name='l'>" + visual("v", box_, script) + "</link></model>" +
                              model("rov", box_) + model("rock", box_));
    Acoustics wood, steel;
    wood.lambert_db = -30;
    steel.material = Matter::Steel;
    types::Diagnostics diagnostics;
    const auto geometry = overrideMaterials(scene, {{"Gazebo/Wood", wood}, {"rov", steel}}, diagnostics);
    EXPECT_TRUE(diagnostics.empty());
    EXPECT_FLOAT_EQ(getMaterial(*geometry, 0).lambert_db, -30);
    EXPECT_FLOAT_EQ(getMaterial(*geometry, 1).reflection, 0.936f);
    EXPECT_FALSE(getMaterial(*geometry, 2).has_acoustics);
}

TEST_F(SdfVisualsTest, AScriptNameSelectsItsMatter) {
    const std::string script = "<material><script><name>Gazebo/Wood</name></script></material>";
    const Scene scene = world("<model name='pier'><link name='l'>" + visual("v", box_, script) + "</link></model>" +
                              model("rov", box_));
    const auto geometry = applyMaterialNames(scene.geometry);
    EXPECT_EQ(getMaterial(*geometry, 0).matter, "wood");
    EXPECT_FALSE(getMaterial(*geometry, 1).has_acoustics);
}

TEST_F(SdfVisualsTest, AHeightmapIsAGridOfItsPixels) {
    write("hill.pgm", "P5 3 2 255\n" + std::string("\x00\x33\x66\x99\xcc\xff", 6));
    const Scene scene = world(model(
        "m", "<heightmap><uri>hill.pgm</uri><size>20 10 5</size><pos>100 0 -7</pos></heightmap>", pose("0 0 2 0 0 0")));
    expectSound(*scene.geometry);
    EXPECT_EQ(scene.geometry->triangleCount(), 4u);
    // pixels are 0, 1, 2 m in the top row, at +y, and 3, 4, 5 m in the row below
    for (const glm::dvec3 corner : worldCorners(*scene.geometry)) {
        const double height = (corner.x - 90) / 10 + (corner.y > 0 ? 0 : 3);
        EXPECT_NEAR(corner.z, height - 5, 1e-6);
        EXPECT_NEAR(std::abs(corner.y), 5, 1e-6);
    }
    const auto corners = worldCorners(*scene.geometry);
    EXPECT_GT(glm::cross(corners[1] - corners[0], corners[2] - corners[0]).z, 0);
}

TEST_F(SdfVisualsTest, AHeightmapOfManyPixelsIsReadInSteps) {
    write("plain.pgm", "P5 4097 3 255\n" + std::string(4097 * 3, '\xff'));
    const auto geometry = shape("<heightmap><uri>plain.pgm</uri><size>20 10 5</size></heightmap>");
    EXPECT_EQ(geometry->triangleCount(), 2u * 2048 * 2);
    expectBounds(getBounds(*geometry), {-10, -5, 5}, {10, 5, 5});
}

TEST_F(SdfVisualsTest, AnUnsupportedVisualIsANotice) {
    write("words.png", "no picture");
    write("animation.png",
          std::string("GIF89a\2\0\2\0\0\0\0,\0\0\0\0\2\0\2\0\0\2\2\x84Q\0;", 27));  // stb_image would read it
    const Scene scene =
        world("<model name='m'><link name='l'>" + visual("a", "<mesh><uri>model://gone.dae</uri></mesh>") +
              visual("b", "<heightmap><uri>words.png</uri></heightmap>") +
              visual("f", "<heightmap><uri>animation.png</uri></heightmap>") +
              visual("c", "<heightmap><uri>gone.png</uri></heightmap>") + visual("d", "<box><size>1 0 1</size></box>") +
              visual("e", "<empty/>") + "</link></model>");
    EXPECT_TRUE(scene.geometry->objects.empty());
    for (const char* part : {"visual m::l::a is omitted: model://gone.dae is not found",
                             "visual m::l::b is omitted: words.png is neither PNG nor JPEG",
                             "visual m::l::f is omitted: animation.png is neither PNG nor JPEG",
                             "visual m::l::c is omitted: gone.png is not found",
                             "visuals omitted, their size is zero in some direction or not finite: 1",
                             "visual m::l::e is omitted: its geometry, <empty>, is not supported", "an empty sea"})
        EXPECT_TRUE(hasNotice(*scene.geometry, part)) << part;
}

TEST_F(SdfVisualsTest, MarksOfDrawingsAreRead) {
    const Scene scene = world("<model name='m'><link name='l'>" + visual("plain", box_) +
                              visual("clear", box_, "<transparency>0.5</transparency>") +
                              visual("ghost", box_, "<transparency>1</transparency>") +
                              visual("some", box_, "<visibility_flags>2</visibility_flags>") +
                              visual("none", box_, "<visibility_flags>0</visibility_flags>") +
                              visual("light", box_, "<cast_shadows>false</cast_shadows>") + "</link></model>");
    ASSERT_EQ(scene.drawings.size(), 6u);
    EXPECT_EQ(scene.drawings[0].transparency, 0);
    EXPECT_TRUE(scene.drawings[0].casts_shadow);
    EXPECT_FALSE(scene.drawings[0].is_for_some || scene.drawings[0].is_for_none);
    EXPECT_EQ(scene.drawings[1].transparency, 0.5);
    EXPECT_TRUE(scene.drawings[3].is_for_some && !scene.drawings[3].is_for_none);
    EXPECT_TRUE(scene.drawings[4].is_for_none);
    EXPECT_FALSE(scene.drawings[5].casts_shadow);
    const Scene kept = withoutOmitted(scene, {});
    EXPECT_EQ(kept.geometry->objects.size(), 4u);
    ASSERT_EQ(kept.omitted.size(), 2u);
    EXPECT_EQ(kept.omitted[0].name, "m::l::ghost");
    EXPECT_EQ(kept.omitted[1].name, "m::l::none");
}

TEST_F(SdfVisualsTest, ADrawnSeaIsOmittedAndItsFloorIsNot) {
    const std::string plain = "<box><size>200 200 0.01</size></box>";
    const Scene scene = world("<model name='ocean'><link name='link'>" +
                              visual("water_surface", plain,
                                     "<cast_shadows>false</cast_shadows><transparency>0.6</"
                                     "transparency><visibility_flags>2</visibility_flags>") +
                              visual("floor", plain, pose("0 0 -20 0 0 0")) + "</link></model>");
    for (const OmitRules& rules : {OmitRules{{}, true, 0.0, {}}, OmitRules{}}) {
        const Scene kept = withoutOmitted(scene, rules);
        ASSERT_EQ(kept.geometry->objects.size(), 1u);
        EXPECT_EQ(kept.geometry->objects[0].name, "ocean::link::floor");
    }
    EXPECT_EQ(withoutOmitted(scene, {{"ocean"}, true, {}, {}}).geometry->objects.size(), 0u);
}

}  // namespace
}  // namespace insonify::sdf
