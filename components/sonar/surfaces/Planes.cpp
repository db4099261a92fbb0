#include "components/sonar/surfaces/Planes.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "types/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Returns the plane of a triangle. A triangle without area has no normal, and thus no echo. The point is that of the
 *  plane nearest to the origin within the triangle's reach. Even on a huge triangle it is close to the visible part, if
 *  that is close to the origin. */
PlaneRecord planeOf(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 across = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
    if (!(glm::length(across) > 0)) return {vec4(0), vec4(0)};
    const glm::dvec3 normal = glm::normalize(across), way = normal * glm::dot(normal, middle) - middle;
    const double reach = glm::distance(middle, a), length = glm::length(way);
    const glm::vec3 point(length > reach ? middle + way * (reach / length) : middle + way);
    return {vec4(glm::vec3(normal), static_cast<float>(glm::dot(normal, a - glm::dvec3(point)))), vec4(point, 0)};
}

}  // namespace

std::vector<PlaneRecord> planesOf(const types::Mesh& mesh) {
    std::vector<PlaneRecord> planes(mesh.indices.size() / 3);
    findPlanes(mesh, planes);
    return planes;
}

/** Some triangles at a time, in vector registers, with the same operations in the same order as planeOf(). */
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
        planes[t] = planeOf(mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]);
    }
}

std::vector<PlaneRecord> planesOf(const types::Geometry& geometry) {
    std::vector<PlaneRecord> planes;
    for (const types::Mesh& mesh : geometry.meshes) {
        const std::vector<PlaneRecord> added = planesOf(mesh);
        planes.insert(planes.end(), added.begin(), added.end());
    }
    return planes;
}

}  // namespace insonify::sonar
