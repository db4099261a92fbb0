// The checks of a sonar's configuration that need its beams, bins and effects, and its choice between rays and
// pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/plan/Effects.hpp"

namespace insonify::sonar {
namespace {

constexpr int64_t max_ray_columns = int64_t{1} << 22;

void checkPublished(const SonarConfig& config, types::Diagnostics& diagnostics) {
    if (config.model != Model::Cerqueira2017)
        diagnostics.push_back({"published", "is true; only with model: cerqueira2017"});
    if (config.bin_count < 2) diagnostics.push_back({"bin_count", "is 1; must be at least 2 with published: true"});
    if (config.coverageDeg() >= 180)
        diagnostics.push_back({"published", fmt::format("is true with {} deg of azimuth; one image shows less than 180",
                                                        config.coverageDeg())});
    if (config.beam_geometry != BeamGeometry::Planar)
        diagnostics.push_back({"beam_geometry", "is conical; must be planar with published: true"});
}

/** Returns four digits of a range, rounded down, so that bins of the same number of whole microseconds reach it. */
std::string roundedDown(double range) {
    const double unit = std::pow(10, std::floor(std::log10(range)) - 3);
    return fmt::format("{:.4g} m", std::floor(range / unit + 1e-9) * unit);
}

void checkRangeReached(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const BinGrid grid = makeBinGrid(config);
    if (grid.range_max <= 1.25 * config.range) return;
    const double shorter = grid.range_max - grid.range_max / static_cast<double>(grid.bin_duration_us);
    diagnostics.push_back(
        {"range",
         fmt::format("is {} m; {} bins of whole microseconds reach {:.6g} m, which may be at most 25 % "
                     "more: give {}{}, lower bin_count, or set range_rounding: exact",
                     config.range, config.bin_count, grid.range_max,
                     grid.bin_duration_us > 1 ? roundedDown(shorter) + " or " : "", roundedDown(grid.range_max))});
}

/** Checks a property that only rays support. */
void checkNeedOfRays(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const std::string name = config.needsRays();
    if (name.empty()) return;
    if (config.visibility == Visibility::Gl)
        diagnostics.push_back({"visibility", "is gl with " + name + ", which needs rays; may be auto or cpu"});
    if (config.deposit == Deposit::Gpu)
        diagnostics.push_back({"deposit", "is gpu with " + name + ", which needs rays; may be auto or cpu"});
    if (config.model != Model::Physical)
        diagnostics.push_back({name, "is given with model: cerqueira2017, whose bins are means of S(n.d)"});
}

/** Checks that properties that need straight sound paths are not combined with bent paths. */
void checkStraightPaths(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const bool bends = config.water && config.water->profile;
    const std::string name = config.isCoherent()    ? "speckle"
                             : config.tracesPaths() ? "multipath"
                             : config.crosstalk     ? "crosstalk"
                                                    : "";
    if (!name.empty() && (bends || config.motion_in_ping))
        diagnostics.push_back({name, std::string("needs straight sound paths; remove it, or ") +
                                         (bends ? "water.profile" : "motion_in_ping")});
}

/** Returns why the receiver's law in azimuth does not belong to an array of elements; empty where it does. */
std::string whyNoArray(const SonarConfig& config) {
    const auto& law = config.beam_pattern ? config.beam_pattern->receive.azimuth : std::optional<acoustics::BeamLaw>();
    if (!law) return "need beam_pattern.receive.azimuth, whose aperture they fill";
    const acoustics::Weighting weighting = law->weighting.value_or(acoustics::Weighting::Uniform);
    if (!law->file.empty() || weighting == acoustics::Weighting::Gaussian || weighting == acoustics::Weighting::Piston)
        return "need a weighted line in beam_pattern.receive.azimuth; a measured table, gaussian or piston has none";
    return {};
}

void checkElementCount(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const double wavelength = config.speedOfSound() / (1e3 * *config.frequency_khz);
    const double aperture =
        acoustics::BeamPattern(*config.beam_pattern->receive.azimuth, wavelength).aperture() * wavelength;
    const auto [count, spacing] = config.elements->makeArray(aperture, wavelength);
    const double length = static_cast<double>(count) * spacing;
    if (count > 4096)
        return diagnostics.push_back(
            {"elements",
             fmt::format("are {} that are {:.4g} m apart; may be 4096: give a larger spacing_m, or a shorter "
                         "aperture",
                         count, spacing)});
    if (count < 2 || std::abs(length - aperture) > 0.5 * spacing + 1e-9)
        diagnostics.push_back(
            {"elements", fmt::format("are {} that are {:.4g} m apart, {:.4g} m in all; the aperture of "
                                     "beam_pattern.receive.azimuth is {:.4g} m: give count or spacing_m alone",
                                     count, spacing, length, aperture)});
}

void checkElements(const SonarConfig& config, types::Diagnostics& diagnostics) {
    if (!config.elements) return;
    const std::string why = whyNoArray(config);
    if (!config.isCoherent())
        diagnostics.push_back(
            {"elements", "need speckle: {coherent: true}; without it energies are summed, not fields"});
    else if (config.beam_geometry != BeamGeometry::Conical)
        diagnostics.push_back({"elements", "need beam_geometry: conical, because a straight array receives cones"});
    else if (!why.empty())
        diagnostics.push_back({"elements", why});
    else if (config.frequency_khz)
        checkElementCount(config, diagnostics);
}

void checkVisibility(const SonarConfig& config, types::Diagnostics& diagnostics) {
    checkNeedOfRays(config, diagnostics);
    if (config.visibility != Visibility::Cpu) return;
    if (config.published)
        diagnostics.push_back({"visibility", "is cpu with published: true, which is an image; may be gl"});
    if (config.deposit == Deposit::Gpu)
        diagnostics.push_back({"deposit", "is gpu with visibility: cpu; may be auto or cpu"});
}

int imageColumns(const SonarConfig& config) { return makeFrusta(config, makeBeams(config)).front().columns; }

bool fitsImages(const SonarConfig& config) {
    return config.beam_height_deg <= tallest_image_deg && imageColumns(config) <= max_image_size;
}

void checkRays(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const int64_t columns = int64_t{config.beams()} * config.columnsPerBeam();
    if (columns > max_ray_columns)
        diagnostics.push_back({"quality.columns_per_beam",
                               fmt::format("is {}, with {} beams {} columns; may be {}", config.columnsPerBeam(),
                                           config.beams(), columns, max_ray_columns)});
}

void checkAbsorption(const SonarConfig& config, types::Diagnostics& diagnostics) {
    if (!config.absorption || config.absorption->db_per_m) return;
    if (!config.absorbedKhz())
        return diagnostics.push_back({"absorption", "has no value; give db_per_m, or frequency_khz for a law"});
    if (!config.water)
        diagnostics.push_back({config.absorption->frequency_khz ? "absorption.frequency_khz" : "absorption",
                               "is given without water; a law needs the water block"});
}

/** Checks the beams of a straight array: it cannot distinguish echoes from behind abeam from those ahead. */
void checkCones(const SonarConfig& config, types::Diagnostics& diagnostics) {
    for (int k = 0; k < config.beams(); ++k)
        if (std::abs(config.bearingDeg(k)) + config.beamWidthDeg() / 2 > 90 * (1 + 1e-9))
            return diagnostics.push_back(
                {"beam_geometry",
                 fmt::format("is conical, with a beam of {:g} deg about {:g} deg; a straight array sees "
                             "-90 to 90 deg",
                             config.beamWidthDeg(), config.bearingDeg(k))});
}

void checkImages(const SonarConfig& config, types::Diagnostics& diagnostics) {
    if (config.beam_height_deg > tallest_image_deg)
        return diagnostics.push_back(
            {"beam_height_deg", fmt::format("is {:g} deg; an image shows {:g}, rays (visibility: cpu) 180",
                                            config.beam_height_deg, tallest_image_deg)});
    const int columns = imageColumns(config);
    if (columns > max_image_size)
        diagnostics.push_back(
            {"quality.columns_per_beam",
             fmt::format("is {}, which with beams of {:g} deg over {:g} deg makes images of {} columns; may be {}",
                         config.columnsPerBeam(), config.beamWidthDeg(), config.coverageDeg(), columns,
                         max_image_size)});
}

}  // namespace

void AbsorptionConfig::check(types::Diagnostics& diagnostics) const {
    if (db_per_m && frequency_khz)
        diagnostics.push_back({"db_per_m", "is given with frequency_khz; give one of the two"});
}

void BeamPatternConfig::check(types::Diagnostics& diagnostics) const {
    if (!hasAzimuth() && !hasElevation())
        diagnostics.push_back({"", "has no law; give azimuth or elevation of transmit or receive"});
}

void QualityConfig::check(types::Diagnostics& diagnostics) const {
    const char* const choices =
        "is given with another choice; give rows and columns_per_beam, or target_error and max_samples, or budget_ms "
        "(a block in a file is replaced as a whole by --set 'SONAR.quality={rows: 64, columns_per_beam: 2}')";
    const auto refuse = [&](const char* name, bool given, bool other) {
        if (given && (isGiven() || other)) diagnostics.push_back({name, choices});
    };
    refuse("target_error", target_error.has_value(), budget_ms.has_value());
    refuse("max_samples", max_samples.has_value(), budget_ms.has_value());
    refuse("budget_ms", budget_ms.has_value(), false);
}

std::string SonarConfig::needsRays() const {
    if (isCoherent()) return "speckle";
    if (tracesPaths()) return "multipath";
    if (motion_in_ping) return "motion_in_ping";
    return crosstalk && crosstalk->echoes ? "crosstalk.echoes" : "";
}

std::optional<bool> SonarConfig::choosesRays() const {
    if (visibility != Visibility::Auto) return visibility == Visibility::Cpu;
    if (!needsRays().empty()) return true;
    if (published || deposit == Deposit::Gpu) return false;
    if (!fitsImages(*this) || (water && water->profile) || motion_in_ping) return true;
    if (gpu::EglContext::isAskedFor(device)) return false;
    return {};
}

bool SonarConfig::tracesRays() const {
    const std::optional<bool> chosen = choosesRays();
    return chosen ? *chosen : !gpu::EglContext::hasCard();
}

void SonarConfig::requireDevice(const std::string& task) const {
    if (tracesRays()) return;
    try {
        gpu::EglContext::requireDevice(device);
    } catch (const gpu::GlError& error) {
        throw types::ConfigError("", task + ".device", error.what());
    }
}

void SonarConfig::check(types::Diagnostics& diagnostics) const {
    if (!bearings_deg.empty() && !beam_width_deg)
        return diagnostics.push_back({"beam_width_deg", "is absent; bearings_deg needs the width of one beam"});
    if (bearings_deg.empty() && beam_width_deg) return checkFan(diagnostics);
    if (bearings_deg.size() > 4096)
        diagnostics.push_back({"bearings_deg", fmt::format("has {} beams; may have 4096", bearings_deg.size())});
    if (int64_t{beams()} * bin_count > max_bins)
        diagnostics.push_back({"bin_count", fmt::format("is {} for each of {} beams, {} bins in all; may be {}",
                                                        bin_count, beams(), int64_t{beams()} * bin_count, max_bins)});
    if (beam_geometry == BeamGeometry::Conical && coverageDeg() > 180)
        diagnostics.push_back({"beam_geometry", "is conical; a straight array sees at most 180 deg of azimuth"});
    else if (beam_geometry == BeamGeometry::Conical)
        checkCones(*this, diagnostics);
    if (published && !bearings_deg.empty())
        diagnostics.push_back({"bearings_deg", "is given; published: true has a regular fan"});
    checkBeam(diagnostics);
}

void SonarConfig::checkFan(types::Diagnostics& diagnostics) const {
    if (field_of_view_deg && beam_width_convention == BeamWidthConvention::TotalFov)
        return diagnostics.push_back(
            {"field_of_view_deg",
             "is given with beam_width_deg and beam_width_convention: total_fov; give one of the two"});
    if (field_of_view_deg && published)
        return diagnostics.push_back(
            {"beam_width_deg", "is given with field_of_view_deg; published: true has beams as wide as their spacing"});
    const SonarConfig regular = fan();
    if (regular.fieldOfViewDeg() > 360)
        return diagnostics.push_back(
            {"beam_width_deg", fmt::format("is {:g} deg; {} beams of it cover {:g} deg, may be 360; give "
                                           "field_of_view_deg as well for beams that overlap",
                                           *beam_width_deg, beam_count, regular.fieldOfViewDeg())});
    regular.check(diagnostics);
}

void SonarConfig::checkBeam(types::Diagnostics& diagnostics) const {
    if (range_min >= range)
        diagnostics.push_back({"range_min", fmt::format("is {} m; must be below range, {} m", range_min, range)});
    checkAbsorption(*this, diagnostics);
    if (beam_width_deg > 120)
        diagnostics.push_back({"beam_width_deg", fmt::format("is {:g} deg; one beam may have 120", *beam_width_deg)});
    if (published) checkPublished(*this, diagnostics);
    checkEffects(*this, diagnostics);
    checkRangeReached(*this, diagnostics);
    checkVisibility(*this, diagnostics);
    checkStraightPaths(*this, diagnostics);
    checkElements(*this, diagnostics);
    if (!diagnostics.empty()) return;
    choosesRays().value_or(true) ? checkRays(*this, diagnostics) : checkImages(*this, diagnostics);
}

}  // namespace insonify::sonar
