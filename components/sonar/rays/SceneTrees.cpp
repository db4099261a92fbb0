#include "components/sonar/rays/SceneTrees.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "components/sonar/surfaces/MeshFacts.hpp"

namespace insonify::sonar {
namespace {

/** Returns the device of the process. It is never released: Embree would start a thread then, and the process would end
 *  if the system refused it. */
RTCDevice sharedDevice() {
    static const RTCDevice device = [] {
        const RTCDevice made = rtcNewDevice("threads=1");
        if (!made) throw std::runtime_error("Embree has no device on this processor");
        return made;
    }();
    return device;
}

thread_local size_t built_by_this_thread = 0;

/** Returns numbers that are equal for equal objects. */
std::vector<uint64_t> makeKey(const std::vector<TreeObject>& objects) {
    std::vector<uint64_t> key;
    key.reserve(18 * objects.size());
    for (const TreeObject& object : objects) {
        key.push_back(reinterpret_cast<uintptr_t>(object.mesh.get()));
        key.push_back(object.command);
        for (int i = 0; i < 16; ++i) key.push_back(std::bit_cast<uint64_t>(object.place[i / 4][i % 4]));
    }
    return key;
}

constexpr double origin_spacing = 512;  // [m]

/** Returns the distance from a place to the cell of places whose origin is `origin` [m]. */
double distanceToCell(const glm::dvec3& place, const glm::dvec3& origin) {
    return glm::length(glm::max(glm::abs(place - origin) - origin_spacing / 2, 0.0));
}

}  // namespace

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

EmbreeScene::EmbreeScene(Kind kind) : device_(sharedDevice()), kind_(kind), scene_(rtcNewScene(device_)) {
    if (kind == Kind::Built) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        return;
    }
    rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);  // a tree of its own for each part
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

void EmbreeScene::add(const types::Mesh& mesh, const MaterialRun& run, const std::vector<glm::vec3>& at) {
    RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, at.data(), 0, sizeof(glm::vec3),
                               at.size() - 1);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(),
                               run.first_index * sizeof(uint32_t), 3 * sizeof(uint32_t), run.index_count / 3);
    if (kind_ == Kind::Refitted) rtcSetGeometryBuildQuality(triangles, RTC_BUILD_QUALITY_REFIT);
    attach(triangles, true);
}

void EmbreeScene::add(const EmbreeScene& other, const glm::dmat4& place) {
    const glm::mat4 matrix(place);
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, other.scene());
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix);
    attach(instance, false);
}

void EmbreeScene::attach(RTCGeometry geometry, bool has_vertices) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    has_vertices_.push_back(has_vertices);
}

void EmbreeScene::commit(const std::atomic<bool>* quits) {
    const auto goesOn = [](void* flag, double) { return !static_cast<const std::atomic<bool>*>(flag)->load(); };
    if (quits) rtcSetSceneProgressMonitorFunction(scene_, goesOn, const_cast<std::atomic<bool>*>(quits));
    rtcCommitScene(scene_);
    if (quits) rtcSetSceneProgressMonitorFunction(scene_, nullptr, nullptr);
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        throw std::runtime_error("Embree cannot build the scene: error " + std::to_string(error));
}

