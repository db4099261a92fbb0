// Skins and morph targets in pings: the same, bit for bit, as of files with the posed meshes; their velocities.
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "components/scene/motion/Animator.hpp"
#include "components/sonar/raster/SurfaceScene.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/sonar/surfaces/DeformedMeshes.hpp"
#include "components/sonar/surfaces/Motion.hpp"
#include "tests/scene/AnimatedFiles.hpp"
#include "tests/sonar/MovingFan.hpp"
#include "tests/support/Deformed.hpp"
#include "tests/support/Scenes.hpp"
#include "tests/support/Sonars.hpp"
#include "tests/support/Surfaces.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::sonar {
namespace {

using test::makePing;
using test::rigid;

SonarConfig eelFan() {
    SonarConfig config =
        test::getSonar({.beams = 40, .width_deg = 60, .height_deg = 40, .bins = 300, .bin = 0.02, .rows = 128});
    config.quality.columns_per_beam = 4;
    config.visibility = Visibility::Cpu;
    return config;
}

/** The same fan, rasterised; summed on the processor, or by compute shaders that cull as well. */
SonarConfig rasterisedFan(Deposit deposit) {
    SonarConfig config = eelFan();
    config.visibility = Visibility::Gl;
    config.device = "software";
    config.deposit = deposit;
    return config;
}

struct TruePing {
    types::Sonar ping;
    types::SonarTruth truth;
};

/** Returns successive pings of one renderer, which rasterises while no other does. */
std::vector<TruePing> truePings(const SonarConfig& config, const std::vector<types::Snapshot>& snapshots) {
    SonarRenderer renderer(config, snapshots.front().geometry);
    std::vector<TruePing> pings(snapshots.size());
    for (size_t i = 0; i < pings.size(); ++i) {
        renderer.setTruth(pings[i].ping, &pings[i].truth);
        renderer.render(snapshots[i], pings[i].ping);
    }
    return pings;
}

void expectSame(const TruePing& one, const TruePing& other) {
    EXPECT_EQ(one.ping.bins, other.ping.bins);
    EXPECT_EQ(one.truth.object, other.truth.object);
    EXPECT_EQ(one.truth.hits, other.truth.hits);
    EXPECT_EQ(one.truth.share, other.truth.share);
}

/** A plate about its origin, all of it on one joint. */
types::GeometryPtr jointedPlate() {
    return test::makeScene({test::jointed(test::quad({0, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}))});
}

struct DeformingMeshTest : scene::SceneFiles {
    std::shared_ptr<const scene::Scene> read(const std::string& rest) const {
        return std::make_shared<const scene::Scene>(scene::readScene(write("case.gltf", gltf(rest))));
    }
    /** The scene at a time, from a sonar that looks along x. */
    static types::Snapshot at(const std::shared_ptr<const scene::Scene>& scene, double seconds,
                              const glm::dvec3& sonar = {-3, 0.1, 0.05}, double yaw = 0.03, double pitch = 0.02) {
        types::Diagnostics none;
        scene::Animator animator(scene, {}, {}, none);
        animator.take(seconds, {});
        types::Snapshot snapshot = test::makeSnapshot(scene->geometry, sonar, yaw, pitch);
        snapshot.time = types::Time::fromSeconds(1 + seconds);
        animator.addMoved(snapshot.moved);
        animator.addDeformed(snapshot);
        return snapshot;
    }
    /** The same from a file without animations or skins, whose meshes are those that the snapshot shows. */
    types::Snapshot byHand(const types::Snapshot& snapshot) const {
        const types::GeometryPtr posed = types::posedGeometry(snapshot);
        scene::Arrays arrays;
        std::string nodes, meshes;
        for (size_t i = 0; i < posed->objects.size(); ++i) {
            const types::Mesh& mesh = posed->meshes[static_cast<size_t>(posed->objects[i].mesh)];
            std::vector<float> positions;
            for (const glm::vec3& p : mesh.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
            const int vertices = arrays.floats("VEC3", positions), indices = arrays.indices(mesh.indices);
            glm::dmat4 place = posed->objects[i].world_from_object;
            for (const auto& moved : snapshot.moved)
                if (moved.object == i) place = moved.world_from_object;
            nodes += fmt::format(R"({}{{"name":"object_{}","mesh":{},"translation":[{:.17g},{:.17g},{:.17g}]}})",
                                 i ? "," : "", i, i, place[3].x, place[3].z, -place[3].y);
            meshes += fmt::format(R"({}{{"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{}}}]}})",
                                  i ? "," : "", vertices, indices);
        }
        const auto file =
            write("by_hand.gltf", gltf(fmt::format(R"("nodes":[{}],"meshes":[{}],)", nodes, meshes) + arrays.text()));
        types::Snapshot still = snapshot;
        auto geometry = std::make_shared<types::Geometry>(*scene::loadScene(file));
        for (types::Material& material : geometry->materials) material = snapshot.geometry->materials.front();
        for (size_t i = 0; i < posed->objects.size(); ++i) geometry->objects[i].name = posed->objects[i].name;
        still.geometry = geometry;
        still.moved.clear();
        still.deformed.clear();
        return still;
    }
    /** The scene with another material for all. */
    static std::shared_ptr<const scene::Scene> of(const std::shared_ptr<const scene::Scene>& from,
                                                  const types::Material& material) {
        scene::Scene scene = *from;
        auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
        for (types::Material& one : geometry->materials) one = material;
        scene.geometry = std::move(geometry);
        return std::make_shared<const scene::Scene>(std::move(scene));
    }
    /** Snapshots from random places on one side, at random times. */
    static std::vector<types::Snapshot> randomly(const std::shared_ptr<const scene::Scene>& scene, double x,
                                                 std::mt19937& random) {
        std::uniform_real_distribution<double> number(-1, 1);
        std::vector<types::Snapshot> all;
        for (int trial = 0; trial < 5; ++trial)
            all.push_back(at(scene, 1 + number(random), {x + 0.5 * number(random), number(random), number(random)},
                             0.1 * number(random), 0.1 * number(random)));
        return all;
    }
    /** The scene with a bumpy normal map on all its meshes. */
    static std::shared_ptr<const scene::Scene> mapped(const std::shared_ptr<const scene::Scene>& from) {
        scene::Scene scene = *from;
        auto geometry = std::make_shared<types::Geometry>(*scene.geometry);
        types::Mesh mesh = geometry->meshes[0];
        auto deformation = std::make_shared<types::Deformation>(*mesh.deformation);
        for (const glm::vec3& p : mesh.positions) {
            mesh.normals.push_back(glm::normalize(glm::vec3(0.01f, p.y, p.z)));
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.emplace_back(7 * p.x, 20 * (p.y + p.z));
        }
        deformation->normals = mesh.normals;
        deformation->tangents = mesh.tangents;
        mesh.deformation = std::move(deformation);
        geometry->meshes.replace(0, std::make_shared<const types::Mesh>(std::move(mesh)));
        geometry->normal_maps = {test::bumpyMap()};
        for (types::Material& material : geometry->materials) material.normal_map = 0;
        scene.geometry = std::move(geometry);
        return std::make_shared<const scene::Scene>(std::move(scene));
    }
    static size_t getEchoes(const types::Sonar& ping) {
        return static_cast<size_t>(std::ranges::count_if(ping.bins, [](float bin) { return bin > 0; }));
    }
    const scene::Tube tube_{9, 8, 0.1f};
};

