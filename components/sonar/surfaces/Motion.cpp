#include "components/sonar/surfaces/Motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "types/geometry/PosedMesh.hpp"

namespace insonify::sonar {
namespace {

bool isKnown(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to, double seconds) {
    glm::dquat turned = glm::normalize(to * glm::conjugate(from));
    if (turned.w < 0) turned = -turned;
    const glm::dvec3 axis(turned.x, turned.y, turned.z);
    const double sine = glm::length(axis);
    return sine > 0 ? axis * (2 * std::atan2(sine, turned.w) / (sine * seconds)) : glm::dvec3(0);
}

Motion::Motion(const types::Geometry& geometry, double fastest) : fastest_allowed_(fastest) { setScene(geometry); }

void Motion::setScene(const types::Geometry& geometry) {
    const std::vector<Thing> old = std::exchange(things_, {});
    places_.clear();
    deforming_.assign(geometry.objects.size(), nullptr);
    for (const types::Object& object : geometry.objects) {
        const types::MeshPtr& mesh = geometry.meshes.shared(static_cast<size_t>(object.mesh));
        things_.push_back({object.name, mesh, MeshFacts::of(mesh)});
        places_.push_back(object.world_from_object);
    }
    const auto isNew = [&](const types::MovedObject& moved) {
        return moved.object >= things_.size() || moved.object >= old.size() ||
               things_[moved.object] != old[moved.object];
    };
    if (now_) std::erase_if(now_->moved, isNew);
    drifts_.assign(things_.size(), std::nullopt);
}

void Motion::follow(const types::Snapshot& snapshot) {
    if (!now_ || now_->sonar.time != snapshot.time) {
        std::swap(before_, now_);
        if (!now_) now_.emplace();
        now_->sonar = snapshot.sonar;
        now_->sonar.time = snapshot.time;
        now_->moved = snapshot.moved;
        now_->targets = snapshot.targets;
        seconds_ = before_ ? (snapshot.time - before_->sonar.time).seconds() : 0;
        if (seconds_ <= 0) before_.reset();
        followSonar(snapshot);
    }
    followObjects(snapshot);
}

void Motion::followSonar(const types::Snapshot& snapshot) {
    const types::Pose& sonar = snapshot.sonar;
    velocity_ = turn_ = glm::dvec3(0);
    const glm::dvec3 between = before_ ? (sonar.position - before_->sonar.position) / seconds_ : glm::dvec3(0);
    const bool has_moved = before_ && glm::length(between) <= fastest_allowed_;
    if (isKnown(sonar.velocity) && glm::length(sonar.velocity) <= fastest_allowed_)
        velocity_ = sonar.velocity;
    else if (has_moved)
        velocity_ = between;
    if (isKnown(sonar.angular_velocity))
        turn_ = sonar.orientation * sonar.angular_velocity;
    else if (has_moved)
        turn_ = turnBetween(before_->sonar.orientation, sonar.orientation, seconds_);
}

void Motion::followObjects(const types::Snapshot& snapshot) {
    std::ranges::fill(drifts_, std::nullopt);
    fastest_ = 0;
    for (const types::MovedObject& moved : snapshot.moved) {
        if (moved.rate && *moved.rate != glm::dmat4(0)) addDrift(snapshot.sonar, moved, *moved.rate);
        if (!before_ || moved.rate) continue;
        const auto was = std::ranges::find(before_->moved, moved.object, &types::MovedObject::object);
        if (was != before_->moved.end() && was->world_from_object != moved.world_from_object)
            addDrift(snapshot.sonar, moved, (moved.world_from_object - was->world_from_object) / seconds_);
    }
    followShapes(snapshot);
    steepest_ = 0;
    for (const std::optional<Drift>& drift : drifts_)
        if (drift) {
            const glm::dmat3& m = drift->linear;
            const double squares = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
            steepest_ = std::max(steepest_, std::sqrt(squares));
        }
    for (size_t i = 0; i < snapshot.targets.size(); ++i) fastest_ = std::max(fastest_, glm::length(targetVelocity(i)));
}

void Motion::addDrift(const types::Pose& sonar, const types::MovedObject& now, const glm::dmat4& rate) {
    const glm::dmat4& place = now.world_from_object;
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(place));
    const glm::dmat3 world = glm::dmat3(rate) * inverse, turn = glm::mat3_cast(sonar.orientation);
    Drift drift;
    drift.linear = glm::transpose(turn) * world * turn;
    drift.constant = (world * (sonar.position - glm::dvec3(place[3])) + glm::dvec3(rate[3])) * turn;
    const auto& [low, high] = things_[now.object].mesh->box();
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z, 1);
        drift.fastest = std::max(drift.fastest, glm::length(glm::dvec3(rate * p)));
    }
    if (!(drift.fastest <= fastest_allowed_) || !isKnown(drift.constant)) return;
    fastest_ = std::max(fastest_, drift.fastest);
    drifts_[now.object] = drift;
}

