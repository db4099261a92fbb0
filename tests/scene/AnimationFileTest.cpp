// Animations, skins and morph targets of files: what they move, and what is refused.
#include "components/scene/Placement.hpp"
#include "components/scene/motion/Animator.hpp"
#include "tests/scene/AnimatedFiles.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::scene {
namespace {

struct AnimationFileTest : SceneFiles {
    Scene read(const std::string& rest) const { return readScene(write("case.gltf", gltf(rest))); }
    /** The scene at a time, with every animation playing. */
    static types::Snapshot at(const std::shared_ptr<const Scene>& scene, double seconds,
                              const AnimationConfigs& configs = {}, const std::vector<DrivenNode>& driven = {}) {
        types::Diagnostics diagnostics;
        std::vector<int> nodes;
        for (const DrivenNode& one : driven) nodes.push_back(one.node);
        Animator animator(scene, configs, nodes, diagnostics);
        EXPECT_TRUE(diagnostics.empty());
        animator.take(seconds, driven);
        types::Snapshot snapshot;
        snapshot.geometry = scene->geometry;
        animator.addMoved(snapshot.moved);
        animator.addDeformed(snapshot);
        return snapshot;
    }
    std::shared_ptr<const Scene> shared(const std::string& rest) const {
        return std::make_shared<const Scene>(read(rest));
    }
};

const Tube tube(9, 8, 0.1f);

/** Replaces the first occurrence. */
std::string with(std::string text, const std::string& from, const std::string& to) {
    const size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

TEST_F(AnimationFileTest, ANodeMovesByItsKeys) {
    const auto scene = shared(eelText(tube));
    const types::Snapshot snapshot = at(scene, 0.5);
    ASSERT_EQ(snapshot.moved.size(), 1u);
    const glm::dmat4& place = snapshot.moved[0].world_from_object;
    EXPECT_LT(glm::distance(glm::dvec3(place[3]), glm::dvec3(0.25, 0, 0.0625)), 1e-12);  // y of the file is z
    EXPECT_LT(glm::distance(glm::dvec3((*snapshot.moved[0].rate)[3]), glm::dvec3(0.5, 0, 0.125)), 1e-12);
}

/** glTF 2.0, 3.7.3.3: the sum of weight * (place of the joint * inverse bind matrix) over joints, by hand. */
TEST_F(AnimationFileTest, ASkinFollowsItsJoints) {
    const auto scene = shared(eelText(tube));
    const types::Snapshot snapshot = at(scene, 0.25);
    ASSERT_EQ(snapshot.deformed.size(), 1u);
    const types::GeometryPtr posed = types::posedGeometry(snapshot);
    const types::Mesh& mesh = posed->meshes[static_cast<size_t>(posed->objects[0].mesh)];
    const types::Mesh& rest = scene->geometry->meshes[static_cast<size_t>(scene->geometry->objects[0].mesh)];
    NodeShape bent;
    bent.rotation = glm::normalize(glm::dquat(double{0.953939f}, 0, double{0.3f}, 0));
    bent.translation = {0.5, 0, 0};
    const glm::dmat4 first = bent.matrix(), second = first * bent.matrix();
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 p(rest.positions[i]);
        const double share = std::clamp(2 * p.x, 0.0, 2.0);
        const auto about = [&](const glm::dmat4& joint, double x) {
            return glm::dvec3(joint * glm::dvec4(p - glm::dvec3(x, 0, 0), 1));
        };
        const glm::dvec3 expected = share <= 1 ? (1 - share) * p + share * about(first, 0.5)
                                               : (2 - share) * about(first, 0.5) + (share - 1) * about(second, 1);
        EXPECT_LT(glm::distance(glm::dvec3(mesh.positions[i]), expected), 2e-7) << i;
    }
    expectSoundMesh(mesh, posed->materials.size());
}

TEST_F(AnimationFileTest, MorphTargetsAddUpByWeight) {
    const auto scene = shared(kelpText(tube));
    const types::Mesh& rest = scene->geometry->meshes[0];
    for (size_t i = 0; i < rest.positions.size(); ++i) {  // at the default weights of the file, 0.25 and 0
        const glm::vec3 base = rest.deformation->positions[i];
        EXPECT_NEAR(rest.positions[i].y, base.y + 0.1f * base.x * base.x, 1e-6);
    }
    const types::Snapshot snapshot = at(scene, 0.5);  // weights 0.5 and 0.25
    ASSERT_EQ(snapshot.deformed.size(), 1u);
    EXPECT_TRUE(snapshot.moved.empty());
    const types::GeometryPtr posed = types::posedGeometry(snapshot);
    const types::Mesh& mesh = posed->meshes[1];
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 base = rest.deformation->positions[i];
        EXPECT_NEAR(mesh.positions[i].x, base.x - 0.025f * base.x, 1e-6);
        EXPECT_NEAR(mesh.positions[i].y, base.y + 0.2f * base.x * base.x, 1e-6);
        EXPECT_NEAR(mesh.positions[i].z, base.z + 0.075f * base.x * base.x * base.x, 1e-6);
    }
}

