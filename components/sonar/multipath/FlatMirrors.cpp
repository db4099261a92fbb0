#include "components/sonar/multipath/FlatMirrors.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace insonify::sonar {
namespace {

constexpr double float_noise = 0x1p-22;  ///< Rounding of a corner off its plane, relative to its coordinates [1].
constexpr uint32_t few = 8;              ///< Max triangles without a tree.

/** A triangle that reflects, in the axes of its mesh. */
struct Reflecting {
    std::array<glm::dvec3, 3> corners;
    double power;
    uint32_t place;
    glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
};

std::vector<Reflecting> reflectingIn(const types::Geometry& geometry, size_t object, int bounces, uint32_t& count) {
    std::vector<Reflecting> found;
    const types::Mesh& mesh = geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
    for (const types::Cluster& cluster : mesh.clusters) {
        const types::Material& material = geometry.materials[static_cast<size_t>(cluster.material)];
        if (!material.mirror) continue;
        const auto corner = [&](size_t i) { return glm::dvec3(mesh.positions[mesh.indices[i]]); };
        for (size_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
            const Reflecting one{{corner(i), corner(i + 1), corner(i + 2)}, reflectedPower(material, bounces), count++};
            if (glm::length(one.across) > 0) found.push_back(one);
        }
    }
    return found;
}

std::vector<Box> makeBoxes(const std::vector<Reflecting>& triangles) {
    std::vector<Box> boxes(triangles.size());
    for (size_t i = 0; i < boxes.size(); ++i)
        for (const glm::dvec3& corner : triangles[i].corners) boxes[i].add(corner);
    return boxes;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/** Groups the triangles of an object into planes. Each plane is that of a triangle, with all triangles in it. */
class Planes {
public:
    explicit Planes(const std::vector<Reflecting>& triangles)
        : triangles_(triangles), boxes_(makeBoxes(triangles)), tree_(boxes_), taken_(triangles.size()) {
        Box all;
        for (const Box& box : boxes_) all.add(box);
        const glm::dvec3 far = glm::max(glm::abs(all.low), glm::abs(all.high));
        noise_ = float_noise * std::max({far.x, far.y, far.z});
    }

    /** Takes a triangle and all others in its plane that are not taken yet. Returns them, ascending. */
    std::vector<size_t> take(size_t first) {
        const MirrorPlane plane = makePlane(triangles_[first]);
        std::vector<size_t> found;
        const auto off = [&](const glm::dvec3& point) {
            return std::abs(glm::dot(plane.normal, point) - plane.distance);
        };
        const auto isIn = [&](size_t i) {
            return i == first || std::ranges::all_of(triangles_[i].corners,
                                                     [&](const auto& corner) { return off(corner) <= noise_; });
        };
        tree_.any(
            [&](const Box& box) {
                return off(box.centre()) <= glm::dot(glm::abs(plane.normal), box.half()) + 2 * noise_;
            },
            [&](size_t i) {
                if (!taken_[i] && isIn(i)) found.push_back(i);
                return false;
            });
        for (const size_t i : found) taken_[i] = true;
        std::ranges::sort(found);
        return found;
    }
    bool isTaken(size_t i) const { return taken_[i]; }

    static MirrorPlane makePlane(const Reflecting& triangle) {
        const glm::dvec3 normal = glm::normalize(triangle.across);
        return {normal, glm::dot(normal, triangle.corners[0])};
    }

private:
    const std::vector<Reflecting>& triangles_;
    std::vector<Box> boxes_;
    BoxTree tree_;
    std::vector<bool> taken_;
    double noise_ = 0;  ///< [m]
};

/** Chooses the two axes of the mesh along which the plane is least steep. */
void chooseAxes(FlatMirror& mirror, const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int steepest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    mirror.u = (steepest + 1) % 3;
    mirror.v = (steepest + 2) % 3;
}

/** Returns the rectangle on the axes u and v that contains all triangles, in the mirror's plane. */
std::array<glm::dvec3, 4> rectangleAround(const FlatMirror& mirror, const MirrorPlane& plane,
                                          std::span<const MirrorTriangle> triangles) {
    glm::dvec2 low = triangles.front().corners[0], high = low;
    for (const MirrorTriangle& triangle : triangles)
        for (const glm::dvec2& corner : triangle.corners) low = glm::min(low, corner), high = glm::max(high, corner);
    const int w = 3 - mirror.u - mirror.v;
    const auto at = [&](double u, double v) {
        glm::dvec3 point;
        point[mirror.u] = u, point[mirror.v] = v;
        point[w] = (plane.distance - plane.normal[mirror.u] * u - plane.normal[mirror.v] * v) / plane.normal[w];
        return point;
    };
    return {at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)};
}

BoxTree treeOver(std::span<const MirrorTriangle> triangles) {
    std::vector<Box> boxes(triangles.size());
    for (size_t i = 0; i < boxes.size(); ++i)
        for (const glm::dvec2& corner : triangles[i].corners) boxes[i].add({corner, 0});
    return BoxTree(boxes);
}

bool holds(const MirrorTriangle& triangle, const glm::dvec2& point, double slack) {
    for (size_t k = 0; k < 3; ++k) {
        const glm::dvec2 &from = triangle.corners[k], edge = triangle.corners[(k + 1) % 3] - from;
        if (cross(edge, point - from) < -slack * (std::abs(edge.x) + std::abs(edge.y))) return false;
    }
    return true;
}

constexpr size_t room_per_mirror = 64;  ///< Mirrors that may follow; if there are more, they are searched again.

}  // namespace

