#include "components/sonar/surfaces/MeshFacts.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "components/sonar/surfaces/FacetLobes.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Max corners of a mesh that is searched without its clusters [1]. */
constexpr size_t max_corners = 4096;
/** Max triangles that are evaluated individually; the rest is approximated by a box [1]. */
constexpr uint32_t max_triangles = 4096;

constexpr uint32_t at_once = 16;  ///< Triangles whose data fit the nearest cache.

/** Corners of triangles from the sonar [m]. */
struct Corners {
    float x[3][at_once], y[3][at_once], z[3][at_once];
};

/** Returns the square of the distance to the line segment from `p` to `p + d`. */
inline float toEdge(float px, float py, float pz, float dx, float dy, float dz) {
    const float length2 = dx * dx + dy * dy + dz * dz, along = -(px * dx + py * dy + pz * dz);
    const float t = length2 > 0 ? std::min(std::max(along / length2, 0.0f), 1.0f) : 0.0f;
    const float x = px + t * dx, y = py + t * dy, z = pz + t * dz;
    return x * x + y * y + z * z;
}

/** Computes the square of the distance to each triangle: to its plane where the foot of the perpendicular is inside it,
 *  else to the nearest of its edges. */
INSONIFY_VECTOR_CLONES void nearest2(const Corners& c, float (&distance2)[at_once]) {
    for (uint32_t i = 0; i < at_once; ++i) {
        const float ax = c.x[0][i], ay = c.y[0][i], az = c.z[0][i], bx = c.x[1][i], by = c.y[1][i], bz = c.z[1][i],
                    cx = c.x[2][i], cy = c.y[2][i], cz = c.z[2][i];
        const float ux = bx - ax, uy = by - ay, uz = bz - az, vx = cx - ax, vy = cy - ay, vz = cz - az;
        const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        const float n2 = nx * nx + ny * ny + nz * nz, height = ax * nx + ay * ny + az * nz;
        // Signs of the volumes between the origin, the normal and each edge.
        const auto side = [&](float px, float py, float pz, float qx, float qy, float qz) {
            return nx * (py * qz - pz * qy) + ny * (pz * qx - px * qz) + nz * (px * qy - py * qx);
        };
        const float ab = side(ax, ay, az, bx, by, bz), bc = side(bx, by, bz, cx, cy, cz),
                    ca = side(cx, cy, cz, ax, ay, az);
        const float to_edges = std::min(std::min(toEdge(ax, ay, az, ux, uy, uz), toEdge(ax, ay, az, vx, vy, vz)),
                                        toEdge(bx, by, bz, cx - bx, cy - by, cz - bz));
        const bool within = n2 > 0 && ab >= 0 && bc >= 0 && ca >= 0;
        distance2[i] = within ? std::min(height * height / n2, to_edges) : to_edges;
    }
}

/** Finds the nearest and the farthest point in the boxes that may contain them. */
class Search {
public:
    Search(const types::Mesh& mesh, const glm::dmat4& sonar_from_mesh)
        : mesh_(mesh),
          linear_(glm::dmat3(sonar_from_mesh)),
          eye_(-(glm::inverse(glm::dmat3(sonar_from_mesh)) * glm::dvec3(sonar_from_mesh[3]))) {}

    /** For a mesh of few corners. Omits triangles whose corners are all clearly farther than the nearest corner. No
     *  point of a triangle is farther from all its corners than its longest edge over the root of 3. */
    MeshDistances byCorners(double longest_edge, std::vector<float>& corners2) {
        corners2.clear();
        for (const glm::vec3& p : mesh_.positions) {
            const glm::vec3 at = fromSonar(p);
            corners2.push_back(glm::dot(at, at));
        }
        const double scale2 = static_cast<double>(glm::dot(linear_[0], linear_[0]) + glm::dot(linear_[1], linear_[1]) +
                                                  glm::dot(linear_[2], linear_[2]));
        const auto within2 = static_cast<float>(longest_edge * longest_edge * scale2 / 3);
        const float limit2 = 1.00001f * (*std::ranges::min_element(corners2) + within2);
        for (uint32_t i = 0; i < mesh_.indices.size(); i += 3) {
            const uint32_t* corner = &mesh_.indices[i];
            if (std::min({corners2[corner[0]], corners2[corner[1]], corners2[corner[2]]}) <= limit2) look(i);
        }
        lookAtWaiting();
        if (!std::isfinite(found_)) return {};
        return {static_cast<double>(found_), std::sqrt(static_cast<double>(*std::ranges::max_element(corners2)))};
    }