void EmbreeScene::recommit() {
    for (size_t i = 0; i < has_vertices_.size(); ++i) {
        RTCGeometry part = rtcGetGeometry(scene_, static_cast<unsigned>(i));
        if (has_vertices_[i]) rtcUpdateGeometryBuffer(part, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(part);
    }
    commit();
}

std::shared_ptr<MeshTree> MeshTree::of(const types::MeshPtr& mesh) {
    static auto& all = *new SharedValues<const types::Mesh*, MeshTree>;  // threads may use it until the process ends
    return all.of(mesh.get(), [&] { return std::make_shared<MeshTree>(mesh); });
}

const EmbreeScene& MeshTree::tree() {
    built_.call([this] {
        parts_.clear();
        positions_ = mesh_->positions;
        positions_.emplace_back();  // Embree reads 16 bytes at each position
        auto tree = std::make_unique<EmbreeScene>();
        for (const MaterialRun& run : materialRuns(*mesh_)) {
            tree->add(*mesh_, run, positions_);
            parts_.push_back({static_cast<uint32_t>(parts_.size()), run.first_index / 3});
        }
        tree->commit();
        tree_ = std::move(tree);
    });
    return *tree_;
}

std::shared_ptr<StillTree> StillTree::of(const std::vector<TreeObject>& objects) {
    static auto& all =
        *new SharedValues<std::vector<uint64_t>, StillTree>;  // threads may use it until the process ends
    return all.of(makeKey(objects), [&] { return std::make_shared<StillTree>(objects); });
}

const EmbreeScene& StillTree::tree(const std::atomic<bool>* quits) {
    built_.call([&] { build(quits); });
    return *tree_;
}

size_t StillTree::builtByThisThread() { return built_by_this_thread; }

void StillTree::build(const std::atomic<bool>* quits) {
    ++built_by_this_thread;
    auto tree = std::make_unique<EmbreeScene>();
    parts_.clear();
    positions_.clear();
    positions_.reserve(objects_.size());
    for (const TreeObject& object : objects_) {
        std::vector<glm::vec3>& placed = positions_.emplace_back();
        placed.reserve(object.mesh->positions.size() + 1);
        for (const glm::vec3& p : object.mesh->positions) placed.emplace_back(object.place * glm::dvec4(p, 1));
        placed.emplace_back();
        uint32_t command = object.command;
        for (const MaterialRun& run : materialRuns(*object.mesh)) {
            tree->add(*object.mesh, run, placed);
            parts_.push_back({command++, run.first_index / 3});
        }
    }
    tree->commit(quits);
    tree_ = std::move(tree);
}

SceneTrees::SceneTrees(const std::vector<TreeObject>& still, const std::vector<TreeObject>& apart)
    : still_(StillTree::of(still)) {
    const EmbreeScene& tree = still_->tree();
    if (apart.empty()) return;
    top_ = std::make_unique<EmbreeScene>();
    if (!still_->isEmpty()) {
        top_->add(tree, glm::dmat4(1));
        instances_.emplace_back();
    }
    for (const TreeObject& object : apart) {
        const Instance& instance = instances_.emplace_back(MeshTree::of(object.mesh), object.command);
        top_->add(instance.mesh->tree(), object.place);
    }
    top_->commit();
}

struct DeformingTrees::Tree {
    std::vector<glm::vec3> positions;  ///< About the origin, and one more.
    std::vector<TreePart> parts;
    std::unique_ptr<EmbreeScene> scene;
};

DeformingTrees::DeformingTrees() = default;
DeformingTrees::~DeformingTrees() = default;
DeformingTrees::DeformingTrees(DeformingTrees&&) noexcept = default;

DeformingTrees& DeformingTrees::operator=(DeformingTrees&& other) noexcept {
    top_ = std::move(other.top_);  // before the trees that it is of
    trees_ = std::move(other.trees_);
    objects_ = std::move(other.objects_);
    return *this;
}

DeformingTrees::DeformingTrees(std::vector<Object> objects) : objects_(std::move(objects)) {
    if (objects_.empty()) return;
    trees_.resize(objects_.size());
    for (size_t i = 0; i < objects_.size(); ++i) {
        Tree& tree = trees_[i];
        tree.positions = objects_[i].mesh->deformation->positions;
        tree.positions.emplace_back();  // Embree reads 16 bytes at each position
        tree.scene = std::make_unique<EmbreeScene>(EmbreeScene::Kind::Refitted);
        for (const MaterialRun& run : materialRuns(*objects_[i].mesh)) {
            tree.scene->add(*objects_[i].mesh, run, tree.positions);
            tree.parts.push_back({static_cast<uint32_t>(tree.parts.size()), run.first_index / 3});
        }
        tree.scene->commit();
    }
    top_ = std::make_unique<EmbreeScene>(EmbreeScene::Kind::Refitted);
    for (const Tree& tree : trees_) top_->add(*tree.scene, glm::dmat4(1));
}

void DeformingTrees::fit(size_t i, const glm::dmat4& place) {
    Tree& tree = trees_[i];
    const std::vector<glm::vec3>& from = objects_[i].mesh->positions;
    for (size_t k = 0; k < from.size(); ++k) tree.positions[k] = place * glm::dvec4(from[k], 1);
    tree.scene->recommit();
}

void DeformingTrees::join() {
    if (top_) top_->recommit();
}

RTCScene DeformingTrees::scene(size_t i) const { return trees_[i].scene->scene(); }

TreePart DeformingTrees::meaningIn(size_t i, uint32_t geometry) const {
    const TreePart& part = trees_[i].parts[geometry];
    return {objects_[i].first_command + part.command, part.first_triangle};
}

glm::dvec3 originNear(const glm::dvec3& sonar) { return origin_spacing * glm::round(sonar / origin_spacing); }

std::vector<TreeObject> objectsAbout(const std::vector<TreeObject>& in_world, const glm::dvec3& origin) {
    std::vector<TreeObject> objects = in_world;
    for (TreeObject& object : objects) object.place[3] -= glm::dvec4(origin, 0);
    return objects;
}

bool TreesAhead::follow(const glm::dvec3& sonar, const Objects& objects) {
    const double way = before_ ? glm::distance(*before_, sonar) : 0;
    before_ = sonar;
    const int64_t version = version_;
    if (objects != objects_) setObjects(objects);
    if (way == 0 && version == version_) return false;
    const Origins origins = way > 0 && way <= near ? originsAround(sonar) : Origins();
    if (origins.count == 0 && origins_.count == 0) return false;
    if (version == version_ && std::ranges::is_permutation(origins.needed(), origins_.needed())) return false;
    origins_ = origins;
    return true;
}

void TreesAhead::setObjects(const Objects& objects) {
    if (!objects_ || *objects != *objects_) ++version_;
    objects_ = objects;
    size_t triangles = 0;
    for (const TreeObject& object : *objects) triangles += object.mesh->indices.size() / 3;
    max_count_ = std::clamp<size_t>(max_triangles / std::max<size_t>(triangles, 1), 2, max_origins);
}

TreesAhead::Origins TreesAhead::originsAround(const glm::dvec3& sonar) const {
    const glm::dvec3 own = originNear(sonar);
    Origins origins;
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 origin = own;
        for (int axis = 0; axis < 3; ++axis)
            if (corner >> axis & 1) origin[axis] += sonar[axis] < own[axis] ? -origin_spacing : origin_spacing;
        const double distance = distanceToCell(sonar, origin);
        if (distance > (needs(origin) ? kept : near)) continue;
        size_t at = origins.count++;
        for (; at > 0 && distanceToCell(sonar, origins.all[at - 1]) > distance; --at)
            origins.all[at] = origins.all[at - 1];
        origins.all[at] = origin;
    }
    origins.count = origins.count == 1 ? 0 : std::min(origins.count, max_count_);
    return origins;
}

