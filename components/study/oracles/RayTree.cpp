#include "components/study/oracles/RayTree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "components/sonar/rays/Embree.hpp"
#include "components/sonar/surfaces/FacetLobes.hpp"

namespace insonify::study {
namespace {

/** Returns a texel index within a map: wrapped around, or clamped to the edge. */
int wrapped(int i, int size, bool repeats) { return repeats ? ((i % size) + size) % size : std::clamp(i, 0, size - 1); }

glm::dvec3 texel(const types::NormalMap& map, int x, int y) {
    const auto at = 3 * (static_cast<size_t>(wrapped(y, map.height, map.repeat_v)) * static_cast<size_t>(map.width) +
                         static_cast<size_t>(wrapped(x, map.width, map.repeat_u)));
    return glm::dvec3(map.rgb[at], map.rgb[at + 1], map.rgb[at + 2]) * (2.0 / 255) - 1.0;
}

/** Looks up a map bilinearly between the centres of texels. */
glm::dvec3 lookedUp(const types::NormalMap& map, glm::dvec2 uv) {
    const double x = uv.x * map.width - 0.5, y = uv.y * map.height - 0.5;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const double right = x - column, down = y - row;
    return (1 - down) * ((1 - right) * texel(map, column, row) + right * texel(map, column + 1, row)) +
           down * ((1 - right) * texel(map, column, row + 1) + right * texel(map, column + 1, row + 1));
}

/** Returns the weights of a triangle's corners at a point of its plane. */
glm::dvec3 weightsAt(const glm::dvec3& point, const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0], across = glm::cross(a, b);
    const glm::dvec3 p = point - corners[0];
    const double area = glm::dot(across, across);
    const double second = glm::dot(glm::cross(p, b), across) / area, third = glm::dot(glm::cross(a, p), across) / area;
    return {1 - second - third, second, third};
}

template <class T>
auto mixed(const std::vector<T>& values, const uint32_t* corners, const glm::dvec3& weights) {
    using Double = glm::vec<T::length(), double>;
    return weights.x * Double(values[corners[0]]) + weights.y * Double(values[corners[1]]) +
           weights.z * Double(values[corners[2]]);
}

}  // namespace

struct RayTree::Embree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);

    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    /** Commits triangles, three corners each, about the origin [m]. */
    void commit(std::span<const glm::dvec3> corners);
};

void RayTree::Embree::commit(std::span<const glm::dvec3> corners) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), corners.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), corners.size() / 3));
    if (!corners.empty() && (!vertices || !indices)) throw std::runtime_error("out of memory in Embree for the scene");
    for (size_t i = 0; i < corners.size(); ++i) {
        for (size_t axis = 0; axis < 3; ++axis)
            vertices[3 * i + axis] = static_cast<float>(corners[i][static_cast<int>(axis)]);
        indices[i] = static_cast<uint32_t>(i);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        throw std::runtime_error("Embree cannot build the scene: error " + std::to_string(error));
}

void RayTree::Rays::set(int i, const glm::dvec3& direction, double nearest_met) {
    nearest[i] = static_cast<float>(nearest_met);
    x[i] = static_cast<float>(direction.x), y[i] = static_cast<float>(direction.y),
    z[i] = static_cast<float>(direction.z);
}

RayTree::RayTree(const types::Snapshot& scene)
    : geometry_(scene.geometry), origin_(scene.sonar.position), embree_(std::make_unique<Embree>()) {
    std::vector<glm::dmat4> world_from_object;
    for (const types::Object& object : geometry_->objects) world_from_object.push_back(object.world_from_object);
    for (const types::MovedObject& moved : scene.moved) world_from_object[moved.object] = moved.world_from_object;
    for (glm::dmat4& place : world_from_object) {
        place[3] -= glm::dvec4(origin_, 0);
        places_.push_back({place, glm::transpose(glm::inverse(glm::dmat3(place)))});
    }
    std::vector<glm::dvec3> corners;
    for (uint32_t object = 0; object < places_.size(); ++object) add(object, corners);
    embree_->commit(corners);
}

RayTree::~RayTree() = default;

void RayTree::updateLaws(const sonar::SonarConfig& config) {
    const Hearer hearer{config.model, config.frequency_khz, config.speedOfSound()};
    if (std::exchange(received_by_, hearer) == hearer) return;
    laws_ = sonar::makeMaterialLaws(config, *geometry_);
    facets_.clear();
    if (laws_.tables.empty() && !laws_.hasLobes()) return void(laws_.records.clear());
    std::vector<size_t> first{0};
    for (const types::Mesh& mesh : geometry_->meshes) first.push_back(first.back() + mesh.indices.size() / 3);
    const std::vector<sonar::FacetRecord> facets = sonar::facetLobes(*geometry_, laws_);
    if (facets.empty()) return;
    for (const Source& source : sources_) {
        const size_t mesh = static_cast<size_t>(geometry_->objects[source.object].mesh);
        sonar::FacetRecord& facet = facets_.emplace_back(facets[first[mesh] + source.first_index / 3]);
        facet.axis = glm::vec4(glm::vec3(places_[source.object].normals * glm::dvec3(facet.axis)), 0);
    }
}