TEST_F(DeformingMeshTest, ASkinnedMeshIsTheSameMeshPosedByHandBitForBit) {
    const auto scene = read(eelText(tube_));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int trial = 0; trial < 40; ++trial) {
        const types::Snapshot snapshot =
            at(scene, 1 + number(random), {-3 + number(random), number(random), number(random)}, 0.1 * number(random),
               0.1 * number(random));
        ASSERT_EQ(snapshot.deformed.size(), 1u);
        const types::Sonar animated = makePing(eelFan(), snapshot), still = makePing(eelFan(), byHand(snapshot));
        ASSERT_GT(getEchoes(animated), 20u) << trial;
        EXPECT_EQ(animated.bins, still.bins) << trial;
    }
}

TEST_F(DeformingMeshTest, AMorphedMeshIsTheSameMeshPosedByHandBitForBit) {
    const auto scene = read(kelpText(tube_));
    for (const double time : {0.0, 0.3, 1.1, 1.9}) {
        const types::Snapshot snapshot = at(scene, time, {2, 0.1, 0.05});
        const types::Sonar animated = makePing(eelFan(), snapshot), still = makePing(eelFan(), byHand(snapshot));
        ASSERT_GT(getEchoes(animated), 20u);
        EXPECT_EQ(animated.bins, still.bins) << time;
    }
}

