#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "components/ros/Cdr.hpp"
#include "components/viewer/FoxgloveMessages.hpp"
#include "components/viewer/PingPicture.hpp"
#include "components/viewer/SceneMesh.hpp"
#include "components/viewer/SceneUpdates.hpp"
#include "tests/support/Deformed.hpp"

namespace insonify::viewer {
namespace {

struct MeshMessage {
    nlohmann::json json;
    std::string data;
    template <class T>
    std::vector<T> list(const nlohmann::json& accessor) const {
        std::vector<T> values(accessor["count"].get<size_t>());
        std::memcpy(values.data(), data.data() + accessor["offset"].get<size_t>(), values.size() * sizeof(T));
        return values;
    }
};

MeshMessage meshTakenApart(const std::string& bytes, uint32_t kind = scene_kind) {
    uint32_t head[2];
    std::memcpy(head, bytes.data(), sizeof head);
    EXPECT_EQ(head[0], kind);
    return {nlohmann::json::parse(bytes.substr(8, head[1])), bytes.substr(8 + head[1])};
}

/** Returns a strip of triangles, and a vertex that no triangle uses. */
types::Mesh strip(uint32_t triangles) {
    types::Mesh mesh;
    mesh.positions.push_back({99, 99, 99});
    for (uint32_t i = 0; i < triangles + 2; ++i) mesh.positions.push_back({float(i), float(i % 2), 0});
    for (uint32_t i = 1; i <= triangles; ++i) mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 2});
    types::Cluster cluster;
    cluster.index_count = 3 * triangles;
    mesh.clusters = {cluster};
    return mesh;
}

types::Geometry scene(uint32_t large, uint32_t small) {
    types::Geometry geometry;
    geometry.meshes = {strip(large), strip(small)};
    geometry.materials.resize(1);
    geometry.materials[0].name = "sand";
    geometry.objects = {{"small", 1, glm::dmat4(1)}, {"large", 0, glm::dmat4(2)}, {"other", 1, glm::dmat4(1)}};
    return geometry;
}