sonar::LobeSlopes RayTree::lobeSlopes(uint32_t triangle, double cosine, const glm::dvec3& direction,
                                      double range) const {
    const Triangle& plane = triangles_[triangle];
    if (!laws_.hasLobe(static_cast<size_t>(plane.material))) return {};
    sonar::LobeSample sample{};
    sample.facet = facets_[triangle];
    sample.normal = plane.normal;
    sample.axis = glm::dvec3(facets_[triangle].axis);
    sample.range = range;
    sample.lookAlong(direction);
    if (plane.mapped) sample.mapped = cosine;
    return laws_.lobeSlopes(static_cast<size_t>(plane.material), sample);
}

void RayTree::add(uint32_t object, std::vector<glm::dvec3>& corners) {
    const types::Mesh& mesh = geometry_->meshes[static_cast<size_t>(geometry_->objects[object].mesh)];
    const bool has_frames = !mesh.normals.empty() && !mesh.tangents.empty() && !mesh.uvs.empty();
    for (const types::Cluster& cluster : mesh.clusters) {
        const types::Material& material = geometry_->materials[static_cast<size_t>(cluster.material)];
        const double mu = std::pow(10, material.lambert_db / 10);
        for (uint32_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
            const std::array<glm::dvec3, 3> triangle = getCorners({object, i, cluster.material});
            const glm::dvec3 across = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
            const double length = glm::length(across);
            const glm::dvec3 normal = length > 0 ? across / length : glm::dvec3(0);
            triangles_.push_back(
                {normal, glm::dot(normal, triangle[0]), mu, has_frames && material.normal_map >= 0, cluster.material});
            sources_.push_back({object, i, cluster.material});
            corners.insert(corners.end(), triangle.begin(), triangle.end());
        }
    }
}

std::array<glm::dvec3, 3> RayTree::getCorners(const Source& source) const {
    const types::Mesh& mesh = geometry_->meshes[static_cast<size_t>(geometry_->objects[source.object].mesh)];
    std::array<glm::dvec3, 3> corners;
    for (size_t k = 0; k < 3; ++k)
        corners[k] = glm::dvec3(places_[source.object].origin_from_object *
                                glm::dvec4(mesh.positions[mesh.indices[source.first_index + k]], 1));
    return corners;
}

void RayTree::trace(glm::dvec3 from, std::span<const Rays> rays, std::span<Found> found) const {
    std::array<RTCRayHit16, packets_at_once> hits;
    for (size_t k = 0; k < rays.size(); ++k) {
        RTCRayHit16& hit = hits[k];
        for (int i = 0; i < packet; ++i) {
            hit.ray.org_x[i] = static_cast<float>(from.x), hit.ray.org_y[i] = static_cast<float>(from.y),
            hit.ray.org_z[i] = static_cast<float>(from.z);
            hit.ray.dir_x[i] = rays[k].x[i], hit.ray.dir_y[i] = rays[k].y[i], hit.ray.dir_z[i] = rays[k].z[i];
            hit.ray.tnear[i] = rays[k].nearest[i], hit.ray.tfar[i] = std::numeric_limits<float>::infinity();
            hit.ray.mask[i] = ~0u, hit.ray.time[i] = 0, hit.ray.flags[i] = 0;
            hit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
    }
    sonar::intersect(embree_->scene, std::span(hits).first(rays.size()));
    for (size_t k = 0; k < rays.size(); ++k)
        for (size_t i = 0; i < packet; ++i)
            found[k][i] = hits[k].hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? none : hits[k].hit.primID[i];
}

double RayTree::bistatic(uint32_t triangle, double cosine, double other, const glm::dvec3& middle, double range) const {
    const Triangle& plane = triangles_[triangle];
    if (laws_.records.empty()) return plane.mu * other;
    const double half = std::abs(glm::dot(plane.normal, middle));
    const auto section = laws_.bistatic(static_cast<size_t>(plane.material), other, cosine, half,
                                        lobeSlopes(triangle, half, middle, range));
    return section.diffuse + section.lobe;
}

double RayTree::mappedCosine(uint32_t triangle, glm::dvec3 point, glm::dvec3 direction) const {
    const Source& source = sources_[triangle];
    const Place& place = places_[source.object];
    const types::Mesh& mesh = geometry_->meshes[static_cast<size_t>(geometry_->objects[source.object].mesh)];
    const types::Material& material = geometry_->materials[static_cast<size_t>(source.material)];
    const uint32_t* corners = &mesh.indices[source.first_index];
    const glm::dvec3 weights = weightsAt(point, getCorners(source));
    const glm::dvec4 along = mixed(mesh.tangents, corners, weights);
    const glm::dvec3 normal = glm::normalize(place.normals * mixed(mesh.normals, corners, weights));
    const glm::dvec3 leaning = glm::dmat3(place.origin_from_object) * glm::dvec3(along);
    const glm::dvec3 tangent = glm::normalize(leaning - normal * glm::dot(normal, leaning));
    const glm::dvec3 reported =
        lookedUp(geometry_->normal_maps[static_cast<size_t>(material.normal_map)], mixed(mesh.uvs, corners, weights));
    const double scale = material.normal_scale;
    const glm::dvec3 bent =
        glm::normalize(reported.x * scale * tangent + reported.y * scale * along.w * glm::cross(normal, tangent) +
                       reported.z * normal);
    const double cosine = -glm::dot(bent, direction) * (glm::dot(normal, direction) < 0 ? 1 : -1);
    return cosine > 1e-6 ? cosine : 1e-6;
}

}  // namespace insonify::study
