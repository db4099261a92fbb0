#include "components/sonar/beams/Directivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/beams/BinGrid.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::sonar {
namespace {

using std::numbers::pi;

/** Min cells across a beam, or across the spacing of two beams [1]. */
constexpr int min_cells = 2;
constexpr size_t far_cells = 16;  ///< Cells that are merged where only sidelobes receive them.
/** Max azimuth cells of a fan [1]. */
constexpr int max_cells = 16384;
constexpr double reach_step = types::radians(0.05);

std::optional<acoustics::BeamPattern> findPattern(const std::optional<acoustics::BeamLaw>& law,
                                                  const std::optional<double>& wavelength) {
    if (!law) return {};
    return acoustics::BeamPattern(*law, wavelength);
}

double computePower(const std::optional<acoustics::BeamPattern>& law, double angle, double axis = 0) {
    return law ? law->power(angle, axis) : 1;
}

double computeAmplitude(const std::optional<acoustics::BeamPattern>& law, double angle, double axis = 0) {
    return law ? law->amplitude(angle, axis) : 1;
}

/** A zone of range, and the phase at the ends of an array that is not focused there. */
struct FocusZone {
    double end;    ///< [m]
    double phase;  ///< [rad]
};

/** Returns zones of range. In a zone the phase at the array's ends, pi L^2 / (4 lambda) (1 / R - 1 / F), differs from
 *  that of the zone's middle by at most a sixteenth of pi, or 7 % of itself. A zone with a smaller phase is in focus.
 *  Ranges below the array's length count as that length: Fresnel's approximation ends there. */
std::vector<FocusZone> focusZones(double length, double wavelength, double focus, double range) {
    const double scale = pi * length * length / (4 * wavelength);
    const auto phaseAt = [&](double r) { return scale * (1 / std::max(r, length) - 1 / focus); };
    std::vector<FocusZone> zones;
    constexpr double step = pi / 8, growth = 0.15;
    for (double side : {1.0, -1.0}) {  // before the focus, behind it
        const double farthest = side * phaseAt(side > 0 ? 0 : range);
        std::vector<FocusZone> own;
        for (double low = step / 2; low < farthest;) {
            const double high = low + std::max(step, growth * low);
            const double near = 1 / focus + side * (side > 0 ? low : high) / scale;
            own.push_back({near > 0 ? 1 / near : std::numeric_limits<double>::infinity(), side * 0.5 * (low + high)});
            low = high;
        }
        if (side > 0) {
            zones.assign(own.rbegin(), own.rend());
            const double behind = 1 / focus - 0.5 * step / scale;
            zones.push_back({behind > 0 ? 1 / behind : std::numeric_limits<double>::infinity(), 0});
        } else {
            zones.insert(zones.end(), own.begin(), own.end());
        }
    }
    zones.back().end = std::numeric_limits<double>::infinity();
    return zones;
}

/** Returns the angle modulo a whole turn, within half a turn of 0. */
double wrapped(double angle) { return std::abs(angle) <= pi ? angle : std::remainder(angle, 2 * pi); }

/** Returns the angle farthest from `inner` towards `outer` at which `power` is not below the floor, plus a step. */
double farthest(double outer, double inner, double floor, const auto& power) {
    const double step = std::copysign(reach_step, inner - outer);
    double angle = outer;
    while (std::abs(inner - angle) > reach_step && power(angle) < floor) angle += step;
    return step > 0 ? std::max(outer, angle - step) : std::min(outer, angle - step);
}

}  // namespace

size_t receivingElements(const SonarConfig& config) {
    if (config.imperfections && config.imperfections->elements)
        return static_cast<size_t>(*config.imperfections->elements);
    std::optional<double> wavelength;
    if (config.frequency_khz) wavelength = config.speedOfSound() / (1e3 * *config.frequency_khz);
    const double aperture = acoustics::BeamPattern(*config.beam_pattern->receive.azimuth, wavelength).aperture();
    if (config.elements && wavelength) return config.elements->makeArray(aperture * *wavelength, *wavelength).count;
    return std::clamp<size_t>(static_cast<size_t>(std::lround(2 * aperture)), 2, 4096);
}