TEST(SceneMeshTest, SendsMeshesWithTheVerticesThatTheyUse) {
    const MeshMessage message = meshTakenApart(sceneMessage(scene(4, 1), 1000, "scene.snapshot"));
    const auto& mesh = message.json["meshes"][1];
    EXPECT_EQ(message.list<float>(mesh["positions"]), (std::vector<float>{0, 0, 0, 1, 1, 0, 2, 0, 0}));
    EXPECT_EQ(message.list<uint32_t>(mesh["indices"]), (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(message.json["source"], "scene.snapshot");
    EXPECT_EQ(message.json["objects"].size(), 3u);
    EXPECT_EQ(message.json["objects"][1]["matrix"][0], 2);
    EXPECT_EQ(message.json["materials"][0], "sand");
    EXPECT_EQ(message.json["coarse"], false);
    EXPECT_EQ(message.json["left_out"], 0);
}

TEST(SceneMeshTest, OmitsAndCountsSmallObjectsBeyondTheTriangleLimit) {
    const MeshMessage message = meshTakenApart(sceneMessage(scene(100, 10), 115, "scene.snapshot"));
    EXPECT_EQ(message.json["triangles"], 120);
    EXPECT_EQ(message.json["left_out"], 1);
    EXPECT_EQ(message.json["objects"][0]["name"], "small");
    EXPECT_EQ(message.json["objects"][1]["name"], "large");
}

TEST(SceneMeshTest, DoesNotSendOmittedMeshes) {
    types::Geometry geometry = scene(500, 10);
    for (int i = 0; i < 50; ++i) {
        geometry.meshes.push_back(strip(400));
        geometry.objects.push_back({"too many", static_cast<int>(geometry.meshes.size()) - 1, glm::dmat4(1)});
    }
    const MeshMessage message = meshTakenApart(sceneMessage(geometry, 520, "scene.snapshot"));
    EXPECT_EQ(message.json["left_out"], 50);
    EXPECT_EQ(message.json["meshes"].size(), 52u) << "objects have the numbers of their meshes";
    EXPECT_EQ(message.json["meshes"][2]["indices"]["count"], 0);
    EXPECT_EQ(message.data.size(), size_t{(502 + 12) * 3 * 4 + (500 + 10) * 3 * 4});
}

TEST(SceneMeshTest, ReducesLargeMeshesToOutlines) {
    types::Geometry geometry = scene(100, 10);
    geometry.meshes[0].coarse_indices = {1, 50, 100};
    const MeshMessage message = meshTakenApart(sceneMessage(geometry, 50, "scene.snapshot"));
    EXPECT_EQ(message.json["coarse"], true);
    EXPECT_EQ(message.json["meshes"][0]["indices"]["count"], 3);
    EXPECT_EQ(message.json["left_out"], 0);
}

TEST(SceneMeshTest, ASnapshotHasThePlacesOfObjects) {
    types::Snapshot snapshot;
    snapshot.sonar.position = {1, 2, 3};
    snapshot.moved = {{7, glm::dmat4(1)}};
    snapshot.water_surface = -1;
    const auto json = nlohmann::json::parse(snapshotMessage(snapshot, 1000, "scene.snapshot"));
    EXPECT_EQ(json["position"], nlohmann::json::parse("[1, 2, 3]"));
    EXPECT_EQ(json["orientation"], nlohmann::json::parse("[0, 0, 0, 1]"));
    EXPECT_EQ(json["moved"][0]["object"], 7);
    EXPECT_EQ(json["water_surface"], -1);
}

/** Two objects of one mesh, the second of which is posed and moved. */
types::Snapshot posedScene(double up) {
    auto geometry = std::make_shared<types::Geometry>(scene(4, 2));
    geometry->meshes[1] = test::jointed(geometry->meshes[1]);
    types::Snapshot snapshot;
    snapshot.geometry = geometry;
    snapshot.sonar.target_frame = "world";
    test::pose(snapshot, 2, glm::translate(glm::dmat4(1), {0, 0, up}));
    return snapshot;
}

TEST(SceneMeshTest, ASnapshotHasThePositionsOfMeshesThatDeform) {
    const MeshMessage message = meshTakenApart(snapshotMessage(posedScene(7), 1000, "scene.snapshot"), snapshot_kind);
    EXPECT_EQ(message.json["type"], "snapshot");
    ASSERT_EQ(message.json["shapes"].size(), 1u);
    EXPECT_EQ(message.json["shapes"][0]["object"], 2);
    EXPECT_EQ(message.list<float>(message.json["shapes"][0]), (std::vector<float>{0, 0, 7, 1, 1, 7, 2, 0, 7, 3, 1, 7}));
}

TEST(SceneMeshTest, FoxgloveShowsMeshesThatDeformLikeRigidMeshesOfThatShape) {
    const types::Snapshot first = posedScene(7), second = posedScene(-2);
    SceneUpdates deforming(ros::WorldFrame::Enu, 1000), rigid(ros::WorldFrame::Enu, 1000);
    EXPECT_EQ(*deforming.whole(first), *rigid.whole(test::rigid(first)));
    EXPECT_EQ(deforming.moved(first), nullptr) << "has the same shape";
    types::Snapshot moved = test::rigid(second);
    moved.moved = {{2, glm::dmat4(1)}};
    const Bytes update = deforming.moved(second);
    ASSERT_NE(update, nullptr);
    SceneUpdates other(ros::WorldFrame::Enu, 1000);
    other.whole(test::rigid(second));
    types::Snapshot aside = moved;
    aside.geometry = second.geometry;
    aside.moved[0].world_from_object[3].x = 1;
    other.moved(aside);  // so that the object counts as moved
    EXPECT_EQ(*update, *other.moved(moved));
    types::Snapshot rest = second;
    rest.deformed.clear();
    EXPECT_NE(deforming.moved(rest), nullptr) << "is at rest again";
}

TEST(SceneMeshTest, FoxglovesMeshesFarFromTheOriginAreRelativeToTheirObject) {
    const glm::dvec3 far(500'000.25, 6'500'000.5, 0.125);
    types::Snapshot near_by = posedScene(7);
    near_by.deformed.clear();
    const auto updateAt = [&](const glm::dvec3& place) {
        auto geometry = std::make_shared<types::Geometry>(*near_by.geometry);
        for (types::Object& object : geometry->objects) object.world_from_object[3] += glm::dvec4(place, 0);
        types::Snapshot snapshot = near_by;
        snapshot.geometry = geometry;
        const Bytes bytes = SceneUpdates(ros::WorldFrame::AsIs, 1000).whole(snapshot);
        foxglove::SceneUpdate update;
        ros::decode({bytes->begin(), bytes->end()}, update);
        return update;
    };
    const foxglove::SceneUpdate here = updateAt({0, 0, 0}), there = updateAt(far);
    ASSERT_EQ(here.entities.size(), there.entities.size());
    for (size_t i = 0; i < here.entities.size(); ++i) {
        const foxglove::TriangleListPrimitive &a = here.entities[i].triangles.at(0),
                                              &b = there.entities[i].triangles.at(0);
        EXPECT_EQ(a.pose.position.x, 0);
        ASSERT_EQ(a.points.size(), b.points.size());
        for (size_t k = 0; k < a.points.size(); ++k) {
            EXPECT_LT(std::abs(b.points[k].y), 1000) << "a number of 32 bits resolves it";
            EXPECT_NEAR(b.pose.position.x + b.points[k].x, a.points[k].x + far.x, 1e-6);
            EXPECT_NEAR(b.pose.position.y + b.points[k].y, a.points[k].y + far.y, 1e-6);
            EXPECT_NEAR(b.pose.position.z + b.points[k].z, a.points[k].z + far.z, 1e-6);
        }
    }
}

}  // namespace
}  // namespace insonify::viewer
