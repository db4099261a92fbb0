#include "components/sonar/bins/Truth.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "components/sonar/plan/Effects.hpp"
#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

/** Converts sines into angles, within 3e-7 rad: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46. */
INSONIFY_VECTOR_CLONES void toAngles(float* sines, size_t count) {
    constexpr float quarter = std::numbers::pi_v<float> / 2;
    for (size_t i = 0; i < count; ++i) {
        const float x = std::abs(sines[i]);
        float sum = -0.0012624911f;
        sum = sum * x + 0.0066700901f;
        sum = sum * x - 0.0170881256f;
        sum = sum * x + 0.0308918810f;
        sum = sum * x - 0.0501743046f;
        sum = sum * x + 0.0889789874f;
        sum = sum * x - 0.2145988016f;
        sum = sum * x + 1.5707963050f;
        sines[i] = std::copysign(quarter - std::sqrt(1 - x) * sum, sines[i]);
    }
}

/** Reports a bin in which no object is strongest, with the share of the water; 0: no water. */
void reportNoObject(size_t to, double share, types::SonarTruth& truth) {
    truth.object[to] = types::SonarTruth::no_object;
    truth.path[to] = share > 0 ? types::SonarTruth::water : uint8_t{0};
    truth.share[to] = static_cast<float>(share);
    truth.elevation[to] = truth.grazing[to] = std::numeric_limits<float>::quiet_NaN();
}

constexpr double whole_turn = 2 * std::numbers::pi;

/** Returns the azimuth, or the azimuth plus or minus a whole turn where only that is between two others [rad]. */
double turnedBetween(double low, double high, double azimuth) {
    if (azimuth < low && azimuth + whole_turn < high) return azimuth + whole_turn;
    return azimuth >= high && azimuth - whole_turn >= low ? azimuth - whole_turn : azimuth;
}

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/** Returns the elevation of a bin's echo, which is that of its beam; unknown for the water [rad]. */
double computeElevation(const types::SonarTruth& truth, size_t beam, size_t at) {
    return truth.path[at] == types::SonarTruth::water ? double{unknown} : truth.bearings[beam].rad;
}

void markShadows(size_t first, size_t bins, types::SonarTruth& truth) {
    bool echo_beyond = false;
    for (size_t at = first + bins; at-- > first;) {
        const bool received = truth.object[at] != types::SonarTruth::no_object || truth.hits[at] > 0;
        truth.shadow[at] = !received && echo_beyond;
        echo_beyond = echo_beyond || received;
    }
}

}  // namespace

TruthTable::TruthTable(size_t beams, size_t bins)
    : bins_(bins),
      used_(beams * bins),
      first_(beams * bins),
      others_(beams * bins * (kept_apart - 1)),
      rest_(beams * bins) {}

void TruthTable::clear() { std::ranges::fill(used_, uint8_t{0}); }

void TruthTable::addToOthers(size_t at, const ObjectEcho& added) {
    const size_t count = objectsAt(at);
    size_t highest = 0;
    for (size_t i = 0; i < count; ++i) {
        if (echo(at, i).object == added.object) return echo(at, i).add(added);
        if (echo(at, i).object > echo(at, highest).object) highest = i;
    }
    if (count < kept_apart) {
        echo(at, count) = added;
        ++used_[at];
    } else if (added.object > echo(at, highest).object) {
        addRest(at, added);
    } else {
        addRest(at, echo(at, highest));
        echo(at, highest) = added;
    }
}

void TruthTable::addRest(size_t at, const ObjectEcho& added) {
    if (used_[at] != more) rest_[at] = {};
    used_[at] = more;
    rest_[at].add(added);
}

void TruthTable::merge(size_t beam, const TruthTable& other, size_t of) {
    INSONIFY_CHECK(other.bins_ == bins_, other.bins_, bins_);
    for (size_t bin = 0; bin < bins_; ++bin) {
        const size_t from = of * bins_ + bin;
        for (size_t i = 0; i < other.objectsAt(from); ++i) add(beam, bin, other.echo(from, i));
        if (other.used_[from] == more) addRest(beam * bins_ + bin, other.rest_[from]);
    }
}