    double farthest() const {
        const types::Cluster* first = nullptr;
        float maximum = -1;
        forEachFarther([&](const types::Cluster& cluster, float at_most) {
            if (at_most > maximum) maximum = at_most, first = &cluster;
            return maximum;
        });
        if (!first) return 0;
        float found = farthestIn(*first);
        uint32_t looked_at = 0;
        forEachFarther([&](const types::Cluster& cluster, float at_most) {
            if (at_most <= found || &cluster == first) return found;
            looked_at += cluster.index_count / 3;
            found = looked_at > max_triangles ? at_most : std::max(found, farthestIn(cluster));
            return found;
        });
        return static_cast<double>(found);
    }

    double nearest() {
        const types::Cluster* first = nullptr;
        float minimum = std::numeric_limits<float>::infinity();
        forEachCluster([&](const types::Cluster& cluster, float at_least) {
            if (at_least < minimum) minimum = at_least, first = &cluster;
            return minimum;
        });
        if (!first) return 0;
        look(*first);
        uint32_t looked_at = 0;
        forEachCluster([&](const types::Cluster& cluster, float at_least) {
            if (at_least >= found_ || &cluster == first) return found_;
            looked_at += cluster.index_count / 3;
            if (looked_at > max_triangles)
                found_ = std::max(at_least, 0.0f);
            else
                look(cluster);
            return found_;
        });
        return static_cast<double>(found_);
    }

private:
    /** Calls nearer = use(cluster, lower bound of its distance), except for clusters in patches that are no nearer. */
    void forEachCluster(const auto& use) const {
        float nearer = std::numeric_limits<float>::infinity();
        const auto useAll = [&](std::span<const types::Cluster> clusters) {
            for (const types::Cluster& cluster : clusters) nearer = use(cluster, atLeast(cluster.centre, cluster.half));
        };
        if (mesh_.cluster_nodes.empty()) return useAll(mesh_.clusters);
        for (size_t i = 0; i < mesh_.cluster_nodes.size();) {
            const types::ClusterNode& node = mesh_.cluster_nodes[i];
            if (atLeast(node.centre, node.half) >= nearer)
                i = node.next;
            else if (++i == node.next)
                useAll(std::span(mesh_.clusters).subspan(node.first_cluster, node.cluster_count));
        }
    }

    glm::vec3 fromSonar(const glm::vec3& p) const { return linear_ * glm::vec3(glm::dvec3(p) - eye_); }

    /** Returns a lower bound of the distance to a box along the mesh's axes. */
    float atLeast(const glm::vec3& centre, const glm::vec3& half) const {
        const glm::vec3 at = fromSonar(centre);
        const float distance = glm::length(at);
        if (!(distance > 0)) return 0;
        return distance - glm::dot(glm::abs(at / distance * linear_), half);
    }

    /** Calls farther = use(cluster, upper bound of its distance), except for clusters in patches that are no farther.
     */
    void forEachFarther(const auto& use) const {
        float farther = -1;
        const auto useAll = [&](std::span<const types::Cluster> clusters) {
            for (const types::Cluster& cluster : clusters) farther = use(cluster, atMost(cluster.centre, cluster.half));
        };
        if (mesh_.cluster_nodes.empty()) return useAll(mesh_.clusters);
        for (size_t i = 0; i < mesh_.cluster_nodes.size();) {
            const types::ClusterNode& node = mesh_.cluster_nodes[i];
            if (atMost(node.centre, node.half) <= farther)
                i = node.next;
            else if (++i == node.next)
                useAll(std::span(mesh_.clusters).subspan(node.first_cluster, node.cluster_count));
        }
    }

    /** Returns the distance to the farthest corner of a box along the mesh's axes. */
    float atMost(const glm::vec3& centre, const glm::vec3& half) const {
        const glm::vec3 at = fromSonar(centre), u = linear_[0] * half.x, v = linear_[1] * half.y,
                        w = linear_[2] * half.z;
        float most2 = 0;
        for (const glm::vec3& edge : {u + v, u - v, v - u, -u - v})
            for (const glm::vec3& corner : {at + edge + w, at + edge - w})
                most2 = std::max(most2, glm::dot(corner, corner));
        return std::sqrt(most2);
    }

