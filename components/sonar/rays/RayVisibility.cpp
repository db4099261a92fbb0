#include "components/sonar/rays/RayVisibility.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "components/sonar/base/Counters.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "components/sonar/rays/SceneTrees.hpp"
#include "components/sonar/surfaces/MeshFacts.hpp"
#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
namespace {

/** Max triangles that are copied to their places, once for each object. In larger scenes, meshes with several places
 *  are instances of one tree, which are slower to trace [1]. */
constexpr size_t max_copied = 4'000'000;

/** Returns the number of the lattice of scatterers of each object. It follows from the object's name alone, so that the
 *  speckle of an object does not change with the order or number of the others. The tiles of a survey, which share a
 *  name and a place, share a lattice. Other objects of one name, which no file has, are numbered in their order. */
std::vector<uint32_t> makeLattices(const types::Geometry& geometry) {
    std::map<std::string, std::vector<size_t>> namesakes;  // the first object of each lattice of a name
    std::vector<uint32_t> lattices;
    for (size_t i = 0; i < geometry.objects.size(); ++i) {
        const types::Object& own = geometry.objects[i];
        std::vector<size_t>& firsts = namesakes[own.name];
        const auto same = std::ranges::find_if(firsts, [&](size_t first) {
            const types::Object& other = geometry.objects[first];
            return own.transient && other.transient && other.world_from_object == own.world_from_object;
        });
        lattices.push_back(
            static_cast<uint32_t>(types::hashedName(own.name, static_cast<uint64_t>(same - firsts.begin()))));
        if (same == firsts.end()) firsts.push_back(i);
    }
    return lattices;
}

/** The three rows of a matrix that transforms directions and places from one frame to another. */
struct Rows {
    glm::vec3 x, y, z;

    explicit Rows(const glm::mat3& m)
        : x(m[0][0], m[1][0], m[2][0]), y(m[0][1], m[1][1], m[2][1]), z(m[0][2], m[1][2], m[2][2]) {}
};

void forgetHits(RTCRayHit16& all) {
    std::fill_n(all.hit.geomID, tile_samples, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(all.hit.instID[0], tile_samples, RTC_INVALID_GEOMETRY_ID);
}

/** Sets origins and directions of the active rays; keeps their hits so far. */
void direct(const Rows& turn, glm::vec3 from, const TileRays& rays, RTCRayHit16& all) {
    std::fill_n(all.ray.org_x, tile_samples, from.x);
    std::fill_n(all.ray.org_y, tile_samples, from.y);
    std::fill_n(all.ray.org_z, tile_samples, from.z);
    for (int i = 0; i < tile_samples; ++i) {
        const float x = rays.x[i], y = rays.y[i], z = rays.z[i];
        all.ray.dir_x[i] = turn.x.x * x + turn.x.y * y + turn.x.z * z;
        all.ray.dir_y[i] = turn.y.x * x + turn.y.y * y + turn.y.z * z;
        all.ray.dir_z[i] = turn.z.x * x + turn.z.y * y + turn.z.z * z;
    }
    forgetHits(all);
}

/** Extends active rays from `nearest` [m] to infinity; the others end before they begin. */
void extend(const TileRays& rays, float nearest, RTCRayHit16& all) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::fill_n(all.ray.tnear, tile_samples, nearest);
    std::fill_n(all.ray.tfar, tile_samples, infinity);
    std::fill_n(all.ray.time, tile_samples, 0.0f);
    std::fill_n(all.ray.mask, tile_samples, 0xffffffff);
    std::fill_n(all.ray.flags, tile_samples, 0u);
    for (uint32_t ended = ~rays.active & 0xffff; ended != 0; ended &= ended - 1) {
        all.ray.tnear[std::countr_zero(ended)] = infinity;
        all.ray.tfar[std::countr_zero(ended)] = -infinity;
    }
}

/** Sets rays with other origins, in the axes given by `turn` and `place` of the sonar. */
void direct(const Rows& turn, glm::vec3 place, const PathRays& rays, auto& ray) {
    const auto turned = [](glm::vec3 row, float x, float y, float z) { return row.x * x + row.y * y + row.z * z; };
    for (int i = 0; i < tile_samples; ++i) {
        ray.org_x[i] = place.x + turned(turn.x, rays.from_x[i], rays.from_y[i], rays.from_z[i]);
        ray.org_y[i] = place.y + turned(turn.y, rays.from_x[i], rays.from_y[i], rays.from_z[i]);
        ray.org_z[i] = place.z + turned(turn.z, rays.from_x[i], rays.from_y[i], rays.from_z[i]);
        ray.dir_x[i] = turned(turn.x, rays.towards.x[i], rays.towards.y[i], rays.towards.z[i]);
        ray.dir_y[i] = turned(turn.y, rays.towards.x[i], rays.towards.y[i], rays.towards.z[i]);
        ray.dir_z[i] = turned(turn.z, rays.towards.x[i], rays.towards.y[i], rays.towards.z[i]);
    }
}

/** Limits rays to their own bounds; inactive rays end before they begin. */
void bound(const PathRays& rays, auto& ray) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < tile_samples; ++i) {
        const bool active = rays.towards.active >> i & 1;
        ray.tnear[i] = active ? rays.nearest[i] : infinity;
        ray.tfar[i] = active ? rays.farthest[i] : -infinity;
        ray.time[i] = 0;
        ray.mask[i] = 0xffffffff;
        ray.flags[i] = 0;
    }
}