void TruthTable::reportBin(size_t at, size_t to, uint64_t water, types::SonarTruth& truth) const {
    const ObjectEcho* strongest = &first_[at];
    ObjectEcho all = *strongest;
    for (size_t i = 1; i < objectsAt(at); ++i) {
        const ObjectEcho& other = echo(at, i);
        all.add(other);
        if (std::pair(other.energy, strongest->object) > std::pair(strongest->energy, other.object)) strongest = &other;
    }
    if (used_[at] == more) all.add(rest_[at]);
    truth.hits[to] = all.hits;
    const double total = static_cast<double>(all.energy) + static_cast<double>(water);
    if (water > strongest->energy) return reportNoObject(to, static_cast<double>(water) / total, truth);
    const auto energy = static_cast<double>(static_cast<int64_t>(strongest->energy));
    const double per_energy = 2 / energy;
    const auto sine = [&](int64_t sines) {
        return std::clamp(static_cast<float>(static_cast<double>(sines) * per_energy), -1.0f, 1.0f);
    };
    const bool alone = used_[at] == 1 && water == 0;
    truth.object[to] = static_cast<int32_t>(strongest->object & ~(behind_walls | rung_in_wall));
    truth.path[to] = strongest->object & behind_walls   ? types::SonarTruth::through_wall
                     : strongest->object & rung_in_wall ? types::SonarTruth::rung
                                                        : 0;
    truth.elevation[to] = sine(strongest->elevation);
    truth.grazing[to] = sine(strongest->grazing);
    truth.share[to] = alone ? 1 : static_cast<float>(energy / total);
}

void TruthTable::report(size_t beam, size_t to, types::SonarTruth& truth, std::span<const uint64_t> water) const {
    INSONIFY_CHECK((beam + 1) * bins_ <= used_.size(), beam, bins_, used_.size());
    INSONIFY_CHECK((to + 1) * bins_ <= truth.object.size(), to, bins_, truth.object.size());
    INSONIFY_CHECK(water.empty() || water.size() == bins_, water.size(), bins_);
    bool echo_beyond = false;
    for (size_t bin = bins_; bin-- > 0;) {
        const size_t from = beam * bins_ + bin, at = to * bins_ + bin;
        const bool received = used_[from] > 0;
        const uint64_t of_water = water.empty() ? 0 : water[bin];
        truth.shadow[at] = !received && echo_beyond;
        echo_beyond = echo_beyond || received;
        if (received) {
            reportBin(from, at, of_water, truth);
        } else {
            truth.hits[at] = 0;
            reportNoObject(at, of_water > 0 ? 1 : 0, truth);
        }
    }
    toAngles(truth.elevation.data() + to * bins_, bins_);
    toAngles(truth.grazing.data() + to * bins_, bins_);
}

std::vector<int32_t> beamsOfCells(const RenderPlan& plan) {
    if (!plan.has(Pass::Beamform)) return {};
    const std::vector<double> edges = plan.beams.midpoints();
    std::vector<int32_t> beams;
    for (const Beam& cell : plan.cells) {
        const auto above = std::ranges::upper_bound(edges, turnedBetween(edges.front(), edges.back(), cell.centre));
        const bool outside = above == edges.begin() || above == edges.end();
        beams.push_back(outside ? -1 : static_cast<int32_t>(above - edges.begin()) - 1);
    }
    return beams;
}

WaterTruth::WaterTruth(const RenderPlan& plan, size_t sum_count, int threads)
    : beams_of_cells_(beamsOfCells(plan)),
      bin_count_(static_cast<size_t>(plan.grid.bin_count)),
      per_bin_(sum_count / bin_count_),
      levels_(plan.config, plan.grid),
      energies_(plan.beams.size() * bin_count_),
      intensities_(static_cast<size_t>(threads), std::vector<float>(sum_count)) {}

void WaterTruth::begin() { std::ranges::fill(energies_, uint64_t{0}); }

void WaterTruth::take(const EchoRules& rules, const uint64_t* sums, size_t cell, double solid_angle, size_t thread) {
    constexpr double maximum = 0x1p54;  // limit of a cell, so that a beam's sum does not overflow
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0) return;
    INSONIFY_CHECK(thread < intensities_.size(), thread, intensities_.size());
    std::vector<float>& intensities = intensities_[thread];
    std::ranges::fill(intensities, 0.0f);
    addOwnSums(rules, sums, cell, solid_angle, intensities);
    const double quanta = quanta_per_unit * rules.strength_scale / solid_angle;
    for (size_t bin = 0; bin < bin_count_; ++bin) {
        double intensity = 0;
        for (size_t i = bin * per_bin_; i < (bin + 1) * per_bin_; ++i) intensity += double{intensities[i]};
        if (!(intensity > 0)) continue;
        const double energy = std::clamp(intensity / levels_.factor(bin) * quanta, 1.0, maximum);
        std::atomic_ref(energies_[static_cast<size_t>(beam) * bin_count_ + bin])
            .fetch_add(static_cast<uint64_t>(energy + 0.5), std::memory_order_relaxed);
    }
}

