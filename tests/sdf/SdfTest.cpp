// Models, links, frames and joints of SDF worlds; their places are known in closed form.
#include "components/sdf/Sdf.hpp"
#include "tests/sdf/SdfFiles.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

struct SdfTest : SdfFiles {
    static std::vector<std::string> getNames(const std::vector<Part>& parts, const Scene& scene) {
        std::vector<std::string> names;
        for (const Part& part : parts) names.push_back(scene.geometry->objects[part.object].name);
        return names;
    }
    static std::string getParent(const Scene& scene, const std::string& name) {
        const int node = findNode(scene, name);
        if (node < 0) return "no such node";
        const int parent = scene.nodes[static_cast<size_t>(node)].parent;
        return parent < 0 ? "" : scene.nodes[static_cast<size_t>(parent)].name;
    }
    static std::string link(const std::string& name) { return "<link name='" + name + "'/>"; }
    static std::string joint(const std::string& parent, const std::string& child) {
        static int count = 0;
        return "<joint name='joint_" + std::to_string(++count) + "' type='revolute'><parent>" + parent +
               "</parent><child>" + child + "</child><axis><xyz>0 0 1</xyz></axis></joint>";
    }
};

using Names = std::vector<std::string>;

TEST_F(SdfTest, ABoxIsPlacedByModelLinkAndVisual) {
    const Scene scene =
        world("<model name='m'>" + pose("10 0 0 0 0 1.5707963267948966") + "<link name='l'>" + pose("3 0 0 0 0 0") +
              visual("v", box_, pose("0 0 5 1.5707963267948966 0 0")) + "</link></model>");
    // in the visual the box turns about x: 2 x 6 x 4; the model turns it about z: 6 x 2 x 4 about (10, 3, 5)
    expectBounds(getBounds(*scene.geometry), {7, 2, 3}, {13, 4, 7});
    expectSound(*scene.geometry);
    EXPECT_EQ(scene.geometry->objects.at(0).name, "m::l::v");
    EXPECT_TRUE(scene.geometry->notices.empty());
}

TEST_F(SdfTest, PosesAreRelativeToTheFrameThatTheyName) {
    const Scene scene = world("<frame name='f'>" + pose("10 0 0 0 0 1.5707963267948966") + "</frame><model name='m'>" +
                              "<pose relative_to='f'>1 0 0 0 0 0</pose><frame name='top'>" + pose("0 0 7 0 0 0") +
                              "</frame><link name='l'><pose relative_to='top'>2 0 0 0 0 0</pose>" + visual("v", box_) +
                              "</link></model>");
    // f turns x to y: the model is at (10, 1, 0), its link at (10, 3, 7)
    expectBounds(getBounds(*scene.geometry), {8, 2, 4}, {12, 4, 10});
}

TEST_F(SdfTest, IncludedAndNestedModelsHaveTheirScopes) {
    writeModel("inner", model("inner", box_));
    writeModel("outer",
               "<model name='outer'>" + link("base") +
                   "<include><uri>model://inner</uri><name>arm</name><pose>0 0 3 0 0 0</pose></include></model>");
    const Scene scene = world("<include><uri>model://outer</uri><name>rov</name>" + pose("5 0 0 0 0 0") + "</include>");
    EXPECT_TRUE(scene.geometry->notices.empty());
    expectBounds(getBounds(*scene.geometry), {4, -2, 0}, {6, 2, 6});
    EXPECT_EQ(getParent(scene, "rov"), "");
    EXPECT_EQ(getParent(scene, "rov::arm"), "rov");
    EXPECT_EQ(getParent(scene, "rov::arm::hull"), "rov::arm");
    EXPECT_EQ(scene.geometry->objects.at(0).name, "rov::arm::hull::skin");
}

TEST_F(SdfTest, AnIncludeIsPlacedByItsPlacementFrame) {
    writeModel("post", "<model name='post'><frame name='foot'>" + pose("0 0 -3 0 0 0") + "</frame><link name='l'>" +
                           visual("v", box_) + "</link></model>");
    const Scene scene = world("<include><uri>model://post</uri><placement_frame>foot</placement_frame>" +
                              pose("1 1 0 0 0 0") + "</include>");
    expectBounds(getBounds(*scene.geometry), {0, -1, 0}, {2, 3, 6});
}