FlatMirrors::FlatMirrors(const types::Geometry& geometry, int bounces)
    : geometry_(geometry), bounces_(bounces), places_(geometry.objects.size()) {
    addAll();
}

void FlatMirrors::addAll() {
    mirrors_.clear();
    triangles_.clear();
    reflects_.assign(geometry_.objects.size(), false);
    uint32_t count = 0;
    for (size_t object = 0; bounces_ > 0 && object < geometry_.objects.size(); ++object)
        addObject(object, bounces_, count);
}

void FlatMirrors::addObject(size_t object, int bounces, uint32_t& count) {
    const std::vector<Reflecting> all = reflectingIn(geometry_, object, bounces, count);
    if (all.empty()) return;
    reflects_[object] = true;
    Planes planes(all);
    std::vector<size_t> by_size(all.size());
    std::iota(by_size.begin(), by_size.end(), size_t{0});
    std::ranges::stable_sort(by_size, std::greater(), [&](size_t i) { return glm::length(all[i].across); });
    for (const size_t maximum : by_size) {
        if (planes.isTaken(maximum)) continue;
        const MirrorPlane plane = Planes::makePlane(all[maximum]);
        FlatMirror mirror;
        mirror.object = object;
        mirror.corners = all[maximum].corners;
        mirror.first = static_cast<uint32_t>(triangles_.size());
        chooseAxes(mirror, plane.normal);
        for (const size_t i : planes.take(maximum)) {
            MirrorTriangle triangle{{}, all[i].power, all[i].place};
            for (size_t k = 0; k < 3; ++k)
                triangle.corners[k] = {all[i].corners[k][mirror.u], all[i].corners[k][mirror.v]};
            auto& [a, b, c] = triangle.corners;
            const double area = cross(b - a, c - a);
            if (area < 0) std::swap(b, c);
            if (area != 0) triangles_.push_back(triangle);
        }
        mirror.count = static_cast<uint32_t>(triangles_.size()) - mirror.first;
        if (mirror.count == 0) continue;
        const auto triangles = std::span(triangles_).subspan(mirror.first, mirror.count);
        const auto& [a, b, c] = mirror.corners;
        mirror.outline_in_mesh = mirror.count == 1 ? std::array{a, b, c, c} : rectangleAround(mirror, plane, triangles);
        if (mirror.count > few) mirror.tree = treeOver(triangles);
        mirrors_.push_back(std::move(mirror));
    }
}

void FlatMirrors::place(const types::Snapshot& snapshot) {
    if (std::ranges::any_of(snapshot.deformed, [&](const auto& one) { return reflects_[one.object]; })) addAll();
    for (size_t i = 0; i < places_.size(); ++i) places_[i] = &geometry_.objects[i].world_from_object;
    for (size_t i = snapshot.moved.size(); i-- > 0;)
        places_[snapshot.moved[i].object] = &snapshot.moved[i].world_from_object;
    for (FlatMirror& mirror : mirrors_) {
        const auto inWorld = [&](const glm::dvec3& point) {
            return glm::dvec3(*places_[mirror.object] * glm::dvec4(point, 1));
        };
        const glm::dvec3 a = inWorld(mirror.corners[0]), b = inWorld(mirror.corners[1]), c = inWorld(mirror.corners[2]);
        const glm::dvec3 across = glm::cross(b - a, c - a);
        mirror.is_there = glm::length(across) > 0;
        for (size_t k = 0; k < 4; ++k) mirror.outline[k] = inWorld(mirror.outline_in_mesh[k]);
        if (!mirror.is_there) continue;
        mirror.plane.normal = glm::normalize(across);
        mirror.plane.distance = glm::dot(mirror.plane.normal, a);
        // A point of the plane is a + s (b - a) + t (c - a); s and t are its products with two vectors of the plane.
        const glm::dvec3 per_s = glm::cross(c - a, across) / glm::dot(across, across),
                         per_t = glm::cross(across, b - a) / glm::dot(across, across);
        const glm::dvec3 s = mirror.corners[1] - mirror.corners[0], t = mirror.corners[2] - mirror.corners[0];
        mirror.origin = a;
        mirror.per_u = s[mirror.u] * per_s + t[mirror.u] * per_t;
        mirror.per_v = s[mirror.v] * per_s + t[mirror.v] * per_t;
    }
}