TEST_F(DeformingMeshTest, SoItIsWithEveryEffectThatKnowsMeshes) {
    types::Material smooth;
    smooth.reflection = 0.7f;
    smooth.roughness_slope = 0.1f;
    types::Material wall;
    wall.shell = types::Shell{.thickness = 0.002, .density = 1180, .sound_speed = 2700, .shear_speed = 1300};
    types::Material mirror = smooth;
    mirror.mirror = true;
    SonarConfig plain = eelFan();
    plain.frequency_khz = 500;
    SonarConfig published = eelFan(), edges = plain, multipath = plain, coherent = plain, conical = plain,
                water = plain;
    published.model = Model::Cerqueira2017;
    edges.effects["edge_diffraction"] = {};
    multipath.multipath.emplace();
    coherent.speckle.emplace().coherent = true;
    conical.beam_geometry = BeamGeometry::Conical;
    water.volume.emplace_back().strength_db = -60;
    const auto eel = read(eelText(tube_));
    for (const SonarConfig& config : {plain, published, edges, multipath, coherent, conical, water})
        for (const types::Material& material : {smooth, wall, mirror}) {
            const types::Snapshot snapshot = at(of(eel, material), 0.6, {-2.5, 0.2, 0.1});
            const types::Sonar animated = makePing(config, snapshot), still = makePing(config, byHand(snapshot));
            ASSERT_GT(getEchoes(animated), 5u);
            EXPECT_EQ(animated.bins, still.bins);
        }
}

TEST_F(DeformingMeshTest, APingDoesNotDependOnThoseBeforeIt) {
    const auto scene = read(eelText(tube_));
    SonarRenderer renderer(eelFan(), scene->geometry);
    types::Sonar ping;
    for (const double time : {0.0, 0.2, 0.4, 0.1, 0.9}) {
        const types::Snapshot snapshot = at(scene, time);
        renderer.render(snapshot, ping);
        EXPECT_EQ(ping.bins, makePing(eelFan(), snapshot).bins) << time;
    }
    types::Snapshot rest = at(scene, 0.3);
    rest.deformed.clear();
    renderer.render(rest, ping);
    types::Snapshot plain = rest;
    auto geometry = std::make_shared<types::Geometry>(*rest.geometry);
    geometry->objects[0].world_from_object = rest.moved[0].world_from_object;
    plain.geometry = geometry;
    plain.moved.clear();
    EXPECT_EQ(ping.bins, makePing(eelFan(), plain).bins);
}

/** Also in a snapshot of the same shape, whose meshes would not be posed again. */
TEST_F(DeformingMeshTest, OtherSettingsOfTheSonarKeepItsShape) {
    types::Material smooth;
    smooth.reflection = 0.7f;
    smooth.roughness_slope = 0.1f;
    const types::Snapshot bent = at(of(read(eelText(tube_)), smooth), 0.4);
    for (const SonarConfig& config : {eelFan(), rasterisedFan(Deposit::Cpu), rasterisedFan(Deposit::Gpu)}) {
        std::vector<SonarConfig> all(3, config);
        for (SonarConfig& each : all) each.frequency_khz = 500;
        all[1].frequency_khz = 120;
        all[2].range *= 0.8;
        std::vector<std::vector<float>> made;
        for (const SonarConfig& each : all) made.push_back(makePing(each, bent).bins);
        EXPECT_NE(made[0], made[1]);
        SonarRenderer renderer(all[0], bent.geometry);
        types::Sonar ping;
        for (const size_t i : {0, 1, 2, 0}) {
            renderer.setConfig(all[i]);
            renderer.render(bent, ping);
            EXPECT_TRUE(ping.bins == made[i]) << i;
        }
    }
}