    float farthestIn(const types::Cluster& cluster) const {
        float most2 = 0;
        for (uint32_t i = 0; i < cluster.index_count; ++i) {
            const glm::vec3 at = fromSonar(mesh_.positions[mesh_.indices[cluster.first_index + i]]);
            most2 = std::max(most2, glm::dot(at, at));
        }
        return std::sqrt(most2);
    }

    void look(const types::Cluster& cluster) {
        for (uint32_t i = 0; i < cluster.index_count; i += 3) look(cluster.first_index + i);
        lookAtWaiting();
    }

    /** Queues a triangle; evaluates the queue when it is full. */
    void look(uint32_t first_index) {
        for (uint32_t k = 0; k < 3; ++k) {
            const glm::vec3 p = fromSonar(mesh_.positions[mesh_.indices[first_index + k]]);
            corners_.x[k][waiting_] = p.x, corners_.y[k][waiting_] = p.y, corners_.z[k][waiting_] = p.z;
        }
        if (++waiting_ == at_once) lookAtWaiting();
    }

    void lookAtWaiting() {
        float distance2[at_once];
        nearest2(corners_, distance2);
        const uint32_t count = std::exchange(waiting_, 0);
        for (uint32_t i = 0; i < count; ++i) found_ = std::min(found_, std::sqrt(distance2[i]));
    }

    const types::Mesh& mesh_;
    glm::mat3 linear_;
    glm::dvec3 eye_;  ///< The sonar in the mesh's axes [m].
    Corners corners_{};
    uint32_t waiting_ = 0;
    float found_ = std::numeric_limits<float>::infinity();
};

}  // namespace

double longestEdge(const types::Mesh& mesh) {
    float longest2 = 0;
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        const glm::vec3 edge =
            mesh.positions[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]] - mesh.positions[mesh.indices[i]];
        longest2 = std::max(longest2, glm::dot(edge, edge));
    }
    return std::sqrt(static_cast<double>(longest2));
}

MeshDistances distancesTo(const types::Mesh& mesh, double longest_edge, const glm::dmat4& sonar_from_mesh,
                          std::vector<float>& scratch) {
    Search search(mesh, sonar_from_mesh);
    const bool few = mesh.positions.size() <= max_corners && !mesh.positions.empty();
    if (few) return search.byCorners(longest_edge, scratch);
    const double nearest = search.nearest();
    return {nearest, search.farthest()};
}

namespace {

/** Returns the plane of a triangle. A triangle without area has no normal, and thus no echo. The point is that of the
 *  plane nearest to the origin within the triangle's reach. Even on a huge triangle it is close to the visible part, if
 *  that is close to the origin. */
PlaneRecord makePlane(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 across = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
    if (!(glm::length(across) > 0)) return {vec4(0), vec4(0)};
    const glm::dvec3 normal = glm::normalize(across), way = normal * glm::dot(normal, middle) - middle;
    const double reach = glm::distance(middle, a), length = glm::length(way);
    const glm::vec3 point(length > reach ? middle + way * (reach / length) : middle + way);
    return {vec4(glm::vec3(normal), static_cast<float>(glm::dot(normal, a - glm::dvec3(point)))), vec4(point, 0)};
}

std::vector<Box> leaves(const types::Mesh& mesh) {
    constexpr size_t leaf = 3 * MeshFacts::leaf_triangles;
    std::vector<Box> boxes((mesh.indices.size() + leaf - 1) / leaf);
    for (size_t i = 0; i < mesh.indices.size(); ++i) boxes[i / leaf].add(mesh.positions[mesh.indices[i]]);
    for (Box& box : boxes) {  // meetTriangle accepts hits slightly beyond the edges
        const glm::dvec3 slack = 1e-9 * (glm::max(glm::abs(box.low), glm::abs(box.high)) + box.half());
        box.low -= slack, box.high += slack;
    }
    return boxes;
}

Box makeBox(const types::Mesh& mesh) {
    Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
    for (const glm::vec3& p : mesh.positions) box.add(p);
    return box;
}

std::vector<float> computeMapDensity(const types::Mesh& mesh) {
    std::vector<float> all;
    all.reserve(mesh.indices.size() / 3);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t* const corners = &mesh.indices[i];
        const glm::dvec3 a = mesh.positions[corners[0]];
        const glm::dvec2 uv = mesh.uvs[corners[0]];
        const glm::dvec2 to_b = glm::dvec2(mesh.uvs[corners[1]]) - uv, to_c = glm::dvec2(mesh.uvs[corners[2]]) - uv;
        const double area = glm::length(
            glm::cross(glm::dvec3(mesh.positions[corners[1]]) - a, glm::dvec3(mesh.positions[corners[2]]) - a));
        const double covered = std::abs(to_b.x * to_c.y - to_b.y * to_c.x);
        all.push_back(area > 0 ? static_cast<float>(std::sqrt(covered / area)) : 0.0f);
    }
    return all;
}

}  // namespace

