#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "components/scene/Scene.hpp"
#include "types/Angle.hpp"

namespace insonify::scene {
namespace {

double largest(const glm::vec3& v) { return static_cast<double>(std::max({v.x, v.y, v.z})); }

/** Returns by how much the normal of a triangle turns if its corners move by one step [rad]. */
double tiltOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double step, double& area) {
    area = glm::length(glm::cross(b - a, c - a)) / 2;
    const double base = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    return std::atan2(step * base, 2 * area);
}

}  // namespace

std::optional<VertexRounding> roundingOf(const types::Mesh& mesh) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const types::Cluster& cluster : mesh.clusters) {
        low = glm::min(low, cluster.centre - cluster.half);
        high = glm::max(high, cluster.centre + cluster.half);
    }
    VertexRounding rounding;
    rounding.farthest = largest(glm::max(glm::abs(low), glm::abs(high)));
    if (mesh.indices.empty() || rounding.farthest < 2 * largest(high - low)) return {};  // two bits are too few
    const auto farthest = static_cast<float>(rounding.farthest);
    rounding.step = static_cast<double>(std::nextafter(farthest, std::numeric_limits<float>::max()) - farthest);
    double all = 0, off = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        double area = 0;
        const double tilt = tiltOf(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                                   mesh.positions[mesh.indices[i + 2]], rounding.step, area);
        all += area;
        if (tilt < VertexRounding::max_tilt) continue;
        off += area;
        rounding.tilt = std::max(rounding.tilt, tilt);
    }
    rounding.share = all > 0 ? off / all : 0;
    if (!(rounding.share > VertexRounding::max_share)) return {};
    return rounding;
}

namespace {

/** Returns a warning that names the objects with rounded meshes; none: there are none. */
std::optional<types::Notice> roundingNotice(const types::Geometry& geometry) {
    constexpr size_t shown = 5;
    std::vector<std::optional<VertexRounding>> known(geometry.meshes.size());
    for (size_t i = 0; i < known.size(); ++i) known[i] = roundingOf(geometry.meshes[i]);
    std::vector<std::string> names;
    VertexRounding worst;
    for (const types::Object& object : geometry.objects) {
        const auto& rounding = known[static_cast<size_t>(object.mesh)];
        if (!rounding) continue;
        names.push_back(object.name);
        if (rounding->tilt * rounding->share > worst.tilt * worst.share) worst = *rounding;
    }
    if (names.empty()) return {};
    const size_t more = names.size() - std::min(shown, names.size());
    names.resize(names.size() - more);
    return types::warning(fmt::format(
        "vertices far from the origin of their own mesh have coarse coordinates, which turns small triangles "
        "and changes their echoes: {}{}, up to {:.4g} m away in steps of {:.2g} mm: {:.3g} % of the surface is turned "
        "by up to {:.2g} deg; keep vertices near the origin of the file, and place the object by its node, its link "
        "or `placement`",
        fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "", worst.farthest, 1e3 * worst.step,
        100 * worst.share, types::degrees(worst.tilt)));
}

}  // namespace

void noteRounding(types::GeometryPtr& geometry) {
    auto notice = roundingNotice(*geometry);
    if (!notice) return;
    auto noted = std::make_shared<types::Geometry>(*geometry);
    noted->notices.push_back(std::move(*notice));
    geometry = std::move(noted);
}

}  // namespace insonify::scene