/** The active rays, for Embree. */
struct Valid {
    alignas(64) int of[tile_samples];

    explicit Valid(uint32_t active) {
        for (int i = 0; i < tile_samples; ++i) of[i] = (active >> i & 1) ? -1 : 0;
    }
};

/** Records the new hits of rays; `meaning` of a geometry and an instance is a TreePart. */
void take(const RTCRayHit16& all, TileHits& hits, const auto& meaning) {
    const unsigned* const geometry = all.hit.geomID;
    const unsigned* const instance = all.hit.instID[0];
    unsigned others = 0;
    for (int i = 1; i < tile_samples; ++i) others |= (geometry[i] ^ geometry[0]) | (instance[i] ^ instance[0]);
    if (others != 0) {
        for (int i = 0; i < tile_samples; ++i) {
            if (geometry[i] == RTC_INVALID_GEOMETRY_ID) continue;
            const TreePart part = meaning(geometry[i], instance[i]);
            hits.command[i] = part.command;
            hits.triangle[i] = part.first_triangle + all.hit.primID[i];
        }
    } else if (geometry[0] != RTC_INVALID_GEOMETRY_ID) {
        const TreePart part = meaning(geometry[0], instance[0]);
        std::fill_n(hits.command, tile_samples, part.command);
        for (int i = 0; i < tile_samples; ++i) hits.triangle[i] = part.first_triangle + all.hit.primID[i];
    }
    for (int i = 0; i < tile_samples; ++i) {
        const bool is_hit = geometry[i] != RTC_INVALID_GEOMETRY_ID;
        hits.u[i] = is_hit ? all.hit.u[i] : hits.u[i];
        hits.v[i] = is_hit ? all.hit.v[i] : hits.v[i];
        hits.distance[i] = is_hit ? all.ray.tfar[i] : hits.distance[i];
    }
}

using Places = std::array<glm::vec3, tile_samples>;

/** Returns the places of a tile's rays at one range, for an object that moves by `drift`. */
Places getPlaces(const RayPaths& paths, const TileRays& rays, double range, const Drift* drift = nullptr) {
    Places places;
    for (int i = 0; i < tile_samples; ++i)
        places[static_cast<size_t>(i)] =
            glm::vec3(paths.at(glm::normalize(glm::dvec3(rays.x[i], rays.y[i], rays.z[i])), range, drift));
    return places;
}

