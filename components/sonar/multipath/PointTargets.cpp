#include "components/sonar/multipath/PointTargets.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "components/sonar/bins/EchoField.hpp"
#include "types/Check.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
PointTargets::PointTargets(const RenderPlan& plan, const types::Geometry& geometry)
    : plan_(plan), absorption_(makeAbsorption(plan.config).intensityPerMetre()), shape_(echoShape(plan)) {
    means_.reserve(static_cast<size_t>(plan.grid.bin_count));
    setScene(geometry);
}

void PointTargets::setScene(const types::Geometry& geometry) {
    walls_.reset();
    if (plan_.has(Pass::Walls)) walls_.emplace(plan_);
    paths_.emplace(plan_.config, geometry, walls_ ? &*walls_ : nullptr);
}

std::optional<BeamAngles> PointTargets::computeDirection(const glm::dvec3& direction) const {
    const bool conical = plan_.features.has(Feature::Conical);
    if (conical && direction.x < 0) return {};
    return beamAngles(direction, conical);
}

std::optional<PointTargets::Return> PointTargets::computeReturn(const TargetPath& out, const TargetPath& back,
                                                                double strength_db) const {
    const auto sent = computeDirection(out.direction), received = computeDirection(back.direction);
    const double range = 0.5 * (out.length + back.length);
    if (!sent || !received || !(range >= plan_.grid.range_min)) return {};
    const double ringing = &out == &back ? out.ringing : 1;
    const double intensity = std::pow(10, strength_db / 10) * out.power * back.power * ringing *
                             std::exp(-absorption_ * range) / (out.length * out.length * back.length * back.length);
    return Return{range,
                  *sent,
                  *received,
                  intensity,
                  out.by_surface == back.by_surface ? 1.0 : -1.0,
                  inPhase(out) * inPhase(back),
                  out.walls + back.walls > 0};
}

double PointTargets::inPhase(const TargetPath& path) const {
    if (!path.by_surface || !plan_.config.frequency_khz) return 1;
    const double wavelength = plan_.grid.speed_of_sound / (1e3 * *plan_.config.frequency_khz);
    return coherentReflection(plan_.config.multipath->surface->wind_m_s, wavelength, path.sine_grazing);
}

bool PointTargets::mayReceive(const glm::dvec3& direction) const {
    const auto angles = computeDirection(direction);
    if (!angles) return false;
    const auto& pattern = plan_.directivity;
    if (pattern && pattern->hasElevation()) {
        const double along = pattern->sentElevation(angles->elevation) * pattern->receivedElevation(angles->elevation);
        if (along < pattern->floor()) return false;
    } else if (std::abs(angles->elevation) > types::radians(plan_.config.beam_height_deg) / 2) {
        return false;
    }
    return (pattern && pattern->hasAzimuth() && !pattern->hasBoxes()) || plan_.beams.spans(angles->azimuth);
}

double PointTargets::powerIn(const Beam& beam, const Return& echo) const {
    const auto& pattern = plan_.directivity;
    const double half_height = types::radians(plan_.config.beam_height_deg) / 2;
    const double off = std::remainder(echo.received.azimuth - beam.centre, 2 * std::numbers::pi);
    const bool in_box = off >= beam.low - beam.centre && off < beam.high - beam.centre;
    const double across = pattern && pattern->hasAzimuth()
                              ? pattern->sentAzimuth(echo.sent.azimuth) *
                                    (pattern->hasBoxes() ? static_cast<double>(in_box)
                                                         : pattern->receivedAzimuth(echo.received.azimuth, beam.centre,
                                                                                    pattern->zoneAt(echo.range)))
                              : in_box && plan_.beams.spans(echo.sent.azimuth);
    const double along =
        pattern && pattern->hasElevation()
            ? pattern->sentElevation(echo.sent.elevation) * pattern->receivedElevation(echo.received.elevation)
            : std::abs(echo.received.elevation) <= half_height && std::abs(echo.sent.elevation) <= half_height;
    return pattern && across * along < pattern->floor() ? 0 : across * along;
}

std::complex<double> PointTargets::phaseIn(const Beam& beam, const Return& echo) const {
    if (!plan_.directivity || !plan_.directivity->hasAzimuth()) return 1;
    const double sent = plan_.directivity->sentAmplitude(echo.sent.azimuth);
    const std::complex<double> received =
        plan_.directivity->receivedField(echo.received.azimuth, beam.centre, plan_.directivity->zoneAt(echo.range));
    if (received.imag() == 0) return std::copysign(1.0, sent * received.real());
    return std::copysign(1.0, sent) * received / std::abs(received);
}

bool PointTargets::spread(double range) {
    const BinGrid& grid = plan_.grid;
    const double reach = shape_ ? shape_->reach() : 0;
    const double first = std::max(0.0, binAt(range - reach, grid.bin_width));
    const double last = std::min(grid.bin_count - 1.0, binAt(range + reach, grid.bin_width));
    means_.clear();
    first_bin_ = static_cast<size_t>(first);
    for (double k = first; k <= last; ++k)
        means_.push_back(shape_ ? shape_->mean(k * grid.bin_width - range, (k + 1) * grid.bin_width - range) : 1);
    return !means_.empty();
}

