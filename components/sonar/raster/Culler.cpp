#include "components/sonar/raster/Culler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "components/sonar/base/Counters.hpp"
#include "types/Check.hpp"

namespace insonify::sonar {
namespace {

using glm::abs;
using glm::dot;
using glm::length;
using glm::max;
using glm::vec3;
#include "shaders/cull.glsl"

/** Returns a lower bound of a box's distance [m]; infinite when it is out of view. */
float nearest(const Culler::View& view, const ObjectRecord& object, vec3 centre, vec3 half) {
    const vec3 at = boxCentre(object, centre);
    for (const vec3& outward : view)
        if (boxBeyond(object, at, half, outward)) return std::numeric_limits<float>::infinity();
    return boxDistance(object, at, half);
}

}  // namespace

Culler::View Culler::computeView(const ViewFrustum& frustum) {
    const double cosine = std::cos(frustum.azimuth), sine = std::sin(frustum.azimuth), u = frustum.extent_u,
                 v = frustum.extent_v;
    const auto turned = [&](double x, double y, double z) {
        return glm::vec3(cosine * x - sine * y, sine * x + cosine * y, z);
    };
    return {turned(-u, 1, 0), turned(-u, -1, 0), turned(-v, 0, 1), turned(-v, 0, -1), turned(-1, 0, 0)};
}

Culler::Culler(const types::Geometry& geometry, const CullRules& rules)
    : geometry_(geometry),
      rules_(rules),
      places_(std::in_place, geometry, rules.reach, rules.draw_all),
      range_max_(static_cast<float>(rules.reach.range_max)) {
    for (const types::Object& object : geometry.objects)
        draw_range_limit_ += geometry.meshes[static_cast<size_t>(object.mesh)].clusters.size();
}

void Culler::setRules(const CullRules& rules) {
    rules_ = rules;
    places_.emplace(geometry_, rules.reach, rules.draw_all);
    range_max_ = static_cast<float>(rules.reach.range_max);
}

void Culler::visible(const ViewFrustum& frustum, std::vector<DrawRange>& ranges) const {
    ranges.clear();
    const View view = computeView(frustum);
    for (size_t i = 0; i < records().size(); ++i)
        if (const uint32_t in_view = inView(view, i); in_view != NOT_IN_VIEW)
            addObject({i, view, in_view}, ranges);
        else
            count(Counter::ObjectsCulled);
}

uint32_t Culler::inView(const View& view, size_t object) const {
    if (places_->isFar(object)) return NOT_IN_VIEW;
    if (rules_.draw_all) return WHOLE_IN_VIEW;
    const Box& box = places_->box(object);
    const glm::vec3 centre(box.low * 0.5 + box.high * 0.5), half(box.high * 0.5 - box.low * 0.5);
    const float distance = nearest(view, records()[object], centre, half);
    if (!(distance <= range_max_)) return NOT_IN_VIEW;
    return distance > rules_.range_min ? FRONT_IN_VIEW : IN_VIEW;  // behind an omitted front the back may be seen
}

void Culler::addObject(const Query& query, std::vector<DrawRange>& ranges) const {
    const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[query.object].mesh)];
    if (mesh.cluster_nodes.empty()) return addClusters(query, mesh.clusters, ranges);
    for (size_t i = 0; i < mesh.cluster_nodes.size();) {
        const types::ClusterNode& patch = mesh.cluster_nodes[i];
        if (!mayShow(query, patch.centre, patch.half)) {
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
        if (clusters.size() > 1 && !mayShow(query, cluster.centre, cluster.half)) continue;
        if (turnsItsBack(query, cluster)) continue;
        const auto id = static_cast<uint32_t>(query.object);
        if (!ranges.empty() && ranges.back().object == id && ranges.back().material == cluster.material &&
            ranges.back().first_index + ranges.back().index_count == cluster.first_index)
            ranges.back().index_count += cluster.index_count;
        else
            ranges.push_back({id, cluster.first_index, cluster.index_count, cluster.material});
        INSONIFY_CHECK(ranges.size() <= draw_range_limit_, ranges.size(), draw_range_limit_);
    }
}

bool Culler::isSingleSided(const types::Cluster& cluster) const {
    return !geometry_.materials[static_cast<size_t>(cluster.material)].double_sided;
}

bool Culler::turnsItsBack(const Query& query, const types::Cluster& cluster) const {
    if (query.in_view != FRONT_IN_VIEW || cluster.cone_cutoff > 1 || !isSingleSided(cluster)) return false;
    return showsBacks(glm::vec3(records()[query.object].eye), cluster.cone_apex, cluster.cone_axis,
                      cluster.cone_cutoff);
}

bool Culler::mayShow(const Query& query, glm::vec3 centre, glm::vec3 half) const {
    return query.in_view == WHOLE_IN_VIEW || nearest(query.view, records()[query.object], centre, half) <= range_max_;
}

}  // namespace insonify::sonar