TEST_F(DeformingMeshTest, AnObjectThatIsScaledToNothingIsNotThere) {
    types::Snapshot snapshot = at(read(eelText(tube_)), 0.3);
    snapshot.targets = {{{1, 0, 0}, 0}};
    glm::dmat4& place = snapshot.moved[0].world_from_object;
    for (int axis = 0; axis < 3; ++axis) place[axis] = glm::dvec4(0);
    types::Snapshot target = test::makeSnapshot(test::openWater(), snapshot.sonar.position);
    target.sonar = snapshot.sonar;
    target.targets = snapshot.targets;
    const types::Sonar expected = makePing(eelFan(), target);
    ASSERT_GT(getEchoes(expected), 0u);
    EXPECT_EQ(makePing(eelFan(), snapshot).bins, expected.bins);
    snapshot.deformed.clear();  // by the path of objects that move
    EXPECT_EQ(makePing(eelFan(), snapshot).bins, expected.bins);
}

TEST_F(DeformingMeshTest, ARasterisedMeshIsTheSameMeshPosedByHandBitForBit) {
    types::Material smooth;
    smooth.reflection = 0.7f;
    smooth.roughness_slope = 0.1f;
    std::mt19937 random(2);
    const auto eel = read(eelText(tube_)), kelp = read(kelpText(tube_));
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        SonarConfig config = rasterisedFan(deposit);
        config.frequency_khz = 500;
        for (const auto& [scene, x] : {std::pair(eel, -3.0), std::pair(kelp, 2.0), std::pair(of(eel, smooth), -3.0),
                                       std::pair(of(kelp, smooth), 2.0)}) {
            const auto snapshots = randomly(scene, x, random);
            const std::vector<TruePing> pings = truePings(config, snapshots);
            for (size_t i = 0; i < pings.size(); ++i) {
                EXPECT_GT(getEchoes(pings[i].ping), 20u);
                expectSame(pings[i], truePings(config, {byHand(snapshots[i])}).front());
            }
        }
    }
}

TEST_F(DeformingMeshTest, SoItIsRasterisedWithEveryEffectThatKnowsMeshes) {
    types::Material smooth;
    smooth.reflection = 0.7f;
    smooth.roughness_slope = 0.1f;
    std::mt19937 random(6);
    const auto eel = of(read(eelText(tube_)), smooth);
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        SonarConfig plain = rasterisedFan(deposit);
        plain.frequency_khz = 500;
        SonarConfig published = rasterisedFan(deposit), edges = plain, conical = plain, water = plain;
        published.model = Model::Cerqueira2017;
        edges.effects["edge_diffraction"] = {};
        conical.beam_geometry = BeamGeometry::Conical;
        water.volume.emplace_back().strength_db = -60;
        for (const SonarConfig& config : {published, edges, conical, water}) {
            auto snapshots = randomly(eel, -3, random);
            for (types::Snapshot& snapshot : snapshots) snapshot.targets = {{{2, 0, 0}, 0}};
            const std::vector<TruePing> pings = truePings(config, snapshots);
            for (size_t i = 0; i < pings.size(); ++i)
                expectSame(pings[i], truePings(config, {byHand(snapshots[i])}).front());
        }
    }
}

TEST_F(DeformingMeshTest, ARasterisedNormalMapTurnsWithTheMesh) {
    std::mt19937 random(3);
    const auto plain = read(eelText(tube_)), eel = mapped(plain);
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        const SonarConfig config = rasterisedFan(deposit);
        const auto snapshots = randomly(eel, -3, random);
        const std::vector<TruePing> pings = truePings(config, snapshots);
        for (size_t i = 0; i < pings.size(); ++i) {
            EXPECT_GT(getEchoes(pings[i].ping), 20u);
            expectSame(pings[i], truePings(config, {rigid(snapshots[i])}).front());
            types::Snapshot unmapped = snapshots[i];
            unmapped.geometry = plain->geometry;
            EXPECT_NE(pings[i].ping.bins, makePing(config, unmapped).bins);
        }
    }
}