TEST_F(AnimationFileTest, AnimationsPlayInALoopUnlessConfiguredOtherwise) {
    const auto scene = shared(eelText(tube));
    const auto placeAt = [&](double seconds, const AnimationConfig& config) {
        const auto snapshot = at(scene, seconds, {{"advance", config}});
        return snapshot.moved.empty() ? -1 : snapshot.moved[0].world_from_object[3].x;
    };
    EXPECT_NEAR(placeAt(2.5, {}), 0.25, 1e-12);
    EXPECT_NEAR(placeAt(2.5, {.loop = false}), 1, 1e-12);
    EXPECT_NEAR(placeAt(0.5, {.start_s = 0.5}), 0.5, 1e-12);
    EXPECT_NEAR(placeAt(0.25, {.speed = 2}), 0.25, 1e-12);
    EXPECT_NEAR(placeAt(0.5, {.speed = -1}), 0.75, 1e-12);
    EXPECT_EQ(placeAt(0.5, {.play = false}), -1);
}

TEST_F(AnimationFileTest, APortMovesANodeInPlaceOfItsAnimation) {
    const auto scene = shared(eelText(tube));
    DrivenNode eel{.node = findNode(*scene, "eel")};
    eel.world_from_node = glm::dmat4(2);
    (*eel.world_from_node)[3] = {7, 8, 9, 1};
    const types::Snapshot snapshot = at(scene, 0.25, {}, {eel});
    EXPECT_TRUE(snapshot.moved.empty());  // the task moves it, as any other node
    ASSERT_EQ(snapshot.deformed.size(), 1u);
    const types::Snapshot free = at(scene, 0.25);
    for (size_t i = 0; i < free.joints.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_LT(glm::distance(free.joints[i].mesh_from_bind[c], snapshot.joints[i].mesh_from_bind[c]), 1e-12);
}

TEST_F(AnimationFileTest, AJointThatAPortMovesDeformsTheSkin) {
    const auto scene = shared(eelText(tube));
    DrivenNode joint{.node = findNode(*scene, "joint_2")};
    joint.world_from_node = glm::dmat4(1);
    (*joint.world_from_node)[3] = {1, 1, 0, 1};
    const types::Snapshot still = at(scene, 0, {{"*", {.play = false}}}),
                          moved = at(scene, 0, {{"*", {.play = false}}}, {joint});
    EXPECT_TRUE(still.deformed.empty());
    ASSERT_EQ(moved.deformed.size(), 1u);
    EXPECT_GT(glm::distance(moved.joints[2].mesh_from_bind[3], glm::dvec3(-1, 0, 0)), 0.5);
}

TEST_F(AnimationFileTest, VelocitiesAreThoseOfDifferences) {
    const double step = 1e-3;
    for (const std::string& text : {eelText(tube), kelpText(tube)}) {
        const auto scene = shared(text);
        for (const double time : {0.1, 0.4, 0.6, 0.9, 1.3}) {
            const auto placesAt = [&](double seconds) {
                const types::Snapshot snapshot = at(scene, seconds);
                types::Geometry posed = *types::posedGeometry(snapshot);
                for (const auto& moved : snapshot.moved)
                    posed.objects[moved.object].world_from_object = moved.world_from_object;
                std::vector<glm::dvec3> places;
                for (const glm::vec3& p : posed.meshes[static_cast<size_t>(posed.objects[0].mesh)].positions)
                    places.emplace_back(posed.objects[0].world_from_object * glm::dvec4(p, 1));
                return places;
            };
            const auto before = placesAt(time - step), after = placesAt(time + step);
            const types::Snapshot now = at(scene, time);
            std::vector<glm::vec3> velocities;
            const auto& mesh = scene->geometry->meshes[static_cast<size_t>(scene->geometry->objects[0].mesh)];
            types::computeVelocities(types::getPose(now, now.deformed[0], *mesh.deformation), *mesh.deformation,
                                     velocities);
            const auto posed = types::posedGeometry(now);
            const glm::dmat4 place =
                now.moved.empty() ? posed->objects[0].world_from_object : now.moved[0].world_from_object;
            const glm::dmat4 rate = now.moved.empty() ? glm::dmat4(0) : *now.moved[0].rate;
            for (size_t i = 0; i < velocities.size(); ++i) {
                const glm::dvec3 p(posed->meshes[static_cast<size_t>(posed->objects[0].mesh)].positions[i]);
                const glm::dvec3 velocity(rate * glm::dvec4(p, 1) + place * glm::dvec4(velocities[i], 0));
                EXPECT_LT(glm::distance(velocity, (after[i] - before[i]) / (2 * step)), 3e-3) << time << " " << i;
            }
        }
    }
}

TEST_F(AnimationFileTest, APlacedAndScaledSceneMovesAlike) {
    const Scene scene = read(eelText(tube));
    types::Diagnostics diagnostics;
    const auto changed = std::make_shared<const Scene>(
        scaled(placed(scene, {.position = {10, 0, 0}, .yaw_deg = 90}), {{"eel", 2}}, diagnostics));
    const types::Snapshot snapshot = at(changed, 0.5);
    ASSERT_EQ(snapshot.moved.size(), 1u);
    const glm::dmat4& place = snapshot.moved[0].world_from_object;
    EXPECT_LT(glm::distance(glm::dvec3(place[3]), glm::dvec3(10, 0.25, 0.0625)), 1e-12);
    EXPECT_NEAR(glm::length(place[0]), 2, 1e-12);
    const types::Snapshot plain = at(std::make_shared<const Scene>(scene), 0.5);
    for (size_t i = 0; i < plain.joints.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_LT(glm::distance(plain.joints[i].mesh_from_bind[c], snapshot.joints[i].mesh_from_bind[c]), 1e-12);
}

TEST_F(AnimationFileTest, TwoAnimationsThatMoveTheSameAreReported) {
    const std::string second = R"(],"animations":[{"name":"rests","samplers":[{"input":7,"output":8}],
        "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]},)";
    const std::string text = with(eelText(tube), R"(],
        "animations":[)",
                                  second);
    const auto scene = shared(text);
    types::Diagnostics diagnostics;
    const Animator animator(scene, {}, {}, diagnostics);
    ASSERT_EQ(animator.notices().size(), 2u);
    EXPECT_NE(animator.notices()[1].text.find("advance (1 of 1 channels)"), std::string::npos)
        << animator.notices()[1].text;
    Animator(scene, {{"swims", {}}}, {}, diagnostics);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].path, "animations.swims");
}

