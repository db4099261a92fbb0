#include "components/nav/Dvl.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "components/nav/ErrorModel.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/MeshRays.hpp"
#include "types/geometry/PosedMesh.hpp"

namespace insonify::nav {
namespace {

/** The random numbers of each beam: constants of the instrument, and errors that differ from ping to ping. */
enum Channel : uint64_t { Scale, Bias, Velocity, Range, Dropout };
uint64_t getChannel(Channel channel, size_t beam) { return 200 + beam_count * channel + beam; }

}  // namespace

const types::Mesh& Bottom::getMesh(size_t object) const {
    const types::Geometry& geometry = *snapshot_->geometry;
    return geometry.meshes[static_cast<size_t>(geometry.objects[object].mesh)];
}

const types::Mesh& Bottom::posed(const types::DeformedObject& deformed) {
    const auto found = posed_.try_emplace(deformed.object, getMesh(deformed.object)).first;
    types::poseMesh(types::getPose(*snapshot_, deformed, *found->second.deformation), found->second);
    return found->second;
}

void Bottom::place(size_t object, const glm::dmat4& world_from_object, const types::Mesh& mesh) {
    Placed placed;
    placed.world_from_object = world_from_object;
    placed.mesh = &mesh;
    for (const types::Cluster& cluster : mesh.clusters) {
        const types::WorldBox box(world_from_object, cluster.centre, cluster.half);
        placed.low = glm::min(placed.low, box.centre - box.half);
        placed.high = glm::max(placed.high, box.centre + box.half);
    }
    placed_[object] = placed;
}

void Bottom::take(types::SnapshotPtr snapshot) {
    const bool is_other = !snapshot_ || snapshot_->geometry != snapshot->geometry;
    snapshot_ = std::move(snapshot);
    if (!snapshot_->geometry) return placed_.clear();
    const std::vector<types::Object>& objects = snapshot_->geometry->objects;
    if (is_other) {
        placed_.assign(objects.size(), {});
        for (size_t i = 0; i < objects.size(); ++i) place(i, objects[i].world_from_object, getMesh(i));
        changed_.clear();
        posed_.clear();
    }
    for (const size_t object : changed_) place(object, objects[object].world_from_object, getMesh(object));
    changed_.clear();
    for (const types::MovedObject& moved : snapshot_->moved) {
        place(moved.object, moved.world_from_object, getMesh(moved.object));
        changed_.push_back(moved.object);
    }
    for (const types::DeformedObject& deformed : snapshot_->deformed) {
        place(deformed.object, glm::dmat4(placed_[deformed.object].world_from_object), posed(deformed));
        changed_.push_back(deformed.object);
    }
}

bool Bottom::isUnderWater(const glm::dvec3& place) const {
    return !snapshot_ || !snapshot_->water_surface || place.z < *snapshot_->water_surface;
}

std::optional<double> Bottom::range(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const {
    if (snapshot_) return rangeOfScene(from, direction, farthest);
    if (!height_ || direction.z == 0) return {};
    const double range = (*height_ - from.z) / direction.z;
    return range > 0 && range <= farthest ? std::optional(range) : std::nullopt;
}

std::optional<double> Bottom::rangeOfScene(const glm::dvec3& from, const glm::dvec3& direction, double farthest) const {
    double nearest = farthest;
    bool is_met = false;
    for (size_t i = 0; i < placed_.size(); ++i) {
        const Placed& placed = placed_[i];
        const glm::dvec3 way = direction * nearest;
        if (placed.mesh->clusters.empty() ||
            !types::meetsBox(from, way, (placed.low + placed.high) / 2.0, (placed.high - placed.low) / 2.0))
            continue;
        double share = 1;
        types::anyTriangleMet(*placed.mesh, placed.world_from_object, from, way, [&](double range, bool, size_t) {
            share = std::min(share, range);
            return false;
        });
        is_met = is_met || share < 1;
        nearest *= share;
    }
    return is_met ? std::optional(nearest) : std::nullopt;
}

BeamDirections janusBeams(double slant_deg, double azimuth_deg) {
    const double slant = types::radians(slant_deg);
    BeamDirections beams;
    for (size_t i = 0; i < beam_count; ++i) {
        const double azimuth = types::radians(azimuth_deg + 90 * static_cast<double>(i));
        beams[i] = {std::sin(slant) * std::cos(azimuth), std::sin(slant) * std::sin(azimuth), -std::cos(slant)};
    }
    return beams;
}

std::optional<VelocitySolution> solveVelocity(const BeamDirections& beams,
                                              const std::array<double, beam_count>& velocities,
                                              const std::array<double, beam_count>& variances) {
    glm::dmat3 normal{0}, spread{0};
    glm::dvec3 sum{0};
    size_t good = 0;
    for (size_t i = 0; i < beam_count; ++i) {
        if (std::isnan(velocities[i])) continue;
        const glm::dmat3 square = glm::outerProduct(beams[i], beams[i]);
        normal += square;
        spread += square * variances[i];
        sum += beams[i] * velocities[i];
        ++good;
    }
    if (good < 3) return {};
    const glm::dmat3 inverse = glm::inverse(normal);
    return VelocitySolution{inverse * sum, inverse * spread * inverse};
}

Dvl::Dvl(const DvlConfig& config)
    : config_(config),
      beams_(janusBeams(config.slant_deg, config.beam_azimuth_deg)),
      cosine_(std::cos(types::radians(config.slant_deg))) {
    for (size_t i = 0; i < beam_count; ++i) {
        scale_[i] = config.errors.scale_error * normal(config.sensor.randomSeed(), getChannel(Scale, i), {});
        bias_[i] = config.errors.velocity_bias * normal(config.sensor.randomSeed(), getChannel(Bias, i), {});
    }
}

double Dvl::range(size_t beam, const Motion& motion, const Bottom& bottom) const {
    if (config_.errors.dropout > uniform(config_.sensor.randomSeed(), getChannel(Dropout, beam), motion.time))
        return types::Pose::unknown;
    const glm::dvec3 direction = motion.orientation * beams_[beam];
    const auto range = bottom.range(motion.position, direction, config_.max_altitude / cosine_);
    if (!range || *range * cosine_ < config_.min_altitude) return types::Pose::unknown;
    const double noise =
        config_.errors.range_noise * normal(config_.sensor.randomSeed(), getChannel(Range, beam), motion.time);
    return std::max(*range + noise, 0.0);
}

double Dvl::variance(double velocity) const {
    const BeamErrors& errors = config_.errors;
    const auto square = [](double x) { return x * x; };
    return square(errors.velocity_noise) + square(errors.velocity_bias) + square(errors.scale_error * velocity);
}

void Dvl::measure(const Motion& motion, const Bottom& bottom, types::Dvl& reported) const {
    const glm::dvec3 velocity = glm::conjugate(motion.orientation) * motion.velocity;
    const bool is_under_water = bottom.isUnderWater(motion.position);
    reported.time = motion.time;
    reported.speed_of_sound = config_.speed_of_sound;
    reported.beam_directions.assign(beams_.begin(), beams_.end());
    for (auto* list : {&reported.beam_ranges, &reported.beam_velocities, &reported.beam_velocity_variances})
        list->assign(beam_count, types::Pose::unknown);
    for (size_t i = 0; i < beam_count; ++i) {
        reported.beam_ranges[i] = is_under_water ? range(i, motion, bottom) : types::Pose::unknown;
        if (std::isnan(reported.beam_ranges[i])) continue;
        const double along = glm::dot(beams_[i], velocity);
        const double noise =
            config_.errors.velocity_noise * normal(config_.sensor.randomSeed(), getChannel(Velocity, i), motion.time);
        reported.beam_velocities[i] = (1 + scale_[i]) * along + bias_[i] + noise;
        reported.beam_velocity_variances[i] = variance(along);
    }
    solve(reported);
}

void Dvl::solve(types::Dvl& reported) const {
    std::array<double, beam_count> velocities, variances;
    double sum = 0;
    for (size_t i = 0; i < beam_count; ++i) {
        velocities[i] = reported.beam_velocities[i];
        variances[i] = reported.beam_velocity_variances[i];
        sum += std::isnan(reported.beam_ranges[i]) ? 0 : reported.beam_ranges[i];
    }
    const auto good = static_cast<double>(reported.goodBeams());
    reported.altitude = good > 0 ? cosine_ * sum / good : types::Pose::unknown;
    const auto solution = solveVelocity(beams_, velocities, variances);
    reported.velocity = solution ? solution->velocity : glm::dvec3(types::Pose::unknown);
    reported.cov_velocity = solution ? solution->covariance : types::Pose::unknownMatrix();
}

types::Pose getVelocity(const types::Dvl& dvl) {
    types::Pose pose;
    pose.time = dvl.time;
    pose.source_frame = pose.target_frame = "dvl";
    pose.position = glm::dvec3(types::Pose::unknown);
    pose.velocity = dvl.velocity;
    pose.cov_velocity = dvl.cov_velocity;
    return pose;
}

}  // namespace insonify::nav
