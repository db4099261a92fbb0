#include "components/study/Probe.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/renderer/SonarRenderer.hpp"
#include "components/study/Shapes.hpp"
#include "components/study/oracles/EmbreeTracer.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::study {
namespace {

constexpr double max_rays = 1e6, max_triangles = 1e5;  ///< Max for the computation of kappa, which takes time.

/** Returns the max number of bins that one pixel covers; NaN if the ray tracer does not support the beams, or would
 * take too long. */
double kappa(const sonar::SonarConfig& config, const types::Snapshot& snapshot) {
    const double rays = static_cast<double>(config.rows()) * config.columnsPerBeam() * config.beams();
    const bool planar = config.bearings_deg.empty() && config.beam_geometry == sonar::BeamGeometry::Planar;
    if (!planar || rays > max_rays || static_cast<double>(snapshot.geometry->triangleCount()) > max_triangles)
        return NAN;
    EmbreeTracer tracer(snapshot);
    std::vector<float> unused;
    tracer.prepare(config);
    tracer.render(snapshot.sonar, unused);
    return tracer.kappaMax();
}

/** Returns the loudest material relative to the mean of all [dB]. */
double strengthSpan(const types::Geometry& geometry) {
    double loudest = 0, sum = 0;
    for (const types::Material& material : geometry.materials) {
        const double mu = std::pow(10, material.lambert_db / 10);
        loudest = std::max(loudest, mu);
        sum += mu;
    }
    return sum > 0 ? 10 * std::log10(loudest * static_cast<double>(geometry.materials.size()) / sum) : 0;
}

Conditions getConditions(const sonar::SonarConfig& config, const types::Snapshot& snapshot, const types::Sonar& ping) {
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    const double nearest = std::max(grid.range_min, 0.5 * grid.bin_width);
    const auto occupied = static_cast<double>(std::ranges::count_if(ping.bins, [](float bin) { return bin != 0; }));
    const double pixels = static_cast<double>(config.rows()) * config.columnsPerBeam() * config.beams();
    Conditions all = {{"kappa", kappa(config, snapshot)},
                      {"range_ratio", grid.range_max / nearest},
                      {"attenuation_db", 2 * sonar::makeAbsorption(config).db_per_m * (grid.range_max - nearest)},
                      {"offset_ratio", glm::length(snapshot.sonar.position) / grid.bin_width},
                      {"strength_db", strengthSpan(*snapshot.geometry)},
                      {"samples_per_bin", occupied > 0 ? pixels / occupied : 0}};
    std::erase_if(all, [](const auto& condition) { return std::isnan(condition.second); });
    return all;
}

}  // namespace

double Probe::energy() const { return std::accumulate(ping.bins.begin(), ping.bins.end(), 0.0); }

double Probe::energy(uint32_t beam) const {
    const auto from = ping.bins.begin() + static_cast<ptrdiff_t>(size_t{beam} * ping.bin_count);
    return std::accumulate(from, from + ping.bin_count, 0.0);
}

int Probe::firstReturn(uint32_t beam) const {
    const auto from = ping.bins.begin() + static_cast<ptrdiff_t>(size_t{beam} * ping.bin_count);
    const auto found = std::find_if(from, from + ping.bin_count, [](float bin) { return bin > 0; });
    return found == from + ping.bin_count ? -1 : static_cast<int>(found - from);
}

bool Probe::isSound() const {
    return std::ranges::all_of(ping.bins, [](float bin) { return std::isfinite(bin) && bin >= 0; });
}

Probe probe(const sonar::SonarConfig& config, const types::Snapshot& snapshot) {
    sonar::SonarRenderer renderer(config, snapshot.geometry);
    Probe received;
    renderer.render(snapshot, received.ping);
    received.plan = renderer.plan();
    received.device = renderer.device();
    received.conditions = getConditions(config, snapshot, received.ping);
    return received;
}

sonar::SonarConfig fan(double fov_deg, double height_deg, int beams, double range) {
    sonar::SonarConfig config;
    config.speed_of_sound = 1000;
    config.range = range;
    config.bin_count = static_cast<int>(std::lround(range / 0.1));
    config.beam_count = beams;
    config.field_of_view_deg = fov_deg;
    config.beam_height_deg = height_deg;
    return config;
}

void setSamples(sonar::SonarConfig& config, int rows, int columns_per_beam) {
    config.quality.rows = rows;
    config.quality.columns_per_beam = columns_per_beam;
}

types::Snapshot lookingAt(types::GeometryPtr geometry, glm::dvec3 position, double yaw, double pitch) {
    types::Snapshot snapshot;
    snapshot.geometry = std::move(geometry);
    snapshot.sonar.position = position;
    snapshot.sonar.orientation = glm::angleAxis(yaw, glm::dvec3(0, 0, 1)) * glm::angleAxis(pitch, glm::dvec3(0, 1, 0));
    return snapshot;
}

std::shared_ptr<types::Geometry> makeCopy(const types::GeometryPtr& geometry) {
    return std::make_shared<types::Geometry>(*geometry);
}

types::Mesh levelGround(float z, float width) {
    return quad({-width / 2, -width / 2, z}, {width, 0, 0}, {0, width, 0});
}

types::Mesh facingWall(float x, float half_width) {
    return quad({x, -half_width, -half_width}, {0, 2 * half_width, 0}, {0, 0, 2 * half_width});
}

double difference(const types::Sonar& a, const types::Sonar& b) {
    if (a.bins.size() != b.bins.size()) return INFINITY;
    double error = 0, norm = 0;
    for (size_t i = 0; i < a.bins.size(); ++i) {
        error += std::pow(double{a.bins[i]} - b.bins[i], 2);
        norm += std::pow(double{b.bins[i]}, 2);
    }
    return error == 0 ? 0 : std::sqrt(error / norm);
}

double off(double a, double b) { return a == b ? 0 : std::abs(a / b - 1); }

double trueEnergy(const sonar::SonarConfig& config, uint32_t beam, const Truth& truth) {
    const sonar::BinGrid grid = sonar::makeBinGrid(config);
    return trueEnergy(config, beam, truth, grid.range_min, grid.range_max);
}

double trueEnergy(const sonar::SonarConfig& config, uint32_t beam, const Truth& truth, double r1, double r2) {
    const sonar::Beam limits = sonar::makeBeams(config)[beam];
    return truth({limits.low, limits.high, types::radians(config.beam_height_deg) / 2}, r1, r2);
}

double worstBeam(const Probe& received, const sonar::SonarConfig& config, const Truth& truth) {
    double worst = 0;
    for (uint32_t beam = 0; beam < received.ping.beam_count; ++beam)
        worst = std::max(worst, off(received.energy(beam), trueEnergy(config, beam, truth)));
    return worst;
}

Outcome within(double tolerance, double deviation, const std::string& got, const Probe& received) {
    return {received.conditions, got, deviation,
            deviation <= tolerance && received.isSound() ? Verdict::Pass : Verdict::Fail};
}

}  // namespace insonify::study