TEST_F(SdfTest, AModelsPoseMovesAllThatIsInIt) {
    const Scene scene = world("<model name='m'>" + pose("10 0 0 0 0 1") + "<link name='l'>" + pose("0 0 2 0 0 0") +
                              visual("v", box_) + "</link></model>" + model("other", box_));
    const std::vector<Part> parts = getParts(scene, findNode(scene, "m"));
    ASSERT_EQ(getNames(parts, scene), Names{"m::l::v"});
    // the body is the model's frame: its own pose, yaw and place, no longer counts
    const glm::dmat4 scaled = glm::scale(glm::translate(glm::dmat4(1), {0, 0, 2}), {2, 4, 6});
    for (int column = 0; column < 4; ++column)
        EXPECT_LT(glm::distance(parts[0].body_from_object[column], scaled[column]), 1e-12);
}

TEST_F(SdfTest, AJointAttachesALinkToItsParent) {
    const Scene scene =
        world("<model name='arm'>" + ("<link name='hand'>" + pose("4 0 0 0 0 0") + visual("v", box_) + "</link>") +
              link("elbow") + link("base") + joint("elbow", "hand") + joint("base", "elbow") + "</model>");
    EXPECT_EQ(getParent(scene, "arm::base"), "arm");
    EXPECT_EQ(getParent(scene, "arm::elbow"), "arm::base");
    EXPECT_EQ(getParent(scene, "arm::hand"), "arm::elbow");
    EXPECT_EQ(getNames(getParts(scene, findNode(scene, "arm::elbow")), scene), Names{"arm::hand::v"});
    expectBounds(getBounds(*scene.geometry), {3, -2, -3}, {5, 2, 3});
}

TEST_F(SdfTest, AJointAttachesANestedModelToItsParent) {
    writeModel("gripper", model("gripper", box_));
    const Scene scene = world("<model name='rov'>" + link("wrist") + "<include><uri>model://gripper</uri>" +
                              pose("1 0 0 0 0 0") + "</include>" + joint("wrist", "gripper::hull") + "</model>");
    EXPECT_EQ(getParent(scene, "rov::gripper"), "rov::wrist");
    EXPECT_EQ(getNames(getParts(scene, findNode(scene, "rov::wrist")), scene), Names{"rov::gripper::hull::skin"});
}

TEST_F(SdfTest, JointsInACircleEndAtTheModel) {
    const Scene scene =
        world("<model name='m'>" + link("a") + link("b") + joint("a", "b") + joint("b", "a") + "</model>");
    EXPECT_EQ(getParent(scene, "m::b"), "m");
    EXPECT_EQ(getParent(scene, "m::a"), "m::b");
}

TEST_F(SdfTest, NamesOfOldWorldsMayHoldColons) {
    // libsdformat takes the links of a scope for links of a nested model, which old worlds did not have
    const Scene scene = world("<model name='a::b'><link name='x::l'>" + pose("1 0 0 0 0 0") + visual("v::v", box_) +
                                  "</link>" + link("tip") + joint("x::l", "tip") + "</model>",
                              "1.6");
    EXPECT_EQ(getParent(scene, "a::b::x::l"), "a::b::x");
    EXPECT_EQ(getParent(scene, "a::b::tip"), "a::b::x::l");
    EXPECT_EQ(scene.geometry->objects.at(0).name, "a::b::x::l::v::v");
    expectBounds(getBounds(*scene.geometry), {0, -2, -3}, {2, 2, 3});
}

