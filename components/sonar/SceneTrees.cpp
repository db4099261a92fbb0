#include "components/sonar/SceneTrees.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace insonify::sonar {
std::vector<MaterialRun> materialRuns(const types::Mesh& mesh) {
    std::vector<MaterialRun> ranges;
    for (const types::Cluster& cluster : mesh.clusters) {
        if (!ranges.empty() && ranges.back().material == cluster.material)
            ranges.back().index_count += cluster.index_count;
        else
            ranges.push_back({cluster.first_index, cluster.index_count, cluster.material});
    }
    return ranges;
}

SceneTrees::SceneTrees(const types::Geometry& geometry)
    : geometry_(geometry), device_(rtcNewDevice("threads=1")), meshes_(geometry.meshes.size()) {
    if (!device_) throw std::runtime_error("Embree has no device on this processor");
}

SceneTrees::~SceneTrees() {
    for (MeshTree& tree : meshes_)
        if (tree.scene) rtcReleaseScene(tree.scene);
    if (still_) rtcReleaseScene(still_);
    rtcReleaseDevice(device_);
}

RTCScene SceneTrees::newScene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    return scene;
}

void SceneTrees::clear() {
    if (still_) rtcReleaseScene(still_);
    still_ = newScene();
    parts_.clear();
    instances_.clear();
    positions_.clear();
    positions_.reserve(geometry_.objects.size());
}

void SceneTrees::commit() {
    rtcCommitScene(still_);
    const RTCError error = rtcGetDeviceError(device_);
    if (error == RTC_ERROR_NONE) return;
    rtcReleaseScene(std::exchange(still_, nullptr));
    throw std::runtime_error("Embree cannot build the scene: error " + std::to_string(error));
}

void SceneTrees::addRun(RTCScene scene, const types::Mesh& mesh, const MaterialRun& run,
                        const std::vector<glm::vec3>& at) const {
    RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, at.data(), 0, sizeof(glm::vec3),
                               at.size() - 1);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(),
                               run.first_index * sizeof(uint32_t), 3 * sizeof(uint32_t), run.index_count / 3);
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
}

const SceneTrees::MeshTree& SceneTrees::treeOf(int index) {
    MeshTree& tree = meshes_[static_cast<size_t>(index)];
    if (tree.scene) return tree;
    tree.positions = mesh(index).positions;
    tree.positions.emplace_back();  // Embree reads 16 bytes at each position
    tree.scene = newScene();
    for (const MaterialRun& run : materialRuns(mesh(index))) {
        addRun(tree.scene, mesh(index), run, tree.positions);
        tree.parts.push_back({static_cast<uint32_t>(tree.parts.size()), run.first_index / 3});
    }
    rtcCommitScene(tree.scene);
    return tree;
}

void SceneTrees::copy(int index, const glm::dmat4& place, uint32_t command) {
    std::vector<glm::vec3>& placed = positions_.emplace_back();
    placed.reserve(mesh(index).positions.size() + 1);
    for (const glm::vec3& p : mesh(index).positions) placed.emplace_back(place * glm::dvec4(p, 1));
    placed.emplace_back();
    for (const MaterialRun& run : materialRuns(mesh(index))) {
        addRun(still_, mesh(index), run, placed);
        parts_.push_back({command++, run.first_index / 3});
        instances_.emplace_back();
    }
}

void SceneTrees::instance(int index, const glm::dmat4& place, uint32_t command) {
    const glm::mat4 matrix(place);
    const MeshTree& tree = treeOf(index);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, tree.scene);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(still_, geometry);
    rtcReleaseGeometry(geometry);
    parts_.emplace_back();
    instances_.push_back({&tree, command});
}

}  // namespace insonify::sonar
