#include "types/geometry/BeamArc.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace insonify::types {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-9;  ///< [rad]

/** Returns a bearing within half a turn of ahead; logs of other programs may contain larger bearings. */
double normalised(Angle bearing) { return std::abs(bearing.rad) <= pi ? bearing.rad : Angle::fromRad(bearing.rad).rad; }

/** Returns the place behind the widest gap of ascending bearings; 0, behind the gap astern, unless another gap is
 *  clearly wider. */
size_t findBegin(const std::vector<double>& ascending) {
    size_t begin = 0;
    double widest = ascending.front() + 2 * pi - ascending.back() + 1e-6;
    for (size_t i = 1; i < ascending.size(); ++i)
        if (const double gap = ascending[i] - ascending[i - 1]; gap > widest) {
            widest = gap;
            begin = i;
        }
    return begin;
}

}  // namespace

ArcOrder alongArc(std::span<const double> directions, double turn) {
    ArcOrder arc;
    arc.order.resize(directions.size());
    std::iota(arc.order.begin(), arc.order.end(), size_t{0});
    std::ranges::stable_sort(arc.order, {}, [&](size_t i) { return directions[i]; });
    if (directions.empty()) return arc;
    const auto at = [&](size_t k) { return directions[arc.order[k]]; };
    // Gaps that differ only by rounding do not move the seam.
    double widest = (at(0) + turn - at(directions.size() - 1)) * (1 + 1e-6) + 1e-9 * turn;
    size_t first = 0;
    for (size_t k = 1; k < directions.size(); ++k)
        if (at(k) - at(k - 1) > widest) {
            widest = at(k) - at(k - 1);
            first = k;
        }
    std::ranges::rotate(arc.order, arc.order.begin() + static_cast<ptrdiff_t>(first));
    arc.turned = first;
    return arc;
}

void BeamArc::take(const Sonar& ping, double lone_width) {
    const std::span<const Angle> table(ping.bearings);
    take(table.first(std::min<size_t>(ping.beam_count, table.size())), ping.beam_width, lone_width);
}

void BeamArc::take(std::span<const Angle> table, Angle beam_width, double lone_width) {
    beams.clear();
    bearings.clear();
    right = left = 0;
    for (uint32_t beam = 0; beam < table.size(); ++beam)
        if (std::isfinite(table[beam].rad)) beams.push_back(beam);
    std::ranges::sort(beams, {}, [&](uint32_t beam) { return std::pair(normalised(table[beam]), beam); });
    for (const uint32_t beam : beams) bearings.push_back(normalised(table[beam]));
    width_known_ = beam_width.rad > 0;
    width = width_known_ ? beam_width.rad : lone_width;
    if (beams.empty()) return;
    const auto begin = static_cast<std::ptrdiff_t>(findBegin(bearings));
    std::for_each(bearings.begin(), bearings.begin() + begin, [](double& bearing) { bearing += 2 * pi; });
    std::ranges::rotate(bearings, bearings.begin() + begin);
    std::ranges::rotate(beams, beams.begin() + begin);
    if (!width_known_ && beams.size() > 1)
        width = (bearings.back() - bearings.front()) / static_cast<double>(beams.size() - 1);
    right = bearings.front() - width / 2;
    left = bearings.back() + width / 2;
    const bool meet = !width_known_ || stepAcross() <= 2 * width + rounding;
    if (fullCircle() || (isRing() && meet)) right = -pi, left = pi;
}

bool BeamArc::isRing() const {
    if (bearings.size() < 3) return false;
    if (fullCircle()) return true;
    double widest = 0;
    for (size_t i = 1; i < bearings.size(); ++i) widest = std::max(widest, bearings[i] - bearings[i - 1]);
    return stepAcross() <= widest * (1 + 1e-6);
}

bool BeamArc::joins(size_t place) const {
    return !width_known_ || bearings[place + 1] - bearings[place] <= 2 * width + rounding;
}

double BeamArc::turned(double bearing) const {
    const double turns = std::floor((bearing - opposite()) / (2 * pi));
    return turns == 0 ? bearing : bearing - 2 * pi * turns;
}

std::optional<double> BeamArc::placeAt(double bearing) const {
    if (beams.empty()) return {};
    const double at = turned(bearing);
    if (!fullCircle() && (at < right || at > left)) return {};
    const auto after = std::upper_bound(bearings.begin(), bearings.end(), at);
    if (fullCircle() && beams.size() > 1 && (after == bearings.begin() || after == bearings.end())) {
        const double beyond = at - bearings.back() + (after == bearings.begin() ? 2 * pi : 0);
        return static_cast<double>(beams.size() - 1) + beyond / stepAcross();
    }
    if (after == bearings.begin()) return 0;
    const auto place = static_cast<size_t>(after - bearings.begin() - 1);
    const auto index = static_cast<double>(place);
    if (after == bearings.end()) return index;
    const double before = at - bearings[place];
    if (joins(place)) return index + before / (*after - bearings[place]);
    if (before <= width / 2) return index;
    return *after - at <= width / 2 ? std::optional(index + 1) : std::nullopt;
}

std::optional<uint32_t> BeamArc::beamAt(double bearing) const {
    const std::optional<double> place = placeAt(bearing);
    return place ? std::optional(beams[static_cast<size_t>(std::lround(*place)) % beams.size()]) : std::nullopt;
}

std::vector<BeamArc::Sector> BeamArc::sectors() const {
    std::vector<Sector> all;
    for (const double bearing : bearings) all.push_back({bearing - width / 2, bearing + width / 2});
    if (all.empty()) return all;
    const size_t last = all.size() - 1;
    for (size_t i = 0; i < last; ++i)
        if (joins(i)) all[i].left = all[i + 1].right = (bearings[i] + bearings[i + 1]) / 2;
    if (last > 0 && joins(0)) all.front().right = bearings[0] - (bearings[1] - bearings[0]) / 2;
    if (last > 0 && joins(last - 1)) all.back().left = bearings[last] + (bearings[last] - bearings[last - 1]) / 2;
    const double begin = opposite(), beyond = all.front().right - begin, before = begin + 2 * pi - all.back().left;
    if (beyond < -rounding || (fullCircle() && beyond > rounding)) all.front().right = begin;
    if (before < -rounding || (fullCircle() && before > rounding)) all.back().left = begin + 2 * pi;
    return all;
}

BeamArc::Reach BeamArc::within(size_t place, double half_width) const {
    const double centre = bearings[place];
    const double before = place > 0 ? bearings[place - 1] : bearings.back() - 2 * pi;
    const double after = place + 1 < bearings.size() ? bearings[place + 1] : bearings.front() + 2 * pi;
    return {std::min(half_width, (centre - before) / 2 + rounding),
            std::min(half_width, (after - centre) / 2 + rounding)};
}

}  // namespace insonify::types