/** Sets the rays from one place to another; keeps their hits so far. */
void direct(const Rows& turn, glm::vec3 place, const Places& from, const Places& to, RTCRayHit16& all) {
    for (size_t i = 0; i < tile_samples; ++i) {
        const glm::vec3 way = to[i] - from[i];
        all.ray.org_x[i] = place.x + glm::dot(turn.x, from[i]);
        all.ray.org_y[i] = place.y + glm::dot(turn.y, from[i]);
        all.ray.org_z[i] = place.z + glm::dot(turn.z, from[i]);
        all.ray.dir_x[i] = glm::dot(turn.x, way);
        all.ray.dir_y[i] = glm::dot(turn.y, way);
        all.ray.dir_z[i] = glm::dot(turn.z, way);
        all.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        all.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
}

/** A cone about the rays of a tile. */
struct TileCone {
    glm::vec3 axis;      ///< Unit, sonar axes.
    float cosine, sine;  ///< Cosine and sine of half its angle.
};

TileCone coneAbout(const TileRays& rays) {
    const auto ray = [&](int i) { return glm::normalize(glm::vec3(rays.x[i], rays.y[i], rays.z[i])); };
    const glm::vec3 axis = glm::normalize(ray(0) + ray(tile_samples - 1));
    float narrowest = 1;
    for (int i = 0; i < tile_samples; ++i) narrowest = std::min(narrowest, glm::dot(axis, ray(i)));
    const float half = std::clamp(narrowest - 1e-6f, -1.0f, 1.0f);
    return {axis, half, std::sqrt(1 - half * half)};
}

}  // namespace

/** An object that moves. */
struct RayVisibility::Mover {
    uint32_t object, first_command;
    std::shared_ptr<MeshTree> mesh;
    RTCScene tree;
    Box box;                      ///< Bounds in its own axes [m].
    bool placed = false;          ///< Whether rays can hit it.
    glm::mat3 from_sonar{1};      ///< Rotation of directions from sonar axes to its own.
    glm::vec3 place{0};           ///< Place of the sonar in its axes [m].
    glm::vec3 towards{0};         ///< Unit vector from the sonar to the middle of a ball about it, sonar axes.
    float cosine = -1, sine = 0;  ///< Cosine and sine of the angular radius of the ball; -1: the sonar is inside.

    void placeAt(const glm::dmat4& sonar_from_object);
    bool mayMeet(const TileCone& rays) const;
    TreePart meaning(uint32_t geometry) const {
        const TreePart& part = mesh->parts()[geometry];
        return {first_command + part.command, part.first_triangle};
    }
};

void RayVisibility::Mover::placeAt(const glm::dmat4& sonar_from_object) {
    const glm::dmat3 linear(sonar_from_object);
    const double volume = glm::determinant(linear);
    placed = std::isfinite(volume) && volume != 0 && !mesh->parts().empty();
    if (!placed) return;
    const glm::dmat3 inverse = glm::inverse(linear);
    from_sonar = glm::mat3(inverse);
    place = glm::vec3(-(inverse * glm::dvec3(sonar_from_object[3])));
    const glm::dvec3 half = box.half();
    const glm::dvec3 middle(sonar_from_object * glm::dvec4(box.centre(), 1));
    const double radius = std::abs(half.x) * glm::length(linear[0]) + std::abs(half.y) * glm::length(linear[1]) +
                          std::abs(half.z) * glm::length(linear[2]);
    const double distance = glm::length(middle), share = 1.001 * radius / distance;
    cosine = -1;
    if (!(share < 1)) return;
    towards = glm::vec3(middle / distance);
    sine = static_cast<float>(share);
    cosine = static_cast<float>(std::sqrt(1 - share * share));
}

/** Returns whether a cone of rays touches the cone about the ball. */
bool RayVisibility::Mover::mayMeet(const TileCone& rays) const {
    if (!placed) return false;
    if (cosine < 0) return true;
    return glm::dot(rays.axis, towards) >= rays.cosine * cosine - rays.sine * sine ||
           rays.cosine * sine + rays.sine * cosine < 0;
}