bool PointTargets::addTo(PingInMaking& to, const Return& echo) const {
    bool received = false;
    for (size_t beam = 0; beam < plan_.beams.size(); ++beam) {
        const double power = powerIn(plan_.beams[beam], echo);
        if (!(power > 0)) continue;
        const size_t first = beam * to.ping.bin_count + first_bin_;
        INSONIFY_CHECK(first + means_.size() <= to.ping.bins.size(), first, means_.size(), to.ping.bins.size());
        float* bins = &to.ping.bins[first];
        for (size_t i = 0; i < means_.size(); ++i) {
            const auto added = static_cast<float>(echo.intensity * power * means_[i]);
            bins[i] += added;
            if (added > bins[i] / 2) to.report(first + i, echo.passes_walls);
        }
        received = true;
    }
    return received;
}

bool PointTargets::addTo(EchoField& field, const Return& echo, uint64_t key) const {
    constexpr double turn = 2 * std::numbers::pi;
    const double turns = 2e3 * *plan_.config.frequency_khz / plan_.grid.speed_of_sound * echo.range;
    const double phase = turn * (turns - std::floor(turns)), loose = turn * static_cast<double>(key >> 11) * 0x1p-53;
    const std::complex<double> unit = echo.sign * (std::polar(echo.in_phase, phase) +
                                                   std::polar(std::sqrt(1 - echo.in_phase * echo.in_phase), loose));
    bool received = false;
    for (size_t k = 0; k < plan_.beams.size(); ++k) {
        const double power = powerIn(plan_.beams[k], echo);
        if (!(power > 0)) continue;
        field.add(k, echo.range, std::sqrt(echo.intensity * power) * phaseIn(plan_.beams[k], echo) * unit);
        received = true;
    }
    return received;
}

std::optional<TargetPath> PointTargets::findBentPath(const RayPaths& bent, const types::Snapshot& snapshot,
                                                     size_t target) {
    const glm::dvec3 from_sonar = snapshot.targets[target].position - snapshot.sonar.position;
    const auto received = bent.received(glm::conjugate(snapshot.sonar.orientation) * from_sonar, target);
    if (!received) return {};
    TargetPath path;
    path.length = glm::length(received->place);
    path.direction = received->place / path.length;
    path.power = received->focus;
    return path;
}

size_t PointTargets::add(PingInMaking& to) {
    const types::Snapshot& snapshot = to.snapshot;
    paths_->place(snapshot, plan_.grid.range_max + (shape_ ? shape_->reach() : 0));
    size_t received = 0;
    const auto time = static_cast<uint64_t>(snapshot.time.microseconds);
    const bool named = snapshot.target_names && snapshot.target_names->size() == snapshot.targets.size();
    for (size_t i = 0; i < snapshot.targets.size(); ++i) {
        const types::PointTarget& target = snapshot.targets[i];
        const uint64_t own = named ? types::hashedName((*snapshot.target_names)[i]) : i;
        bool any = false;
        std::span<const TargetPath> paths = paths_->pathsTo(target.position);
        const auto path = to.bent && !paths.empty() ? findBentPath(*to.bent, snapshot, i) : std::nullopt;
        if (to.bent) paths = {path ? &*path : nullptr, path ? 1u : 0u};
        for (const TargetPath& out : paths)
            for (const TargetPath& back : paths) {
                const auto pair =
                    static_cast<uint64_t>((&out - paths.data()) * std::ssize(paths) + (&back - paths.data()));
                any |= addPair(out, back, target.strength_db, to, types::hashed(time, own, pair));
            }
        received += any ? 1 : 0;
    }
    return received;
}

bool PointTargets::addPair(const TargetPath& out, const TargetPath& back, double strength_db, PingInMaking& to,
                           uint64_t key) {
    if (&out == &back && out.arrivals) return addRinging(out, strength_db, to, key);
    if (out.arrivals || back.arrivals) return addRinging(out, back, strength_db, to, key);
    const auto echo = computeReturn(out, back, strength_db);
    if (!echo || !spread(echo->range)) return false;
    return to.field ? addTo(*to.field, *echo, key) : addTo(to, *echo);
}

bool PointTargets::addRinging(const TargetPath& path, double strength_db, PingInMaking& to, uint64_t key) {
    const EchoTrain& train = path.arrivals->both;
    bool any = false;
    for (size_t k = 0; k < train.size(); ++k) {
        TargetPath rung = path;
        rung.arrivals = nullptr;
        rung.length += train[k].late;
        rung.power *= std::sqrt(std::max(train[k].weight, 0.0));
        if (rung.length > 0) any |= addPair(rung, rung, strength_db, to, key);
    }
    return any;
}

bool PointTargets::addRinging(const TargetPath& out, const TargetPath& back, double strength_db, PingInMaking& to,
                              uint64_t key) {
    constexpr double min_share = 1e-6;
    const EchoTrain none, &there = out.arrivals ? out.arrivals->once : none,
                          &here = back.arrivals ? back.arrivals->once : none;
    bool any = false;
    for (size_t j = 0; j < there.size(); ++j)
        for (size_t k = 0; k < here.size(); ++k) {
            if (!(there[j].weight * here[k].weight > min_share)) continue;
            TargetPath rung = out, returned = back;
            rung.arrivals = returned.arrivals = nullptr;
            rung.power *= there[j].weight * here[k].weight;
            rung.length += there[j].late + here[k].late;
            returned.length += there[j].late + here[k].late;
            if (std::min(rung.length, returned.length) > 0) any |= addPair(rung, returned, strength_db, to, key);
        }
    return any;
}

bool PointTargets::addAlong(const TargetPath& path, double strength_db, PingInMaking& to) {
    return addPair(path, path, strength_db, to, 0);
}

}  // namespace insonify::sonar