/** A narrow fan shows some of the many clusters of a mesh. */
TEST_F(DeformingMeshTest, ALargeRasterisedMeshIsCulledInItsShape) {
    std::mt19937 random(4);
    const auto kelp = read(kelpText(scene::Tube{300, 20, 0.05f}));
    ASSERT_GT(kelp->geometry->meshes[0].clusters.size(), 20u);
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        SonarConfig config = rasterisedFan(deposit);
        config.field_of_view_deg = 24;
        config.beam_height_deg = 16;
        const auto snapshots = randomly(kelp, 3.5, random);
        SonarConfig all = config;
        all.draw_all = true;
        const std::vector<TruePing> culled = truePings(config, snapshots), drawn = truePings(all, snapshots);
        size_t with_echoes = 0;
        for (size_t i = 0; i < culled.size(); ++i) {
            expectSame(culled[i], drawn[i]);
            expectSame(culled[i], truePings(config, {rigid(snapshots[i])}).front());
            with_echoes += getEchoes(culled[i].ping) > 5;
        }
        EXPECT_GT(with_echoes, 0u);
    }
}

/** Two objects share a mesh of the file, and only one of them deforms. */
TEST_F(DeformingMeshTest, RasterisedObjectsOfOneMeshHaveTheirOwnShapes) {
    const types::GeometryPtr plate = jointedPlate();
    auto geometry = std::make_shared<types::Geometry>(*plate);
    geometry->objects.push_back(geometry->objects.front());
    geometry->objects[0].name = "one", geometry->objects[1].name = "other";
    for (size_t i = 0; i < 2; ++i)
        geometry->objects[i].world_from_object[3] = glm::dvec4(3 + 0.5 * static_cast<double>(i), i ? 1 : -1, 0, 1);
    types::Snapshot snapshot = test::makeSnapshot(geometry);
    test::pose(snapshot, 1, glm::rotate(glm::dmat4(1), 0.4, glm::dvec3(0, 0, 1)));
    for (const Deposit deposit : {Deposit::Cpu, Deposit::Gpu}) {
        const SonarConfig config = rasterisedFan(deposit);
        types::Snapshot rest = snapshot;
        rest.deformed.clear();
        const std::vector<TruePing> pings = truePings(config, {snapshot, rest, snapshot});
        EXPECT_GT(getEchoes(pings[0].ping), 20u);
        EXPECT_NE(pings[0].ping.bins, pings[1].ping.bins);
        expectSame(pings[0], pings[2]);
        expectSame(pings[0], truePings(config, {rigid(snapshot)}).front());
        expectSame(pings[1], truePings(config, {rigid(rest)}).front());
    }
}

TEST_F(DeformingMeshTest, ThreadsChangeNothing) {
    const types::Snapshot snapshot = at(read(eelText(tube_)), 0.35);
    RenderOptions one, four;
    one.threads = 1;
    four.threads = 4;
    EXPECT_EQ(makePing(eelFan(), snapshot, one).bins, makePing(eelFan(), snapshot, four).bins);
}

TEST_F(DeformingMeshTest, TruthNamesTheObject) {
    const types::Snapshot snapshot = at(read(eelText(tube_)), 0.35);
    SonarRenderer renderer(eelFan(), snapshot.geometry);
    types::Sonar ping;
    types::SonarTruth truth;
    renderer.setTruth(ping, &truth);
    renderer.render(snapshot, ping);
    ASSERT_EQ(truth.object.size(), ping.bins.size());
    for (size_t i = 0; i < ping.bins.size(); ++i) EXPECT_EQ(truth.object[i], ping.bins[i] > 0 ? 0 : -1) << i;
}