TruthGrid::TruthGrid(const RenderPlan& plan, const EchoRules& rules, bool whole, int threads)
    : beams_of_cells_(beamsOfCells(plan)), beam_count_(plan.beams.size()) {
    if (!rules.own.empty()) water_.emplace(plan, static_cast<size_t>(rules.bins.bin_count), threads);
    if (whole && beams_of_cells_.empty()) return;
    gathered_.emplace(beam_count_, static_cast<size_t>(plan.grid.bin_count));
    alone_.resize(beam_count_);
}

void TruthGrid::begin() {
    if (gathered_) gathered_->clear();
    if (water_) water_->begin();
}

void TruthGrid::take(size_t cell, const TruthTable& echoes, size_t of, types::SonarTruth& truth) {
    const int32_t row = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (row < 0) return;
    const auto beam = static_cast<size_t>(row);
    if (!gathered_) return echoes.report(of, beam, truth, getWater(beam));
    const std::lock_guard one_at_a_time(alone_[beam]);
    gathered_->merge(beam, echoes, of);
}

void TruthGrid::finish(types::SonarTruth& truth, ThreadPool& threads) const {
    if (!gathered_) return;
    std::atomic<size_t> next = 0;
    threads.share([&](int, int) {
        for (size_t beam = next++; beam < beam_count_; beam = next++)
            gathered_->report(beam, beam, truth, getWater(beam));
    });
}

PathTruth::PathTruth(const RenderPlan& plan, size_t bin_count)
    : beams_of_cells_(beamsOfCells(plan)),
      selection_(plan.options.selection),
      sum_count_(bin_count),
      bin_count_(static_cast<size_t>(plan.grid.bin_count)),
      shown_(plan.beams.size(), bin_count_),
      alone_(plan.beams.size()) {
    for (std::vector<uint64_t>& sums : sums_) sums.resize(plan.cells.size() * sum_count_);
    for (std::vector<double>& energies : energies_) energies.resize(plan.beams.size() * bin_count_);
}

void PathTruth::begin() {
    for (std::vector<uint64_t>& sums : sums_) std::ranges::fill(sums, 0);
    for (std::vector<double>& energies : energies_) std::ranges::fill(energies, 0.0);
    shown_.clear();
}

void PathTruth::show(size_t cell, size_t bin, const ObjectEcho& echo) {
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0 || echo.energy == 0) return;
    INSONIFY_CHECK(bin < sum_count_, bin, sum_count_);
    const std::lock_guard one_at_a_time(alone_[static_cast<size_t>(beam)]);
    shown_.add(static_cast<size_t>(beam), bin / (sum_count_ / bin_count_), echo);
}

void PathTruth::take(size_t cell, std::span<const float> direct, const BinLevels& levels, double quantum) {
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0) return;
    const size_t first = static_cast<size_t>(beam) * bin_count_, per_bin = sum_count_ / bin_count_;
    knows_direct_ = !direct.empty();
    for (size_t j = 0; j < direct.size(); ++j) energies_[0][first + j] += double{direct[j]};
    for (size_t path = 0; path < sums_.size(); ++path)
        for (size_t j = 0; j < sum_count_; ++j) {
            const uint64_t sum = sums_[path][cell * sum_count_ + j];
            if (sum > 0)
                energies_[path + 1][first + j / per_bin] +=
                    double{levels.intensity(j, static_cast<double>(sum) * quantum)};
        }
}

uint8_t PathTruth::loudest(const types::SonarTruth& truth, size_t at, double water) const {
    const bool of_surface = truth.hits[at] > 0 && truth.path[at] != types::SonarTruth::water;
    if (!knows_direct_ && of_surface) return 0;
    double energy = std::max(energies_[0][at] - water, water);
    uint8_t loudest = 0;
    for (uint8_t path = 1; path < energies_.size(); ++path)
        if (energies_[path][at] > energy) loudest = path, energy = energies_[path][at];
    return loudest;
}

void PathTruth::completeBin(types::SonarTruth& truth, size_t at, double water) const {
    const bool is_shown = truth.isByMirror(at) && shown_truth_.object[at] >= 0;
    const bool of_water = truth.object[at] < 0 && truth.share[at] > 0;
    const double direct = knows_direct_ ? energies_[0][at] : of_water ? water / double{truth.share[at]} : 0;
    const double paths = sumPathEnergy(at), all = paths + direct;
    if (!is_shown) {
        if (direct > 0) truth.share[at] = static_cast<float>(double{truth.share[at]} * direct / all);
        return;
    }
    truth.object[at] = shown_truth_.object[at];
    truth.share[at] = static_cast<float>(double{shown_truth_.share[at]} * paths / all);
    truth.elevation[at] = shown_truth_.elevation[at];
    truth.grazing[at] = shown_truth_.grazing[at];
    truth.hits[at] += shown_truth_.hits[at];
}

