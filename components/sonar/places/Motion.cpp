#include "components/sonar/places/Motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <utility>

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

Motion::Motion(const types::Geometry& geometry, double fastest) : fastest_allowed_(fastest) { takeScene(geometry); }

void Motion::takeScene(const types::Geometry& geometry) {
    const std::vector<Thing> old = std::exchange(things_, {});
    for (const types::Object& object : geometry.objects)
        things_.push_back({object.name, MeshFacts::of(geometry.meshes.shared(static_cast<size_t>(object.mesh)))});
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
        if (!before_) break;
        const auto was = std::ranges::find(before_->moved, moved.object, &types::MovedObject::object);
        if (was != before_->moved.end() && was->world_from_object != moved.world_from_object)
            driftOf(snapshot.sonar, moved, was->world_from_object);
    }
    for (size_t i = 0; i < snapshot.targets.size(); ++i) fastest_ = std::max(fastest_, glm::length(targetVelocity(i)));
}

void Motion::driftOf(const types::Pose& sonar, const types::MovedObject& now, const glm::dmat4& before) {
    const glm::dmat4& place = now.world_from_object;
    const glm::dmat4 rate = (place - before) / seconds_;
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

glm::dvec3 Motion::targetVelocity(size_t target) const {
    if (!before_ || before_->targets.size() != now_->targets.size() || target >= now_->targets.size()) return {};
    const glm::dvec3 velocity = (now_->targets[target].position - before_->targets[target].position) / seconds_;
    return glm::length(velocity) <= fastest_allowed_ ? velocity : glm::dvec3(0);
}

}  // namespace insonify::sonar