TEST_F(DeformingMeshTest, APointTargetIsHiddenWhereTheMeshBendsBeforeIt) {
    const auto scene = read(kelpText(tube_));
    SonarConfig config = eelFan();
    std::vector<double> echoes;
    for (const double time : {0.0, 1.0}) {  // straight, and with its end 0.4 m to the side
        types::Snapshot snapshot = at(scene, time, {5.95, 0, 3}, 0, 1.5707963);  // looks down
        snapshot.targets = {{{5.95, 0, -2}, 0}};
        SonarRenderer renderer(config, snapshot.geometry);
        types::Sonar ping;
        renderer.render(snapshot, ping);
        echoes.push_back(static_cast<double>(renderer.othersReceived()));
    }
    EXPECT_EQ(echoes[0] + echoes[1], 1) << echoes[0];
}

/** The plate at a place by its joint, or by its object, with a rate of the matrix. */
types::Snapshot movingPlate(const glm::dmat4& place, const glm::dmat4& rate, bool by_joint) {
    types::Snapshot snapshot = test::makeSnapshot(jointedPlate());
    if (by_joint) {
        snapshot.deformed = {{0, 0, 0}};
        snapshot.joints = {{glm::dmat4x3(place), glm::dmat4x3(rate)}};
    } else {
        snapshot.moved = {{0, place, rate}};
    }
    return snapshot;
}

double centre(const types::Sonar& ping) {
    double sum = 0, at = 0;
    for (size_t i = 0; i < ping.bins.size(); ++i) {
        sum += double{ping.bins[i]};
        at += double{ping.bins[i]} * 0.1 * (static_cast<double>(i % ping.bin_count) + 0.5);
    }
    return at / sum;
}

/** |p + v t1| = c t1, and the same way back: the range of the echo of a plate in front of the sonar. */
TEST(DeformingMotionTest, AnApproachingJointEchoesLikeAnApproachingObject) {
    glm::dmat4 place(1), rate(0);
    place[3] = {200, 0, 0, 1};
    rate[3] = {-12, 0, 0, 0};
    const types::Sonar still = makePing(movingFan(), movingPlate(place, glm::dmat4(0), true));
    const types::Sonar joint = makePing(movingFan(), movingPlate(place, rate, true));
    const types::Sonar object = makePing(movingFan(), movingPlate(place, rate, false));
    EXPECT_NEAR(centre(still), 200, 0.1);
    EXPECT_NEAR(centre(joint), 200 / (1 + 12.0 / 1500), 0.1);
    EXPECT_NEAR(centre(joint), centre(object), 0.01);
}

TEST(DeformingMotionTest, AJointThatTurnsEchoesAsAnObjectThatDoes) {
    glm::dmat4 place(1), rate(0);
    place[3] = {20, 1, 0, 1};
    const glm::dvec3 turn(0, 0, 0.5);  // [rad/s]
    rate[3] = {-3, 1, 0, 0};
    for (int axis = 0; axis < 3; ++axis) rate[axis] = glm::dvec4(glm::cross(turn, glm::dvec3(place[axis])), 0);
    SonarConfig config = movingFan();
    config.range = 30;
    config.bin_count = 300;
    const types::Sonar joint = makePing(config, movingPlate(place, rate, true));
    const types::Sonar object = makePing(config, movingPlate(place, rate, false));
    const auto sumEnergy = [](const types::Sonar& ping) {
        return std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0);
    };
    EXPECT_GT(sumEnergy(object), 0);
    EXPECT_NEAR(sumEnergy(joint) / sumEnergy(object), 1, 0.1);  // rays meet the joint by the mean of its velocities
    EXPECT_NEAR(centre(joint), centre(object), 0.02);
    std::vector<double> by_beam;  // ranges of the echoes of each beam: the plate is turned
    for (const types::Sonar& ping : {joint, object})
        for (size_t beam = 0; beam < ping.beam_count; ++beam) {
            types::Sonar one = ping;
            one.bins.assign(ping.bins.begin() + static_cast<long>(beam * ping.bin_count),
                            ping.bins.begin() + static_cast<long>((beam + 1) * ping.bin_count));
            if (sumEnergy(one) > 0) by_beam.push_back(centre(one));
        }
    ASSERT_EQ(by_beam.size() % 2, 0u);
    for (size_t i = 0; i < by_beam.size() / 2; ++i) EXPECT_NEAR(by_beam[i], by_beam[i + by_beam.size() / 2], 0.02);
}