std::vector<PlaneRecord> extractPlanes(const types::Mesh& mesh) {
    std::vector<PlaneRecord> planes(mesh.indices.size() / 3);
    findPlanes(mesh, planes);
    return planes;
}

/** Some triangles at a time, in vector registers, with the same operations in the same order as makePlane(). */
INSONIFY_VECTOR_CLONES void findPlanes(const types::Mesh& mesh, std::span<PlaneRecord> planes) {
    constexpr size_t at_once = 16;
    double a[3][at_once], b[3][at_once], c[3][at_once], normal[3][at_once], point[3][at_once], squares[at_once];
    const size_t whole = planes.size() / at_once * at_once;
    for (size_t first = 0; first < whole; first += at_once) {
        const uint32_t* const corners = &mesh.indices[3 * first];
        for (size_t i = 0; i < at_once; ++i) {
            const glm::vec3 &p = mesh.positions[corners[3 * i]], &q = mesh.positions[corners[3 * i + 1]],
                            &r = mesh.positions[corners[3 * i + 2]];
            a[0][i] = p.x, a[1][i] = p.y, a[2][i] = p.z;
            b[0][i] = q.x, b[1][i] = q.y, b[2][i] = q.z;
            c[0][i] = r.x, c[1][i] = r.y, c[2][i] = r.z;
        }
        for (size_t i = 0; i < at_once; ++i) {
            const double ux = b[0][i] - a[0][i], uy = b[1][i] - a[1][i], uz = b[2][i] - a[2][i];
            const double vx = c[0][i] - a[0][i], vy = c[1][i] - a[1][i], vz = c[2][i] - a[2][i];
            const double x = uy * vz - vy * uz, y = uz * vx - vz * ux, z = ux * vy - vx * uy;
            const double square = x * x + y * y + z * z;
            squares[i] = square;
            const double per_length = 1.0 / std::sqrt(square);
            const double nx = x * per_length, ny = y * per_length, nz = z * per_length;
            const double mx = (a[0][i] + b[0][i] + c[0][i]) / 3.0, my = (a[1][i] + b[1][i] + c[1][i]) / 3.0,
                         mz = (a[2][i] + b[2][i] + c[2][i]) / 3.0;
            const double height = nx * mx + ny * my + nz * mz;
            const double wx = nx * height - mx, wy = ny * height - my, wz = nz * height - mz;
            const double rx = a[0][i] - mx, ry = a[1][i] - my, rz = a[2][i] - mz;
            const double reach = std::sqrt(rx * rx + ry * ry + rz * rz),
                         length = std::sqrt(wx * wx + wy * wy + wz * wz);
            const double share = length > reach ? reach / length : 1.0;
            normal[0][i] = nx, normal[1][i] = ny, normal[2][i] = nz;
            point[0][i] = mx + wx * share, point[1][i] = my + wy * share, point[2][i] = mz + wz * share;
        }
        for (size_t i = 0; i < at_once; ++i) {
            const glm::vec3 at(point[0][i], point[1][i], point[2][i]);
            const double ox = a[0][i] - double{at.x}, oy = a[1][i] - double{at.y}, oz = a[2][i] - double{at.z};
            const double offset = normal[0][i] * ox + normal[1][i] * oy + normal[2][i] * oz;
            planes[first + i] = {vec4(glm::vec3(normal[0][i], normal[1][i], normal[2][i]), static_cast<float>(offset)),
                                 vec4(at, 0)};
        }
        for (size_t i = 0; i < at_once; ++i)
            if (!(squares[i] > 0)) planes[first + i] = {vec4(0), vec4(0)};
    }
    for (size_t t = whole; t < planes.size(); ++t) {
        const uint32_t* const corners = &mesh.indices[3 * t];
        planes[t] = makePlane(mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]);
    }
}