void PathTruth::report(types::SonarTruth& truth, const WaterTruth* water, double quantum) {
    types::SonarTruth::forEachArray(shown_truth_,
                                    [&](const char*, auto& numbers, auto) { numbers.resize(truth.object.size()); });
    for (size_t beam = 0; beam < truth.beam_count; ++beam) {
        shown_.report(beam, beam, shown_truth_);
        bool echo_beyond = false;
        for (size_t j = bin_count_; j-- > 0;) {
            const size_t at = beam * bin_count_ + j;
            const double of_water = water ? water->intensity(beam, j, quantum) : 0;
            const uint8_t loudest = this->loudest(truth, at, of_water);
            const bool received = truth.hits[at] > 0 || sumPathEnergy(at) > 0;
            if (loudest > 0) truth.path[at] = loudest;
            truth.shadow[at] = echo_beyond && !received;
            echo_beyond = echo_beyond || received;
            completeBin(truth, at, of_water);
        }
    }
}

void GridTruth::forget(size_t at, types::SonarTruth& truth) {
    truth.object[at] = types::SonarTruth::no_object;
    truth.share[at] = 0;
    truth.hits[at] = 0;
    truth.elevation[at] = truth.grazing[at] = unknown;
    truth.path[at] = truth.shadow[at] = 0;
}

void GridTruth::shape(const types::Sonar& ping, size_t rows, types::SonarTruth& azimuths, types::SonarTruth& returns) {
    azimuths.copyGrid(ping);
    types::Sonar grid;
    grid.time = ping.time;
    static_cast<types::RangeBins&>(grid) = ping;
    grid.bin_count = 1;
    grid.beam_count = static_cast<uint32_t>(rows * ping.beam_count);
    for (size_t row = 0; row < rows; ++row)
        grid.bearings.insert(grid.bearings.end(), ping.bearings.rbegin(), ping.bearings.rend());
    returns.copyGrid(grid);
    for (size_t cell = 0; cell < grid.beam_count; ++cell) forget(cell, returns);
}

void GridTruth::addTo(const types::Sonar& fan, const types::SonarTruth& truth, size_t column,
                      types::SonarTruth& azimuths) {
    const size_t bins = fan.bin_count;
    for (size_t bin = 0; bin < bins; ++bin) {
        echoes_.clear();
        double energy = 0;
        uint32_t hits = 0;
        for (size_t beam = 0; beam < fan.beam_count; ++beam) {
            const size_t at = beam * bins + bin;
            const auto received = static_cast<double>(fan.bins[at]);
            const bool has_label =
                truth.object[at] != types::SonarTruth::no_object || truth.path[at] == types::SonarTruth::water;
            if (!has_label || !(received > 0)) continue;
            energy += received;
            hits += truth.hits[at];
            const double share = received * static_cast<double>(truth.share[at]);
            const auto known = std::ranges::find_if(echoes_, [&](const Echo& echo) {
                return echo.object == truth.object[at] && echo.path == truth.path[at];
            });
            Echo& echo =
                known != echoes_.end() ? *known : echoes_.emplace_back(Echo{truth.object[at], truth.path[at], 0, 0, 0});
            echo.energy += share;
            echo.elevation += share * computeElevation(truth, beam, at);
            echo.grazing += share * static_cast<double>(truth.grazing[at]);
        }
        fillBin(column * bins + bin, energy, hits, azimuths);
    }
    markShadows(column * bins, bins, azimuths);
}

void GridTruth::fillBin(size_t at, double energy, uint32_t hits, types::SonarTruth& azimuths) const {
    if (echoes_.empty()) return forget(at, azimuths);
    const Echo& strongest = *std::ranges::max_element(
        echoes_, {}, [](const Echo& echo) { return std::tuple(echo.energy, -echo.path, -echo.object); });
    azimuths.object[at] = strongest.object;
    azimuths.path[at] = strongest.path;
    azimuths.share[at] = static_cast<float>(strongest.energy / energy);
    azimuths.hits[at] = hits;
    azimuths.elevation[at] = static_cast<float>(strongest.elevation / strongest.energy);
    azimuths.grazing[at] = static_cast<float>(strongest.grazing / strongest.energy);
}

void GridTruth::copyReturn(const types::SonarTruth& truth, size_t beam, size_t bin, size_t cell,
                           types::SonarTruth& returns) {
    const size_t at = beam * truth.bin_count + bin;
    returns.object[cell] = truth.object[at];
    returns.share[cell] = truth.share[at];
    returns.hits[cell] = truth.hits[at];
    returns.elevation[cell] = static_cast<float>(computeElevation(truth, beam, at));
    returns.grazing[cell] = truth.grazing[at];
    returns.path[cell] = truth.path[at];
}

}  // namespace insonify::sonar