/** Drifts of triangles, against differences of the places of their corners. */
TEST_F(DeformingMeshTest, EachTriangleDriftsAsItsCornersDo) {
    const auto scene = read(eelText(tube_));
    const double time = 0.6, step = 1e-3;
    const auto cornersAt = [&](double seconds) {
        const types::Snapshot snapshot = at(scene, seconds);
        const types::GeometryPtr posed = types::posedGeometry(snapshot);
        const types::Mesh& mesh = posed->meshes[static_cast<size_t>(posed->objects[0].mesh)];
        const glm::dmat3 sonar_from_world = glm::transpose(glm::mat3_cast(snapshot.sonar.orientation));
        std::vector<glm::dvec3> places;
        for (const uint32_t index : mesh.indices)
            places.push_back(sonar_from_world *
                             (glm::dvec3(snapshot.moved[0].world_from_object * glm::dvec4(mesh.positions[index], 1)) -
                              snapshot.sonar.position));
        return places;
    };
    const types::Snapshot now = at(scene, time);
    DeformedMeshes meshes(now, {});
    meshes.take(now, 0, 1);
    Motion motion(*meshes.geometry(), 100);
    motion.follow(now);
    const auto before = cornersAt(time - step), here = cornersAt(time), after = cornersAt(time + step);
    for (uint32_t t = 0; t < here.size() / 3; ++t) {
        Drift own;
        const Drift* const drift = motion.findDrift(0, t, own);
        ASSERT_NE(drift, nullptr);
        for (size_t k = 3 * t; k < 3 * t + 3; ++k)
            EXPECT_LT(glm::distance(drift->at(here[k]), (after[k] - before[k]) / (2 * step)), 5e-3) << t;
    }
    EXPECT_GT(motion.fastest(), 0.5);
}

/** Sixteen triangles at a time, and each by itself. */
TEST(DeformingPlanesTest, PlanesAreTheSameInRegistersBitForBit) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> number(-3, 3);
    types::Mesh mesh;
    for (uint32_t i = 0; i < 3 * 100; ++i) {
        mesh.positions.push_back({number(random), 50 * number(random), number(random)});
        mesh.indices.push_back(i % 30 == 7 ? i - 1 : i);  // some have no area
    }
    const std::vector<PlaneRecord> all = extractPlanes(mesh);
    for (size_t t = 0; t < all.size(); ++t) {
        types::Mesh one;
        one.positions = mesh.positions;
        one.indices = {mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]};
        const PlaneRecord plane = extractPlanes(one).front();
        EXPECT_EQ(all[t].normal, plane.normal) << t;
        EXPECT_EQ(all[t].point, plane.point) << t;
    }
}

TEST_F(DeformingMeshTest, APlanSaysWhatDeforms) {
    const auto scene = read(eelText(tube_));
    for (const SonarConfig& config : {eelFan(), rasterisedFan(Deposit::Cpu)}) {
        EXPECT_EQ(makeRenderPlan(config, *scene->geometry).findOmitted("deforming meshes"), nullptr);
        EXPECT_EQ(makeRenderPlan(config, *test::openWater()).findOmitted("deforming meshes")->reason,
                  Reason::NoneInScene);
    }
}

TEST_F(DeformingMeshTest, SnapshotsThatDoNotFitAreFound) {
    types::Snapshot snapshot = at(read(eelText(tube_)), 0.3);
    EXPECT_TRUE(types::deformsRightly(snapshot));
    types::Snapshot other = snapshot;
    other.joints.pop_back();
    EXPECT_FALSE(types::deformsRightly(other));
    other = snapshot;
    other.deformed[0].object = 9;
    EXPECT_FALSE(types::deformsRightly(other));
    other = snapshot;
    other.deformed.push_back(other.deformed[0]);
    EXPECT_FALSE(types::deformsRightly(other));
    other = snapshot;
    other.geometry = test::openWater();
    EXPECT_FALSE(types::deformsRightly(other));
}

}  // namespace
}  // namespace insonify::sonar