/** The scene about one origin. */
struct RayVisibility::Tree {
    std::optional<SceneTrees> trees;
    std::vector<Mover> movers;
    glm::dvec3 origin{0};  ///< Place in the world [m].
    bool is_built = false;
};

RayVisibility::RayVisibility(const types::Geometry& geometry, std::span<const uint32_t> deforming)
    : here_(std::make_unique<Tree>()), before_(std::make_unique<Tree>()) {
    setScene(geometry, deforming);
}

RayVisibility::~RayVisibility() = default;

void RayVisibility::setScene(const types::Geometry& geometry, std::span<const uint32_t> deforming) {
    geometry_ = &geometry;
    moves_.resize(geometry.objects.size());
    here_->is_built = before_->is_built = false;
    still_.reset();
    listCommands();
    deforms_.assign(deforming.empty() ? 0 : geometry.objects.size(), false);
    std::vector<DeformingTrees::Object> objects;
    for (const uint32_t object : deforming) {
        deforms_[object] = true;
        const auto mesh = static_cast<size_t>(geometry.objects[object].mesh);
        if (!geometry.meshes[mesh].indices.empty())
            objects.push_back({object, first_command_[object], geometry.meshes.shared(mesh)});
    }
    deforming_ = DeformingTrees(std::move(objects));
    deforming_places_.resize(deforming_.size());
    is_fitted_ = false;
}

void RayVisibility::listCommands() {
    commands_.clear();
    first_command_.clear();
    uint32_t planes = 0;
    std::vector<uint32_t> first_plane;
    for (const types::Mesh& mesh : geometry_->meshes) {
        first_plane.push_back(planes);
        planes += static_cast<uint32_t>(mesh.indices.size() / 3);
    }
    const std::vector<uint32_t> lattices = makeLattices(*geometry_);
    for (size_t i = 0; i < geometry_->objects.size(); ++i) {
        first_command_.push_back(static_cast<uint32_t>(commands_.size()));
        const auto mesh = static_cast<size_t>(geometry_->objects[i].mesh);
        for (const MaterialRun& run : materialRuns(geometry_->meshes[mesh]))
            commands_.push_back(
                {static_cast<uint32_t>(i), first_plane[mesh], static_cast<uint32_t>(run.material), lattices[i]});
    }
}

bool RayVisibility::hasNewMover(const types::Snapshot& snapshot) const {
    return std::ranges::any_of(snapshot.moved, [this](const auto& moved) { return isStill(moved.object); }) ||
           (snapshot.movable &&
            std::ranges::any_of(*snapshot.movable, [this](uint32_t object) { return isStill(object); }));
}

void RayVisibility::place(const types::Snapshot& snapshot) {
    const glm::dvec3 origin = originNear(snapshot.sonar.position);
    if (hasNewMover(snapshot)) forgetTrees(snapshot);
    if (here_->is_built && here_->origin != origin) std::swap(here_, before_);
    if (!here_->is_built || here_->origin != origin) build(origin);
    if (trees_ahead_.follow(snapshot.sonar.position, still_)) {
        if (!trees_ahead_.needs(before_->origin)) *before_ = {};  // while the other thread still has the tree
        trees_ahead_.send();
    }
    world_from_sonar_ = glm::mat3(glm::mat3_cast(snapshot.sonar.orientation));
    place_ = glm::vec3(snapshot.sonar.position - origin);
    placeMovers(snapshot);
    if (!deforming_.isEmpty()) placeDeforming(snapshot);
}

void RayVisibility::placeDeforming(const types::Snapshot& snapshot) {
    for (size_t i = 0; i < deforming_.size(); ++i) {
        const uint32_t object = deforming_.object(i);
        const auto moved = std::ranges::find(snapshot.moved, object, &types::MovedObject::object);
        glm::dmat4 place =
            moved == snapshot.moved.end() ? geometry_->objects[object].world_from_object : moved->world_from_object;
        place[3] -= glm::dvec4(here_->origin, 0);
        is_fitted_ = is_fitted_ && place == deforming_places_[i];
        deforming_places_[i] = place;
    }
}

