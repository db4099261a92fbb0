#include "components/sonar/Culler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace insonify::sonar {
namespace {

/** Whether the axes of an object do not stay at right angles. */
bool isSheared(const glm::dmat3& m) {
    const auto cosine = [&](int i, int j) { return std::abs(glm::dot(glm::normalize(m[i]), glm::normalize(m[j]))); };
    return !(std::max({cosine(0, 1), cosine(0, 2), cosine(1, 2)}) < 1e-6);
}

vec4 row(const glm::dmat4& m, int i) { return vec4(glm::dvec4(m[0][i], m[1][i], m[2][i], m[3][i])); }

/** Rotation and place of the sonar undone in double, so that world coordinates may be large. */
glm::dmat4 sonarFromWorld(const types::Pose& sonar) {
    glm::dmat4 inverse = glm::transpose(glm::mat4_cast(sonar.orientation));
    inverse[3] = glm::dvec4(-(glm::dmat3(inverse) * sonar.position), 1);
    return inverse;
}

/** `sonar_from_world` * `world_from_object`, subtracting the two origins before anything is rotated. */
glm::dmat4 relative(const glm::dmat3& rotation, const glm::dvec3& sonar, const glm::dmat4& world_from_object) {
    glm::dmat4 result(rotation * glm::dmat3(world_from_object));
    result[3] = glm::dvec4(rotation * (glm::dvec3(world_from_object[3]) - sonar), 1);
    return result;
}

/** Outward normals of the planes that bound a slab's view, all through the sonar; sonar axes, of any length. */
std::array<glm::vec3, 5> viewOf(const Slab& slab) {
    const double cosine = std::cos(slab.azimuth), sine = std::sin(slab.azimuth), u = slab.extent_u, v = slab.extent_v;
    const auto turned = [&](double x, double y, double z) {
        return glm::vec3(cosine * x - sine * y, sine * x + cosine * y, z);
    };
    return {turned(-u, 1, 0), turned(-u, -1, 0), turned(-v, 0, 1), turned(-v, 0, -1), turned(-1, 0, 0)};
}

double dot2(const glm::dvec3& v) { return glm::dot(v, v); }

}  // namespace

Culler::Culler(const types::Geometry& geometry, const CullRules& rules)
    : geometry_(geometry), rules_(rules), range_max_(static_cast<float>(rules.range_max)) {
    for (const types::Mesh& mesh : geometry.meshes) {
        Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
        for (const glm::vec3& p : mesh.positions)
            box = {glm::min(box.low, glm::dvec3(p)), glm::max(box.high, glm::dvec3(p))};
        mesh_boxes_.push_back(box);
    }
    for (const types::Object& object : geometry.objects)
        run_limit_ += geometry.meshes[static_cast<size_t>(object.mesh)].clusters.size();
    records_.resize(geometry.objects.size());
    far_.resize(geometry.objects.size());
    world_from_object_.resize(geometry.objects.size());
}

void Culler::place(const types::Snapshot& snapshot) {
    for (size_t i = 0; i < geometry_.objects.size(); ++i)
        world_from_object_[i] = geometry_.objects[i].world_from_object;
    for (const types::MovedObject& moved : snapshot.moved) world_from_object_[moved.object] = moved.world_from_object;
    const glm::dmat3 rotation(sonarFromWorld(snapshot.sonar));
    for (size_t i = 0; i < world_from_object_.size(); ++i)
        placeObject(i, relative(rotation, snapshot.sonar.position, world_from_object_[i]));
}

vec4 Culler::extent(size_t index, const glm::dmat4& m) const {
    const Box& box = mesh_boxes_[static_cast<size_t>(geometry_.objects[index].mesh)];
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                           corner & 4 ? box.high.z : box.low.z, 1);
        farthest = std::max(farthest, glm::length(glm::dvec3(m * p)));
    }
    glm::dvec3 nearest(m[3]);  // the box's axes stay orthogonal unless the object is sheared: then nothing is known
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 direction(m[axis]);
        const double at = -glm::dot(glm::dvec3(m[3]), direction) / glm::dot(direction, direction);
        nearest += direction * std::clamp(at, box.low[axis], std::max(box.low[axis], box.high[axis]));
    }
    const double distance = isSheared(glm::dmat3(m)) ? 0 : glm::length(nearest);
    const double slack = 1e-5;  // of the float that carries it
    return vec4(distance > 1e-6 ? (1 + slack) / distance : 1e6, farthest > 0 ? (1 - slack) / farthest : 0, 0, 0);
}

