#include "components/meshes/WorldBuilder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stb_image.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "components/meshes/MeshFile.hpp"
#include "components/scene/Placement.hpp"
#include "components/scene/Surface.hpp"
#include "components/scene/SurfaceMaps.hpp"

namespace insonify::meshes {

using namespace scene;
namespace {

constexpr uint32_t facets = 64;

/** Revolves a profile of (radius, z), from the bottom up, about z. */
Surface revolve(const std::vector<glm::dvec2>& profile) {
    Surface surface;
    for (const glm::dvec2 point : profile)
        for (uint32_t k = 0; k < facets; ++k) {
            const double angle = 2 * std::numbers::pi * k / facets;
            surface.positions.emplace_back(point.x * std::cos(angle), point.x * std::sin(angle), point.y);
        }
    for (uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (uint32_t k = 0; k < facets; ++k) {
            const uint32_t a = ring * facets + k, b = ring * facets + (k + 1) % facets;
            const uint32_t c = b + facets, d = a + facets;
            if (profile[ring].x > 0) surface.indices.insert(surface.indices.end(), {a, b, c});
            if (profile[ring + 1].x > 0) surface.indices.insert(surface.indices.end(), {a, c, d});
        }
    return surface;
}

/** Adds half of a sphere's outline about (0, z): the lower half from its pole, or the upper half to its pole. */
void addQuarter(std::vector<glm::dvec2>& profile, double radius, double z, bool is_upper) {
    constexpr uint32_t steps = facets / 4;
    for (uint32_t i = 0; i <= steps; ++i) {
        const double elevation = std::numbers::pi / 2 * (is_upper ? i : steps - i) / steps;
        const bool is_pole = i == (is_upper ? steps : 0);
        profile.emplace_back(is_pole ? 0 : radius * std::cos(elevation),
                             z + (is_upper ? 1 : -1) * radius * std::sin(elevation));
    }
}

constexpr int max_picture_side = 32768;  ///< Max side of pictures, checked before they are decoded [pixels].
constexpr int max_corners = 2049;        ///< Max vertices along each side.

/** Returns the pixels of one side that become vertices: evenly spaced, including both ends. */
std::vector<int> getCorners(int pixels) {
    const int count = std::min(pixels, max_corners);
    std::vector<int> corners;
    for (int i = 0; i < count; ++i) corners.push_back(static_cast<int>(int64_t{i} * (pixels - 1) / (count - 1)));
    return corners;
}

bool isRead(const std::filesystem::path& file) {
    std::string begin(picture_mark_size, '\0');
    std::ifstream(file, std::ios::binary).read(begin.data(), picture_mark_size);
    return isPngOrJpeg(begin) || begin.starts_with("P5");
}

}  // namespace

Surface unitBox() {
    Surface surface;
    for (int i = 0; i < 8; ++i)
        surface.positions.emplace_back(i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f);
    surface.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return surface;
}

Surface unitPlane() {
    Surface surface;
    surface.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    surface.indices = {0, 1, 2, 0, 2, 3};
    return surface;
}

Surface unitSphere() { return capsule(1, 0); }

Surface unitCylinder() { return revolve({{0, -0.5}, {1, -0.5}, {1, 0.5}, {0, 0.5}}); }

Surface unitCone() { return revolve({{0, -0.5}, {1, -0.5}, {0, 0.5}}); }

Surface capsule(double radius, double length) {
    std::vector<glm::dvec2> profile;
    addQuarter(profile, radius, -length / 2, false);
    if (length == 0) profile.pop_back();
    addQuarter(profile, radius, length / 2, true);
    return revolve(profile);
}

Surface readHeightmap(const std::filesystem::path& file, glm::dvec3 size) {
    int width = 0, height = 0, channels = 0;
    if (!isRead(file) || !stbi_info(file.c_str(), &width, &height, &channels))
        throw std::runtime_error("is neither PNG nor JPEG nor PGM");
    if (width < 2 || height < 2 || width > max_picture_side || height > max_picture_side)
        throw std::runtime_error(
            fmt::format("has {} x {} pixels; may have 2 to {} a side", width, height, max_picture_side));
    const std::unique_ptr<stbi_us, decltype(&stbi_image_free)> pixels(
        stbi_load_16(file.c_str(), &width, &height, &channels, 1), stbi_image_free);
    if (!pixels) throw std::runtime_error(fmt::format("is damaged ({})", stbi_failure_reason()));

    const std::vector<int> columns = getCorners(width), rows = getCorners(height);
    Surface surface;
    for (const int row : rows)
        for (const int column : columns) {
            const double value = pixels.get()[size_t(row) * size_t(width) + size_t(column)] / 65535.0;
            surface.positions.emplace_back(
                size * glm::dvec3(double(column) / (width - 1) - 0.5, 0.5 - double(row) / (height - 1), value));
        }
    forEachCell(columns.size(), rows.size(), [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        surface.indices.insert(surface.indices.end(), {a, c, d, a, d, b});
    });
    return surface;
}

using namespace scene;
namespace {

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

Placing scaled(Placing placing, glm::dvec3 size) {
    placing.visual_from_object = glm::scale(placing.visual_from_object, size);
    return placing;
}

/** Turns a square's normal from z by the shortest rotation. */
Placing turnedTo(Placing placing, glm::dvec3 normal) {
    const double length = glm::length(normal);
    if (!(length > 0)) return placing;
    const glm::dvec3 up(0, 0, 1), to = normal / length;
    const bool is_opposite = glm::dot(up, to) < -1 + 1e-12;
    const glm::dquat turn =
        is_opposite ? glm::dquat(0, 1, 0, 0) : glm::normalize(glm::dquat(1 + glm::dot(up, to), glm::cross(up, to)));
    placing.visual_from_object = glm::mat4_cast(turn);
    return placing;
}

std::string leftOutText(const std::vector<std::string>& visuals, const std::string& why) {
    constexpr size_t named = 3;
    if (visuals.size() == 1) return fmt::format("visual {} is omitted: {}", visuals.front(), why);
    const std::vector<std::string> first(visuals.begin(),
                                         visuals.begin() + static_cast<ptrdiff_t>(std::min(visuals.size(), named)));
    const std::string others = visuals.size() > named ? fmt::format(" and {} more", visuals.size() - named) : "";
    return fmt::format("{} visuals are omitted: {} ({}{})", visuals.size(), why, fmt::join(first, ", "), others);
}

}  // namespace

types::Diagnostic findFault(const Shape& shape) {
    const auto checked = [](const char* key, std::initializer_list<double> sizes) {
        for (const double size : sizes)
            if (!(size >= 0)) return types::Diagnostic{key, fmt::format("is {}; must not be negative", size)};
        return types::Diagnostic{};
    };
    return std::visit(
        Overloaded{
            [&](const BoxShape& box) {
                return checked("size", {box.size.x, box.size.y, box.size.z});
            },
            [&](const EllipsoidShape& ball) {
                return checked(ball.is_sphere ? "radius" : "radii", {ball.radii.x, ball.radii.y, ball.radii.z});
            },
            [&](const CylinderShape& c) {
                return checked("radius, length", {c.radius, c.length});
            },
            [&](const ConeShape& c) {
                return checked("radius, length", {c.radius, c.length});
            },
            [&](const CapsuleShape& c) {
                return checked("radius, length", {c.radius, c.length});
            },
            [&](const auto&) { return types::Diagnostic{}; },
        },
        shape);
}

int WorldBuilder::addNode(const std::string& name, int parent, const glm::dmat4& world_from_node) {
    const glm::dmat4 parent_from_world = parent < 0 ? glm::dmat4(1) : glm::inverse(worldFromNode(parent));
    scene_.nodes.push_back({names_.add(name), parent, parent_from_world * world_from_node, glm::dvec3(1)});
    world_from_node_.push_back(world_from_node);
    return static_cast<int>(scene_.nodes.size()) - 1;
}

void WorldBuilder::addVisual(const std::string& name, int node, const glm::dmat4& node_from_visual, const Shape& shape,
                             const Look& look, const Drawing& drawing) {
    for (const Placing& placing : getPlacings(name, shape, look)) {
        const glm::dmat4 node_from_object = node_from_visual * placing.visual_from_object;
        const glm::dmat4 world_from_object = worldFromNode(node) * node_from_object;
        if (!isFinite(world_from_object) || glm::determinant(glm::dmat3(node_from_object)) == 0) {
            ++flat_visuals_;
            continue;
        }
        geometry_.objects.push_back({object_names_.add(name), placing.mesh, world_from_object});
        scene_.object_nodes.push_back(node);
        scene_.node_from_object.push_back(node_from_object);
        scene_.drawings.push_back(drawing);
    }
}

void WorldBuilder::leaveOut(const std::string& visual, const std::string& why) {
    LeftOut& with_reason = left_out_[why];
    if (with_reason.visuals.empty()) {
        with_reason.notice = geometry_.notices.size();
        notice("");
    }
    with_reason.visuals.push_back(visual);
    geometry_.notices[with_reason.notice].text = leftOutText(with_reason.visuals, why);
}

Scene WorldBuilder::take() {
    for (const std::string& where : searched_) notice(where);
    addCount(flat_visuals_, "visuals omitted, their size is zero in some direction or not finite", geometry_.notices);
    if (geometry_.objects.empty()) notice("the scene has no triangles: an empty sea");
    scene_.geometry = std::make_shared<const types::Geometry>(std::move(geometry_));
    return std::move(scene_);
}

std::vector<Placing> WorldBuilder::getPlacings(const std::string& name, const Shape& shape, const Look& look) {
    using Placings = std::vector<Placing>;
    return std::visit(
        Overloaded{
            [&](const BoxShape& box) -> Placings { return {scaled(meshes_.shape("box", look, unitBox), box.size)}; },
            [&](const EllipsoidShape& ball) -> Placings {
                return {scaled(meshes_.shape("sphere", look, unitSphere), ball.radii)};
            },
            [&](const CylinderShape& c) -> Placings {
                return {scaled(meshes_.shape("cylinder", look, unitCylinder), {c.radius, c.radius, c.length})};
            },
            [&](const ConeShape& c) -> Placings {
                return {scaled(meshes_.shape("cone", look, unitCone), {c.radius, c.radius, c.length})};
            },
            [&](const CapsuleShape& c) -> Placings {
                if (!(static_cast<float>(c.radius) > 0) || !std::isfinite(static_cast<float>(c.radius + c.length)))
                    return ++flat_visuals_, Placings{};
                return {meshes_.shape(fmt::format("capsule {} {}", c.radius, c.length), look,
                                      [&] { return capsule(c.radius, c.length); })};
            },
            [&](const PlaneShape& plane) -> Placings {
                const Placing turned = turnedTo(meshes_.shape("plane", look, unitPlane), plane.normal);
                return {scaled(turned, {plane.size.x, plane.size.y, 1})};
            },
            [&](const MeshShape& mesh) -> Placings { return placingsOfMesh(name, mesh, look); },
            [&](const HeightmapShape& map) -> Placings { return placingsOfHeightmap(name, map, look); },
            [&](const OtherShape& other) -> Placings {
                const std::string which = other.name.empty() ? "" : fmt::format(", <{}>,", other.name);
                return leaveOut(name, fmt::format("its geometry{} is not supported", which)), Placings{};
            },
        },
        shape);
}

std::vector<Placing> WorldBuilder::placingsOfMesh(const std::string& name, const MeshShape& mesh,
                                                  const Look& look) try {
    const auto path = paths_.find(mesh.uri, mesh.named_in);
    if (!path) return missed(mesh.uri), leaveOut(name, mesh.uri + " is not found"), std::vector<Placing>{};
    std::vector<Placing> placings = meshes_.file(*path, mesh.submesh, look);
    if (placings.empty())
        return leaveOut(name, fmt::format("{} has no submesh \"{}\"", mesh.uri, mesh.submesh)), placings;
    if (mesh.is_centred) placings = meshes_.centred(std::move(placings));
    const glm::dmat4 scale = glm::scale(glm::dmat4(1), mesh.scale);
    for (Placing& placing : placings) placing.visual_from_object = scale * placing.visual_from_object;
    if (mesh.scale != glm::dvec3(1)) return placings;  // which answers the question
    const auto question = askUnit(*path, meshes_.extent(placings).size(),
                                  "give it <scale>0.001 0.001 0.001</scale>, in URDF scale=\"0.001 0.001 0.001\"");
    if (question && question->kind == types::Notice::Kind::Warning && unit_questions_.insert(question->text).second)
        geometry_.notices.push_back(*question);
    return placings;
} catch (const types::ConfigError& failure) {
    leaveOut(name, fmt::format("{} {}", mesh.uri, failure.diagnostics().front().message));
    return {};
}

std::vector<Placing> WorldBuilder::placingsOfHeightmap(const std::string& name, const HeightmapShape& map,
                                                       const Look& look) try {
    const auto path = paths_.find(map.uri, map.named_in);
    if (!path) return missed(map.uri), leaveOut(name, map.uri + " is not found"), std::vector<Placing>{};
    const glm::dvec3 size = map.size;
    Placing placing = meshes_.shape(fmt::format("{} {} {} {}", path->string(), size.x, size.y, size.z), look,
                                    [&] { return readHeightmap(*path, size); });
    placing.visual_from_object = glm::translate(glm::dmat4(1), map.position);
    return {placing};
} catch (const std::runtime_error& failure) {
    leaveOut(name, fmt::format("{} {}", map.uri, failure.what()));
    return {};
}

}  // namespace insonify::meshes