Directivity::Directivity(const SonarConfig& config)
    : conical_(config.beam_geometry == BeamGeometry::Conical),
      half_box_(types::radians(config.beamWidthDeg()) / 2),
      floor_(std::pow(10, config.beam_pattern->floor_db / 10)) {
    std::optional<double> wavelength;
    if (config.frequency_khz) wavelength = config.speedOfSound() / (1e3 * *config.frequency_khz);
    transmit_azimuth_ = findPattern(config.beam_pattern->transmit.azimuth, wavelength);
    receive_azimuth_ = findPattern(config.beam_pattern->receive.azimuth, wavelength);
    transmit_elevation_ = findPattern(config.beam_pattern->transmit.elevation, wavelength);
    receive_elevation_ = findPattern(config.beam_pattern->receive.elevation, wavelength);
    if (config.imperfections && receive_azimuth_) makeZones(config, wavelength);
}

void Directivity::makeZones(const SonarConfig& config, std::optional<double> wavelength) {
    const ImperfectionsConfig& errors = *config.imperfections;
    const double aperture = receive_azimuth_->aperture();
    if (aperture == 0 || (!errors.hasElementErrors() && !errors.focus_m)) return;
    const size_t count = receivingElements(config);
    const std::vector<double> weights = acoustics::elementWeights(count, aperture, receive_azimuth_->taper());
    const std::vector<std::complex<double>> factors = errors.elementFactors(count);
    std::vector<FocusZone> focus{{std::numeric_limits<double>::infinity(), 0}};
    if (errors.focus_m && wavelength)
        focus = focusZones(aperture * *wavelength, *wavelength, *errors.focus_m, config.range);
    for (const auto& [end, phase] : focus) {
        std::vector<std::complex<double>> parts;
        for (size_t m = 0; m < count; ++m) {
            const double place = 2 * acoustics::elementPlace(m, count);
            parts.push_back(weights[m] * (factors[m] * std::polar(1.0, -phase * place * place) - 1.0));
        }
        zones_.push_back({end, phase, acoustics::ElementField(parts)});
    }
}

const Directivity::Zone& Directivity::zoneOfPhase(double phase) const {
    return *std::ranges::min_element(zones_, {}, [&](const Zone& zone) { return std::abs(zone.phase - phase); });
}

double Directivity::zoneEnd(size_t zone) const {
    return zone < lastZone() ? zones_[zone].end : std::numeric_limits<double>::infinity();
}

size_t Directivity::zoneAt(double range) const {
    size_t zone = 0;
    while (zone < lastZone() && range >= zones_[zone].end) ++zone;
    return zone;
}

double Directivity::nearAzimuth(size_t zone) const {
    if (zones_.empty()) return nearAzimuth();
    return nearAzimuth() + 4 * std::abs(zones_[zone].phase) / (pi * receive_azimuth_->aperture());
}

double Directivity::sentAzimuth(double azimuth) const {
    return computePower(transmit_azimuth_, conical_ ? azimuth : wrapped(azimuth));
}

double Directivity::receivedAzimuth(double azimuth, double bearing, size_t zone) const {
    if (!zones_.empty()) return std::norm(receivedField(azimuth, bearing, zone));
    if (hasBoxes()) {
        const double off = conical_ ? azimuth - bearing : wrapped(azimuth - bearing);
        return off >= -half_box_ && off < half_box_ ? 1 : 0;
    }
    return conical_ ? computePower(receive_azimuth_, azimuth, bearing)
                    : computePower(receive_azimuth_, wrapped(azimuth - bearing));
}

double Directivity::azimuth(double azimuth, double bearing, size_t zone) const {
    return sentAzimuth(azimuth) * receivedAzimuth(azimuth, bearing, zone);
}

