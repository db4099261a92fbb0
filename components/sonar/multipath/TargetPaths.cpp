#include "components/sonar/multipath/TargetPaths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <utility>

namespace insonify::sonar {
namespace {

constexpr size_t max_reserved = 4096;  ///< Max paths to one point with preallocated memory.
constexpr double same = 1e-9;          ///< Max relative difference of the lengths of equal paths [1].

double distanceFrom(const MirrorPlane& plane, const glm::dvec3& point) {
    return glm::dot(plane.normal, point) - plane.distance;
}

/** Returns the rounding of places: a few units in the last digit of their coordinates; intersections add some. */
double doubt(std::span<const PlacedMirror> mirrors, const glm::dvec3& sonar, double longest) {
    Box all;
    all.add(sonar);
    for (const PlacedMirror& mirror : mirrors)
        if (mirror.flat) all.add(mirror.box);
    const glm::dvec3 far = glm::max(glm::abs(all.low), glm::abs(all.high));
    return 1e-12 * longest + 1e-14 * std::max({far.x, far.y, far.z});
}

double distanceTo(const Box& box, const glm::dvec3& point) {
    return glm::length(glm::max(glm::max(box.low - point, point - box.high), 0.0));
}

bool holds(const Box& box, const glm::dvec3& point, double margin) {
    return point.x >= box.low.x - margin && point.x <= box.high.x + margin && point.y >= box.low.y - margin &&
           point.y <= box.high.y + margin && point.z >= box.low.z - margin && point.z <= box.high.z + margin;
}

}  // namespace

WallSights::WallSights(const RenderPlan& plan) : plan_(plan) {
    constexpr size_t usual = 64;
    if (!plan.has(Pass::Walls)) return;
    for (const WallLaw& wall : plan.laws.walls) are_walls_.push_back(wall.letsThrough() && !wall.fill);
    hits_.reserve(usual);
}

double WallSights::passed(const Sightlines& sightlines, const glm::dvec3& from, const glm::dvec3& to, int& walls,
                          WallArrivals& arrivals) {
    if (are_walls_.empty()) return sightlines.isOpen(from, to) ? 1 : 0;
    if (!sightlines.findWalls(from, to, are_walls_, hits_)) return 0;
    double once = 1, both = 1, behind = 0;
    for (const Sightlines::WallHit& hit : hits_) {
        if (hit.range < behind) continue;  // another triangle of the same wall
        behind = hit.range * (1 + same_wall) + nearest_wall;
        once *= pass(hit, arrivals);
        both *= plan_.laws.walls[hit.material].exactly(hit.cosine);
        if (++walls > plan_.config.max_walls || !(both >= min_passed * min_passed)) return 0;
    }
    arrivals.ringing *= both / (once * once);
    return once;
}

double WallSights::pass(const Sightlines::WallHit& hit, WallArrivals& arrivals) const {
    const WallLaw& wall = plan_.laws.walls[hit.material];
    const double sine = std::sqrt(std::max(1 - hit.cosine * hit.cosine, 0.0)), resolution = plan_.grid.bin_width / 2;
    if (wall.rings()) {
        arrivals.both = arrivals.both.then(wall.behind, wall.spacing(sine), resolution);
        arrivals.both.moveAway(wall.delay(sine));
    }
    arrivals.once.passOnce(wall, sine, resolution);
    return wall.exactly_once(hit.cosine);
}

TargetPaths::TargetPaths(const SonarConfig& config, const types::Geometry& geometry, WallSights* walls)
    : bounces_(config.tracesPaths() ? config.multipath->bounces : 0),
      flat_(geometry, bounces_),
      sightlines_(geometry, flat_.all().empty() ? Sightlines::Lines::Few : Sightlines::Lines::Many),
      walls_(walls),
      water_(config),
      mirrors_(bounces_ > 0 ? flat_.all().size() + 1 : 0),
      reach_(bounces_ > 1 ? mirrors_.size() : 0),
      images_(mirrors_.size()),
      distances_(mirrors_.size()) {
    static_assert(TargetPath::max_mirrors == 2, "pathsTo() looks for paths by one mirror and by two");
    paths_.reserve(std::min(max_reserved, 1 + mirrors_.size() * (1 + mirrors_.size())));
}

void TargetPaths::place(const types::Snapshot& snapshot, double range_max) {
    sightlines_.place(snapshot);
    sonar_ = snapshot.sonar.position;
    sonar_from_world_ = glm::conjugate(snapshot.sonar.orientation);
    longest_ = 2 * range_max;
    has_reach_ = false;
    if (bounces_ > 0) placeMirrors(snapshot, range_max);
}

void TargetPaths::placeMirrors(const types::Snapshot& snapshot, double range_max) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    water_.place(snapshot, range_max);
    flat_.place(snapshot);
    PlacedMirror& surface = mirrors_.front();
    surface.is_there = water_.reflects();
    if (surface.is_there) surface.plane = {{0, 0, 1}, *snapshot.water_surface};
    surface.box = {glm::dvec3(-infinity), glm::dvec3(infinity)};
    for (size_t i = 1; i < mirrors_.size(); ++i) {
        const FlatMirror& flat = flat_.all()[i - 1];
        PlacedMirror& mirror = mirrors_[i];
        mirror.plane = flat.plane;
        mirror.flat = &flat;
        mirror.box = {};
        for (const glm::dvec3& corner : flat.outline) mirror.box.add(corner);
        mirror.is_there = flat.is_there && distanceTo(mirror.box, sonar_) <= longest_ * (1 + same);
    }
    doubt_ = doubt(mirrors_, sonar_, longest_);
    for (PlacedMirror& mirror : mirrors_) {
        mirror.sonar_image = mirror.plane.image(sonar_);
        mirror.sonar_side = distanceFrom(mirror.plane, sonar_);
    }
}