void RayVisibility::joinDeforming() {
    deforming_.join();
    is_fitted_ = true;
}

void RayVisibility::fitDeforming(size_t part, size_t parts) {
    for (size_t i = part; i < deforming_.size(); i += parts) deforming_.fit(i, deforming_places_[i]);
}

void RayVisibility::forget() {
    moves_.assign(moves_.size(), false);
    here_->is_built = before_->is_built = false;
    still_.reset();
}

void RayVisibility::forgetTrees(const types::Snapshot& snapshot) {
    for (const types::MovedObject& moved : snapshot.moved) moves_[moved.object] = true;
    if (snapshot.movable)
        for (const uint32_t object : *snapshot.movable) moves_[object] = true;
    here_->is_built = before_->is_built = false;
    still_.reset();
}

void RayVisibility::sortObjects() {
    auto still = std::make_shared<std::vector<TreeObject>>();
    apart_.clear();
    std::vector<size_t> uses(geometry_->meshes.size());
    size_t triangles = 0;
    for (const types::Object& object : geometry_->objects) {
        const auto mesh = static_cast<size_t>(object.mesh);
        ++uses[mesh];
        if (!object.transient) triangles += geometry_->meshes[mesh].indices.size() / 3;
    }
    for (size_t i = 0; i < geometry_->objects.size(); ++i) {
        const types::Object& object = geometry_->objects[i];
        const auto mesh = static_cast<size_t>(object.mesh);
        if (geometry_->meshes[mesh].indices.empty() || !isStill(static_cast<uint32_t>(i))) continue;
        const bool is_apart = object.transient || (triangles > max_copied && uses[mesh] > 1);
        (is_apart ? apart_ : *still)
            .push_back({geometry_->meshes.shared(mesh), object.world_from_object, first_command_[i]});
    }
    still_ = std::move(still);
}

void RayVisibility::build(const glm::dvec3& origin) {
    here_->is_built = false;
    here_->origin = origin;
    if (!still_) sortObjects();
    std::vector<Mover> movers;
    for (size_t i = 0; i < geometry_->objects.size(); ++i) {
        const auto mesh = static_cast<size_t>(geometry_->objects[i].mesh);
        if (!moves_[i] || doesDeform(i) || geometry_->meshes[mesh].indices.empty()) continue;
        const types::MeshPtr& shared = geometry_->meshes.shared(mesh);
        Mover& mover = movers.emplace_back(static_cast<uint32_t>(i), first_command_[i], MeshTree::of(shared));
        mover.tree = mover.mesh->tree().scene();
        mover.box = MeshFacts::of(shared)->box();
    }
    // Keeps the old trees until it has reused them.
    here_->trees.emplace(SceneTrees(objectsAbout(*still_, origin), objectsAbout(apart_, origin)));
    here_->movers = std::move(movers);
    here_->is_built = true;
}