TEST_F(AnimationFileTest, AStillSceneHasNoAnimations) {
    EXPECT_EQ(read(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" + triangle())
                  .animations,
              nullptr);
}

struct BadFile {
    const char* name;
    const char *from, *to;  ///< A part of eelText() and its replacement.
    const char* diagnostic;
};
class BadAnimationTest : public AnimationFileTest, public ::testing::WithParamInterface<BadFile> {};

TEST_P(BadAnimationTest, IsRefusedWithItsPlace) {
    const auto& [name, from, to, diagnostic] = GetParam();
    const std::string said = diagnosticOfGltf(with(eelText(tube), from, to));
    EXPECT_NE(said.find(diagnostic), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadAnimationTest,
    ::testing::Values(
        BadFile{"sampler", R"("sampler":0,"target":{"node":3)", R"("sampler":7,"target":{"node":3)",
                "animations[0].channels[0].sampler: is 7; the animation has 1 samplers"},
        BadFile{"node", R"("target":{"node":3)", R"("target":{"node":99)",
                "animations[0].channels[0].target.node: is 99; the file has 5 nodes"},
        BadFile{"interpolation", R"("samplers":[{)", R"("samplers":[{"interpolation":"BEZIER",)",
                "animations[0].samplers[0].interpolation: is \"BEZIER\"; may be LINEAR, STEP or CUBICSPLINE"},
        BadFile{"counts", R"("samplers":[{)", R"("samplers":[{"interpolation":"CUBICSPLINE",)",
                "animations[0].samplers[0].output: has 4 elements; 4 keys of 3 values need 12"},
        BadFile{"input", R"("input":5)", R"("input":99)", "accessors[99]: does not exist"},
        BadFile{"type", R"("input":5)", R"("input":0)",
                "accessors[0].type: is not the one needed here; must be SCALAR"},
        BadFile{"component", R"("input":5)", R"("input":1)",
                "animations[0].samplers[0].input: is not of componentType 5126"},
        BadFile{"weights", R"("node":3,"path":"rotation")", R"("node":3,"path":"weights")",
                "animations[0].channels[0].target.path: is weights; nodes[3] has no mesh with morph targets"},
        BadFile{"matrix", R"("name":"joint_1","translation":[0.5,0,0])",
                R"("name":"joint_1","matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0.5,0,0,1])",
                "animations[0].channels[0].target.node: is nodes[3], which has a matrix"},
        BadFile{"skin", R"("mesh":0,"skin":0)", R"("mesh":0,"skin":4)", "nodes[1].skin: is 4; the file has 1 skins"},
        BadFile{"joint", R"("joints":[2,3,4])", R"("joints":[2,3,99])",
                "skins[0].joints[2]: is 99; the file has 5 nodes"},
        BadFile{"few_joints", R"("joints":[2,3,4])", R"("joints":[2,3])",
                "meshes[0].primitives[0].attributes.JOINTS_0: is 2 at vertex"},
        BadFile{"matrices", R"("joints":[2,3,4])", R"("joints":[2,3,4,0])",
                "skins[0].inverseBindMatrices: are 3; the skin has 4 joints, and may have 65536"},
        BadFile{"no_weights", R"(,"WEIGHTS_0":3)", "", "meshes[0].primitives[0].attributes: has no WEIGHTS_0"},
        BadFile{"no_joints", R"(,"JOINTS_0":2,"WEIGHTS_0":3)", "", "has no JOINTS_0 and no WEIGHTS_0"},
        BadFile{"joint_type", R"("JOINTS_0":2)", R"("JOINTS_0":3)",
                "JOINTS_0: has componentType 5126; must be 5121 or 5123"},
        BadFile{"outside", R"("name":"joint_0","children":[3])", R"("name":"joint_0")",
                "skins[0].joints[1]: is nodes[3], which is not in the scene"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST_F(AnimationFileTest, TimesMustIncrease) {
    const auto diagnosticOfTimes = [&](const std::vector<float>& times) {
        Arrays arrays;
        const int positions = arrays.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}),
                  input = arrays.floats("SCALAR", times),
                  output = arrays.floats("VEC3", std::vector<float>(3 * times.size(), 1.0f));
        return diagnosticOfGltf(
            fmt::format(
                R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}}}}]}}],
            "animations":[{{"samplers":[{{"input":{},"output":{}}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"scale"}}}}]}}],)",
                positions, input, output) +
            arrays.text());
    };
    EXPECT_EQ(diagnosticOfTimes({0, 1, 2}), "");
    const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    EXPECT_TRUE(
        has(diagnosticOfTimes({0, 1, 1}), "input: is 1 s at key 2, and 1 s at the key before; times must increase"));
    EXPECT_TRUE(has(diagnosticOfTimes({0, NAN, 1}), "input: is nan s at key 1; must be 0 or more"));
    EXPECT_TRUE(has(diagnosticOfTimes({-1, 0, 1}), "input: is -1 s at key 0; must be 0 or more"));
    EXPECT_TRUE(has(diagnosticOfTimes({}), "input: has no times"));
}

