#include "types/geometry/PosedMesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace insonify::types {
namespace {

constexpr double noise = 0x1p-22;  ///< Rounding of a coordinate, relative to all coordinates [1].
constexpr double of_edge = 1.0 / 16;
constexpr uint32_t nobody = std::numeric_limits<uint32_t>::max();

/** Returns the median length of the edges, of a sample of at most some thousand [m]. */
double medianEdge(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    constexpr size_t enough = 4096;
    const size_t triangles = indices.size() / 3, step = std::max<size_t>(1, triangles / enough);
    std::vector<double> lengths;
    for (size_t t = 0; t < triangles; t += step)
        for (size_t k = 0; k < 3; ++k)
            lengths.push_back(glm::distance(glm::dvec3(positions[indices[3 * t + k]]),
                                            glm::dvec3(positions[indices[3 * t + (k + 1) % 3]])));
    if (lengths.empty()) return 0;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    return *middle;
}

/** Returns the distance within which two vertices are at the same place [m]. */
double sameWithin(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const uint32_t index : indices) {
        low = glm::min(low, positions[index]);
        high = glm::max(high, positions[index]);
    }
    if (indices.empty()) return 0;
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low),
                     farthest = glm::max(glm::abs(glm::dvec3(low)), glm::abs(glm::dvec3(high)));
    const double extent = std::max({size.x, size.y, size.z}), largest = std::max({farthest.x, farthest.y, farthest.z});
    if (largest <= extent) return noise * extent;
    return std::max(noise * extent, std::min(noise * largest, of_edge * medianEdge(positions, indices)));
}

/** The first vertices of places, by cells of space. */
class Places {
public:
    Places(const std::vector<glm::vec3>& positions, double within)
        : positions_(positions),
          within_(within),
          per_cell_(1 / std::max(cells * within, 1e-30)),
          first_(std::bit_ceil(2 * positions.size() + 1), nobody),
          next_(positions.size(), nobody) {}

    /** Returns the first vertex of the place of a vertex, which becomes one itself where there is none. */
    uint32_t of(uint32_t vertex) {
        const glm::dvec3 at(positions_[vertex]), own = findCell(at);
        const glm::dvec3 low = findCell(at - within_), high = findCell(at + within_);
        uint32_t found = nobody;
        for (int corner = 0; corner < 8; ++corner) {  // at most two cells in each direction
            const bool right = corner & 1, up = corner & 2, on = corner & 4;
            if ((right && high.x == low.x) || (up && high.y == low.y) || (on && high.z == low.z)) continue;
            found = std::min(found, within({right ? high.x : low.x, up ? high.y : low.y, on ? high.z : low.z}, at));
        }
        if (found != nobody) return found;
        uint32_t& head = first_[slot(own)];
        next_[vertex] = head;
        return head = vertex;
    }

private:
    static constexpr double cells = 8;  ///< Side of a cell, in distances of one place [1].

    glm::dvec3 findCell(const glm::dvec3& at) const { return glm::floor(at * per_cell_); }
    size_t slot(const glm::dvec3& cell) const {
        uint64_t key = 0;
        for (const double number : {cell.x, cell.y, cell.z}) {
            key = (key ^ std::bit_cast<uint64_t>(number + 0.0)) * 0x9e3779b97f4a7c15u;
            key ^= key >> 29;
        }
        return key & (first_.size() - 1);
    }
    uint32_t within(const glm::dvec3& cell, const glm::dvec3& at) const {
        uint32_t lowest = nobody;
        for (uint32_t i = first_[slot(cell)]; i != nobody; i = next_[i]) {
            const glm::dvec3 off = glm::dvec3(positions_[i]) - at;
            if (glm::dot(off, off) <= within_ * within_) lowest = std::min(lowest, i);
        }
        return lowest;
    }

    const std::vector<glm::vec3>& positions_;
    double within_, per_cell_;
    std::vector<uint32_t> first_, next_;  ///< Lists of first vertices of the same slot.
};

}  // namespace