bool TreesAhead::needs(const glm::dvec3& origin) const { return std::ranges::count(origins_.needed(), origin) > 0; }

void TreesAhead::send() {
    MadeAhead::Items items;
    for (const glm::dvec3& origin : origins_.needed()) {
        items.push_back({{version_, std::bit_cast<int64_t>(origin.x), std::bit_cast<int64_t>(origin.y),
                          std::bit_cast<int64_t>(origin.z)},
                         [objects = objects_, origin](const std::atomic<bool>& quits) {
                             const auto tree = StillTree::of(objectsAbout(*objects, origin));
                             tree->tree(&quits);
                             return tree;
                         }});
    }
    ahead_.take(std::move(items));
}

namespace {

/** Data of a mesh that is kept until a geometry has the mesh. */
struct MeshData {
    types::MeshPtr mesh;
    std::shared_ptr<MeshTree> tree;
    std::shared_ptr<MeshFacts> facts;
    MeshFacts::Planes planes;
    MeshFacts::Facets facets;
    MeshFacts::Curves curves;
};

std::shared_ptr<const MeshData> getData(const types::MeshPtr& mesh, const MaterialLaws& laws) {
    MeshData data{mesh, MeshTree::of(mesh), MeshFacts::of(mesh), {}, {}, {}};
    data.tree->tree();
    data.facts->box();
    data.facts->longestEdge();
    data.facts->triangles();
    data.planes = data.facts->planes();
    data.facets = data.facts->facets(glm::dmat3(1), laws);
    data.curves = data.facts->curves(glm::dmat3(1));
    return std::make_shared<const MeshData>(std::move(data));
}

}  // namespace

void MeshesAhead::take(const Meshes& meshes, const MaterialLaws& laws) {
    if (meshes == taken_) return;
    taken_ = meshes;
    MadeAhead::Items items;
    const auto shared_laws = std::make_shared<const MaterialLaws>(laws);
    if (meshes)
        for (const types::MeshPtr& mesh : *meshes)
            items.push_back({{static_cast<int64_t>(reinterpret_cast<intptr_t>(mesh.get()))},
                             [mesh, shared_laws](const std::atomic<bool>&) { return getData(mesh, *shared_laws); }});
    ahead_.take(std::move(items));
}

}  // namespace insonify::sonar
