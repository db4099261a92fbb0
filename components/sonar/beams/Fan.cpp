#include "components/sonar/beams/Fan.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "types/geometry/BeamArc.hpp"

namespace insonify::sonar {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

/** Swaps that bring beam k, which is in row k, to rows[k]. */
std::vector<std::pair<size_t, size_t>> swapsTo(const std::vector<size_t>& rows) {
    std::vector<size_t> beam_in(rows.size()), row_of(rows.size()), wanted(rows.size());
    std::iota(beam_in.begin(), beam_in.end(), size_t{0});
    row_of = beam_in;
    for (size_t k = 0; k < rows.size(); ++k) wanted[rows[k]] = k;
    std::vector<std::pair<size_t, size_t>> swaps;
    for (size_t row = 0; row < rows.size(); ++row) {
        const size_t from = row_of[wanted[row]];
        if (from == row) continue;
        swaps.push_back({row, from});
        row_of[beam_in[row]] = from;
        std::swap(beam_in[row], beam_in[from]);
    }
    return swaps;
}

}  // namespace

Fan::Fan(const std::vector<Beam>& table) {
    for (const Beam& beam : table) {
        if (!std::isfinite(beam.centre) || !(beam.low < beam.high) || !std::isfinite(beam.high - beam.low))
            throw std::invalid_argument("a beam of a fan has no extent, or a bearing that is not finite");
        bearings_.push_back(beam.centre);
    }
    const types::ArcOrder arc = types::alongArc(bearings_, whole_turn);
    rows_ = arc.order;
    for (size_t k = 0; k < rows_.size(); ++k) {
        const Beam& beam = table[rows_[k]];
        const double added = k + arc.turned < rows_.size() ? 0 : whole_turn;
        beams_.push_back({beam.centre + added, beam.low + added, beam.high + added});
    }
    swaps_ = swapsTo(rows_);
    measure();
    if (arc.turned > 0) seam_ = 0.5 * (back().centre + front().centre + whole_turn);
}

Fan Fan::sorted(std::vector<Beam> beams) {
    Fan fan;
    for (const Beam& beam : beams) fan.bearings_.push_back(beam.centre);
    fan.beams_ = std::move(beams);
    fan.rows_.resize(fan.size());
    std::iota(fan.rows_.begin(), fan.rows_.end(), size_t{0});
    fan.measure();
    return fan;
}

void Fan::measure() {
    if (empty()) return;
    low_ = front().low;
    high_ = back().high;
    for (size_t k = 0; k < size(); ++k) {
        low_ = std::min(low_, beams_[k].low);
        high_ = std::max(high_, beams_[k].high);
        widest_ = std::max(widest_, beams_[k].high - beams_[k].low);
        joins_ = joins_ &&
                 (k == 0 || std::abs(beams_[k].low - beams_[k - 1].high) <= 1e-9 * (beams_[k].high - beams_[k].low));
    }
}

bool Fan::isRing() const {
    if (size() < 3) return false;
    if (isRound()) return true;
    double widest = 0;
    for (size_t k = 1; k < size(); ++k) widest = std::max(widest, beams_[k].centre - beams_[k - 1].centre);
    return front().centre + whole_turn - back().centre <= widest * (1 + 1e-6);
}

bool Fan::spans(double azimuth) const {
    const double off = std::abs(std::remainder(azimuth - 0.5 * (low_ + high_), whole_turn));
    return off <= 0.5 * (high_ - low_) * (1 + 1e-12);
}

double Fan::minSpacing() const {
    double minimum = whole_turn;
    const auto take = [&](double spacing) {
        if (spacing > 1e-9) minimum = std::min(minimum, spacing);
    };
    for (size_t k = 1; k < size(); ++k) take(beams_[k].centre - beams_[k - 1].centre);
    if (size() > 1) take(front().centre + whole_turn - back().centre);
    return minimum;
}

std::vector<double> Fan::midpoints() const {
    if (size() == 1) return {front().low, front().high};
    std::vector<double> edges{0};
    for (size_t k = 1; k < size(); ++k) edges.push_back((beams_[k - 1].centre + beams_[k].centre) / 2);
    const double beyond_front = (beams_[1].centre - front().centre) / 2, beyond_back = back().centre - edges.back();
    const double across = (front().centre + whole_turn - back().centre) / 2;
    edges.front() = front().centre - std::min(beyond_front, across);
    edges.push_back(back().centre + std::min(beyond_back, across));
    return edges;
}

}  // namespace insonify::sonar