void Culler::placeObject(size_t index, const glm::dmat4& sonar_from_object) {
    const glm::dmat3 linear(sonar_from_object);
    const double scale = std::sqrt(dot2(linear[0]) + dot2(linear[1]) + dot2(linear[2]));  // at most
    const Box& box = mesh_boxes_[static_cast<size_t>(geometry_.objects[index].mesh)];
    const glm::dvec3 centre(sonar_from_object * glm::dvec4((box.low + box.high) / 2.0, 1));
    const double radius = scale * glm::length(box.high - box.low) / 2;
    far_[index] = !rules_.draw_all && glm::length(centre) - radius > 1.001 * rules_.range_max;
    if (far_[index]) return;
    const glm::dmat3 inverse = glm::inverse(linear);
    const glm::dmat4 normals(glm::transpose(inverse));
    const glm::dvec4 eye(-(inverse * glm::dvec3(sonar_from_object[3])), 0);
    ObjectRecord& record = records_[index];
    record = {row(sonar_from_object, 0),
              row(sonar_from_object, 1),
              row(sonar_from_object, 2),
              row(normals, 0),
              row(normals, 1),
              row(normals, 2),
              extent(index, sonar_from_object),
              vec4(eye),
              vec4(eye - glm::dvec4(vec4(eye)))};
}

void Culler::visible(const Slab& slab, std::vector<Run>& runs) const {
    runs.clear();
    const View view = viewOf(slab);
    for (size_t i = 0; i < records_.size(); ++i) {
        if (far_[i]) continue;
        const Box& box = mesh_boxes_[static_cast<size_t>(geometry_.objects[i].mesh)];
        const glm::vec3 centre(box.low * 0.5 + box.high * 0.5), half(box.high * 0.5 - box.low * 0.5);
        const float distance = nearest(view, records_[i], centre, half);
        if (distance <= range_max_) addObject({i, view, before(i, distance)}, runs);
    }
}

std::optional<glm::vec3> Culler::before(size_t object, float distance) const {
    if (!(distance > rules_.range_min)) return {};  // of a front that is blanked the back may be heard
    return glm::vec3(records_[object].eye);
}

void Culler::addObject(const Query& query, std::vector<Run>& runs) const {
    const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[query.object].mesh)];
    if (mesh.patches.empty()) return addClusters(query, mesh.clusters, runs);
    for (size_t i = 0; i < mesh.patches.size();) {
        const types::Patch& patch = mesh.patches[i];
        if (!(nearest(query.view, records_[query.object], patch.centre, patch.half) <= range_max_)) {
            i = patch.next;
            continue;
        }
        const std::span clusters = std::span(mesh.clusters).subspan(patch.first_cluster, patch.cluster_count);
        if (++i == patch.next) addClusters(query, clusters, runs);
    }
}

void Culler::addClusters(const Query& query, std::span<const types::Cluster> clusters, std::vector<Run>& runs) const {
    for (const types::Cluster& cluster : clusters) {
        if (clusters.size() > 1 &&
            !(nearest(query.view, records_[query.object], cluster.centre, cluster.half) <= range_max_))
            continue;
        if (turnsItsBack(query, cluster)) continue;
        const auto id = static_cast<uint32_t>(query.object);
        if (!runs.empty() && runs.back().object == id && runs.back().material == cluster.material &&
            runs.back().first_index + runs.back().index_count == cluster.first_index)
            runs.back().index_count += cluster.index_count;
        else
            runs.push_back({id, cluster.first_index, cluster.index_count, cluster.material});
    }
}

bool Culler::isSingleSided(const types::Cluster& cluster) const {
    return !geometry_.materials[static_cast<size_t>(cluster.material)].double_sided;
}

bool Culler::turnsItsBack(const Query& query, const types::Cluster& cluster) const {
    if (!query.before || cluster.cone_cutoff > 1 || !isSingleSided(cluster)) return false;
    const glm::vec3 away = cluster.cone_apex - *query.before;
    return glm::dot(away, cluster.cone_axis) >= (cluster.cone_cutoff + 1e-4f) * glm::length(away);
}

float Culler::nearest(const View& view, const ObjectRecord& object, glm::vec3 centre, glm::vec3 half) const {
    constexpr float never = std::numeric_limits<float>::infinity();
    if (rules_.draw_all) return 0;
    const vec4 middle(centre, 1);
    const glm::vec3 at(glm::dot(object.row_x, middle), glm::dot(object.row_y, middle), glm::dot(object.row_z, middle));
    // How far the box reaches from its centre along a direction of the sonar's axes.
    const auto reach = [&](const glm::vec3& along) {
        const glm::vec3 axes =
            along.x * glm::vec3(object.row_x) + along.y * glm::vec3(object.row_y) + along.z * glm::vec3(object.row_z);
        return glm::dot(glm::abs(axes), half);
    };
    const float rounding = 1e-5f * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
    for (const glm::vec3& outward : view)
        if (!(glm::dot(outward, at) - reach(outward) <= rounding * glm::length(outward))) return never;
    const float distance = glm::length(at);
    return distance > 0 ? std::max(distance - reach(at / distance) - rounding, 0.0f) : 0;
}

}  // namespace insonify::sonar