std::vector<PlaneRecord> extractPlanes(const types::Geometry& geometry) {
    std::vector<PlaneRecord> planes;
    for (const types::Mesh& mesh : geometry.meshes) {
        const std::vector<PlaneRecord> added = extractPlanes(mesh);
        planes.insert(planes.end(), added.begin(), added.end());
    }
    return planes;
}

std::shared_ptr<MeshFacts> MeshFacts::of(const types::MeshPtr& mesh) {
    static auto& all = *new SharedValues<const types::Mesh*, MeshFacts>;  // threads may use it until the process ends
    return all.of(mesh.get(), [&] { return std::make_shared<MeshFacts>(mesh); });
}

std::vector<std::shared_ptr<MeshFacts>> MeshFacts::ofAll(const types::Geometry& geometry) {
    std::vector<std::shared_ptr<MeshFacts>> all;
    for (size_t i = 0; i < geometry.meshes.size(); ++i) all.push_back(of(geometry.meshes.shared(i)));
    return all;
}

void MeshFacts::renew() {
    box_.renew([this](Box& box) { box = makeBox(*mesh_); });
    longest_edge_.renew([this](double& longest) { longest = sonar::longestEdge(*mesh_); });
    triangles_.renew([this](BoxTree& tree) { tree.refit(leaves(*mesh_)); });
    planes_.renew([this](const std::shared_ptr<std::vector<PlaneRecord>>& planes) { findPlanes(*mesh_, *planes); });
    map_density_.renew([this](std::vector<float>& density) { density = computeMapDensity(*mesh_); });
}

const Box& MeshFacts::box() {
    return box_.get([this] { return makeBox(*mesh_); });
}

double MeshFacts::longestEdge() {
    return longest_edge_.get([this] { return sonar::longestEdge(*mesh_); });
}

const BoxTree& MeshFacts::triangles() {
    return triangles_.get([this] { return BoxTree(leaves(*mesh_)); });
}

MeshFacts::Planes MeshFacts::planes() {
    return planes_.get([this] { return std::make_shared<std::vector<PlaneRecord>>(extractPlanes(*mesh_)); });
}

const std::vector<float>& MeshFacts::mapDensity() {
    return map_density_.get([this] { return computeMapDensity(*mesh_); });
}

MeshFacts::Facets MeshFacts::facets(const glm::dmat3& world_from_mesh, const MaterialLaws& laws) {
    if (!hasLobes(*mesh_, laws)) return nullptr;
    const double wavelength = laws.wavelength.value_or(0);
    std::array<double, 11> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    key[9] = wavelength;
    key[10] = laws.sharp_turn.value_or(0);
    const Edges edges = laws.sharp_turn ? this->edges(world_from_mesh, laws, *laws.sharp_turn) : nullptr;
    return facets_.of(key, [&] {
        return std::make_shared<const std::vector<FacetRecord>>(
            facetLobes(*mesh_, world_from_mesh, wavelength, edges.get()));
    });
}

MeshFacts::Facets MeshFacts::facetsNow(const types::Mesh& mesh, const glm::dmat3& world_from_mesh,
                                       const MaterialLaws& laws) {
    if (!hasLobes(mesh, laws)) return nullptr;
    std::optional<StraightEdges> edges;
    if (laws.sharp_turn) edges = straightEdges(mesh, world_from_mesh, *laws.sharp_turn);
    return std::make_shared<const std::vector<FacetRecord>>(
        facetLobes(mesh, world_from_mesh, laws.wavelength.value_or(0), edges ? &*edges : nullptr));
}

MeshFacts::Curves MeshFacts::curves(const glm::dmat3& world_from_mesh) {
    std::array<double, 9> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    return curves_.of(
        key, [&] { return std::make_shared<const std::vector<CurveRecord>>(facetCurves(*mesh_, world_from_mesh)); });
}

MeshFacts::Edges MeshFacts::edges(const glm::dmat3& world_from_mesh, const MaterialLaws& laws, double min_turn) {
    if (!hasLobes(*mesh_, laws)) return nullptr;
    std::array<double, 10> key{};
    std::copy_n(&world_from_mesh[0].x, 9, key.begin());
    key[9] = min_turn;
    return edges_.of(
        key, [&] { return std::make_shared<const StraightEdges>(straightEdges(*mesh_, world_from_mesh, min_turn)); });
}

}  // namespace insonify::sonar