TEST_F(AnimationFileTest, BadMorphTargetsAreRefused) {
    const auto has = [&](const std::string& from, const std::string& to, const std::string& part) {
        const std::string said = diagnosticOfGltf(with(kelpText(tube), from, to));
        EXPECT_NE(said.find(part), std::string::npos) << said;
    };
    has(R"("weights":[0.25,0])", R"("weights":[0.25])",
        "meshes[0].weights: has 1 numbers; the mesh has 2 morph targets");
    has(R"({"POSITION":2})", R"({"POSITION":4})", "accessors[4].type");
    has(R"("name":"kelp")", R"("name":"kelp","weights":[1,2,3])", "nodes[0].weights: has 3 numbers; the mesh has 2");
    has(R"("output":5)", R"("output":4)",
        "animations[0].samplers[0].output: has 3 elements; 3 keys of 1 values need 6");
    has(R"(,{"POSITION":3}])", R"(,{"POSITION":1}])", "accessors[1].type");
}

TEST_F(AnimationFileTest, NumbersThatAreNotFiniteAreRefused) {
    Tube broken = tube;
    broken.positions[4] =
        NAN;  // of the mesh: its triangles are dropped, as ever; of targets and weights it is an error
    const std::string said = diagnosticOfGltf(kelpText(broken));
    EXPECT_EQ(said, "");
    broken = tube;
    broken.positions[0] = NAN;
    const std::string of_target = diagnosticOfGltf(kelpText(broken));
    EXPECT_NE(of_target.find("meshes[0].primitives[0].targets[0].POSITION: is not a finite number at vertex 0"),
              std::string::npos)
        << of_target;
}

TEST_F(AnimationFileTest, OtherPathsAreOmittedWithANotice) {
    const auto scene = read(with(eelText(tube), R"("node":3,"path":"rotation")", R"("node":3,"path":"pointer")"));
    EXPECT_TRUE(hasNotice(*scene.geometry, "channels of animations omitted, they animate what is not read: 1"));
}

}  // namespace
}  // namespace insonify::scene
