#include "components/sonar/Culler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace insonify::sonar {
namespace {

/** Whether the axes of an object do not stay at right angles. */
bool isSheared(const glm::dmat3& m) {
    const auto cosine = [&](int i, int j) { return std::abs(glm::dot(glm::normalize(m[i]), glm::normalize(m[j]))); };
    return !(std::max({cosine(0, 1), cosine(0, 2), cosine(1, 2)}) < 1e-6);
}

/** Largest factor by which a matrix stretches a vector, or a little more when it shears. */
double stretch(const glm::dmat3& m) {
    const double x = glm::dot(m[0], m[0]), y = glm::dot(m[1], m[1]), z = glm::dot(m[2], m[2]);
    return std::sqrt(isSheared(m) ? x + y + z : std::max({x, y, z}) * (1 + 3e-6));
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

}  // namespace

Culler::Culler(const types::Geometry& geometry, double range_max)
    : geometry_(geometry), range_max_(static_cast<float>(range_max)) {
    for (const types::Mesh& mesh : geometry.meshes) {
        glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
        for (const types::Cluster& cluster : mesh.clusters) {
            low = glm::min(low, cluster.centre - cluster.radius);
            high = glm::max(high, cluster.centre + cluster.radius);
        }
        Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
        for (const glm::vec3& p : mesh.positions)
            box = {glm::min(box.low, glm::dvec3(p)), glm::max(box.high, glm::dvec3(p))};
        mesh_boxes_.push_back(box);
        const bool empty = mesh.clusters.empty();
        mesh_spheres_.push_back(empty ? Sphere{}
                                      : Sphere{low * 0.5f + high * 0.5f, glm::length(high * 0.5f - low * 0.5f)});
    }
    for (const types::Object& object : geometry.objects)
        run_limit_ += geometry.meshes[static_cast<size_t>(object.mesh)].clusters.size();
    object_spheres_.resize(geometry.objects.size());
    scales_.resize(geometry.objects.size());
    records_.resize(geometry.objects.size());
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
    const glm::dmat4 normals(glm::transpose(glm::inverse(linear)));
    ObjectRecord& record = records_[index];
    record = {row(sonar_from_object, 0), row(sonar_from_object, 1), row(sonar_from_object, 2),       row(normals, 0),
              row(normals, 1),           row(normals, 2),           extent(index, sonar_from_object)};
    const Sphere& mesh = mesh_spheres_[static_cast<size_t>(geometry_.objects[index].mesh)];
    scales_[index] = static_cast<float>(stretch(linear));
    object_spheres_[index] = {glm::vec3(sonar_from_object * glm::dvec4(mesh.centre, 1)), mesh.radius * scales_[index]};
}

void Culler::visible(const Slab& slab, std::vector<Run>& runs) const {
    runs.clear();
    for (size_t i = 0; i < object_spheres_.size(); ++i)
        if (sees(slab, object_spheres_[i])) addRuns(i, slab, runs);
}

void Culler::addRuns(size_t object, const Slab& slab, std::vector<Run>& runs) const {
    const types::Mesh& mesh = geometry_.meshes[static_cast<size_t>(geometry_.objects[object].mesh)];
    const ObjectRecord& record = records_[object];
    for (const types::Cluster& cluster : mesh.clusters) {
        const vec4 centre(cluster.centre, 1);
        const Sphere sphere{
            {glm::dot(record.row_x, centre), glm::dot(record.row_y, centre), glm::dot(record.row_z, centre)},
            cluster.radius * scales_[object]};
        if (mesh.clusters.size() > 1 && !sees(slab, sphere)) continue;
        const auto id = static_cast<uint32_t>(object);
        if (!runs.empty() && runs.back().object == id && runs.back().material == cluster.material &&
            runs.back().first_index + runs.back().index_count == cluster.first_index)
            runs.back().index_count += cluster.index_count;
        else
            runs.push_back({id, cluster.first_index, cluster.index_count, cluster.material});
    }
}

bool Culler::sees(const Slab& slab, const Sphere& sphere) const {
    const auto cosine = static_cast<float>(std::cos(slab.azimuth)), sine = static_cast<float>(std::sin(slab.azimuth));
    const float x = cosine * sphere.centre.x + sine * sphere.centre.y,
                y = cosine * sphere.centre.y - sine * sphere.centre.x;
    const float z = sphere.centre.z;
    const auto u = static_cast<float>(slab.extent_u), v = static_cast<float>(slab.extent_v);
    const float margin = sphere.radius + 1e-5f * (std::abs(x) + std::abs(y) + std::abs(z));  // rounding of the centre
    return std::abs(y) - u * x <= margin * std::sqrt(1 + u * u) &&
           std::abs(z) - v * x <= margin * std::sqrt(1 + v * v) && x >= -margin &&
           glm::length(sphere.centre) - margin <= range_max_;
}

}  // namespace insonify::sonar