void RayVisibility::placeMovers(const types::Snapshot& snapshot) {
    if (here_->movers.empty()) return;
    const glm::dmat3 sonar_from_world = glm::transpose(glm::mat3_cast(snapshot.sonar.orientation));
    for (Mover& mover : here_->movers) {
        const auto moved = std::ranges::find(snapshot.moved, mover.object, &types::MovedObject::object);
        const glm::dmat4& world_from_object = moved == snapshot.moved.end()
                                                  ? geometry_->objects[mover.object].world_from_object
                                                  : moved->world_from_object;
        glm::dmat4 place(sonar_from_world * glm::dmat3(world_from_object));
        place[3] = glm::dvec4(sonar_from_world * (glm::dvec3(world_from_object[3]) - snapshot.sonar.position), 1);
        mover.placeAt(place);
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void RayVisibility::trace(std::span<const TileRays> rays,
                                                                          std::span<TileHits> hits) const {
    INSONIFY_CHECK(here_->is_built);
    INSONIFY_CHECK(rays.size() <= tiles_at_once && rays.size() == hits.size(), rays.size(), hits.size());
    std::array<RTCRayHit16, tiles_at_once> all;
    const Rows world(world_from_sonar_);
    for (size_t i = 0; i < rays.size(); ++i) {
        extend(rays[i], static_cast<float>(nearest), all[i]);
        direct(world, place_, rays[i], all[i]);
        count(Counter::Rays, std::popcount(rays[i].active));
    }
    intersect(here_->trees->scene(), std::span(all).first(rays.size()));
    for (size_t i = 0; i < rays.size(); ++i) {
        std::fill_n(hits[i].command, tile_samples, TileHits::nothing);
        take(all[i], hits[i],
             [this](uint32_t geometry, uint32_t instance) { return here_->trees->meaning(geometry, instance); });
    }
    if (!deforming_.isEmpty()) {
        for (size_t i = 0; i < rays.size(); ++i) forgetHits(all[i]);
        intersect(deforming_.scene(), std::span(all).first(rays.size()));
        for (size_t i = 0; i < rays.size(); ++i)
            take(all[i], hits[i],
                 [this](uint32_t geometry, uint32_t instance) { return deforming_.meaning(geometry, instance); });
    }
    for (size_t i = 0; i < rays.size(); ++i) traceToMovers(rays[i], all[i], hits[i]);
}

void RayVisibility::traceToMovers(const TileRays& rays, RTCRayHit16& all, TileHits& hits) const {
    if (here_->movers.empty()) return;
    const TileCone cone = coneAbout(rays);
    alignas(64) int valid[tile_samples];
    for (int i = 0; i < tile_samples; ++i) valid[i] = (rays.active >> i & 1) ? -1 : 0;
    for (const Mover& mover : here_->movers) {
        if (!mover.mayMeet(cone)) {
            count(Counter::ObjectsCulled);
            continue;
        }
        direct(Rows(mover.from_sonar), mover.place, rays, all);
        intersect(mover.tree, valid, all);
        take(all, hits, [&](uint32_t geometry, uint32_t) { return mover.meaning(geometry); });
    }
}

void RayVisibility::traceAlong(const RayPaths& paths, const TileRays& rays, TileHits& hits) const {
    const std::span<const double> corners = paths.corners();
    count(Counter::Rays, std::popcount(rays.active));
    std::fill_n(hits.command, tile_samples, TileHits::nothing);
    TileRays left = rays;
    Piece piece{};
    for (size_t k = 1; k < corners.size() && left.active; ++k) {
        const double start = corners[k - 1], length = corners[k] - start;
        piece = {start, corners[k], piece.to, getPlaces(paths, rays, corners[k])};
        RTCRayHit16 all;
        extend(left, k == 1 ? static_cast<float>(nearest / length) : 0, all);
        for (float& end : all.ray.tfar) end = std::min(end, 1.0f);
        tracePiece(paths, left, piece, all, hits);
        for (uint32_t i = 0; i < tile_samples; ++i) {
            if (hits.command[i] == TileHits::nothing || !(left.active >> i & 1)) continue;
            hits.range[i] = static_cast<float>(start + static_cast<double>(all.ray.tfar[i]) * length);
            left.active &= ~(1u << i);
        }
    }
}

void RayVisibility::tracePiece(const RayPaths& paths, const TileRays& rays, const Piece& piece, RTCRayHit16& all,
                               TileHits& hits) const {
    alignas(64) int valid[tile_samples];
    for (int i = 0; i < tile_samples; ++i) valid[i] = (rays.active >> i & 1) ? -1 : 0;
    direct(Rows(world_from_sonar_), place_, piece.from, piece.to, all);
    intersect(here_->trees->scene(), valid, all);
    take(all, hits, [this](uint32_t geometry, uint32_t instance) { return here_->trees->meaning(geometry, instance); });
    if (!deforming_.isEmpty()) tracePieceAtDeforming(paths, rays, piece, valid, all, hits);
    for (const Mover& mover : here_->movers) {
        if (!mover.placed) continue;
        if (const Drift* drift = paths.drift(mover.object))
            direct(Rows(mover.from_sonar), mover.place, getPlaces(paths, rays, piece.start, drift),
                   getPlaces(paths, rays, piece.end, drift), all);
        else
            direct(Rows(mover.from_sonar), mover.place, piece.from, piece.to, all);
        intersect(mover.tree, valid, all);
        take(all, hits, [&](uint32_t geometry, uint32_t) { return mover.meaning(geometry); });
    }
}

/** Each object by itself, for it moves by a drift of its own. */
void RayVisibility::tracePieceAtDeforming(const RayPaths& paths, const TileRays& rays, const Piece& piece,
                                          const int* valid, RTCRayHit16& all, TileHits& hits) const {
    for (size_t i = 0; i < deforming_.size(); ++i) {
        if (const Drift* drift = paths.drift(deforming_.object(i)))
            direct(Rows(world_from_sonar_), place_, getPlaces(paths, rays, piece.start, drift),
                   getPlaces(paths, rays, piece.end, drift), all);
        else
            direct(Rows(world_from_sonar_), place_, piece.from, piece.to, all);
        intersect(deforming_.scene(i), valid, all);
        take(all, hits, [&](uint32_t geometry, uint32_t) { return deforming_.meaningIn(i, geometry); });
    }
}

void RayVisibility::trace(const PathRays& rays, TileHits& hits) const {
    std::fill_n(hits.command, tile_samples, TileHits::nothing);
    RTCRayHit16 all;
    count(Counter::OnwardRays, std::popcount(rays.towards.active));
    const Valid valid(rays.towards.active);
    bound(rays, all.ray);
    direct(Rows(world_from_sonar_), place_, rays, all.ray);
    forgetHits(all);
    intersect(here_->trees->scene(), valid.of, all);
    take(all, hits, [this](uint32_t geometry, uint32_t instance) { return here_->trees->meaning(geometry, instance); });
    if (!deforming_.isEmpty()) {
        forgetHits(all);
        intersect(deforming_.scene(), valid.of, all);
        take(all, hits,
             [this](uint32_t geometry, uint32_t instance) { return deforming_.meaning(geometry, instance); });
    }
    for (const Mover& mover : here_->movers) {
        if (!mover.placed) continue;
        direct(Rows(mover.from_sonar), mover.place, rays, all.ray);
        forgetHits(all);
        intersect(mover.tree, valid.of, all);
        take(all, hits, [&](uint32_t geometry, uint32_t) { return mover.meaning(geometry); });
    }
}

uint32_t RayVisibility::blocked(const PathRays& rays) const {
    RTCRay16 all;
    count(Counter::OcclusionRays, std::popcount(rays.towards.active));
    const Valid valid(rays.towards.active);
    bound(rays, all);
    direct(Rows(world_from_sonar_), place_, rays, all);
    // Embree 3.13 may never return from rtcOccluded16 of coherent rays through instances.
    const bool are_coherent = !here_->trees->hasInstances();
    occlude(here_->trees->scene(), valid.of, are_coherent, all);
    if (!deforming_.isEmpty()) occlude(deforming_.scene(), valid.of, false, all);
    for (const Mover& mover : here_->movers) {
        if (!mover.placed) continue;
        direct(Rows(mover.from_sonar), mover.place, rays, all);
        occlude(mover.tree, valid.of, are_coherent, all);
    }
    uint32_t hits = 0;
    for (int i = 0; i < tile_samples; ++i) hits |= static_cast<uint32_t>(all.tfar[i] < 0) << i;
    return hits & rays.towards.active;
}

}  // namespace insonify::sonar