TEST_F(SdfTest, NamesWithColonsThatLibsdformatRefusesAreReadWithUnderscores) {
    const std::string body = model("a::b", "<mesh><uri>plate.obj</uri></mesh>");
    write("plate.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scene scene = world(body, "1.9");
    expectBounds(getBounds(*scene.geometry), {0, 0, 0}, {1, 1, 0});
    EXPECT_GE(findNode(scene, "a__b"), 0);
    EXPECT_TRUE(hasNotice(*scene.geometry, "names are read with \"__\" for \"::\""));
    // in this case it throws an object that is no std::exception
    const Scene old = world("<model name='m'>" + link("x::l") + link("x::k") +
                                "<joint name='x::j' type='revolute'><parent>x::l</parent><child>x::k</child><axis>"
                                "<xyz>0 0 1</xyz></axis></joint></model>",
                            "1.4");
    EXPECT_EQ(getParent(old, "m::x__k"), "m::x__l");
    EXPECT_TRUE(hasNotice(*old.geometry, "cannot be read as SDF: SDF ASSERTION Error: <xyz>'s attribute"));
}

TEST_F(SdfTest, AModelAloneIsASceneAndFindsItsOwnFiles) {
    std::filesystem::create_directories(folder_ / "anchor/meshes");
    write("anchor/meshes/fluke.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    writeModel("anchor",
               model("anchor", "<mesh><uri>model://anchor/meshes/fluke.obj</uri></mesh>", pose("0 0 2 0 0 0")));
    const Scene scene = readScene(folder_ / "anchor/model.sdf");
    expectBounds(getBounds(*scene.geometry), {0, 0, 2}, {1, 1, 2});
    EXPECT_GE(findNode(scene, "anchor"), 0);
}

TEST_F(SdfTest, ReadsTheFirstOfSeveralWorlds) {
    const Scene scene =
        readScene(write("two.sdf", "<sdf version='1.9'><world name='a'>" + model("m", box_) +
                                       "</world><world name='b'>" + model("n", box_) + "</world></sdf>"));
    EXPECT_EQ(scene.geometry->objects.size(), 1u);
    EXPECT_TRUE(hasNotice(*scene.geometry, "worlds omitted, the first of the file is read: 1"));
}

TEST_F(SdfTest, UnsupportedPartsOfAWorldAreNotices) {
    const Scene scene =
        world(model("m", box_) + "<state world_name='w'><model name='m'>" + pose("9 0 0 0 0 0") +
              "</model></state><actor name='diver'><skin><filename>diver.dae</filename></skin></actor>");
    expectBounds(getBounds(*scene.geometry), {-1, -2, -3}, {1, 2, 3});
    EXPECT_TRUE(hasNotice(*scene.geometry, "the poses of <state> are not used"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "actors omitted: 1"));
}

TEST_F(SdfTest, AnIncludeThatIsNotFoundIsANoticeWithItsLine) {
    const Scene scene = world("<include><uri>model://crate</uri></include>\n" + model("m", box_) +
                              "\n<include><uri>https://fuel.gazebosim.org/1.0/x/models/y</uri></include>\n");
    EXPECT_EQ(scene.geometry->objects.size(), 1u);
    EXPECT_TRUE(hasNotice(*scene.geometry, "case.world:2: ")) << scene.geometry->notices.at(0).text;
    EXPECT_TRUE(hasNotice(*scene.geometry, "Unable to find uri[model://crate]; omitted"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "1 model of Fuel is not found, and omitted: https://fuel.gazebosim.org"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "INSONIFY_MODEL_PATH adds folders"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "gz fuel download"));
}

TEST_F(SdfTest, MissingModelsOfFuelAreOneNotice) {
    std::string includes;
    for (int i = 0; i < 20; ++i)
        includes += "<include><uri>https://fuel.gazebosim.org/1.0/x/models/m" + std::to_string(i) + "</uri></include>";
    const Scene scene = world(includes + model("m", box_));
    EXPECT_TRUE(hasNotice(*scene.geometry, "20 models of Fuel are not found"));
    EXPECT_EQ(scene.geometry->notices.size(), 2u) << "that, and where they were searched";
}

TEST_F(SdfTest, AModelInTheCacheOfFuelIsRead) {
    const Variable home("HOME", folder_.string());
    write(".gz/fuel/fuel.gazebosim.org/open/models/post/2/model.config",
          "<model><name>post</name><sdf version='1.9'>model.sdf</sdf></model>");
    write(".gz/fuel/fuel.gazebosim.org/open/models/post/2/model.sdf",
          "<sdf version='1.9'>" + model("post", box_) + "</sdf>");
    const Scene scene = world("<include><uri>https://fuel.gazebosim.org/1.0/Open/models/Post</uri>" +
                              pose("5 0 0 0 0 0") + "</include>");
    expectBounds(getBounds(*scene.geometry), {4, -2, -3}, {6, 2, 3});
}

TEST_F(SdfTest, APopulationHasTheCopiesThatGazeboPlaces) {
    const auto population = [&](const std::string& rule, const std::string& region, const std::string& count) {
        return "<population name='p'>" + model("m", "<box><size>1 1 1</size></box>") +
               pose("10 20 30 0 0 1.5707963267948966") + region + "<model_count>" + count +
               "</model_count><distribution>" + rule + "</distribution></population>";
    };
    const std::string box = "<box><size>6 4 2</size></box>",
                      cylinder = "<cylinder><radius>3</radius><length>2</length></cylinder>";
    const Scene grid = world(population("<type>grid</type><rows>2</rows><cols>3</cols><step>4 5 6</step>", box, "0"));
    ASSERT_EQ(grid.geometry->objects.size(), 6u);
    EXPECT_GE(findNode(grid, "m_clone_5"), 0);
    // The region is turned by 90 degrees: its x is along y. The copies are not turned.
    expectBounds(getBounds(*grid.geometry), {10 - 5 - 0.5, 20 - 0.5, 29.5}, {10.5, 20 + 8 + 0.5, 30.5}, 1e-5);
    const Scene row = world(population("<type>linear-x</type>", box, "3"));
    expectBounds(getBounds(*row.geometry), {10 - 2 - 0.5, 19.5, 31 - 0.5}, {10 - 2 + 0.5, 24.5, 31.5}, 1e-5);
    for (const char* type : {"random", "uniform"})
        for (const std::string& region : {box, cylinder}) {
            const Scene drawn = world(population(std::string("<type>") + type + "</type>", region, "40"));
            ASSERT_EQ(drawn.geometry->objects.size(), 40u);
            const Bounds bounds = getBounds(*drawn.geometry);
            const glm::dvec3 low = region == box ? glm::dvec3(6, 20, 30) : glm::dvec3(7, 17, 29),
                             high = region == box ? glm::dvec3(10, 26, 32) : glm::dvec3(13, 23, 31);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(bounds.low[axis], low[axis] - 0.51);
                EXPECT_LE(bounds.high[axis], high[axis] + 0.51);
                EXPECT_GT(bounds.high[axis] - bounds.low[axis], 1 + 0.6 * (high[axis] - low[axis]))
                    << "they are spread";
            }
            EXPECT_TRUE(hasNotice(*drawn.geometry, "population p: 40 times m, at places that are drawn"));
            const Scene again = world(population(std::string("<type>") + type + "</type>", region, "40"));
            EXPECT_EQ(again.geometry->objects.back().world_from_object,
                      drawn.geometry->objects.back().world_from_object);
        }
    EXPECT_EQ(world(population("<type>random</type>", box, "0")).geometry->objects.size(), 0u);
    EXPECT_EQ(world(population("<type>random</type>", box, "-3")).geometry->objects.size(), 0u);
    EXPECT_EQ(world(population("<type>random</type>", box, "1e9")).geometry->objects.size(), 1u)
        << "a number with an end";
    const Scene none = world("<population name='p'><model_count>2</model_count></population>" + model("n", box_));
    EXPECT_TRUE(hasNotice(*none.geometry, "population p is omitted: it has no model"));
}