double Directivity::idealAzimuth(double azimuth, double bearing) const {
    if (hasBoxes()) return this->azimuth(azimuth, bearing, 0);
    return sentAzimuth(azimuth) * (conical_ ? computePower(receive_azimuth_, azimuth, bearing)
                                            : computePower(receive_azimuth_, wrapped(azimuth - bearing)));
}

double Directivity::sentAmplitude(double azimuth) const {
    return computeAmplitude(transmit_azimuth_, conical_ ? azimuth : wrapped(azimuth));
}

std::complex<double> Directivity::receivedField(double azimuth, double bearing, size_t zone) const {
    const double angle = conical_ ? azimuth : wrapped(azimuth - bearing), axis = conical_ ? bearing : 0;
    if (zones_.empty() || std::abs(angle) > pi / 2) return computeAmplitude(receive_azimuth_, angle, axis);
    const double u = receive_azimuth_->aperture() * (std::sin(angle) - std::sin(axis));
    const std::complex<double> ideal = receive_azimuth_->taper().amplitude(u);
    if (!conical_ || zones_.size() == 1) return ideal + zones_[zone].added.at(u);
    // A steered straight array is foreshortened, and so is the path to its ends.
    return ideal + zoneOfPhase(zones_[zone].phase * std::cos(axis) * std::cos(axis)).added.at(u);
}

double Directivity::sentElevation(double angle) const { return computePower(transmit_elevation_, angle); }

double Directivity::receivedElevation(double angle) const { return computePower(receive_elevation_, angle); }

double Directivity::elevation(double angle) const { return sentElevation(angle) * receivedElevation(angle); }

double Directivity::elevationReach() const {
    const auto either = [&](double angle) { return std::max(elevation(angle), elevation(-angle)); };
    return farthest(pi / 2, 0, floor_, either);
}

int Directivity::rowsFor(int in_main_lobe, bool even) const {
    constexpr int steps = 8192;
    const double reach = elevationReach(), half_power = 0.5 * elevation(0);
    double all = 0, main_lobe = 0;
    for (int i = 0; i < steps; ++i) {
        const double angle = reach * ((2 * i + 1.0) / steps - 1), density = even ? 1 : rowDensity(angle);
        all += density;
        if (elevation(angle) >= half_power) main_lobe += density;
    }
    const double rows = main_lobe > 0 ? std::ceil(in_main_lobe * all / main_lobe) : max_image_size;
    return static_cast<int>(std::min(rows, double{max_image_size}));
}

Directivity::Span Directivity::azimuthSpan(const Fan& beams) const {
    if (hasBoxes()) return {beams.low(), beams.high()};
    const double to = conical_ ? pi / 2 : beams.seam(), from = conical_ ? -to : to - 2 * pi;
    const auto any = [&](double at) {
        return std::max({azimuth(at, beams.front().centre), azimuth(at, beams[beams.size() / 2].centre),
                         azimuth(at, beams.back().centre)});
    };
    return {farthest(from, beams.front().centre, floor_, any), farthest(to, beams.back().centre, floor_, any)};
}

double Directivity::halfPowerAzimuth() const {
    double angle = 0;
    while (angle < pi && idealAzimuth(angle, 0) > 0.5) angle += reach_step / 50;
    return 2 * angle;
}

