// Invalid SDF: a ConfigError with the place, or a scene with notices; never a crash.
#include <random>

#include "tests/sdf/SdfFiles.hpp"

namespace insonify::sdf {

using namespace scene;
namespace {

struct SdfBadInputTest : SdfFiles {
    void expectDiagnostic(const std::string& diagnostic, const std::string& part) const {
        EXPECT_NE(diagnostic.find(part), std::string::npos) << diagnostic;
        EXPECT_NE(diagnostic.find(folder_.string()), std::string::npos) << diagnostic;
        EXPECT_EQ(std::ranges::count(diagnostic, '\n'), 0) << diagnostic;
    }
};

TEST_F(SdfBadInputTest, ReportsFilesThatAreNotSdf) {
    std::filesystem::create_directory(folder_ / "folder.world");
    expectDiagnostic(findDiagnostic(folder_ / "missing.world"), "does not exist; looked for at ");
    expectDiagnostic(findDiagnostic(folder_ / "folder.world"), "is not a file");
    expectDiagnostic(findDiagnostic(write("empty.sdf", "")), "is no XML: it is empty");
    expectDiagnostic(findDiagnostic(write("cut.sdf", "<sdf version='1.9'>\n<world name='w'>\n<model")),
                     "cut.sdf:3: is no XML: a tag is not finished (<model>)");
    for (const char* const name : {"wide.sdf", "wide.urdf"})
        expectDiagnostic(findDiagnostic(write(name, std::string("\xff\xfe<\0s\0d\0f\0", 10))), "is text in UTF-16");
    expectDiagnostic(findDiagnostic(write("page.world", "<html><body>404</body></html>")),
                     "holds neither a world nor a model");
    expectDiagnostic(findDiagnostic(write("none.world", "<sdf version='1.9'/>")), "holds neither a world nor a model");
    expectDiagnostic(findDiagnostic(write("noise.world", toBytes<uint64_t>({~0ull, 0x1234567890abcdef}))),
                     "is no XML: ");
}

TEST_F(SdfBadInputTest, ReportsAnUnreadableValueWithItsLineAndReason) {
    expectDiagnostic(diagnosticOfWorld("<model name='m'>\n" + pose("1 2 x 0 0 0") + "<link name='l'/></model>"),
                     "case.world:3: m.pose: is \"1 2 x 0 0 0\": x is no finite number; must be numbers");
    // Commas behind the numbers of a pose, and texts that are no numbers, are read as before.
    EXPECT_EQ(diagnosticOfWorld("<model name='m'>" + pose("1, 2, 3, 0, 0, 0") + "<link name='l'/></model>"), "");
    EXPECT_EQ(diagnosticOfWorld(model("m", "<box><size>1 2 3</size><my:size>large</my:size></box>")), "");
    EXPECT_EQ(diagnosticOfWorld(model("m",
                                      "<heightmap><uri>h.png</uri><texture><size>1</size><normal>flat.png</normal>"
                                      "</texture></heightmap>"))
                  .find("finite"),
              std::string::npos);
    // libsdformat reads 0 of it.
    for (const char* const shape : {"<sphere><radius>0,5</radius></sphere>", "<box><size>1 2,5 3</size></box>",
                                    "<cylinder><radius>1m</radius><length>2</length></cylinder>",
                                    "<polyline><point>0,5 1</point><height>1</height></polyline>",
                                    "<polyline><point>0 1</point><height>1,5</height></polyline>",
                                    "<heightmap><uri>h.png</uri><sampling>two</sampling></heightmap>"})
        expectDiagnostic(diagnosticOfWorld("\n" + model("m", shape)), "is no finite number; must be numbers");
    expectDiagnostic(diagnosticOfWorld("\n" + model("m", "<sphere><radius>0,5</radius></sphere>")),
                     "case.world:3: m::hull::skin.radius: is \"0,5\"");
    expectDiagnostic(diagnosticOfWorld("<model name='m'>" + pose("nan 0 0 0 0 0") + "<link name='l'/></model>"),
                     "nan is no finite number");
    expectDiagnostic(diagnosticOfWorld("<model><link name='l'/></model>"), "Required attribute[name]");
    expectDiagnostic(diagnosticOfWorld("\n" + model("m", "<sphere><radius>-3</radius></sphere>")),
                     "case.world:3: m::hull::skin.radius: is -3; must not be negative");
}

TEST_F(SdfBadInputTest, ReportsEveryUnresolvedPose) {
    const std::string diagnostic = diagnosticOfWorld(
        "<model name='a'><pose relative_to='b'>1 0 0 0 0 0</pose><link name='l'/></model>"
        "<model name='b'><pose relative_to='a'>1 0 0 0 0 0</pose><link name='l'/></model>");
    EXPECT_NE(diagnostic.find("a.pose: relative to \"b\" cannot be resolved: PoseRelativeToGraph cycle"),
              std::string::npos);
    EXPECT_NE(diagnostic.find("b.pose: relative to \"a\" cannot be resolved"), std::string::npos) << diagnostic;
}

TEST_F(SdfBadInputTest, ABadJointOmitsOnlyTheJoint) {
    const Scene scene = world("<model name='m'><link name='l'>" + visual("v", box_) +
                              "</link><joint name='j' type='revolute'><parent>nowhere</parent><child>l</child><axis>"
                              "<xyz>0 0 0</xyz></axis></joint></model>");
    EXPECT_EQ(scene.geometry->objects.size(), 1u);
    EXPECT_TRUE(hasNotice(*scene.geometry, "parent frame with name[nowhere]"));
}

TEST_F(SdfBadInputTest, ADamagedMeshOmitsOnlyItsVisual) {
    write("noise.stl", "solid of nothing");
    const Scene scene = world(model("m", "<mesh><uri>noise.stl</uri></mesh>") + model("n", box_));
    EXPECT_EQ(scene.geometry->objects.size(), 1u);
    EXPECT_TRUE(hasNotice(*scene.geometry, "noise.stl"));
}

TEST_F(SdfBadInputTest, AModelThatIncludesItselfIsRefused) {
    writeModel("a", "<model name='a'><link name='l'/><include><uri>model://b</uri></include></model>");
    writeModel("b", "<model name='b'><link name='l'/><include><uri>model://a</uri></include></model>");
    expectDiagnostic(diagnosticOfWorld("<include><uri>model://a</uri></include>"), "a model may not include itself");
    writeModel("b", "<model name='b'><link name='l'/><!-- <include><uri>model://a</uri></include> --></model>");
    EXPECT_EQ(diagnosticOfWorld("<include><uri>model://a</uri></include>"), "");
}

TEST_F(SdfBadInputTest, CommentsCostNextToNothing) {
    std::string comments;
    for (int i = 0; i < 200'000; ++i)
        comments += "<!-- a comment that is as long as those of people who explain much -->\n";
    EXPECT_EQ(diagnosticOfWorld(comments + model("m", box_)), "");
}

TEST_F(SdfBadInputTest, BoundsTheTimeToReadAFile) {
    std::string models, links, attributes;
    for (int i = 0; i < 15'000; ++i) {
        const std::string number = std::to_string(i);
        models += model("m" + number, box_);
        links += "<link name='l" + number + "'/>";
        attributes += " a" + number + "='1'";
    }
    const std::string part = "would take minutes to read: with what it includes it may hold up to 100000 elements";
    expectDiagnostic(diagnosticOfWorld(models), part);
    expectDiagnostic(diagnosticOfWorld("<model name='m'>" + links + "</model>"), part);
    expectDiagnostic(diagnosticOfWorld("<model name='m'" + attributes + "><link name='l'/></model>"), part);
}

TEST_F(SdfBadInputTest, ModelsThatIncludeEachOtherTwiceAreBoundedAsWell) {
    const auto including = [](const std::string& name, int times) {
        std::string includes;
        for (int i = 0; i < times; ++i)
            includes += "<include><uri>model://" + name + "</uri><name>n" + std::to_string(i) + "</name></include>";
        return includes;
    };
    writeModel("m0", model("m0", box_));
    for (int i = 1; i <= 40; ++i)
        writeModel("m" + std::to_string(i),
                   "<model name='m'><link name='l'/>" + including("m" + std::to_string(i - 1), 2) + "</model>");
    EXPECT_EQ(diagnosticOfWorld(including("m2", 2)), "");
    expectDiagnostic(diagnosticOfWorld(including("m40", 1)), "would take minutes to read");
    writeModel("m0", "<model name='m'><link name='l'/>" + including("m99", 1) + "</model>");
    for (int i = 41; i <= 99; ++i)
        writeModel("m" + std::to_string(i),
                   "<model name='m'><link name='l'/>" + including("m" + std::to_string(i + 1), 1) + "</model>");
    expectDiagnostic(diagnosticOfWorld(including("m41", 1)), "models include each other 51 deep; may be up to 50");
}

TEST_F(SdfBadInputTest, DeepNestingEndsInASceneOrAnError) {
    for (const int depth : {30, 450, 100'000}) {
        std::string body = "<link name='l'/>";
        std::string open, close;
        for (int i = 0; i < depth; ++i) {
            open += "<model name='m'><link name='l'/>";
            close += "</model>";
        }
        const std::string diagnostic = diagnosticOfWorld(open + close);
        EXPECT_EQ(diagnostic.empty(), depth < 100) << depth << ": " << diagnostic;
    }
}

TEST_F(SdfBadInputTest, EveryTruncationAndDamageIsASceneOrAnError) {
    writeModel("inner", model("inner", box_));
    const std::string whole =
        "<sdf version='1.7'><world name='w'><frame name='f'>" + pose("1 2 3 0 0 1") +
        "</frame><include><uri>model://inner</uri>" + pose("1 0 0 0 0 0") +
        "</include><model name='m'><pose relative_to='f'>1 0 0 0 0 0</pose><link name='l'>" +
        visual("v", "<cylinder><radius>1</radius><length>2</length></cylinder>",
               "<insonify:acoustics><sediment>clay</sediment></insonify:acoustics>") +
        "</link><link name='k'/><joint name='j' type='revolute'><parent>l</parent><child>k</child>"
        "<axis><xyz>0 0 1</xyz></axis></joint></model></world></sdf>";
    ASSERT_EQ(findDiagnostic(write("whole.world", whole)), "");
    std::minstd_rand random(3);
    size_t scenes = 0, diagnostics = 0;
    for (int i = 0; i < 100; ++i) {
        std::string bytes = whole;
        bytes[random() % bytes.size()] = static_cast<char>(random() % 96 + 32);
        if (i % 10 == 0) bytes.resize(random() % bytes.size());
        const auto file = write("damaged.world", bytes);
        try {
            expectSound(*loadScene(file));
            ++scenes;
        } catch (const types::ConfigError& error) {
            EXPECT_FALSE(error.diagnostics().empty()) << bytes;
            for (const char* raw : {"std::", "stoi", "_M_", "basic_string", "XML_ERROR", "libsdformat"})
                EXPECT_EQ(std::string(error.what()).find(raw), std::string::npos) << error.what();
            ++diagnostics;
        }
    }
    EXPECT_GE(scenes, 5u);
    EXPECT_GE(diagnostics, 5u);
}

}  // namespace
}  // namespace insonify::sdf