TEST_F(SdfTest, SurfacesOfOtherSimulatorsAreReadWhereTheyNameAMaterialElseOneNotice) {
    const Scene scene =
        readScene(write("can.sdf",
                        "<sdf version='1.9' xmlns:surface_props='s'><model "
                        "name='can'><surface_props:material>metal</surface_props:material>"
                        "<surface_props:biofouling_rating>10</surface_props:biofouling_rating><link name='l'>" +
                            visual("v", box_, "<laser_retro>2</laser_retro>") +
                            visual("w", box_, "<laser_retro>3</laser_retro>") + "</link></model></sdf>"));
    EXPECT_EQ(scene.geometry->materials.at(0).name, "steel");
    EXPECT_TRUE(hasNotice(*scene.geometry, "not used: laser_retro, surface_props:biofouling_rating; a surface's echo"));
    EXPECT_FALSE(hasNotice(*world(model("m", box_)).geometry, "not used"));
    EXPECT_TRUE(
        hasNotice(*world(model("m", box_) + "<road name='r'><point>0 0 0</point><point>1 0 0</point></road>").geometry,
                  "roads omitted: drawn strips on the ground: 1"));
}

/** What Gazebo's older parsers took, and what a sonar needs nothing of. */
TEST_F(SdfTest, FaultsInWhatASonarDoesNotNeedAreNoObstacle) {
    const std::string body = "<link name='hull'>" + visual("skin", box_);
    const std::map<std::string, std::string> files = {
        {"inertia of three numbers", "<sdf version='1.6'><model name='m'>" + body + "<inertial>" + pose("1 2 3") +
                                         "</inertial></link></model></sdf>"},
        {"friction below 0", "<sdf version='1.6'><model name='m'>" + body + "<collision name='c'><geometry>" + box_ +
                                 "</geometry><surface><friction><ode><mu>-1</mu></ode></friction></surface></"
                                 "collision></link></model></sdf>"},
        {"narrow camera",
         "<sdf version='1.6'><model name='m'>" + body +
             "<sensor name='s' "
             "type='camera'><camera><horizontal_fov>0.01</horizontal_fov></camera></sensor></link></model></sdf>"},
        {"no quotes", "<sdf version='1.6'><model name='m'><link name=hull><visual name=skin><geometry>" + box_ +
                          "</geometry></visual></link></model></sdf>"},
        {"late declaration",
         "<!-- licence -->\n<?xml version='1.0'?><sdf version='1.6'>" + model("m", box_) + "</sdf>"},
        {"root of old", "<gazebo version='1.2'>" + model("m", box_) + "</gazebo>"},
    };
    for (const auto& [what, text] : files) {
        SCOPED_TRACE(what);
        const Scene alone = readScene(write("alone.sdf", text));
        expectBounds(getBounds(*alone.geometry), {-1, -2, -3}, {1, 2, 3});
        writeModel("bad", "");
        write("bad/model.sdf", text);
        const Scene included =
            world("<include><uri>model://bad</uri>" + pose("7 0 0 0 0 0") + "</include>" + model("n", box_));
        expectBounds(getBounds(*included.geometry), {-1, -2, -3}, {8, 2, 3});
        EXPECT_TRUE(hasNotice(*included.geometry, "is read without what a sonar does not need"));
    }
    const Scene padded =
        readScene(write("alone.sdf", "<sdf version='1.6'>" + model("m", box_, pose("5 0 0 0 0")) + "</sdf>"));
    expectBounds(getBounds(*padded.geometry), {4, -2, -3}, {6, 2, 3});
    EXPECT_TRUE(hasNotice(*padded.geometry, "must have 6 values, but 5 were found"));
}

