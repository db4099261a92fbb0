#include "components/sonar/SonarConfig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/Acoustics.hpp"
#include "components/sonar/BeamFan.hpp"
#include "components/sonar/BinGrid.hpp"
#include "components/sonar/CastEchoes.hpp"

namespace insonify::sonar {
namespace {

constexpr double tallest_image_deg = 150;
constexpr int64_t most_bins = int64_t{1} << 24;  // sums of 16 bytes: 256 MiB

void checkPublished(const SonarConfig& config, types::Problems& problems) {
    if (config.model != Model::Cerqueira2017)
        problems.push_back({"published", "is true; only with model: cerqueira2017"});
    if (config.bin_count < 2) problems.push_back({"bin_count", "is 1; must be at least 2 with published: true"});
    if (config.coverageDeg() >= 180)
        problems.push_back({"published", fmt::format("is true with {} deg of azimuth; one image shows less than 180",
                                                     config.coverageDeg())});
    if (config.beam_geometry != BeamGeometry::Planar)
        problems.push_back({"beam_geometry", "is conical; must be planar with published: true"});
}

void checkRangeReached(const SonarConfig& config, types::Problems& problems) {
    const BinGrid grid = makeBinGrid(config);
    if (grid.range_max > 1.25 * config.range)
        problems.push_back(
            {"range", fmt::format("is {} m; {} bins of whole microseconds reach {:.6g} m, which may be at most 25 % "
                                  "more: lower bin_count, raise range, or set range_rounding: exact",
                                  config.range, config.bin_count, grid.range_max)});
}

void checkVisibility(const SonarConfig& config, types::Problems& problems) {
    if (config.visibility != Visibility::Cpu) return;
    if (!haveRays()) problems.push_back({"visibility", "is cpu; this build has no rays (Embree), may be auto or gl"});
    if (config.published)
        problems.push_back({"visibility", "is cpu with published: true, which is an image; may be gl"});
    if (config.deposit == Deposit::Gpu)
        problems.push_back({"deposit", "is gpu with visibility: cpu; may be auto or cpu"});
}

void checkImages(const SonarConfig& config, types::Problems& problems) {
    if (config.beam_height_deg > tallest_image_deg)
        return problems.push_back(
            {"beam_height_deg", fmt::format("is {:g} deg; an image shows {:g}, rays (visibility: cpu) 180",
                                            config.beam_height_deg, tallest_image_deg)});
    const int columns = makeSlabs(config, makeBeams(config)).front().columns;
    if (columns > most_image_size)
        problems.push_back(
            {"quality.columns_per_beam",
             fmt::format("is {}, which with beams of {:g} deg over {:g} deg makes images of {} columns; may be {}",
                         config.columnsPerBeam(), config.beamWidthDeg(), config.coverageDeg(), columns,
                         most_image_size)});
}

void checkDevice(const std::string& device, types::Problems& problems) {
    try {
        gpu::EglContext::requireDevice(device);
    } catch (const gpu::GlError& error) {
        problems.push_back({"device", error.what()});
    }
}

}  // namespace

void AbsorptionConfig::check(types::Problems& problems) const {
    if (db_per_m && frequency_khz) problems.push_back({"db_per_m", "stands beside frequency_khz; give one of the two"});
    if (!db_per_m && !frequency_khz)
        problems.push_back({"", "has no value; give db_per_m, or frequency_khz for a law"});
}

double SonarConfig::bearingDeg(int k) const {
    return bearings_deg.empty() ? field_of_view_deg * ((k + 0.5) / beam_count - 0.5)
                                : bearings_deg[static_cast<size_t>(k)];
}

double SonarConfig::coverageDeg() const {
    if (bearings_deg.empty()) return field_of_view_deg;
    const auto [first, last] = std::minmax_element(bearings_deg.begin(), bearings_deg.end());
    return std::min(*last - *first + beamWidthDeg(), 360.0);
}

std::optional<double> SonarConfig::targetError() const {
    constexpr double default_target = 0.02;
    if (quality.target_error) return quality.target_error;
    if (published || quality.isGiven() || quality.budget_ms) return {};
    return default_target;
}

bool SonarConfig::castsRays() const {
    if (visibility != Visibility::Auto) return visibility == Visibility::Cpu;
    if (!haveRays() || needsImages() || deposit == Deposit::Gpu) return false;
    return !gpu::EglContext::isAskedFor(device) && !gpu::EglContext::hasCard();
}

double SonarConfig::speedOfSound() const { return speed_of_sound.value_or(water ? leroySpeed(*water) : 1500); }

void SonarConfig::check(types::Problems& problems) const {
    if (!bearings_deg.empty() && !beam_width_deg)
        return problems.push_back({"beam_width_deg", "is absent; bearings_deg needs the width of one beam"});
    if (bearings_deg.empty() && beam_width_deg) return checkFan(problems);
    if (bearings_deg.size() > 4096)
        problems.push_back({"bearings_deg", fmt::format("has {} beams; may have 4096", bearings_deg.size())});
    if (int64_t{beams()} * bin_count > most_bins)
        problems.push_back({"bin_count", fmt::format("is {} for each of {} beams, {} bins in all; may be {}", bin_count,
                                                     beams(), int64_t{beams()} * bin_count, most_bins)});
    if (beam_geometry == BeamGeometry::Conical && coverageDeg() > 180)
        problems.push_back({"beam_geometry", "is conical; a straight array sees at most 180 deg of azimuth"});
    if (published && !bearings_deg.empty())
        problems.push_back({"bearings_deg", "is given; published: true has a regular fan"});
    checkBeam(problems);
}

SonarConfig SonarConfig::fan() const {
    SonarConfig fan = *this;
    if (!bearings_deg.empty() || !beam_width_deg) return fan;
    const bool total = beam_width_convention == BeamWidthConvention::TotalFov;
    fan.field_of_view_deg = total ? *beam_width_deg : *beam_width_deg * beam_count;
    fan.beam_width_deg.reset();
    return fan;
}

void SonarConfig::checkFan(types::Problems& problems) const {
    const SonarConfig regular = fan();
    if (field_of_view_deg != SonarConfig().field_of_view_deg)
        return problems.push_back({"field_of_view_deg", "is given with beam_width_deg; one of the two tells the fan"});
    if (regular.field_of_view_deg > 360)
        return problems.push_back(
            {"beam_width_deg", fmt::format("is {:g} deg; {} beams of it cover {:g} deg, may be 360", *beam_width_deg,
                                           beam_count, regular.field_of_view_deg)});
    regular.check(problems);
}

void QualityConfig::check(types::Problems& problems) const {
    for (const auto& [name, value] : {std::pair{"target_error", target_error}, {"budget_ms", budget_ms}})
        if (value && (isGiven() || (target_error && budget_ms)))
            problems.push_back(
                {name, "is given with another choice; give rows and columns_per_beam, or target_error, or budget_ms"});
}

void SonarConfig::checkBeam(types::Problems& problems) const {
    if (range_min >= range)
        problems.push_back({"range_min", fmt::format("is {} m; must be below range, {} m", range_min, range)});
    if (absorption && absorption->frequency_khz && !water)
        problems.push_back({"absorption.frequency_khz", "is given without water; a law needs the water block"});
    if (model == Model::Cerqueira2017 && output != Output::Intensity)
        problems.push_back({"output", "is a level; cerqueira2017 gives means of S in [0, 1], output: intensity"});
    checkDevice(device, problems);
    if (beam_width_deg > 120)
        problems.push_back({"beam_width_deg", fmt::format("is {:g} deg; one beam may have 120", *beam_width_deg)});
    if (gain && output != Output::Intensity)
        problems.push_back({"gain", "is given with a level; it scales output: intensity"});
    if (gain && tvg) problems.push_back({"gain", "is given with tvg; it makes up for spreading itself"});
    if (published) checkPublished(*this, problems);
    checkRangeReached(*this, problems);
    checkVisibility(*this, problems);
    if (problems.empty() && !castsRays()) checkImages(*this, problems);
}

}  // namespace insonify::sonar