namespace {

/** Returns the cells of beams that receive boxes: parts of the directions between neighbouring edges of beams, so that
 *  each cell is within a beam or outside of it. `widest`: of a cell [rad]. */
std::vector<Beam> boxCells(const Fan& beams, bool conical, double widest) {
    const double first = beams.front().low, turn = 2 * pi;
    std::vector<double> edges;
    for (const Beam& beam : beams)
        for (double edge : {beam.low, beam.high}) {
            if (!conical && edge > first + turn) edge -= turn;
            edges.push_back(edge);
        }
    const bool is_round = !conical && beams.high() - beams.low() >= turn - 1e-9;
    if (is_round) edges.push_back(first + turn);
    std::ranges::sort(edges);
    std::vector<Beam> cells;
    for (size_t k = 1; k < edges.size(); ++k) {
        const double low = edges[k - 1], width = edges[k] - low;
        bool received = false;
        if (width > 1e-9 * widest) beams.eachAt(low + width / 2, [&](size_t) { received = true; });
        const int parts = received ? std::max(1, static_cast<int>(std::ceil(width / widest - 1e-6))) : 0;
        for (int i = 0; i < parts; ++i) {
            const double from = low + width * i / parts, to = i + 1 < parts ? low + width * (i + 1) / parts : edges[k];
            cells.push_back({(from + to) / 2, from, to});
        }
    }
    return cells;
}

/** Returns the cells of a sonar whose beams receive boxes, at most max_cells unless the beams' edges make more. */
std::vector<Beam> boxCells(const SonarConfig& config, const Directivity& directivity) {
    const Fan beams = makeBeams(config);
    const double width = std::min(directivity.boxWidth(), directivity.halfPowerAzimuth()),
                 fine = width / std::max(min_cells, config.columnsPerBeam()),
                 least = (beams.high() - beams.low()) / max_cells;
    return boxCells(beams, config.beam_geometry == BeamGeometry::Conical, std::max(fine, least));
}

}  // namespace

SonarConfig sampledConfig(const SonarConfig& config, const Directivity& directivity, bool traces_rays) {
    SonarConfig sampled = config;
    if (directivity.hasElevation())
        sampled.beam_height_deg =
            std::min(types::degrees(2 * directivity.elevationReach()), traces_rays ? 180 : tallest_image_deg);
    if (!directivity.hasAzimuth()) return sampled;
    if (directivity.hasBoxes()) {
        double narrowest = 2 * pi;
        sampled.bearings_deg.clear();
        for (const Beam& cell : boxCells(config, directivity)) {
            sampled.bearings_deg.push_back(types::degrees(cell.centre));
            narrowest = std::min(narrowest, cell.high - cell.low);
        }
        sampled.beam_width_deg = types::degrees(narrowest);
        sampled.quality.columns_per_beam = 1;
        return sampled;
    }
    const Fan beams = makeBeams(config);
    const auto [low, high] = directivity.azimuthSpan(beams);
    const double fine =
        std::min(beams.minSpacing(), directivity.halfPowerAzimuth()) / std::max(min_cells, config.columnsPerBeam());
    const int cells = static_cast<int>(std::clamp(std::ceil((high - low) / fine), 1.0, double{max_cells}));
    const double width = types::degrees(high - low) / cells;
    sampled.bearings_deg.clear();
    for (int c = 0; c < cells; ++c) sampled.bearings_deg.push_back(types::degrees(low) + (c + 0.5) * width);
    sampled.beam_width_deg = width;
    sampled.quality.columns_per_beam = 1;
    return sampled;
}

Fan azimuthCells(const SonarConfig& config, const SonarConfig& sampled, const Fan& beams,
                 const Directivity& directivity, bool traces_rays) {
    if (directivity.hasBoxes()) return Fan::sorted(boxCells(config, directivity));
    const Fan all = makeBeams(sampled);
    if (!traces_rays || !directivity.hasAzimuth()) return all;
    const bool each = sampled.elements || (sampled.isCoherent() && directivity.isComplex());
    const double near = each ? 2 * pi : directivity.nearAzimuth(0);  // fields with phases: all cells
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
    const SonarConfig sampled = sampledConfig(config, Directivity(config), config.tracesRays());
    if (int64_t{sampled.beams()} * sampled.bin_count <= max_bins) return {};
    return fmt::format("has {} azimuth cells of {} bins each, {} in all; may be {}: give wider beams or fewer bins",
                       sampled.beams(), sampled.bin_count, int64_t{sampled.beams()} * sampled.bin_count, max_bins);
}

}  // namespace insonify::sonar
