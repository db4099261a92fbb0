// Robots in URDF: links at their places even without inertia, meshes, names, and other XML.
#include <gmock/gmock.h>

#include <glm/gtc/constants.hpp>
#include <map>

#include "tests/sdf/SdfFiles.hpp"

namespace insonify::sdf {
namespace {

using testing::HasSubstr;

struct UrdfTest : SdfFiles {
    std::filesystem::path robot(const std::string& body) const {
        return write("arm.urdf", "<?xml version='1.0'?>\n<robot name='rov'>\n" + body + "</robot>");
    }
    static std::string link(const std::string& name, const std::string& geometry, const std::string& origin = "",
                            const std::string& more = "") {
        return "<link name='" + name + "'><visual>" + (origin.empty() ? "" : "<origin " + origin + "/>") +
               "<geometry>" + geometry + "</geometry>" + more + "</visual></link>\n";
    }
    static std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                             const std::string& child, const std::string& origin) {
        return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
               "'/><origin " + origin + "/>" +
               (type == "fixed" ? "" : "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>") +
               "</joint>\n";
    }
    static const types::Object& getObject(const Scene& scene, const std::string& node) {
        const int index = findNode(scene, node);
        for (size_t i = 0; i < scene.object_nodes.size(); ++i)
            if (scene.object_nodes[i] == index) return scene.geometry->objects[i];
        throw std::runtime_error("there is no object of " + node);
    }

