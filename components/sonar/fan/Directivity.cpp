#include "components/sonar/fan/Directivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/sonar/fan/BinGrid.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

/** Cells across a beam, or across the distance between two, at least [1]. */
constexpr int min_cells = 2;
constexpr size_t far_cells = 16;  ///< That are one where sidelobes alone hear them.
/** Azimuth cells of a fan, at most [1]. */
constexpr int max_cells = 16384;
constexpr double reach_step = types::radians(0.05);

std::optional<acoustics::BeamPattern> patternOf(const std::optional<acoustics::BeamLaw>& law,
                                                const std::optional<double>& wavelength) {
    if (!law) return {};
    return acoustics::BeamPattern(*law, wavelength);
}

double powerOf(const std::optional<acoustics::BeamPattern>& law, double angle, double axis = 0) {
    return law ? law->power(angle, axis) : 1;
}

double amplitudeOf(const std::optional<acoustics::BeamPattern>& law, double angle, double axis = 0) {
    return law ? law->amplitude(angle, axis) : 1;
}

/** The angle to either side of 0, turned by whole turns. */
double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

/** The angle farthest from `inner` towards `outer` at which `power` is not below the floor, and a step beyond. */
template <class Power>
double farthest(double outer, double inner, double floor, const Power& power) {
    const double step = std::copysign(reach_step, inner - outer);
    double angle = outer;
    while (std::abs(inner - angle) > reach_step && power(angle) < floor) angle += step;
    return step > 0 ? std::max(outer, angle - step) : std::min(outer, angle - step);
}

}  // namespace

Directivity::Directivity(const SonarConfig& config)
    : conical_(config.beam_geometry == BeamGeometry::Conical),
      floor_(std::pow(10, config.beam_pattern->floor_db / 10)) {
    std::optional<double> wavelength;
    if (config.frequency_khz) wavelength = config.speedOfSound() / (1e3 * *config.frequency_khz);
    transmit_azimuth_ = patternOf(config.beam_pattern->transmit.azimuth, wavelength);
    receive_azimuth_ = patternOf(config.beam_pattern->receive.azimuth, wavelength);
    transmit_elevation_ = patternOf(config.beam_pattern->transmit.elevation, wavelength);
    receive_elevation_ = patternOf(config.beam_pattern->receive.elevation, wavelength);
}

double Directivity::sentAzimuth(double azimuth) const {
    return powerOf(transmit_azimuth_, conical_ ? azimuth : wrapped(azimuth));
}

double Directivity::heardAzimuth(double azimuth, double bearing) const {
    return conical_ ? powerOf(receive_azimuth_, azimuth, bearing)
                    : powerOf(receive_azimuth_, wrapped(azimuth - bearing));
}

double Directivity::azimuth(double azimuth, double bearing) const {
    return sentAzimuth(azimuth) * heardAzimuth(azimuth, bearing);
}

double Directivity::sentAmplitude(double azimuth) const {
    return amplitudeOf(transmit_azimuth_, conical_ ? azimuth : wrapped(azimuth));
}

double Directivity::heardAmplitude(double azimuth, double bearing) const {
    return conical_ ? amplitudeOf(receive_azimuth_, azimuth, bearing)
                    : amplitudeOf(receive_azimuth_, wrapped(azimuth - bearing));
}

double Directivity::sentElevation(double angle) const { return powerOf(transmit_elevation_, angle); }

double Directivity::heardElevation(double angle) const { return powerOf(receive_elevation_, angle); }

double Directivity::elevation(double angle) const { return sentElevation(angle) * heardElevation(angle); }

double Directivity::elevationReach() const {
    const auto either = [&](double angle) { return std::max(elevation(angle), elevation(-angle)); };
    return farthest(pi / 2, 0, floor_, either);
}

Directivity::Span Directivity::azimuthSpan(const Fan& beams) const {
    const double to = conical_ ? pi / 2 : beams.seam(), from = conical_ ? -to : to - 2 * pi;
    const auto any = [&](double at) {
        return std::max({azimuth(at, beams.front().centre), azimuth(at, beams[beams.size() / 2].centre),
                         azimuth(at, beams.back().centre)});
    };
    return {farthest(from, beams.front().centre, floor_, any), farthest(to, beams.back().centre, floor_, any)};
}

double Directivity::halfPowerAzimuth() const {
    double angle = 0;
    while (angle < pi && azimuth(angle, 0) > 0.5) angle += reach_step / 50;
    return 2 * angle;
}

SonarConfig sampledConfig(const SonarConfig& config, const Directivity& directivity, bool casts_rays) {
    SonarConfig sampled = config;
    if (directivity.hasElevation())
        sampled.beam_height_deg =
            std::min(types::degrees(2 * directivity.elevationReach()), casts_rays ? 180 : tallest_image_deg);
    if (!directivity.hasAzimuth()) return sampled;
    const Fan beams = makeBeams(config);
    const auto [low, high] = directivity.azimuthSpan(beams);
    const double fine = std::min(beams.smallestSpacing(), directivity.halfPowerAzimuth()) /
                        std::max(min_cells, config.columnsPerBeam());
    const int cells = static_cast<int>(std::clamp(std::ceil((high - low) / fine), 1.0, double{max_cells}));
    const double width = types::degrees(high - low) / cells;
    sampled.bearings_deg.clear();
    for (int c = 0; c < cells; ++c) sampled.bearings_deg.push_back(types::degrees(low) + (c + 0.5) * width);
    sampled.beam_width_deg = width;
    sampled.quality.columns_per_beam = 1;
    return sampled;
}

Fan azimuthCells(const SonarConfig& sampled, const Fan& beams, const Directivity& directivity, bool casts_rays) {
    const Fan all = makeBeams(sampled);
    if (!casts_rays || !directivity.hasAzimuth()) return all;
    const double near = sampled.elements ? 2 * pi : directivity.nearAzimuth();  // elements hear each cell by itself
    const double from = beams.front().centre - near, to = beams.back().centre + near;
    const auto side = [&](const Beam& cell) {
        if (cell.high + 2 * pi >= from && cell.low + 2 * pi <= to) return 0;  // across the seam
        if (cell.high - 2 * pi >= from && cell.low - 2 * pi <= to) return 0;
        return cell.high < from ? -1 : cell.low > to ? 1 : 0;
    };
    std::vector<Beam> cells;
    for (size_t i = 0; i < all.size();) {
        size_t end = i + 1;
        while (side(all[i]) != 0 && end < all.size() && end - i < far_cells && side(all[end]) == side(all[i])) ++end;
        cells.push_back({0.5 * (all[i].low + all[end - 1].high), all[i].low, all[end - 1].high});
        i = end;
    }
    return Fan::sorted(std::move(cells));
}

std::string whyTooLarge(const SonarConfig& config) {
    if (!config.beam_pattern) return {};
    const SonarConfig sampled = sampledConfig(config, Directivity(config), config.castsRays());
    if (int64_t{sampled.beams()} * sampled.bin_count <= max_bins) return {};
    return fmt::format("has {} azimuth cells of {} bins each, {} in all; may be {}: give wider beams or fewer bins",
                       sampled.beams(), sampled.bin_count, int64_t{sampled.beams()} * sampled.bin_count, max_bins);
}

}  // namespace insonify::sonar
