#include "components/sonar/tasks/SideScanTask.hpp"

#include <fmt/format.h>

#include <utility>

#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

constexpr double max_height_deg = 120;  // of one beam of a fan
constexpr int default_rows = 8, default_columns = 2048;

}  // namespace

SonarConfig SideScanConfig::acrossTrack() const {
    SonarConfig fan = sonar;
    const double from_nadir = 90 - depression_deg;
    fan.across_track = true;
    fan.bearings_deg = {-from_nadir, from_nadir};
    fan.beam_width_deg = sonar.beam_height_deg;
    fan.beam_height_deg = *sonar.beam_width_deg;
    const QualityConfig& quality = sonar.quality;
    if (quality.isGiven() || (!quality.target_error && !quality.budget_ms && !quality.max_samples)) {
        fan.quality.rows = quality.rows.value_or(default_rows);
        fan.quality.columns_per_beam = quality.columns_per_beam.value_or(default_columns);
    }
    if (fan.beam_pattern)
        for (ArrayConfig* array : {&fan.beam_pattern->transmit, &fan.beam_pattern->receive})
            std::swap(array->azimuth, array->elevation);
    return fan;
}

void SideScanConfig::check(types::Diagnostics& diagnostics) const {
    const auto refuse = [&](const char* key, std::string why) { diagnostics.push_back({key, std::move(why)}); };
    if (sonar.beam_height_deg > max_height_deg)
        refuse("beam_height_deg",
               fmt::format("is {:g} deg; a side-scan's beam may have {:g}", sonar.beam_height_deg, max_height_deg));
    if (*sonar.beam_width_deg > 180)
        refuse("beam_width_deg", fmt::format("is {:g} deg; along the track it may be 180", *sonar.beam_width_deg));
    if (sonar.beam_geometry != BeamGeometry::Planar)
        refuse("beam_geometry", "is conical; a side-scan's beams are planar, which is the cone about its track");
    if (sonar.beam_pattern && sonar.beam_pattern->transmit.elevation)
        refuse("beam_pattern.transmit.elevation",
               "is given; a side-scan has one law across the track, receive.elevation, two-way about each beam's axis");
    if (diagnostics.empty()) acrossTrack().checkBeam(diagnostics);
}

const char* SideScanTask::setLook(types::Snapshot& scene) {
    scene.sonar.orientation *= glm::angleAxis(types::radians(90), glm::dvec3(0, 1, 0));
    return nullptr;
}

void SideScanTask::stampBearings(types::Sonar& sample) {
    sample.bearings = {types::Angle::fromDeg(-90), types::Angle::fromDeg(90)};
    sample.beam_width = types::Angle::fromDeg(*config->sonar.beam_width_deg);
    sample.beam_height = types::Angle::fromDeg(config->sonar.beam_height_deg);
}

}  // namespace insonify::sonar