const MirrorTriangle* FlatMirrors::triangleAt(const FlatMirror& mirror, const glm::dvec3& point, double slack) const {
    const glm::dvec3 off = point - mirror.origin;
    const glm::dvec2 at(mirror.corners[0][mirror.u] + glm::dot(mirror.per_u, off),
                        mirror.corners[0][mirror.v] + glm::dot(mirror.per_v, off));
    const double reach = slack * std::max(glm::length(mirror.per_u), glm::length(mirror.per_v));
    const auto triangles = std::span(triangles_).subspan(mirror.first, mirror.count);
    if (mirror.count <= few) {
        const auto found = std::ranges::find_if(triangles, [&](const auto& one) { return holds(one, at, reach); });
        return found == triangles.end() ? nullptr : &*found;
    }
    const MirrorTriangle* first = nullptr;
    mirror.tree.any(
        [&](const Box& box) {
            return at.x >= box.low.x - 2 * reach && at.x <= box.high.x + 2 * reach && at.y >= box.low.y - 2 * reach &&
                   at.y <= box.high.y + 2 * reach;
        },
        [&](size_t i) {
            if ((!first || triangles[i].place < first->place) && holds(triangles[i], at, reach)) first = &triangles[i];
            return false;
        });
    return first;
}

MirrorReach::Beam::Beam(const PlacedMirror& mirror, double longest_way, double rounding)
    : apex(mirror.sonar_image),
      front(mirror.sonar_side > 0 ? mirror.plane : MirrorPlane{-mirror.plane.normal, -mirror.plane.distance}),
      longest(longest_way),
      doubt(rounding) {
    if (!mirror.flat) return;
    const std::array<glm::dvec3, 4>& outline = mirror.flat->outline;
    const glm::dvec3 middle = (outline[0] + outline[1] + outline[2] + outline[3]) / 4.0 - apex;
    for (size_t k = 0; k < 4; ++k) {
        const glm::dvec3 from = outline[k] - apex, to = outline[(k + 1) % 4] - apex;
        product[k] = glm::length(from) * glm::length(to);
        sum[k] = glm::length(from) + glm::length(to);
        const glm::dvec3 side = glm::cross(from, to);
        const double inside = glm::dot(side, middle);
        if (std::abs(inside) > doubt * (product[k] + glm::length(middle) * sum[k]))
            inward[k] = inside > 0 ? side : -side;
    }
}

bool MirrorReach::Beam::mayMeet(const Box& box) const {
    const glm::dvec3 centre = box.centre() - apex, half = box.half();
    if (glm::length(glm::max(glm::abs(centre) - half, 0.0)) > longest + doubt) return false;
    const double ahead = glm::dot(front.normal, box.centre()) - front.distance;
    if (ahead + glm::dot(glm::abs(front.normal), half) < -doubt) return false;
    const double reach = glm::length(centre) + glm::length(half);
    for (size_t k = 0; k < 4; ++k)
        if (glm::dot(inward[k], centre) + glm::dot(glm::abs(inward[k]), half) < -doubt * (product[k] + reach * sum[k]))
            return false;
    return true;
}

bool MirrorReach::Beam::mayMeet(const std::array<glm::dvec3, 4>& outline) const {
    const auto allBehind = [&](const auto& isBehind) { return std::ranges::all_of(outline, isBehind); };
    if (allBehind([&](const glm::dvec3& point) { return glm::dot(front.normal, point) - front.distance < -doubt; }))
        return false;
    for (size_t k = 0; k < 4; ++k)
        if (allBehind([&](const glm::dvec3& point) {
                const glm::dvec3 off = point - apex;
                return glm::dot(inward[k], off) < -doubt * (product[k] + glm::length(off) * sum[k]);
            }))
            return false;
    return true;
}

MirrorReach::MirrorReach(size_t count) : boxes_(count - std::min<size_t>(count, 1)), found_(count) {
    seconds_.reserve(count * std::min(count, room_per_mirror));
}

void MirrorReach::place(std::span<const PlacedMirror> mirrors, double longest, double doubt) {
    mirrors_ = mirrors;
    longest_ = longest;
    doubt_ = doubt;
    for (size_t i = 0; i < boxes_.size(); ++i) boxes_[i] = mirrors[i + 1].box;
    if (std::exchange(has_tree_, true))
        tree_.refit(boxes_);
    else
        tree_ = BoxTree(boxes_);
    seconds_.clear();
    for (size_t first = 0; first < mirrors.size(); ++first) {
        Found& found = found_[first];
        found = {static_cast<uint32_t>(seconds_.size()), 0, true};
        forEachMet(first, [&](size_t second) {
            found.is_complete &= seconds_.size() < seconds_.capacity();
            if (found.is_complete) seconds_.push_back(static_cast<uint32_t>(second));
        });
        if (!found.is_complete) seconds_.resize(found.begin);
        found.count = static_cast<uint32_t>(seconds_.size()) - found.begin;
    }
}

}  // namespace insonify::sonar