const std::vector<TargetPath>& TargetPaths::pathsTo(const glm::dvec3& point) {
    paths_.clear();
    arrivals_count_ = 0;
    if (bounces_ > 0 && mirrors_.front().is_there && !(point.z < mirrors_.front().plane.distance)) return paths_;
    addPath(point, {});
    if (bounces_ > 0) addByOne(point);
    if (bounces_ > 1) addByTwo(point);
    std::ranges::sort(paths_, {}, &TargetPath::mirrors);
    return paths_;
}

void TargetPaths::addByOne(const glm::dvec3& point) {
    for (size_t i = 0; i < mirrors_.size(); ++i) {
        const PlacedMirror& mirror = mirrors_[i];
        if (!mirror.is_there) continue;
        images_[i] = mirror.plane.image(point);
        distances_[i] = distanceFrom(mirror.plane, point);
        const PlacedMirror* const chain[] = {&mirror};
        if (mayMeet(mirror, sonar_, mirror.sonar_side, images_[i], distances_[i])) addPath(point, chain);
    }
}

/** Adds the paths via two mirrors. Unfolded, a path via two mirrors is a line from the sonar's image in the first to
 *  the point's image in the second, which intersects both. */
void TargetPaths::addByTwo(const glm::dvec3& point) {
    if (!std::exchange(has_reach_, true)) reach_.place(mirrors_, longest_, doubt_);
    for (size_t i = 0; i < mirrors_.size(); ++i) {
        const PlacedMirror& first = mirrors_[i];
        reach_.forEachAfter(i, [&](size_t j) {
            const PlacedMirror& second = mirrors_[j];
            const glm::dvec3 &from = first.sonar_image, &to = images_[j];
            const PlacedMirror* const chain[] = {&first, &second};
            if (mayMeet(second, from, distanceFrom(second.plane, from), to, distances_[j]) &&
                mayMeet(first, from, first.sonar_side, to, distanceFrom(first.plane, to)))
                addPath(point, chain);
        });
    }
}

bool TargetPaths::mayMeet(const PlacedMirror& mirror, const glm::dvec3& from, double distance, const glm::dvec3& image,
                          double image_distance) const {
    constexpr double grazing = 1e-4, rounded = 1e5;
    const double a = std::abs(distance), b = std::abs(image_distance);
    if (a > doubt_ && b > doubt_ && distance * image_distance < 0) return false;
    if (!(a + b > grazing * longest_)) return true;
    return holds(mirror.box, from + a / (a + b) * (image - from), rounded * doubt_);
}