std::vector<uint32_t> weldedPlaces(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    std::vector<uint32_t> first(positions.size());
    Places places(positions, sameWithin(positions, indices));
    for (uint32_t vertex = 0; vertex < positions.size(); ++vertex) first[vertex] = places.of(vertex);
    return first;
}

namespace {

struct FloatBox {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    void add(const glm::vec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

/** Takes a box, rounded up, so that centre +- half holds all of it. */
void setBox(auto& part, const FloatBox& box) {
    part.centre = box.low + (box.high - box.low) / 2.0f;
    const glm::vec3 half = glm::max(box.high - part.centre, part.centre - box.low);
    for (int axis = 0; axis < 3; ++axis)
        part.half[axis] = std::nextafter(half[axis], std::numeric_limits<float>::infinity());
}

/** A vertex before joints move it: what the file has plus its morph targets. */
glm::dvec3 morphed(const auto& base, std::span<const MorphPose> morphs, const Deformation& deformation, size_t vertex,
                   std::vector<glm::vec3> MorphTarget::*list) {
    glm::dvec3 sum(base);
    for (size_t k = 0; k < morphs.size(); ++k) {
        const std::vector<glm::vec3>& added = deformation.targets[k].*list;
        if (morphs[k].weight != 0 && !added.empty()) sum += morphs[k].weight * glm::dvec3(added[vertex]);
    }
    return sum;
}

std::span<const JointShare> computeShares(const Deformation& deformation, size_t vertex) {
    if (deformation.share_begin.empty()) return {};
    const uint32_t begin = deformation.share_begin[vertex];
    return std::span(deformation.shares).subspan(begin, deformation.share_begin[vertex + 1] - begin);
}

/** The matrix that turns and stretches a vertex's surroundings; identity without a skin. */
glm::dmat3 computeLinear(const MeshPose& pose, const Deformation& deformation, size_t vertex) {
    const auto shares = computeShares(deformation, vertex);
    if (shares.empty()) return glm::dmat3(1);
    glm::dmat3 sum(0);
    for (const JointShare& share : shares)
        sum += static_cast<double>(share.weight) * glm::dmat3(pose.joints[share.joint].mesh_from_bind);
    return sum;
}

/** Squares of what is larger leave the range of float [m]. */
constexpr float max_coordinate = 1e15f;

bool isUsable(const glm::vec3& p) {
    return std::abs(p.x) < max_coordinate && std::abs(p.y) < max_coordinate && std::abs(p.z) < max_coordinate;
}

glm::vec3 unitOr(const glm::dvec3& vector, const glm::vec3& otherwise) {
    const double length = glm::length(vector);
    return std::isfinite(length) && length > 1e-12 ? glm::vec3(vector / length) : otherwise;
}

void posePositions(const MeshPose& pose, const Deformation& deformation, std::vector<glm::vec3>& positions) {
    for (size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 p = morphed(deformation.positions[i], pose.morphs, deformation, i, &MorphTarget::positions);
        const auto shares = computeShares(deformation, i);
        glm::dvec3 sum = shares.empty() ? p : glm::dvec3(0);
        for (const JointShare& share : shares)
            sum += static_cast<double>(share.weight) * (pose.joints[share.joint].mesh_from_bind * glm::dvec4(p, 1));
        const glm::vec3 posed(sum);
        positions[i] = isUsable(posed) ? posed : glm::vec3(0);
    }
}

/** Turns the frames of normal maps. */
void poseFrames(const MeshPose& pose, const Deformation& deformation, Mesh& mesh) {
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        const glm::dmat3 linear = computeLinear(pose, deformation, i);
        // Cofactors are the inverse transpose up to a factor, and are there for a flat matrix as well.
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const glm::dvec3 normal = morphed(deformation.normals[i], pose.morphs, deformation, i, &MorphTarget::normals);
        mesh.normals[i] = unitOr(cofactors * normal, deformation.normals[i]);
        if (mesh.tangents.empty()) continue;
        const glm::vec4& rest = deformation.tangents[i];
        const glm::dvec3 tangent = morphed(glm::vec3(rest), pose.morphs, deformation, i, &MorphTarget::tangents);
        mesh.tangents[i] = glm::vec4(unitOr(linear * tangent, glm::vec3(rest)), rest.w);
    }
}

}  // namespace

MeshPose getPose(const Snapshot& snapshot, const DeformedObject& deformed, const Deformation& deformation) {
    return {std::span(snapshot.joints).subspan(deformed.first_joint, deformation.joint_count),
            std::span(snapshot.morphs).subspan(deformed.first_morph, deformation.targets.size())};
}

bool deformsRightly(const Snapshot& snapshot) {
    int64_t last = -1;
    return std::ranges::all_of(snapshot.deformed, [&](const DeformedObject& one) {
        if (one.object >= snapshot.geometry->objects.size() || one.object <= last) return false;
        last = one.object;
        const auto mesh = static_cast<size_t>(snapshot.geometry->objects[one.object].mesh);
        const auto& deformation = snapshot.geometry->meshes[mesh].deformation;
        return deformation && size_t{one.first_joint} + deformation->joint_count <= snapshot.joints.size() &&
               one.first_morph + deformation->targets.size() <= snapshot.morphs.size();
    });
}

void boundClusters(Mesh& mesh) {
    for (Cluster& cluster : mesh.clusters) {
        FloatBox box;
        for (const uint32_t index : std::span(mesh.indices).subspan(cluster.first_index, cluster.index_count))
            box.add(mesh.positions[index]);
        setBox(cluster, box);
    }
    for (ClusterNode& node : mesh.cluster_nodes) {
        FloatBox box;
        for (const Cluster& cluster : std::span(mesh.clusters).subspan(node.first_cluster, node.cluster_count)) {
            box.add(cluster.centre - cluster.half);
            box.add(cluster.centre + cluster.half);
        }
        setBox(node, box);
    }
}

void poseMesh(const MeshPose& pose, Mesh& mesh) {
    const Deformation& deformation = *mesh.deformation;
    posePositions(pose, deformation, mesh.positions);
    poseFrames(pose, deformation, mesh);
    boundClusters(mesh);
}

void computeVelocities(const MeshPose& pose, const Deformation& deformation, std::vector<glm::vec3>& velocities) {
    velocities.resize(deformation.positions.size());
    for (size_t i = 0; i < velocities.size(); ++i) {
        const glm::dvec3 p = morphed(deformation.positions[i], pose.morphs, deformation, i, &MorphTarget::positions);
        glm::dvec3 rate(0);
        for (size_t k = 0; k < pose.morphs.size(); ++k) {
            const std::vector<glm::vec3>& added = deformation.targets[k].positions;
            if (pose.morphs[k].rate != 0 && !added.empty()) rate += pose.morphs[k].rate * glm::dvec3(added[i]);
        }
        const auto shares = computeShares(deformation, i);
        glm::dvec3 sum = shares.empty() ? rate : glm::dvec3(0);
        for (const JointShare& share : shares) {
            const JointPose& joint = pose.joints[share.joint];
            sum += static_cast<double>(share.weight) *
                   (joint.rate * glm::dvec4(p, 1) + joint.mesh_from_bind * glm::dvec4(rate, 0));
        }
        velocities[i] = glm::vec3(sum);
    }
}

GeometryPtr posedGeometry(const Snapshot& snapshot) {
    if (snapshot.deformed.empty()) return snapshot.geometry;
    auto geometry = std::make_shared<Geometry>(*snapshot.geometry);
    for (const DeformedObject& deformed : snapshot.deformed) {
        Object& object = geometry->objects[deformed.object];
        Mesh mesh = snapshot.geometry->meshes[static_cast<size_t>(object.mesh)];
        poseMesh(getPose(snapshot, deformed, *mesh.deformation), mesh);
        object.mesh = static_cast<int>(geometry->meshes.size());
        geometry->meshes.push_back(std::move(mesh));
    }
    return geometry;
}

}  // namespace insonify::types