void Motion::followShapes(const types::Snapshot& snapshot) {
    for (const auto& one : deforming_)
        if (one) one->moves = false;
    for (const types::DeformedObject& deformed : snapshot.deformed) addShape(snapshot, deformed);
}

void Motion::addShape(const types::Snapshot& snapshot, const types::DeformedObject& deformed) {
    const uint32_t object = deformed.object;
    const types::MeshPtr& mesh = things_[object].shape;
    types::computeVelocities(types::getPose(snapshot, deformed, *mesh->deformation), *mesh->deformation, of_vertices_);
    const auto moved = std::ranges::find(snapshot.moved, object, &types::MovedObject::object);
    const glm::dmat4& place = moved == snapshot.moved.end() ? places_[object] : moved->world_from_object;
    const glm::dmat3 sonar_from_world = glm::transpose(glm::mat3_cast(snapshot.sonar.orientation));
    const glm::dmat3 turn = sonar_from_world * glm::dmat3(place);
    const glm::dvec3 origin = sonar_from_world * (glm::dvec3(place[3]) - snapshot.sonar.position);
    if (!deforming_[object]) deforming_[object] = std::make_shared<Deforming>();
    Deforming& own = *deforming_[object];
    own.mesh = mesh;
    own.places.resize(of_vertices_.size());
    own.velocities.resize(of_vertices_.size());
    const Drift whole = drifts_[object].value_or(Drift());
    Drift drift;  // constant, so that the ways of rays about the object are as straight as before
    double fastest = 0;
    for (size_t i = 0; i < of_vertices_.size(); ++i) {
        own.places[i] = origin + turn * glm::dvec3(mesh->positions[i]);
        const glm::dvec3 bends = turn * glm::dvec3(of_vertices_[i]);
        own.velocities[i] = whole.at(own.places[i]) + bends;
        drift.constant += own.velocities[i];
        fastest = std::max(fastest, glm::length(own.velocities[i]));
    }
    if (!(fastest > 0) || !(fastest <= fastest_allowed_)) return;
    own.moves = true;
    drift.constant /= static_cast<double>(of_vertices_.size());
    drift.fastest = fastest;
    fastest_ = std::max(fastest_, fastest);
    drifts_[object] = drift;
}

const Drift* Motion::findDrift(uint32_t object, uint32_t triangle, Drift& own) const {
    const Deforming* const deforming = deforming_[object].get();
    if (!deforming || !deforming->moves) return drift(object);
    const uint32_t* const corners = &deforming->mesh->indices[3 * static_cast<size_t>(triangle)];
    const glm::dvec3 &a = deforming->places[corners[0]], &v = deforming->velocities[corners[0]];
    const glm::dvec3 s = deforming->places[corners[1]] - a, t = deforming->places[corners[2]] - a;
    const glm::dvec3 rate_s = deforming->velocities[corners[1]] - v, rate_t = deforming->velocities[corners[2]] - v;
    const glm::dvec3 across = glm::cross(s, t);
    const double square = glm::dot(across, across);
    own = {};
    own.constant = v;
    if (!(square > 0)) return &own;
    // A place of the plane is a + x s + y t; x and y are its products with two vectors of the plane. The normal turns
    // with the plane, so that a body that only turns has the gradient of its rotation.
    const glm::dvec3 per_s = glm::cross(t, across) / square, per_t = glm::cross(across, s) / square;
    const glm::dvec3 normal = across / std::sqrt(square);
    const glm::dmat3 within = glm::outerProduct(rate_s, per_s) + glm::outerProduct(rate_t, per_t);
    own.linear = within - glm::outerProduct(glm::transpose(within) * normal, normal);
    own.constant = v - own.linear * a;
    return &own;
}

glm::dvec3 Motion::targetVelocity(size_t target) const {
    if (!before_ || before_->targets.size() != now_->targets.size() || target >= now_->targets.size()) return {};
    const glm::dvec3 velocity = (now_->targets[target].position - before_->targets[target].position) / seconds_;
    return glm::length(velocity) <= fastest_allowed_ ? velocity : glm::dvec3(0);
}

}  // namespace insonify::sonar