void TargetPaths::addPath(const glm::dvec3& point, Chain chain) {
    // The image seen behind the first k mirrors of the chain: the point's image in the mirrors after them.
    std::array<glm::dvec3, TargetPath::max_mirrors + 1> images;
    images[chain.size()] = point;
    for (size_t k = chain.size(); k-- > 0;) images[k] = chain[k]->plane.image(images[k + 1]);
    TargetPath path;
    path.length = glm::distance(sonar_, images[0]);
    if (!(path.length > 0 && path.length <= longest_)) return;
    path.direction = sonar_from_world_ * ((images[0] - sonar_) / path.length);
    std::array<glm::dvec3, TargetPath::max_mirrors + 2> stops{sonar_};
    for (const PlacedMirror* mirror : chain) {
        const auto k = static_cast<size_t>(path.reflections);
        const auto at = meet(*mirror, stops[k], images[k], path);
        if (!at) return;
        stops[k + 1] = *at;
    }
    stops[chain.size() + 1] = point;
    WallArrivals* const arrivals = walls_ ? &newArrivals() : nullptr;
    for (size_t k = 0; k <= chain.size(); ++k) {
        path.power *= walls_ ? walls_->passed(sightlines_, stops[k], stops[k + 1], path.walls, *arrivals)
                             : static_cast<double>(sightlines_.isOpen(stops[k], stops[k + 1]));
        if (!(path.power > 0)) return;
    }
    if (walls_) path.ringing = arrivals->ringing;
    if (walls_ && arrivals->areDelayed()) path.arrivals = arrivals;
    const glm::dvec3 first = stops[chain.size()] - point;
    path.from_point = first / std::max(glm::length(first), std::numeric_limits<double>::min());
    addOnce(path);
}

WallArrivals& TargetPaths::newArrivals() {
    if (arrivals_count_ == arrivals_.size()) arrivals_.emplace_back();
    return arrivals_[arrivals_count_++] = {};
}

std::optional<glm::dvec3> TargetPaths::meet(const PlacedMirror& mirror, const glm::dvec3& from, const glm::dvec3& image,
                                            TargetPath& path) const {
    const double here = distanceFrom(mirror.plane, from), there = distanceFrom(mirror.plane, image);
    // A path may leave a first mirror where it joins the second; then the sonar's side decides.
    const bool in_corner = std::abs(here) <= doubt_;
    if (!((in_corner ? mirror.sonar_side : here) * there < 0)) return {};
    if (std::abs(there) <= doubt_ || (in_corner && std::abs(mirror.sonar_side) <= doubt_)) return {};
    const glm::dvec3 at = in_corner ? from : from + here / (here - there) * (image - from);
    const MirrorTriangle* triangle = mirror.flat ? flat_.triangleAt(*mirror.flat, at, doubt_) : nullptr;
    if (mirror.flat && !triangle) return {};
    if (triangle) path.power *= triangle->power;
    if (!mirror.flat) {
        path.by_surface = true;
        path.sine_grazing =
            in_corner ? std::abs(there) / glm::distance(image, at) : std::abs(here) / glm::distance(from, at);
    }
    path.mirrors[static_cast<size_t>(path.reflections++)] = triangle ? triangle->place + 2 : 1;
    return at;
}

/** Adds a path once: mirrors of several objects may share an edge or overlap, and their reflections are one path. */
void TargetPaths::addOnce(const TargetPath& path) {
    const auto isSame = [&](const TargetPath& other) {
        return other.reflections == path.reflections && std::abs(other.length - path.length) <= same * path.length &&
               glm::distance(other.direction, path.direction) <= same;
    };
    const auto known = std::ranges::find_if(paths_, isSame);
    if (known == paths_.end())
        paths_.push_back(path);
    else if (path.mirrors < known->mirrors)
        *known = path;
}

}  // namespace insonify::sonar
