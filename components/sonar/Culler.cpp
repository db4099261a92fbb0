#include "components/sonar/Culler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace insonify::sonar {
namespace {

/** Outward normals of the planes that bound a frustum's view, all through the sonar; sonar axes, of any length. */
std::array<glm::vec3, 5> viewOf(const ViewFrustum& frustum) {
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth), u = frustum.extent_u,
                 v = frustum.extent_v;
    const auto turned = [&](double x, double y, double z) {
        return glm::vec3(cosine * x - sine * y, sine * x + cosine * y, z);
    };
    return {turned(-u, 1, 0), turned(-u, -1, 0), turned(-v, 0, 1), turned(-v, 0, -1), turned(-1, 0, 0)};
}

}  // namespace

Culler::Culler(const types::Geometry& geometry, const CullRules& rules)
    : geometry_(geometry),
      rules_(rules),
      places_(geometry, rules.reach, rules.draw_all),
      range_max_(static_cast<float>(rules.reach.range_max)) {
    for (const types::Object& object : geometry.objects)
        draw_range_limit_ += geometry.meshes[static_cast<size_t>(object.mesh)].clusters.size();
}

void Culler::visible(const ViewFrustum& frustum, std::vector<DrawRange>& ranges) const {
    ranges.clear();
    const View view = viewOf(frustum);
    for (size_t i = 0; i < records().size(); ++i) {
        if (places_.isFar(i)) continue;
        const ObjectPlaces::Box& box = places_.box(i);
        const glm::vec3 centre(box.low * 0.5 + box.high * 0.5), half(box.high * 0.5 - box.low * 0.5);
        const float distance = nearest(view, records()[i], centre, half);
        if (distance <= range_max_) addObject({i, view, before(i, distance)}, ranges);
    }
}

std::optional<glm::vec3> Culler::before(size_t object, float distance) const {
    if (!(distance > rules_.range_min)) return {};  // of a front that is not drawn the back may be seen
    return glm::vec3(records()[object].eye);
}

void Culler::addObject(const Query& query, std::vector<DrawRange>& ranges) const {
    const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[query.object].mesh)];
    if (mesh.cluster_nodes.empty()) return addClusters(query, mesh.clusters, ranges);
    for (size_t i = 0; i < mesh.cluster_nodes.size();) {
        const types::ClusterNode& patch = mesh.cluster_nodes[i];
        if (!(nearest(query.view, records()[query.object], patch.centre, patch.half) <= range_max_)) {
            i = patch.next;
            continue;
        }
        const std::span clusters = std::span(mesh.clusters).subspan(patch.first_cluster, patch.cluster_count);
        if (++i == patch.next) addClusters(query, clusters, ranges);
    }
}

void Culler::addClusters(const Query& query, std::span<const types::Cluster> clusters,
                         std::vector<DrawRange>& ranges) const {
    for (const types::Cluster& cluster : clusters) {
        if (clusters.size() > 1 &&
            !(nearest(query.view, records()[query.object], cluster.centre, cluster.half) <= range_max_))
            continue;
        if (turnsItsBack(query, cluster)) continue;
        const auto id = static_cast<uint32_t>(query.object);
        if (!ranges.empty() && ranges.back().object == id && ranges.back().material == cluster.material &&
            ranges.back().first_index + ranges.back().index_count == cluster.first_index)
            ranges.back().index_count += cluster.index_count;
        else
            ranges.push_back({id, cluster.first_index, cluster.index_count, cluster.material});
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