TEST_F(SdfTest, AMendedModelFindsItsMeshes) {
    writeModel("bad", "<model name='bad'><link name='l'><inertial>" + pose("1 2 3") + "</inertial>" +
                          visual("v", "<mesh><uri>meshes/plate.obj</uri></mesh>") +
                          visual("w", "<mesh><uri>model://bad/meshes/plate.obj</uri></mesh>", pose("0 0 9 0 0 0")) +
                          "</link></model>");
    write("bad/meshes/plate.obj", "v 0 0 0\nv 1 0 0\nv 1 2 3\nf 1 2 3\n");
    const Scene scene = world("<include><uri>model://bad</uri></include>");
    expectBounds(getBounds(*scene.geometry), {0, 0, 0}, {1, 2, 12});
}

TEST_F(SdfTest, ConesAreReadThoughTheyAreNewerThanTheLibrary) {
    const Scene scene = world(model("m", "<cone><radius>2</radius><length>6</length></cone>"));
    expectBounds(getBounds(*scene.geometry), {-2, -2, -3}, {2, 2, 3}, 1e-5);
    EXPECT_NEAR(computeVolume(*scene.geometry), 3.14159 * 4 * 6 / 3, 0.1);
    EXPECT_TRUE(hasNotice(*world(model("m", "<polyline><height>1</height><point>0 0</point></polyline>")).geometry,
                          "its geometry, <polyline>, is not supported"));
}

TEST_F(SdfTest, AMissingSunIsNoNotice) {
    const Scene scene = world("<include><uri>model://sun</uri></include>\n" + model("m", box_));
    EXPECT_FALSE(hasNotice(*scene.geometry, "sun"));
    EXPECT_FALSE(hasNotice(*scene.geometry, "INSONIFY_MODEL_PATH"));
}

TEST_F(SdfTest, AnIncludeInAnIncludeThatIsNotFoundIsANoticeToo) {
    writeModel("outer", "<model name='outer'>" + link("l") + "<include><uri>model://nowhere</uri></include></model>");
    const Scene scene = world("<include><uri>model://outer</uri></include>");
    EXPECT_TRUE(hasNotice(*scene.geometry, "outer/model.sdf:1: ")) << scene.geometry->notices.at(0).text;
    EXPECT_TRUE(hasNotice(*scene.geometry, "Unable to find uri[model://nowhere]; omitted"));
}

TEST_F(SdfTest, OmitsAnUnreadableIncludeWithTheReason) {
    writeModel("bad", "<model name='bad'>" + pose("1 2 east") + link("l") + "</model>");
    writeModel("good", model("good", box_));
    const Scene scene = world("<include><uri>model://bad</uri></include><include><uri>model://good</uri></include>");
    EXPECT_GE(findNode(scene, "good"), 0);
    EXPECT_LT(findNode(scene, "bad"), 0);
    EXPECT_TRUE(hasNotice(*scene.geometry, "1 2 east"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "bad/model.sdf:1: bad.pose: is "));
    EXPECT_TRUE(hasNotice(*scene.geometry, "bad/model.sdf]; omitted"));
}

TEST_F(SdfTest, LibsdformatPrintsNothing) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    world("<include><uri>model://sun</uri></include>");
    diagnosticOfWorld("<model name='m'>" + pose("1 2 x") + "</model>");
    findDiagnostic(write("urdf.sdf", "<html/>"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace insonify::sdf