    const std::string small_ = "<box size='0.2 0.4 0.6'/>";
};

TEST_F(UrdfTest, KeepsLinksWithoutInertiaAtTheirPlaces) {
    const Scene scene =
        readScene(robot(link("base", small_) + link("upper", "<cylinder radius='0.1' length='1'/>", "xyz='0 0 0.5'") +
                        link("camera", "<sphere radius='0.05'/>") +
                        joint("elbow", "revolute", "base", "upper", "xyz='1 0 0' rpy='0 1.5707963268 0'") +
                        joint("bolt", "fixed", "upper", "camera", "xyz='0 0 1'")));
    ASSERT_EQ(scene.geometry->objects.size(), 3u);
    for (const char* const name : {"rov", "rov::base", "rov::upper", "rov::camera"})
        EXPECT_GE(findNode(scene, name), 0) << name;
    expectBounds(getBounds(*scene.geometry, getObject(scene, "rov::base")), {-0.1, -0.2, -0.3}, {0.1, 0.2, 0.3});
    // Turned by 90 degrees about y, its length along x; the fixed camera is at its end.
    expectBounds(getBounds(*scene.geometry, getObject(scene, "rov::upper")), {1, -0.1, -0.1}, {2, 0.1, 0.1}, 2e-3);
    expectBounds(getBounds(*scene.geometry, getObject(scene, "rov::camera")), {1.95, -0.05, -0.05}, {2.05, 0.05, 0.05},
                 2e-3);
    EXPECT_EQ(scene.nodes[static_cast<size_t>(findNode(scene, "rov::camera"))].parent, findNode(scene, "rov::upper"))
        << "what moves the upper arm moves the camera";
}

TEST_F(UrdfTest, SeveralVisualsHaveTheMaterialsThatTheyName) {
    const Scene scene = readScene(robot("<link name='base'><visual><geometry>" + small_ +
                                        "</geometry><material name='steel'><color rgba='1 1 1 1'/></material></visual>"
                                        "<visual><origin xyz='0 0 2'/><geometry>" +
                                        small_ +
                                        "</geometry><material name='rubber'/></visual></link>"
                                        "<material name='rubber'><color rgba='0 0 0 1'/></material>"));
    ASSERT_EQ(scene.geometry->objects.size(), 2u);
    for (const types::Object& object : scene.geometry->objects) {
        const bool is_upper = getBounds(*scene.geometry, object).low.z > 1;
        const types::Mesh& mesh = scene.geometry->meshes[static_cast<size_t>(object.mesh)];
        EXPECT_EQ(scene.geometry->materials[static_cast<size_t>(mesh.clusters[0].material)].name,
                  is_upper ? "rubber" : "steel");
    }
}

TEST_F(UrdfTest, MeshesAreFoundByPackageAndByPath) {
    std::filesystem::create_directories(folder_ / "rov_description/meshes");
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 2 0\nendloop\nendfacet\n";
    write("rov_description/meshes/fin.stl", "solid fin\n" + facet + "endsolid fin\n");
    write("fin.stl", "solid fin\n" + facet + "endsolid fin\n");
    for (const char* const name : {"package://rov_description/meshes/fin.stl", "fin.stl"}) {
        const Scene scene =
            readScene(robot(link("base", "<mesh filename='" + std::string(name) + "' scale='0.5 0.5 0.5'/>")));
        ASSERT_EQ(scene.geometry->objects.size(), 1u)
            << name << ": " << testing::PrintToString(types::lines(scene.geometry->notices));
        expectBounds(getBounds(*scene.geometry), {0, 0, 0}, {1, 1, 0});
    }
    const Scene without = readScene(robot(link("base", "<mesh filename='package://absent/fin.stl'/>")));
    EXPECT_TRUE(without.geometry->objects.empty());
    EXPECT_THAT(without.geometry->notices, testing::Contains(HasSubstr("absent/fin.stl")));
}

TEST_F(UrdfTest, RefusesOtherXmlAtItsLine) {
    EXPECT_THAT(findDiagnostic(write("cut.urdf", "<robot name='r'>\n<link name='a'>\n</robot>")),
                testing::AllOf(HasSubstr("cut.urdf:2"), HasSubstr("is no XML (XML_ERROR_MISMATCHED_ELEMENT)")));
    EXPECT_THAT(findDiagnostic(write("empty.urdf", "")), HasSubstr("is no XML (XML_ERROR_EMPTY_DOCUMENT)"));
    EXPECT_THAT(findDiagnostic(write("world.urdf", "<sdf version='1.9'/>")), HasSubstr("holds no <robot>"));
    EXPECT_THAT(findDiagnostic(robot("")), HasSubstr("is a robot without links"));
    EXPECT_THAT(findDiagnostic(robot("<xacro:macro name='leg'/>")), HasSubstr("expand it: xacro IN > OUT.urdf"));
    EXPECT_THAT(findDiagnostic(robot(link("a", small_) + joint("j", "fixed", "a", "b", "xyz='0 0 0'"))),
                HasSubstr("arm.urdf"));
    EXPECT_THAT(findDiagnostic(folder_ / "none.urdf"), HasSubstr("does not exist"));
}

TEST_F(UrdfTest, RefusesShapesAndOriginsThatLackNumbers) {
    const std::pair<const char*, const char*> wrong[] = {
        {"<box size='1 1'/>", "box.size: is \"1 1\"; must be 3 numbers, not negative"},
        {"<box/>", "box.size: is missing"},
        {"<box size='1 1 nan'/>", "box.size: is \"1 1 nan\""},
        {"<box size='1 1 1 1'/>", "box.size: is \"1 1 1 1\""},
        {"<cylinder radius='1'/>", "cylinder.length: is missing; must be a number, not negative"},
        {"<cylinder radius='-1' length='2'/>", "cylinder.radius: is \"-1\""},
        {"<sphere radius='1m'/>", "sphere.radius: is \"1m\""},
        {"<mesh scale='1 1 1'/>", "mesh.filename: is missing"},
        {"<mesh filename='a.stl' scale='2'/>", "mesh.scale: is \"2\"; must be 3 numbers"}};
    for (const auto& [shape, message] : wrong)
        EXPECT_THAT(findDiagnostic(robot(link("a", small_) + "\n" + link("b", shape) +
                                         joint("j", "fixed", "a", "b", "xyz='0 0 0'"))),
                    testing::AllOf(HasSubstr("arm.urdf:5: link b.visual."), HasSubstr(message)))
            << shape;
    EXPECT_THAT(
        findDiagnostic(robot("<link name='a'><visual><origin xyz='1 2'/><geometry><sphere radius='+1'/></geometry>"
                             "</visual></link>")),
        HasSubstr("link a.visual.origin.xyz: is \"1 2\"; must be 3 numbers"));
}

TEST_F(UrdfTest, RefusesJointsThatMakeNoTree) {
    const std::string two = link("a", small_) + link("b", small_), at = "xyz='1 0 0'";
    const std::pair<std::string, const char*> wrong[] = {
        {two, "robot.link: a, b are the children of no joint; only one link may be"},
        {two + joint("j", "fixed", "a", "c", at), "joint j.child.link: is \"c\", which is no link; known: a, b"},
        {two + joint("j", "flying", "a", "b", at), "joint j.type: is \"flying\"; may be fixed, revolute"},
        {two + joint("j", "fixed", "a", "b", "xyz='1 0'"), "joint j.origin.xyz: is \"1 0\"; must be 3 numbers"},
        {two + joint("j", "fixed", "a", "b", at) + joint("k", "fixed", "b", "a", at), "by joints in a circle"},
        {two + link("c", small_) + joint("j", "fixed", "b", "c", at) + joint("k", "fixed", "c", "b", at),
         "robot.joint: carries link b by joints in a circle"},
        {two + joint("j", "fixed", "a", "b", at) + joint("k", "fixed", "a", "b", at), "child of another joint"},
        {two + link("b", small_) + joint("j", "fixed", "a", "b", at), "link b.name: is that of two links"},
        {two + "<joint name='j' type='fixed'><child link='b'/></joint>", "joint j.parent: is missing"},
        {"<link><visual/></link>", "link .name: is missing"}};
    for (const auto& [body, message] : wrong) EXPECT_THAT(findDiagnostic(robot(body)), HasSubstr(message)) << body;
}

TEST_F(UrdfTest, WhatASonarDoesNotNeedMayBeWrong) {
    const std::string odd =
        "<inertial><mass value='x'/></inertial><collision><geometry><box size='1'/></geometry></collision>";
    for (const char* type : {"revolute", "prismatic", "continuous", "floating", "planar", "fixed"}) {
        const Scene scene =
            readScene(robot("<link name='a'>" + odd + "<visual><geometry>" + small_ + "</geometry></visual></link>" +
                            link("b", small_) + "<joint name='j' type='" + type +
                            "'><parent link='a'/><child link='b'/><origin xyz='5 0 0'/><axis xyz='0 0'/>"
                            "<limit lower='x'/><dynamics damping='y'/></joint>"));
        ASSERT_EQ(scene.geometry->objects.size(), 2u) << type;
        EXPECT_NEAR(getObject(scene, "rov::b").world_from_object[3].x, 5, 1e-9) << type;
    }
}

TEST_F(UrdfTest, AShapeThatIsNotKnownIsANoticeAndOthersOfItsLinkStay) {
    const std::string known = "<visual><geometry>" + small_ + "</geometry>";
    for (const char* odd :
         {"<visual><geometry><capsule radius='1' length='2'/></geometry><material name='odd'/></visual>", "<visual/>",
          "<visual><geometry/></visual>"}) {
        const Scene scene = readScene(robot("<link name='a'>" + known + "<material name='rubber'/></visual>" + odd +
                                            known + "<material name='steel'/></visual></link>"));
        ASSERT_EQ(scene.geometry->objects.size(), 2u) << odd;
        std::vector<std::string> names;
        for (const types::Material& material : scene.geometry->materials) names.push_back(material.name);
        EXPECT_THAT(names, testing::UnorderedElementsAre("rubber", "steel")) << odd;
        EXPECT_TRUE(hasNotice(*scene.geometry, "link a.visual.geometry: ")) << odd;
        EXPECT_TRUE(hasNotice(*scene.geometry, "; omitted: may be box, cylinder, sphere or mesh")) << odd;
    }
}

TEST_F(UrdfTest, EachFormOfNumbersMaterialsAndNamesIsRead) {
    for (const char* shape :
         {"<box size='1\t1  1'/>", "<box size=' +1 1\n1 '/>", "<sphere radius='1 '/>", "<box size='1e0 1. .1e1'/>"})
        for (const char* material :
             {"", "<material/>", "<material><color rgba='1 0 0 1'/></material>", "<material name=''/>"}) {
            const Scene scene = readScene(
                robot("<material name='m'/><material name='m'/>" + link("a", shape, "xyz='0\n0  0'", material) +
                      link("b", shape, "", material) + link("c", small_) +
                      joint("b", "fixed", "a", "b", "xyz='5\t0 0'") + joint("b", "fixed", "b", "c", "xyz='0 0 0'")));
            EXPECT_EQ(scene.geometry->objects.size(), 3u) << shape << material;
            EXPECT_NEAR(getObject(scene, "rov::b").world_from_object[3].x, 5, 1e-9) << shape << material;
        }
}

TEST_F(UrdfTest, ManyErrorsAndLinksTakeLittleTime) {
    std::string body;
    for (int i = 0; i < 20000; ++i) {
        const std::string name = std::to_string(i);
        body += "<link name='l" + name + "'/><joint name='j" + name +
                "' type='fixed'><parent link='x'/><child link='l" + name + "'/></joint>";
    }
    EXPECT_LT(findDiagnostic(robot(body)).size(), 20'000u);
}

TEST_F(UrdfTest, AMeshOfAPackageThatIsNotFoundKeepsItsName) {
    const Scene scene = readScene(robot(link("base", "<mesh filename='package://blue/meshes/prop.dae'/>") +
                                        link("arm", "<mesh filename='package://blue/meshes/prop.dae'/>") +
                                        joint("j", "fixed", "base", "arm", "xyz='0 0 0'")));
    EXPECT_TRUE(
        hasNotice(*scene.geometry, "2 visuals are omitted: package://blue/meshes/prop.dae is not found (rov::"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "AMENT_PREFIX_PATH and ROS_PACKAGE_PATH"));
}

TEST_F(UrdfTest, AVisualOfAnInvisibleColourIsAnInvisibleDrawing) {
    const auto coloured = [](const char* alpha) {
        return std::string("<material name='m") + alpha + "'><color rgba='0 0 1 " + alpha + "'/></material>";
    };
    const Scene scene = readScene(robot(
        link("base", small_) + link("ghost", small_, "", coloured("0")) + link("window", small_, "", coloured("0.25")) +
        joint("a", "fixed", "base", "ghost", "xyz='0 0 0'") + joint("b", "fixed", "base", "window", "xyz='0 0 0'")));
    ASSERT_EQ(scene.drawings.size(), 3u);
    std::map<std::string, double> transparency;
    for (size_t i = 0; i < 3; ++i)
        transparency[scene.nodes[static_cast<size_t>(scene.object_nodes[i])].name] = scene.drawings[i].transparency;
    EXPECT_EQ(transparency.at("rov::base"), 0);
    EXPECT_EQ(transparency.at("rov::ghost"), 1);
    EXPECT_NEAR(transparency.at("rov::window"), 0.75, 1e-6);
}

}  // namespace
}  // namespace insonify::sdf
